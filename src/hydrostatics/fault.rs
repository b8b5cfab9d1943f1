//! What can go wrong with a body in water.

use glam::DVec3;

use crate::base::fault::{Describe, Report, Say, codes};
use crate::base::origin::Origin;

/// What can go wrong with a body in water.
#[derive(Clone, Debug, PartialEq)]
pub enum FloatFault {
    /// E656: edges of one face alone lie below the water.
    OpenBelow {
        /// The body.
        body: Origin,
        /// Surface, lowest point and depth of each, the deepest first.
        edges: Vec<(Origin, DVec3, f64)>,
        /// Whether the water is over all of it.
        under: bool,
    },
    /// E656: the faces do not close below the water, although no edge is free there.
    Open {
        /// The body.
        body: Origin,
        /// Difference of the volumes by two sums over the same faces, cubic model units.
        off: f64,
        /// The volume by one of them.
        volume: f64,
    },
    /// E656: the faces enclose nothing up to their highest point.
    NoInside {
        /// The body.
        body: Origin,
    },
    /// E413: no position was found at which weight and buoyancy are in balance.
    NoEquilibrium {
        /// The body.
        body: Origin,
        /// Heel of the last position, radians.
        heel: f64,
        /// Rounds done.
        rounds: usize,
        /// Difference of the volumes that remained, as a share of the wanted one.
        off: f64,
    },
    /// E306: the body sinks, or is too light to be in the water.
    Sinks {
        /// The body.
        body: Origin,
        /// The volume that would carry the weight, cubic model units.
        wanted: f64,
        /// The volume of all of it.
        whole: f64,
    },
}

impl Describe for FloatFault {
    codes! { OpenBelow "E656", Open "E656", NoInside "E656", NoEquilibrium "E413", Sinks "E306" }

    fn describe(&self, say: &dyn Say) -> Report {
        match self {
            Self::OpenBelow { body, edges, under } => {
                let text = format!(
                    "the volume of {} below the water needs faces that close, but {} free edge{} there",
                    say.quoted(*body, "the body"),
                    edges.len(),
                    if edges.len() == 1 { " lies" } else { "s lie" }
                );
                let mut report = Report::new(text).at(*body, "open below the water");
                for (surface, at, depth) in edges.iter().take(4) {
                    let (name, at, depth) = (say.quoted(*surface, "a face"), say.point(*at), say.length(*depth));
                    report = report.note(format!("free edge of {name}, at {at} {depth} below the water"));
                }
                report.help(if *under {
                    "all of it is under water: a draft is counted from `base:`, else from z = 0"
                } else {
                    "add the faces that close it; only the top above the water and the plane y = 0 of a half may be open"
                })
            }
            Self::Open { body, off, volume } => Report::new(format!(
                "the faces of {} do not close below the water: two sums for its volume differ by {:.2} %",
                say.quoted(*body, "the body"),
                100.0 * off / volume.abs().max(f64::MIN_POSITIVE)
            ))
            .at(*body, "not closed, or not turned alike")
            .help("`report connection(…)` shows how its faces join; faces of a mesh must all be turned outwards"),
            Self::NoInside { body } => Report::new(format!("the faces of {} enclose nothing", say.quoted(*body, "the body")))
                .at(*body, "no volume")
                .help("a half hull lies on one side of y = 0, with x forward and z up"),
            Self::NoEquilibrium { body, heel, rounds, off } => Report::new(format!(
                "no position of {} in equilibrium was found in {rounds} rounds: at a heel of {} the volume is off by {off:.1e} of it",
                say.quoted(*body, "the body"),
                say.angle(*heel)
            ))
            .at(*body, "does not come to rest")
            .help("give a mass and a centre of gravity nearer to a position known to be stable"),
            Self::Sinks { body, wanted, whole } => {
                let text = format!(
                    "{} does not float: its weight needs {:.6} of the volume that it has up to its highest point",
                    say.quoted(*body, "the body"),
                    wanted / whole
                );
                Report::new(text).at(*body, "sinks").help("a smaller mass, or a denser water")
            }
        }
    }
}
