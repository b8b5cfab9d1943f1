//! Constructors of surfaces through nets of profiles and guides, and through sections.

use crate::base::fault::{Say, ValueFault};
use crate::base::tolerance::Tolerance;
use crate::builtins;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::std::curves::unit;
use crate::lang::eval::std::kinds::{EndKind, SectionKind};
use crate::lang::eval::std::surfaces::reported;
use crate::lang::values::conversions::Length;
use crate::network::Chain;
use crate::network::net;
use crate::surface::blended::coons::{self, BlendMethod, CoonsSettings, Grid};
use crate::surface::blended::skin::{self, Across};
use crate::surface::blended::skin_align::SkinSection;
use crate::surface::blended::skin_ends::Leaving;
use crate::surface::{Reparam, Surface};

/// The model's tolerance, with another distance at which curves meet.
fn meeting(tolerance: &Tolerance, gap: Option<Length>) -> Result<Tolerance, Halt> {
    match gap {
        None => Ok(*tolerance),
        Some(gap) if gap.0 > 0.0 && gap.0.is_finite() => Ok(Tolerance { point: gap.0, ..*tolerance }),
        Some(gap) => {
            let (found, range) = (gap.0.to_string(), "above 0".to_owned());
            Err(ValueFault::OutsideRange { argument: "tolerance", found, range }.into())
        }
    }
}

crate::choices! {
    /// How a surface runs from section to section.
    pub enum AcrossWord {
        /// By cubic splines through all sections.
        Cubic = "cubic",
        /// Straight, with a kink along each inner section.
        Linear = "linear",
    }
}

builtins! {
    /// Smooth surface through a net of profiles and guides (Gordon).
    ///
    /// Every profile crosses every guide; the surface contains all of them. They come in any order and direction, and a curve
    /// may be given twice where the net closes. Profiles run along u, guides along v; guides may end in one point, a pole. What extends past
    /// the net is ignored with a note. The blend is by cubic splines: where the curves are smooth the surface is.
    /// ```loft
    /// let profiles = [for y in [0m, 1m, 2m]: spline([(0, y, 0), (1m, y, 300mm - y / 10), (2m, y, 0)])]
    /// let guides = [for i in 0..3: spline([for p in profiles: p.at(i * 50%)])]
    /// surface panel = gordon(profiles: profiles, guides: guides)
    /// ```
    fn gordon(
        /// Curves of one family; they run along u, and the first one's direction is +u.
        profiles: Vec<Chain>,
        /// Curves of the other family, along v.
        guides: Vec<Chain>,
        /// How far a profile and a guide may miss each other; the model's tolerance when left out.
        tolerance: Option<Length>,
    ) -> Surface = |cx, profiles, guides, gap| {
        let tolerance = cx.tolerance()?;
        let near = meeting(&tolerance, gap)?;
        let profiles = net::distinct(profiles, &near);
        let count = profiles.len();
        let chains: Vec<Chain> = profiles.into_iter().chain(net::distinct(guides, &near)).collect();
        let (flow, nodes) = net::of_net(&chains, count, &near)?;
        let poles = (flow.poles.0.map(|n| nodes[n]), flow.poles.1.map(|n| nodes[n]));
        let settings = CoonsSettings { method: BlendMethod::Gordon, reparam: Reparam::Smooth, origin: cx.origin() };
        let (surface, mut notes) = coons::build(&Grid { chains: &chains, flow: &flow, poles }, &settings, &tolerance)?;
        notes.extend(surface.gap_note(&tolerance));
        reported(cx, surface, &notes)
    };

    /// Smooth surface through sections, one after the other.
    ///
    /// It contains every section. They come in order, each in any direction: each is read as it runs nearest to the one before, a
    /// closed one from the start that twists least, corner to corner. All are open or all closed; the first and the last one may be
    /// a point, where the surface has a pole. u runs along the sections. `start:` and `end:` say how it leaves the first one and
    /// arrives at the last one: in a direction, or `natural`, without a bend. At a point a direction makes it round: flat across
    /// that direction. `smooth:` lets the surface deviate from inner sections by this much, for fewer spans; N677 says by how much it does.
    /// ```loft
    /// let sections = [for i in 0..4: circle(center: (0, 0, i * 1m), radius: 1m + 300mm * sin(i * 60deg))]
    /// surface vase = skin(sections)
    /// surface egg = skin([(0, 0, -1m), sections, (0, 0, 4m)], start: (0, 0, 1), end: (0, 0, 1))
    /// ```
    fn skin(
        /// Two or more curves in order; three or more where they close. The first and the last may be points.
        sections: Vec<SectionKind>,
        /// How the surface runs between them: `cubic` or `linear`, which has a kink along each inner section.
        across: AcrossWord = "cubic",
        /// Whether the last section is joined to the first one.
        closed: bool = "false",
        /// Its direction at the first section, or `natural`.
        start: Option<EndKind>,
        /// Its direction at the last section, or `natural`.
        end: Option<EndKind>,
        /// How far the surface may deviate from inner sections, for fewer spans.
        smooth: Option<Length>,
    ) -> Surface = |cx, sections, across, closed, start, end, smooth| {
        let tolerance = cx.tolerance()?;
        for (argument, said) in [("start", start.is_some()), ("end", end.is_some()), ("smooth", smooth.is_some())] {
            if said && matches!(across, AcrossWord::Linear) {
                return exclusive("splines, or `across: linear`", vec![argument, "across"]);
            }
            if said && closed && argument != "smooth" {
                return exclusive("ends, or `closed: true`", vec![argument, "closed"]);
            }
        }
        let sections: Vec<SkinSection> = sections.into_iter().map(|s| match s {
            SectionKind::Curve(chain) => SkinSection::Curve(chain),
            SectionKind::Point(p) => SkinSection::Point(p),
        }).collect();
        skin::said_well(&sections, closed, &tolerance)?;
        let smooth = match smooth {
            Some(Length(by)) if by <= 0.0 || !by.is_finite() => {
                let (found, range) = (cx.length(by), "above 0".to_owned());
                return Err(ValueFault::OutsideRange { argument: "smooth", found, range }.into());
            }
            other => other.map(|by| by.0),
        };
        let across = match across {
            AcrossWord::Cubic => Across::Cubic,
            AcrossWord::Linear => Across::Linear,
        };
        let ends = (leaving(start, "start")?, leaving(end, "end")?);
        let settings = skin::SkinSettings { across, closed, ends, smooth, origin: cx.origin() };
        let (surface, notes) = skin::skin(&sections, &settings, &tolerance)?;
        reported(cx, surface, &notes)
    };
}

fn exclusive<T>(what: &'static str, arguments: Vec<&'static str>) -> Result<T, Halt> {
    Err(ValueFault::Exclusive { function: "skin", what, arguments, example: SKIN }.into())
}

const SKIN: &str = "skin([a, b, c], start: (0, 0, 1), end: natural), or skin([a, b, c], closed: true)";

/// How a skin leaves a section.
fn leaving(said: Option<EndKind>, argument: &'static str) -> Result<Leaving, Halt> {
    match said {
        None => Ok(Leaving::Plain),
        Some(EndKind::Natural()) => Ok(Leaving::Natural),
        Some(EndKind::Direction(d)) => Ok(Leaving::Along(unit(d, argument)?)),
    }
}
