//! A round of `snap`: the ends of its curves, moved by [`network::snap::snap`](crate::network::snap::snap).

use glam::DVec3;

use crate::base::fault::Fault;
use crate::base::origin::Origin;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::pipeline::Declared;
use crate::network::Chain;
use crate::network::fault::CurveEnd;
use crate::network::snap::{Hold, SnapEnd, snap};

/// When a curve is snapped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turn {
    /// In this round.
    Now,
    /// In a round before; it stays from then on when other curves are made from it.
    Before {
        /// Whether some are.
        named: bool,
    },
}

/// Brings ends of curves that are closer than `distance`, model units, together or to a declared point, before anything asks for the
/// tolerance. What moved is replaced in place and noted (N513). `asked` is the expression that says the distance.
pub(crate) fn move_ends(
    cx: &mut Cx,
    curves: &mut [(Declared<Chain>, Turn)],
    points: &[DVec3],
    distance: f64,
    asked: Origin,
) -> Result<(), Halt> {
    let tolerance = cx.tolerance()?;
    let (mut ends, mut owners) = (Vec::new(), Vec::new());
    for (k, (declared, turn)) in curves.iter().enumerate() {
        let Some(curve) = declared.value.whole_curve().filter(|c| !c.is_closed(&tolerance)) else { continue };
        let hold = match turn {
            _ if !curve.has_movable_ends(&tolerance) => Hold::Fixed,
            Turn::Before { named: true } => Hold::Settled,
            Turn::Before { named: false } | Turn::Now => Hold::Free,
        };
        let length = declared.value.length();
        for (last, at) in [(false, curve.start()), (true, curve.end())] {
            ends.push(SnapEnd { end: CurveEnd { of: declared.origin, last, at }, hold, length });
            owners.push(k);
        }
    }
    let mut sink: Vec<Fault> = Vec::new();
    let moves = snap(&ends, points, distance, asked, &tolerance, &mut sink)?;
    cx.say_all(&sink);
    let mut places: Vec<DVec3> = ends.iter().map(|e| e.end.at).collect();
    let mut moved = vec![false; owners.len()];
    for m in &moves {
        places[m.end] = m.to;
        moved[m.end] = true;
    }
    for pair in (0..ends.len()).step_by(2) {
        if moved[pair] || moved[pair + 1] {
            let declared = &mut curves[owners[pair]].0;
            if let Some(curve) = declared.value.whole_curve() {
                declared.value = Chain::of_curve(&curve.with_ends(places[pair], places[pair + 1])?);
            }
        }
    }
    Ok(())
}
