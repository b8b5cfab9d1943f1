//! Constructors of surfaces through nets of profiles and guides, and through sections.

use crate::base::fault::ValueFault;
use crate::base::tolerance::Tolerance;
use crate::builtins;
use crate::lang::cx::Stop;
use crate::lang::std::surfaces::finished;
use crate::lang::types::Length;
use crate::network::Chain;
use crate::network::net;
use crate::surface::coons::{self, Grid, Method, Settings};
use crate::surface::skin::{self, Across};
use crate::surface::{Reparam, Surface};

/// The model's tolerance, with another distance at which curves meet.
fn meeting(tolerance: &Tolerance, gap: Option<Length>) -> Result<Tolerance, Stop> {
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
    /// may be given twice where the net closes. Profiles run along u, guides along v; guides may end in one point, a pole. What stands out over
    /// the net is left out with a note. The blend is by cubic splines: where the curves are smooth the surface is.
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
        let settings = Settings { method: Method::Gordon, reparam: Reparam::Smooth, origin: cx.origin() };
        let (surface, notes) = coons::build(&Grid { chains: &chains, flow: &flow, poles }, &settings, &tolerance)?;
        finished(cx, surface, &notes)
    };

    /// Smooth surface through sections, one after the other.
    ///
    /// It contains every section. They come in order, each in any direction: each is read as it runs nearest to the one before, a
    /// closed one from the start that twists least, corner to corner. All are open or all closed. u runs along the sections.
    /// ```loft
    /// let sections = [for i in 0..4: circle(center: (0, 0, i * 1m), radius: 1m + 300mm * sin(i * 60deg))]
    /// surface vase = skin(sections)
    /// ```
    fn skin(
        /// Two or more curves in order; three or more where they close.
        sections: Vec<Chain>,
        /// How the surface runs between them: `cubic` or `linear`, which has a kink along each inner section.
        across: AcrossWord = "cubic",
        /// Whether the last section is joined to the first one.
        closed: bool = "false",
    ) -> Surface = |cx, sections, across, closed| {
        let tolerance = cx.tolerance()?;
        let least = if closed { 3 } else { 2 };
        if sections.len() < least {
            let (found, range) = (format!("{} sections", sections.len()), format!("at least {least}"));
            return Err(ValueFault::OutsideRange { argument: "sections", found, range }.into());
        }
        let rings = sections.iter().filter(|c| c.is_closed(&tolerance)).count();
        if rings != 0 && rings != sections.len() {
            let (found, range) = (format!("{rings} closed of {} sections", sections.len()), "all open or all closed".to_owned());
            return Err(ValueFault::OutsideRange { argument: "sections", found, range }.into());
        }
        let across = match across {
            AcrossWord::Cubic => Across::Cubic,
            AcrossWord::Linear => Across::Linear,
        };
        let (surface, notes) = skin::skin(&sections, across, closed, cx.origin(), &tolerance)?;
        finished(cx, surface, &notes)
    };
}
