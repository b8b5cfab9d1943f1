//! Guides and paths along which sections are carried.

use glam::DVec3;

use crate::base::fault::{Describe, Report, Say, codes};
use crate::base::origin::Origin;
use crate::base::text::decimals;
use crate::surface::faults::sections::few;

/// What can go wrong with a guide or path, or deserves a word. Lengths are model units.
#[derive(Clone, Debug, PartialEq)]
pub enum SweepFault {
    /// E634: a guide does not reach the plane of a station.
    GuideMissesStation {
        /// The guide.
        guide: Origin,
        /// The law's word.
        law: &'static str,
        /// The station, as a fraction of the main guide.
        station: f64,
        /// Its place on the main guide.
        at: DVec3,
        /// How near the guide comes to its plane.
        miss: f64,
        /// Where.
        nearest: DVec3,
    },
    /// E635: a guide runs back against the law.
    GuideDoublesBack {
        /// The guide.
        guide: Origin,
        /// The law's word.
        law: &'static str,
        /// Where.
        at: DVec3,
    },
    /// E637: the main guide touches the axis.
    MainGuideOnAxis {
        /// The guide.
        guide: Origin,
        /// Where.
        at: DVec3,
        /// Its distance from the axis there.
        off: f64,
    },
    /// N638: a guide was made longer to reach all stations.
    GuideExtended {
        /// The guide.
        guide: Origin,
        /// By how much.
        length: f64,
        /// As a share of its length.
        share: f64,
        /// The new end.
        end: DVec3,
    },
    /// E636: a guide or a path turns back on itself, or has no direction.
    GuideCusp {
        /// The guide.
        guide: Origin,
        /// Where.
        at: DVec3,
        /// Fraction of its arc length.
        fraction: f64,
        /// It turns at once there, but not back.
        still: bool,
    },
    /// E306: a run of a path that ends in a mitred corner is bent.
    BentRun {
        /// The path.
        path: Origin,
        /// The corner.
        at: DVec3,
        /// Fraction of its arc length.
        fraction: f64,
    },
    /// W639: what is carried moves backwards somewhere, so that the surface crosses itself.
    SelfIntersects {
        /// The surface.
        surface: Origin,
        /// The path or main guide.
        path: Origin,
        /// Where on the surface.
        at: DVec3,
        /// How far that is from the path.
        reach: f64,
        /// Radius of the path's bend there; none on a straight run between corners.
        radius: Option<f64>,
    },
    /// W646: between its stations a sweep is off its law.
    LawMissed {
        /// The surface.
        surface: Origin,
        /// Name of the law.
        law: &'static str,
        /// By how much, model units.
        off: f64,
        /// The same as a share of the section's length.
        share: f64,
        /// A point of the section that the law asks for.
        at: DVec3,
    },
}

impl Describe for SweepFault {
    codes! {
        GuideMissesStation "E634", GuideDoublesBack "E635", MainGuideOnAxis "E637", GuideExtended "N638", GuideCusp "E636",
        BentRun "E306", SelfIntersects "W639", LawMissed "W646"
    }

    fn describe(&self, say: &dyn Say) -> Report {
        match self {
            Self::GuideMissesStation { guide, law, station, at, miss, nearest } => Report::new(format!(
                "{} does not reach the station at {}% of the main guide, {}: under the {law} law its nearest point, {}, is {} away",
                say.quoted(*guide, "a guide"),
                decimals(100.0 * station, 1),
                say.point(*at),
                say.point(*nearest),
                say.length(*miss)
            ))
            .at(*guide, "too short, even extended by a quarter at each end")
            .help("draw this guide as far as the main guide goes, or cut the main guide: `c[A..B]`"),
            Self::GuideDoublesBack { guide, law, at } => Report::new(format!(
                "{} doubles back at {}: under the {law} law a section would pass there twice",
                say.quoted(*guide, "a guide"),
                say.point(*at)
            ))
            .at(*guide, "turns back here")
            .help("take the run of it that goes one way, `c[A..B]`, or another `law:`"),
            Self::MainGuideOnAxis { guide, at, off } => Report::new(format!(
                "{} is {} from the axis at {}: no half-plane through it is defined there",
                say.quoted(*guide, "the main guide"),
                say.length(*off),
                say.point(*at)
            ))
            .at(*guide, "meets the axis")
            .help("list another guide first, one that does not meet the axis"),
            Self::GuideExtended { guide, length, share, end } => Report::new(format!(
                "{} was extended by {} ({}% of its length), to {}, so that it reaches every station",
                say.quoted(*guide, "a guide"),
                say.length(*length),
                decimals(100.0 * share, 1),
                say.point(*end)
            ))
            .at(*guide, "extrapolated at its end"),
            Self::GuideCusp { guide, at, fraction, still } => {
                let what = if *still { "has unbounded curvature" } else { "turns back on itself" };
                let (which, share) = (say.quoted(*guide, "the path"), decimals(100.0 * fraction, 1));
                Report::new(format!("{which} {what} at {}, {share}% of its length", say.point(*at)))
                    .at(
                        *guide,
                        if *still { "no section can follow it there" } else { "has no direction there that a section could follow" },
                    )
                    .help(if *still {
                        "leave out control points that coincide there, or draw a wider bend"
                    } else {
                        "take the runs before and after it, `c[0..P]` and `c[P..1]`, or replace the cusp by a bend"
                    })
            }
            Self::BentRun { path, at, fraction } => Report::new(format!(
                "{} is curved beside its corner at {}, {}% of its length: a mitre needs straight runs there",
                say.quoted(*path, "the path"),
                say.point(*at),
                decimals(100.0 * fraction, 1)
            ))
            .at(*path, "runs beside a mitred corner must be straight")
            .help("`corner: round` turns the profile about the corner"),
            Self::SelfIntersects { surface, path, at, reach, radius } => {
                let why = match radius {
                    Some(radius) => {
                        format!(
                            "the section extends {} from a path whose radius of curvature there is {}",
                            say.length(*reach),
                            say.length(*radius)
                        )
                    }
                    None => format!("the path between its corners is too short for a section that extends {} from it", say.length(*reach)),
                };
                Report::new(format!("{} crosses itself at {}: {why}", say.quoted(*surface, "this sweep"), say.point(*at)))
                    .at(*path, "bends too sharply for this section")
                    .help("draw the path with wider bends, or a smaller section")
            }
            Self::LawMissed { surface, law, off, share, at } => law_missed(say, *surface, law, (*off, *share), *at),
        }
    }
}

fn law_missed(say: &dyn Say, surface: Origin, law: &str, (off, share): (f64, f64), at: DVec3) -> Report {
    Report::new(format!(
        "{} is {} off the section that the {law} law asks for at {}: {}% of that section's length",
        say.quoted(surface, "this sweep"),
        say.length(off),
        say.point(at),
        few(100.0 * share)
    ))
    .at(surface, "made here")
    .help("list the guide that bends most there first, or add a section there")
}
