//! Faces that a method cannot mesh.

use glam::DVec3;

use crate::base::fault::{Describe, Edit, Report, Say, Subject, codes};
use crate::base::origin::Origin;

/// Why a face cannot be meshed as asked for. Lengths are model units.
#[derive(Clone, Debug, PartialEq)]
pub enum FaceFault {
    /// E705: a face that the mapped method cannot do.
    CannotMap {
        /// The surface.
        surface: Origin,
        /// Why, in words.
        why: String,
        /// A point of the face.
        at: DVec3,
        /// What to write instead.
        help: Option<&'static str>,
    },
    /// E704: triangles that cannot be avoided.
    QuadsImpossible {
        /// The mesh.
        mesh: Origin,
        /// Surface, number of triangles, place.
        places: Vec<(Origin, u64, DVec3)>,
    },
    /// E704: a method that makes triangles only.
    TrianglesOnly {
        /// The mesh or rule that asks for quads.
        of: Origin,
        /// The method.
        method: &'static str,
        /// The surface.
        surface: Origin,
        /// A point of the face.
        at: DVec3,
    },
    /// E713: borders of a face that cross or touch once they are divided.
    BordersCross {
        /// The surface.
        surface: Origin,
        /// Where.
        at: DVec3,
        /// The size of the face, model units.
        size: f64,
    },
    /// E716: a quadtree over a face would need more levels than it may have.
    TreeTooDeep {
        /// The surface.
        surface: Origin,
        /// Where.
        at: DVec3,
        /// The levels it may have.
        levels: u8,
    },
    /// E714: a face with nothing inside its border.
    Empty {
        /// The surface.
        surface: Origin,
        /// Where.
        at: DVec3,
    },
}

impl Describe for FaceFault {
    codes! {
        CannotMap "E705", QuadsImpossible "E704", TrianglesOnly "E704", BordersCross "E713", TreeTooDeep "E716", Empty "E714"
    }

    fn describe(&self, say: &dyn Say) -> Report {
        match self {
            Self::CannotMap { surface, why, at, help } => {
                let report = Report::new(format!("{} cannot be mapped at {}: {why}", say.quoted(*surface, "a face"), say.point(*at)))
                    .at(*surface, "this face");
                help.iter().fold(report, |report, help| report.help(*help))
            }
            Self::QuadsImpossible { mesh, places } => {
                let total: u64 = places.iter().map(|p| p.1).sum();
                let triangles = if total == 1 { "element must be a triangle" } else { "elements must be triangles" };
                let mut report =
                    Report::new(format!("`elements: quads` is impossible here: {total} {triangles}")).at(*mesh, "`elements: quads`");
                for (surface, count, at) in places.iter().take(8) {
                    let plural = if *count == 1 { "" } else { "s" };
                    report = report.at(*surface, format!("{count} triangle{plural} at {}", say.point(*at)));
                }
                report.help("elements: mixed").edit(Subject::Entity(*mesh), Edit::Set("elements", "mixed".to_owned()))
            }
            Self::TrianglesOnly { of, method, surface, at } => {
                Report::new(format!("`elements: quads` is impossible here: `method: {method}` makes triangles, at {}", say.point(*at)))
                    .at(*of, "`elements: quads`")
                    .at(*surface, "this face")
                    .help("method: delaunay")
            }
            Self::BordersCross { surface, at, size } => Report::new(format!(
                "borders of {} divided into steps of {} cross or touch at {}",
                say.quoted(*surface, "a face"),
                say.length(*size),
                say.point(*at)
            ))
            .at(*surface, "this face")
            .help("move the borders further apart, or divide them more finely there"),
            Self::TreeTooDeep { surface, at, levels } => Report::new(format!(
                "the quadtree of {} needs more than {levels} levels at {}",
                say.quoted(*surface, "a face"),
                say.point(*at)
            ))
            .at(*surface, "has a piece of border there shorter than a millionth of the size")
            .help("method: delaunay"),
            Self::Empty { surface, at } => {
                Report::new(format!("the border of {} encloses no area at {}", say.quoted(*surface, "a face"), say.point(*at)))
                    .at(*surface, "this face")
            }
        }
    }
}
