//! Faults of one surface: its shape, its loops, what carries it.

use glam::DVec3;

use crate::base::fault::{Code, Describe, Edit, Report, Say, Subject};
use crate::base::origin::Origin;
use crate::base::text::{decimals, real};

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

/// What can go wrong with a surface, or deserves a word. Lengths are model units, angles radians.
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
    /// N609: an end stands out over the border and is left out.
    EndTrimmed {
        /// The curve.
        curve: Origin,
        /// The border it stands out over.
        border: Origin,
        /// The end that is left out.
        end: DVec3,
        /// Length left out.
        length: f64,
    },
    /// E611: the boundary crosses itself.
    LoopSelfIntersects {
        /// One curve.
        a: Origin,
        /// The other one (or the same).
        b: Origin,
        /// Where.
        at: DVec3,
        /// Fractions of arc length along both.
        along: (f64, f64),
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
    /// E612: a loop of a closed surface with border on both sides of it.
    LoopGoesRound {
        /// The loop.
        of: Origin,
        /// The surface.
        surface: Origin,
        /// The trimming.
        trimming: Origin,
        /// A point of the loop.
        at: DVec3,
    },
    /// E613: a loop that is not on its surface.
    LoopOutsideSurface {
        /// The curve.
        of: Origin,
        /// The surface.
        surface: Origin,
        /// How far the curve is from the surface, model units.
        off: f64,
        /// Where.
        at: DVec3,
        /// The model's tolerance.
        tolerance: f64,
    },
    /// E613: a loop in (u, v) that leaves 0…1.
    LoopOutsideParameters {
        /// The curve.
        of: Origin,
        /// The surface.
        surface: Origin,
        /// Where.
        uv: (f64, f64),
    },
    /// E621: the axis is not a straight line.
    AxisNotStraight {
        /// The axis.
        axis: Origin,
        /// Its largest distance from the line through its ends.
        off: f64,
        /// Where that is.
        at: DVec3,
    },
    /// E622: the profile lies in the axis.
    GeneratrixOnAxis {
        /// The profile.
        profile: Origin,
        /// First point of the stretch in the axis.
        from: DVec3,
        /// Last point of it.
        to: DVec3,
    },
    /// E623: the profile meets the axis between its ends.
    GeneratrixCrossesAxis {
        /// The profile.
        profile: Origin,
        /// Where.
        at: DVec3,
        /// Fraction of the profile's arc length.
        fraction: f64,
    },
    /// E624: the profile runs along the direction in which it is carried.
    SweepDegenerate {
        /// The profile.
        profile: Origin,
        /// First point of the stretch.
        from: DVec3,
        /// Last point of it.
        to: DVec3,
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
    /// E655 `plane-not-flat`: boundary curves that lie in no one plane.
    PlaneNotFlat {
        /// The curve with the point farthest off.
        curve: Origin,
        /// Largest distance from the mean plane.
        off: f64,
        /// Where that is.
        at: DVec3,
        /// What would pass.
        tolerance: f64,
    },
}

/// Help where sections fold.
const IN_ORDER: &str = "list the sections in the order of the surface, none crossing its neighbours";
/// Help where a profile is swept along itself.
const ACROSS: &str =
    "draw the profile across the path, at its start (`-path` starts at the other end), and smaller than the bends of the path";

impl Describe for SurfaceFault {
    fn code(&self) -> Code {
        Code(match self {
            Self::PatchSingular { .. } => "W606",
            Self::PatchFolded { .. } => "W607",
            Self::CrossesItself { .. } => "W669",
            Self::TransfiniteOscillation { .. } => "N608",
            Self::EndTrimmed { .. } => "N609",
            Self::LoopSelfIntersects { .. } => "E611",
            Self::SliverPatch { .. } => "W614",
            Self::LoopGoesRound { .. } => "E612",
            Self::LoopOutsideSurface { .. } | Self::LoopOutsideParameters { .. } => "E613",
            Self::AxisNotStraight { .. } => "E621",
            Self::GeneratrixOnAxis { .. } => "E622",
            Self::GeneratrixCrossesAxis { .. } => "E623",
            Self::SweepDegenerate { .. } => "E624",
            Self::GridUneven { .. } => "W651",
            Self::NoNet { .. } => "E676",
            Self::OffsetFolds { .. } => "W664",
            Self::PlaneNotFlat { .. } => "E655",
        })
    }

    fn describe(&self, say: &dyn Say) -> Report {
        use SurfaceFault as F;
        let uv = |(u, v): (f64, f64)| format!("u {}, v {}", decimals(u, 3), decimals(v, 3));
        match self {
            F::PatchSingular { surface, uv: place, at, made } => {
                Report::new(format!("{} has no normal at {}, {}", say.quoted(*surface, "this surface"), uv(*place), say.point(*at)))
                    .at(*surface, "u and v tangents are parallel there")
                    .help(match made {
                        Construction::Curves => "let no two borders be tangent to each other at a corner, or take the corner as `pole:`",
                        Construction::Sections => IN_ORDER,
                        Construction::Carried => ACROSS,
                    })
            }
            F::PatchFolded { surface, uv: place, at, turn, made } => Report::new(format!(
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
            F::CrossesItself { surface, uv: places, at } => {
                let (name, at) = (say.quoted(*surface, "this surface"), say.point(*at));
                let message = match places {
                    Some((a, b)) => format!("{name} crosses itself at {at}: {} and {} are the same point", uv(*a), uv(*b)),
                    None => format!("{name} crosses itself at {at}: two of its faces cross there"),
                };
                Report::new(message)
                    .at(*surface, "passes through itself there")
                    .help("a mesh of it has no nodes on the crossing line: move the curves apart, or build parts that meet along that line")
            }
            F::TransfiniteOscillation { surface, direction, curves, lebesgue } => Report::new(format!(
                "{} may oscillate between its {curves} curves across {direction}: errors grow up to {lebesgue:.1} times",
                say.quoted(*surface, "this surface")
            ))
            .at(*surface, "one polynomial through all curves")
            .help("`coons` with the same curves stays between them"),
            F::LoopGoesRound { of, surface, trimming, at } => {
                let (which, whose) = (say.quoted(*of, "the loop"), say.quoted(*surface, "the surface"));
                Report::new(format!(
                    "{which} runs around {whose} through {}, with a border on each side: it bounds no part alone",
                    say.point(*at)
                ))
                .at(*trimming, "trimmed here")
                .at(*of, "this loop")
                .help("`by:` this loop with `keep:` a point of the part that stays")
            }
            F::LoopOutsideSurface { of, surface, off, at, tolerance } => Report::new(format!(
                "{} leaves {}: it is {} away at {}, and the tolerance is {}",
                say.quoted(*of, "the curve"),
                say.quoted(*surface, "the surface"),
                say.length(*off),
                say.point(*at),
                say.length(*tolerance)
            ))
            .at(*of, "this loop")
            .at(*surface, "this surface")
            .help("build the curve on the surface, or `project` it"),
            F::LoopOutsideParameters { of, surface, uv } => {
                let (curve, of_surface) = (say.quoted(*of, "the curve"), say.quoted(*surface, "the surface"));
                Report::new(format!("{curve} leaves {of_surface} at u = {}, v = {}: both run from 0 to 1", real(uv.0), real(uv.1)))
                    .at(*of, "x and y of this loop are u and v")
                    .at(*surface, "this surface")
            }
            F::LoopSelfIntersects { a, b, at, along } => Report::new(format!(
                "the boundary crosses itself: {} meets {} at {}, {} % along one and {} % along the other",
                say.quoted(*a, "one curve"),
                say.quoted(*b, "another one"),
                say.point(*at),
                (along.0 * 100.0).round(),
                (along.1 * 100.0).round()
            ))
            .at(*a, "this curve")
            .at(*b, "crosses this one")
            .help("list the corners in order around the face"),
            F::SliverPatch { surface, direction, from_to, width, neighbour, at } => Report::new(format!(
                "kinks of {} almost face each other: a strip {} wide beside one of {}, {direction} {} to {}, at {}",
                say.quoted(*surface, "this surface"),
                say.length(*width),
                say.length(*neighbour),
                decimals(from_to.0, 6),
                decimals(from_to.1, 6),
                say.point(*at)
            ))
            .at(*surface, "the kinks of opposite borders split it here")
            .help("move the kinks to the same fraction of the length on both borders"),
            F::NoNet { surface, trimmed } => {
                let (why, help) = match trimmed {
                    true => ("is trimmed", "take `nurbs` of the surface that it was cut from, and trim that"),
                    false => ("is a plane without four sides", "bound it by four curves"),
                };
                Report::new(format!("{} has no B-spline form: it {why}", say.quoted(*surface, "the surface"))).at(*surface, why).help(help)
            }
            F::AxisNotStraight { axis, off, at } => Report::new(format!(
                "the axis {} is not straight: {} off at {}",
                say.quoted(*axis, "of the rotation"),
                say.length(*off),
                say.point(*at)
            ))
            .at(*axis, "must be one straight line")
            .help("axis: line((0, 0, 0), (0, 0, 1))")
            .edit(Subject::Call, Edit::Set("axis", "line((0, 0, 0), (0, 0, 1))".to_owned())),
            F::GeneratrixOnAxis { profile, from, to } => {
                let (from, to) = say.pair(*from, *to);
                Report::new(format!("{} lies on the axis from {from} to {to}", say.quoted(*profile, "the profile")))
                    .at(*profile, "sweeps no area there")
                    .help("leave that stretch out: `profile[A..B]`")
            }
            F::GeneratrixCrossesAxis { profile, at, fraction } => Report::new(format!(
                "{} meets the axis between its ends, at {}, {} % along",
                say.quoted(*profile, "the profile"),
                say.point(*at),
                decimals(fraction * 100.0, 1)
            ))
            .at(*profile, "meets the axis")
            .help(format!("revolve one side only: `{}[0%..{}%]`", named_or(say.name(*profile), "profile"), decimals(fraction * 100.0, 6)))
            .edit(
                Subject::Argument("profile"),
                Edit::Instead { of: say.name(*profile), put: format!("{}[0%..{}%]", say.name(*profile), decimals(fraction * 100.0, 6)) },
            ),
            F::SweepDegenerate { profile, from, to } => {
                let ((from, to), which) = (say.pair(*from, *to), say.quoted(*profile, "the profile"));
                Report::new(format!("{which} runs along the direction of the sweep from {from} to {to}: no area"))
                    .at(*profile, "parallel to the sweep")
                    .help("choose another `by:`, or leave that stretch out")
            }
            F::GridUneven { surface, line, index, ratio, at } => Report::new(format!(
                "{line} {index} of {} deviates from the mean spacing by a factor of {ratio:.1} at {}",
                say.quoted(*surface, "this grid"),
                say.point(*at)
            ))
            .at(*surface, "all rows share one parameter")
            .help("resample the rows: `[for r in rows: spline(r).points(20)]`"),
            F::OffsetFolds { surface, distance, largest, at } => {
                let message = format!(
                    "{} folds over: at {} the surface bends with a radius of {}, less than the distance, {}",
                    say.quoted(*surface, "this offset"),
                    say.point(*at),
                    say.length(*largest),
                    say.length(distance.abs())
                );
                let most = say.length(largest.copysign(*distance));
                Report::new(message).at(*surface, "turns back there").help(format!("a distance between 0 and {most} does not fold there"))
            }
            F::PlaneNotFlat { curve, off, at, tolerance } => Report::new(format!(
                "the boundary is not flat: {} is {} off the plane at {}; the tolerance is {}",
                say.quoted(*curve, "one curve"),
                say.length(*off),
                say.point(*at),
                say.length(*tolerance)
            ))
            .at(*curve, "leaves the plane of the others")
            .help("`coons` takes borders that are not flat")
            .edit(Subject::Call, Edit::Instead { of: "plane".to_owned(), put: "coons".to_owned() }),
            F::EndTrimmed { curve, border, end, length } => Report::new(format!(
                "{} extends {} past {} to {}; the overhang is ignored",
                say.quoted(*curve, "a curve"),
                say.length(*length),
                say.quoted(*border, "the border"),
                say.point(*end)
            ))
            .at(*curve, "trimmed to the border"),
        }
    }
}

/// A name, or a word that stands for one that is missing.
fn named_or(name: String, otherwise: &str) -> String {
    if name.is_empty() { otherwise.to_owned() } else { name }
}
