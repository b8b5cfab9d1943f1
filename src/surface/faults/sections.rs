//! Sections that a sweep carries.

use glam::DVec3;

use crate::base::fault::{Describe, Report, Say, codes};
use crate::base::origin::Origin;
use crate::base::text::real;

/// What can go wrong with a section of a sweep, or deserves a word. Lengths are model units.
#[derive(Clone, Debug, PartialEq)]
pub enum SectionFault {
    /// E631: under the parallel law a section does not lie in a plane parallel to the others.
    NotParallel {
        /// The section whose plane the others are held to.
        a: Origin,
        /// The one that leaves its own.
        b: Origin,
        /// By which angle, radians.
        angle: f64,
        /// By how much at most.
        off: f64,
        /// Where.
        at: DVec3,
    },
    /// E632: under the rotational law a section does not lie in a half-plane of the axis.
    AxisOff {
        /// The section.
        section: Origin,
        /// How far its point is off.
        off: f64,
        /// That point.
        at: DVec3,
    },
    /// E633: under the normal law a section is not normal to the main guide.
    NotNormal {
        /// The section.
        section: Origin,
        /// The main guide.
        guide: Origin,
        /// By which angle, radians.
        angle: f64,
        /// How far off the normal plane.
        off: f64,
        /// Where.
        at: DVec3,
    },
    /// E640: a section does not touch a guide.
    MissesGuide {
        /// The section.
        section: Origin,
        /// The guide.
        guide: Origin,
        /// Their distance.
        gap: f64,
        /// Where, on the section.
        at: DVec3,
    },
    /// W645: a station bends to and fro more often than the sections around it.
    Ripples {
        /// The surface.
        surface: Origin,
        /// Inflections of the station.
        inflections: usize,
        /// The most that a section beside it has.
        given: usize,
        /// The first of them.
        at: DVec3,
    },
    /// W644: a section was scaled by much to touch its guides.
    Scaled {
        /// The section.
        section: Origin,
        /// The factor.
        scale: f64,
        /// The station.
        at: DVec3,
    },
}

impl Describe for SectionFault {
    codes! { NotParallel "E631", AxisOff "E632", NotNormal "E633", MissesGuide "E640", Ripples "W645", Scaled "W644" }

    fn describe(&self, say: &dyn Say) -> Report {
        match self {
            Self::NotParallel { a, b, angle, off, at } if a == b => Report::new(format!(
                "{} is not flat: at {} it is {} ({}) off its plane",
                say.quoted(*a, "a section"),
                say.point(*at),
                say.length(*off),
                say.angle(*angle)
            ))
            .at(*a, "leaves its plane")
            .help("`law: synchronized` takes sections that are not flat"),
            Self::NotParallel { a, b, angle, off, at } => Report::new(format!(
                "{} and {} are not parallel: the second is {} off, {} at {}",
                say.quoted(*a, "a section"),
                say.quoted(*b, "another one"),
                say.angle(*angle),
                say.length(*off),
                say.point(*at)
            ))
            .at(*b, "not parallel")
            .at(*a, "to this section")
            .help("draw both in parallel planes, or take `law: rotational` or `law: synchronized`"),
            Self::AxisOff { section, off, at } => Report::new(format!(
                "{} does not lie in a half-plane of the axis: it is {} off at {}",
                say.quoted(*section, "a section"),
                say.length(*off),
                say.point(*at)
            ))
            .at(*section, "its plane misses the axis, or it crosses the axis")
            .help("draw the section in a plane through `axis:`, on one side of it"),
            Self::NotNormal { section, guide, angle, off, at } => Report::new(format!(
                "{} is not normal to {}: {} off, {} at {}",
                say.quoted(*section, "a section"),
                say.quoted(*guide, "the main guide"),
                say.angle(*angle),
                say.length(*off),
                say.point(*at)
            ))
            .at(*section, "must stand at right angles")
            .at(*guide, "to this guide")
            .help("turn the section about the point where it touches the guide, or take another `law:`"),
            Self::MissesGuide { section, guide, gap, at } => Report::new(format!(
                "{} does not touch {}: they are {} apart at {}",
                say.quoted(*section, "a section"),
                say.quoted(*guide, "a guide"),
                say.length(*gap),
                say.point(*at)
            ))
            .at(*section, "must touch every guide")
            .at(*guide, "is not touched")
            .help("draw one of them through a point of the other, or leave this guide out of `guides:`"),
            Self::Ripples { surface, inflections, given, at } => Report::new(format!(
                "a station of {} has {}, the sections around it have {}",
                say.quoted(*surface, "a sweep"),
                inflections_of(*inflections),
                inflections_of(*given)
            ))
            .at(*surface, "made here")
            .note(format!("the first is at {}", say.point(*at)))
            .help("`report fairness(…)` lists all stations; move the guides there, or leave one out"),
            Self::Scaled { section, scale, at } => Report::new(format!(
                "{} is scaled by {} to touch its guides at {}",
                say.quoted(*section, "a section"),
                few(*scale),
                say.point(*at)
            ))
            .at(*section, "the nearest section to that station")
            .help("add a section there"),
        }
    }
}

fn inflections_of(n: usize) -> String {
    match n {
        0 => "none".to_owned(),
        1 => "1 inflection".to_owned(),
        n => format!("{n} inflections"),
    }
}

/// A factor with three digits that count.
pub(super) fn few(x: f64) -> String {
    real(format!("{x:.2e}").parse().unwrap_or(x))
}
