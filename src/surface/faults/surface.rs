//! Faults of the shape of one surface.

use glam::DVec3;

use crate::base::fault::{Describe, Report, Say, codes};
use crate::base::origin::Origin;
use crate::base::text::decimals;

/// How a surface is made, for what helps where it folds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Construction {
    /// From curves around it and across.
    Curves,
    /// Through sections in an order.
    Sections,
    /// A profile is carried.
    Carried,
}

/// What can go wrong with the shape of a surface, or deserves a word. Lengths are model units, angles radians.
#[derive(Clone, Debug, PartialEq)]
pub enum SurfaceFault {
    /// W606: the two derivatives are parallel or vanish inside.
    PatchSingular {
        /// The surface.
        surface: Origin,
        /// Where, u and v.
        uv: (f64, f64),
        /// Where in space.
        at: DVec3,
        /// How the surface is made.
        made: Construction,
    },
    /// W607: the normal flips inside.
    PatchFolded {
        /// The surface.
        surface: Origin,
        /// Where, u and v.
        uv: (f64, f64),
        /// Where in space.
        at: DVec3,
        /// Angle between the normal there and that of the neighbouring sample.
        turn: f64,
        /// How the surface is made.
        made: Construction,
    },
    /// W669: a surface crosses itself, or two faces made together cross.
    CrossesItself {
        /// The surface.
        surface: Origin,
        /// Where, u and v of both places; none of two faces.
        uv: Option<((f64, f64), (f64, f64))>,
        /// Where in space.
        at: DVec3,
    },
    /// N608: the Lagrange map may swing out between its curves.
    TransfiniteOscillation {
        /// The surface.
        surface: Origin,
        /// `u` or `v`.
        direction: char,
        /// Curves across that direction.
        curves: usize,
        /// Largest sum of the absolute blending values.
        lebesgue: f64,
    },
    /// W614: kinks so close that a strip of patches is a sliver.
    SliverPatch {
        /// The surface.
        surface: Origin,
        /// `u` or `v`: the direction across the strip.
        direction: char,
        /// Where the strip begins and ends.
        from_to: (f64, f64),
        /// Width of the strip, length.
        width: f64,
        /// Width of its narrower neighbour, length.
        neighbour: f64,
        /// A point on the strip.
        at: DVec3,
    },
    /// W651: rows of points whose spacing differs much from the mean.
    GridUneven {
        /// The surface.
        surface: Origin,
        /// `row` or `column`.
        line: &'static str,
        /// Its number, from 0.
        index: usize,
        /// Its spacing over the mean.
        ratio: f64,
        /// Where.
        at: DVec3,
    },
    /// E676 `no-net`: a surface that is no single B-spline net.
    NoNet {
        /// The surface.
        surface: Origin,
        /// It is a trimmed one, else a plane without sides.
        trimmed: bool,
    },
    /// W664 `offset-folds`: an offset turns back over itself.
    OffsetFolds {
        /// The offset.
        surface: Origin,
        /// How far, model units.
        distance: f64,
        /// The largest distance to that side without a fold, as sampled.
        largest: f64,
        /// The place of the surface below that bends tightest.
        at: DVec3,
    },
}

impl Describe for SurfaceFault {
    codes! {
        PatchSingular "W606", PatchFolded "W607", CrossesItself "W669", TransfiniteOscillation "N608", SliverPatch "W614",
        GridUneven "W651", NoNet "E676", OffsetFolds "W664"
    }

    fn describe(&self, say: &dyn Say) -> Report {
        let uv = |(u, v): (f64, f64)| format!("u {}, v {}", decimals(u, 3), decimals(v, 3));
        match self {
            Self::PatchSingular { surface, uv: place, at, made } => {
                Report::new(format!("{} has no normal at {}, {}", say.quoted(*surface, "this surface"), uv(*place), say.point(*at)))
                    .at(*surface, "u and v tangents are parallel there")
                    .help(match made {
                        Construction::Curves => "let no two borders be tangent to each other at a corner, or take the corner as `pole:`",
                        Construction::Sections => IN_ORDER,
                        Construction::Carried => ACROSS,
                    })
            }
            Self::PatchFolded { surface, uv: place, at, turn, made } => Report::new(format!(
                "{} folds over: its normal turns by {} at {}, {}",
                say.quoted(*surface, "this surface"),
                say.angle(*turn),
                uv(*place),
                say.point(*at)
            ))
            .at(*surface, "the parametrisation folds there")
            .help(match made {
                Construction::Curves => "add a curve across the fold, or divide the surface in two",
                Construction::Sections => IN_ORDER,
                Construction::Carried => ACROSS,
            }),
            Self::CrossesItself { surface, uv: places, at } => {
                let (name, at) = (say.quoted(*surface, "this surface"), say.point(*at));
                let message = match places {
                    Some((a, b)) => format!("{name} crosses itself at {at}: {} and {} are the same point", uv(*a), uv(*b)),
                    None => format!("{name} crosses itself at {at}: two of its faces cross there"),
                };
                Report::new(message)
                    .at(*surface, "passes through itself there")
                    .help("a mesh of it has no nodes on the crossing line: move the curves apart, or build parts that meet along that line")
            }
            Self::TransfiniteOscillation { surface, direction, curves, lebesgue } => Report::new(format!(
                "{} may oscillate between its {curves} curves across {direction}: errors are amplified up to {lebesgue:.1} times",
                say.quoted(*surface, "this surface")
            ))
            .at(*surface, "one polynomial through all curves")
            .help("`coons` with the same curves stays between them"),
            Self::SliverPatch { surface, direction, from_to, width, neighbour, at } => Report::new(format!(
                "kinks on opposite borders of {} are slightly offset: they leave a strip {} wide beside one of {}, {direction} {} to {}, at {}",
                say.quoted(*surface, "this surface"),
                say.length(*width),
                say.length(*neighbour),
                decimals(from_to.0, 6),
                decimals(from_to.1, 6),
                say.point(*at)
            ))
            .at(*surface, "the kinks of opposite borders split it here")
            .help("move the kinks to the same fraction of the length on both borders"),
            Self::GridUneven { surface, line, index, ratio, at } => Report::new(format!(
                "{line} {index} of {} deviates from the mean spacing by a factor of {ratio:.1} at {}",
                say.quoted(*surface, "this grid"),
                say.point(*at)
            ))
            .at(*surface, "all rows share one parameter")
            .help("resample the rows: `[for r in rows: spline(r).points(20)]`"),
            Self::NoNet { surface, trimmed } => {
                let (why, help) = match trimmed {
                    true => ("is trimmed", "take `nurbs` of the surface that it was cut from, and trim that"),
                    false => ("is a plane without four sides", "bound it by four curves"),
                };
                Report::new(format!("{} has no B-spline form: it {why}", say.quoted(*surface, "the surface"))).at(*surface, why).help(help)
            }
            Self::OffsetFolds { surface, distance, largest, at } => {
                let message = format!(
                    "{} folds over: at {} the radius of curvature of the surface is {}, less than the distance, {}",
                    say.quoted(*surface, "this offset"),
                    say.point(*at),
                    say.length(*largest),
                    say.length(distance.abs())
                );
                let most = say.length(largest.copysign(*distance));
                Report::new(message).at(*surface, "turns back there").help(format!("a distance between 0 and {most} does not fold there"))
            }
        }
    }
}

/// Help where sections fold.
const IN_ORDER: &str = "list the sections in the order of the surface, none crossing its neighbours";

/// Help where a profile is swept along itself.
const ACROSS: &str =
    "draw the profile across the path, at its start (`-path` starts at the other end), and smaller than the bends of the path";
