//! Nodes and links: which points are one node, who shares a link, and what is still used.

use glam::DVec3;

use crate::base::fault::quantities::typed;
use crate::base::fault::{Describe, Edit, Report, Say, Subject, codes};
use crate::base::origin::Origin;

/// What can go wrong with the graph of nodes and links, or deserves a word. Lengths and points are in model units.
#[derive(Clone, Debug, PartialEq)]
pub enum GraphFault {
    /// E506: points that are pairwise close form a cluster wider than two tolerances.
    ClusterAmbiguous {
        /// Some of the points, farthest pair first, with their curves.
        points: Vec<(DVec3, Origin)>,
        /// How many points there are.
        count: usize,
        /// Largest distance between two of them.
        diameter: f64,
        /// The tolerance applied.
        tolerance: f64,
        /// A tolerance that keeps them apart.
        smaller: f64,
    },
    /// N512: two curves run over the same links.
    SharedRun {
        /// The curve that owns the links.
        owner: Origin,
        /// The curve that runs over them.
        other: Origin,
        /// Ends of the run.
        run: (DVec3, DVec3),
        /// Its length.
        length: f64,
    },
    /// E510: something higher stands on it.
    InUse {
        /// What was to be removed.
        of: Origin,
        /// Who uses it, upper-most first.
        users: Vec<Origin>,
    },
}

impl Describe for GraphFault {
    codes! { ClusterAmbiguous "E506", SharedRun "N512", InUse "E510" }

    fn describe(&self, say: &dyn Say) -> Report {
        match self {
            Self::ClusterAmbiguous { points, count, diameter, tolerance, smaller } => {
                let mut report = Report::new(format!(
                    "{count} points near {} are pairwise closer than {} but spread over {}: it is ambiguous which of them are one node",
                    say.point(points.first().map_or(DVec3::ZERO, |p| p.0)),
                    say.length(*tolerance),
                    say.length(*diameter)
                ));
                for (point, of) in points {
                    report = report.at(*of, format!("through {}", say.point(*point)));
                }
                let smaller = typed(say, *smaller);
                report.help(format!("`tolerance {smaller}` keeps them apart")).edit(Subject::Call, Edit::Declare("tolerance", smaller))
            }
            Self::SharedRun { owner, other, run, length } => {
                let ((from, to), long) = (say.pair(run.0, run.1), say.length(*length));
                let (one, another) = (say.quoted(*owner, "one curve"), say.quoted(*other, "another"));
                let first = say.quoted(*owner, "the first");
                Report::new(format!("{one} and {another} share a run of {long} from {from} to {to}; it belongs to {first}"))
                    .at(*other, "runs over it")
                    .at(*owner, "owns it")
            }
            Self::InUse { of, users } => in_use(*of, users, say),
        }
    }
}

fn in_use(of: Origin, users: &[Origin], say: &dyn Say) -> Report {
    let names: Vec<String> = users.iter().map(|&u| say.quoted(u, "an unnamed entity")).collect();
    let name = say.name(of);
    let mut report = Report::new(format!("{} is used by {}", say.quoted(of, "this"), names.join(", "))).at(of, "to be removed");
    for &user in users {
        report = report.at(user, "uses it");
    }
    report.help(format!("remove {} first, or `:remove! {name}` to remove all", names.join(", then ")))
}
