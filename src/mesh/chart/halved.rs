//! Which nodes of a border are the corners of cells that become four quads each.

use crate::mesh::border::layout::Face;
use crate::mesh::chart::face_border::FaceBorder;
use crate::mesh::chart::face_input::FaceInput;
use crate::mesh::chart::halves::Halves;
use crate::mesh::chart::outline::Outline;

/// Every second node of each segment, ascending. Where a count is odd one step in the middle stands alone.
pub(crate) fn odd(context: &FaceInput, face: &Face) -> Vec<u32> {
    let odd = |segment| {
        let ids = context.nodes.of_segment(context.layout, segment, false);
        let steps = ids.len() - 1;
        // Steps before the one alone.
        let before = if steps % 2 == 1 { 2 * (steps / 4) } else { steps };
        let middle = move |k: &usize| if *k < before { k % 2 == 1 } else { *k > before && *k < steps && k.is_multiple_of(2) };
        (0..ids.len()).filter(middle).map(|k| ids[k]).collect::<Vec<u32>>()
    };
    let mut middles: Vec<u32> = face.segments().flat_map(odd).collect();
    middles.sort_unstable();
    middles
}

/// The border of the cells: every second node of each segment, corners among them.
pub(crate) fn halved(context: &FaceInput, face: &Face, border: &FaceBorder, outline: &Outline) -> Option<Halves> {
    let middles = odd(context, face);
    Halves::new(outline, &border.ids, |n| middles.binary_search(&border.ids[n as usize]).is_ok())
}
