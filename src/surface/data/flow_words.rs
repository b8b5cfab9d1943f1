//! The flow of surfaces that are not made from a grid of curves, in the same words.

use crate::network::{Flow, FlowKind};

/// Phrase of a surface with so many poles, closed in u and in v.
pub fn phrase(poles: usize, (closed_u, closed_v): (bool, bool)) -> String {
    let kind = match poles {
        0 => FlowKind::Quadrilateral,
        1 => FlowKind::DegenerateTrilateral,
        _ => FlowKind::DegenerateBilateral,
    };
    Flow { kind, along_u: Vec::new(), along_v: Vec::new(), closed_u, closed_v, poles: (None, None), overhangs: Vec::new() }.phrase()
}
