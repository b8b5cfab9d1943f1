//! Curvature combs of the curves of a picture.

use super::picture_things::Things;
use super::pictures::{PictureContext, unsupported};
use crate::base::bbox::Box3;
use crate::base::text::decimals;
use crate::draw::color::COMB;
use crate::draw::{Scene as Drawing, combs};
use crate::lang::eval::halt::Halt;
use crate::lang::values::plans::PictureSpec;
use crate::network::{Chain, LinkId};

/// Adds the combs of all curves that are drawn, if they are asked for; E805 without curves.
pub(super) fn add(spec: &PictureSpec, things: &Things, context: &PictureContext, unit: &str, drawing: &mut Drawing) -> Result<(), Halt> {
    if spec.show.combs != Some(true) {
        return Ok(());
    }
    let own = things.curves.iter().map(|(_, chain)| chain.clone());
    let of_network = context.network(spec, things).into_iter().flat_map(|n| (0..n.links.len()).map(move |k| n.link_chain(LinkId::at(k))));
    let chains: Vec<Chain> = own.chain(of_network).collect();
    if chains.is_empty() {
        return Err(unsupported(spec.origin, "`combs` stand on curves, and none is drawn", "draw a curve, or `network: true`"));
    }
    let points = drawing.sheets.iter().flat_map(|s| &s.points).chain(drawing.lines.iter().flat_map(|l| &l.points));
    let size = Box3::of(points.copied()).diagonal();
    let (lines, most) = combs::combs(&chains.iter().collect::<Vec<_>>(), size, &context.tolerance);
    drawing.lines.extend(lines);
    let digits = (3.0 - crate::base::math::log10(most.max(f64::MIN_POSITIVE))).clamp(0.0, 12.0) as usize;
    let words = if most > 0.0 { format!("curvature, at most {}/{unit}", decimals(most, digits)) } else { "no curvature".to_owned() };
    drawing.keys.push((COMB, words));
    Ok(())
}
