//! Steps of a seam where the way round the face from one of its sides to the other is short: with steps longer than a third of it
//! there would be fewer than three elements all round. Steps of a border that turns back along itself, where elements on its two
//! sides are the same.

use crate::mesh::border::layout::Face;
use crate::mesh::chart::face_border::places;
use crate::mesh::chart::face_input::FaceInput;
use crate::mesh::chart::rings::way_round;
use crate::mesh::size::proximity::Narrow;
use crate::surface::Domain;

/// What steers the steps of seams and of borders that turn back.
struct GirthSettings {
    /// Elements all round at least.
    min_elements: f64,
    /// Steps that are longer than allowed by less than this factor stay.
    slack: f64,
    /// The least step, over the least of the size and of the step at the widest place: towards a tip steps get no shorter.
    min_step: f64,
}

const SETTINGS: GirthSettings = GirthSettings { min_elements: 3.0, slack: 1.15, min_step: 0.25 };

/// Places of the seams of a face where steps have to be shorter.
pub fn find(context: &FaceInput, face: &Face) -> Vec<Narrow> {
    let surface = &context.input.model.surfaces[face.surface.index()].surface;
    let mut found = turned(context, face);
    if surface.domain() == Domain::Loop || face.sides.len() != 4 {
        return found;
    }
    for (one, other) in [(1, 3), (0, 2)] {
        let ([used], [facing]) = (face.sides[one].uses.as_slice(), face.sides[other].uses.as_slice()) else { continue };
        if used.segment != facing.segment {
            continue;
        }
        let at = context.nodes.fractions(used.segment, false);
        let middles: Vec<f64> = at.windows(2).map(|w| 0.5 * (w[0] + w[1])).collect();
        let along = |f: &f64| used.s.0 + (used.s.1 - used.s.0) * if used.against { 1.0 - f } else { *f };
        let mut lengths: Vec<f64> = middles.iter().map(along).collect();
        lengths.sort_by(f64::total_cmp);
        let [from, to] = [one, other].map(|side| places(context.input, face, side, &lengths));
        let mut round: Vec<f64> = from.iter().zip(&to).map(|(p, q)| way_round(surface, *p, *q) / SETTINGS.min_elements).collect();
        if used.against {
            round.reverse();
        }
        let least = SETTINGS.min_step * round.iter().copied().fold(0.0, f64::max).min(face.size.0);
        for ((w, f), round) in at.windows(2).zip(&middles).zip(&round) {
            let (length, size) = (context.layout.length(used.segment) * (w[1] - w[0]), round.max(least));
            if length > SETTINGS.slack * size {
                found.push(Narrow { segment: used.segment, f: *f, size, crossing: false });
            }
        }
    }
    found
}

/// Places of borders that turn back along themselves: their steps are halved again and again.
fn turned(context: &FaceInput, face: &Face) -> Vec<Narrow> {
    let mut found = Vec::new();
    for segment in face.turns().map(|turn| turn.segment) {
        let whole = context.layout.length(segment);
        let size = (0..face.halved).fold(whole.min(face.size.0), |size, _| 0.5 * size);
        for w in context.nodes.fractions(segment, false).windows(2).filter(|w| whole * (w[1] - w[0]) > SETTINGS.slack * size) {
            found.push(Narrow { segment, f: 0.5 * (w[0] + w[1]), size, crossing: false });
        }
    }
    found
}
