//! Constructors of surfaces.

use crate::base::fault::{Fault, ValueFault};
use crate::builtins;
use crate::lang::cx::{Cx, Stop};
use crate::lang::types::{Point, Rest};
use crate::network::{self, Chain, ChainFlow};
use crate::surface::coons::{self, Grid, Method, Settings};
use crate::surface::{Domain, Reparam, Surface};

/// Checks that (u, v) lies in the surface's domain; each with the name of its argument.
pub(super) fn checked_uv(surface: &Surface, u: (f64, &'static str), v: (f64, &'static str)) -> Result<(f64, f64), Stop> {
    for (value, argument) in [u, v] {
        if !(0.0..=1.0).contains(&value) {
            let (found, range) = (value.to_string(), "between 0 and 1".to_owned());
            return Err(ValueFault::OutsideRange { argument, found, range }.into());
        }
    }
    if surface.domain() == Domain::Triangle && u.0 + v.0 > 1.0 {
        let (found, range) = (v.0.to_string(), "at most 1 less u on a surface of three sides".to_owned());
        return Err(ValueFault::OutsideRange { argument: v.1, found, range }.into());
    }
    Ok((u.0, v.0))
}

crate::choices! {
    /// How curves are matched between their meetings.
    pub enum ReparamWord {
        /// Smoothly, so that the surface is C1 across its curves.
        Smooth = "smooth",
        /// Piecewise linear, as first published; the surface is C0 across its curves.
        Linear = "linear",
    }
}

/// Curves as a builtin gets them: those in a row, and those said to run along u and v.
struct Curves {
    row: Rest<Chain>,
    u: Option<Vec<Chain>>,
    v: Option<Vec<Chain>>,
}

impl Curves {
    /// All curves in order of writing, each once, and the places of those along u and v.
    fn listed(self) -> (Vec<Chain>, Vec<usize>, Vec<usize>) {
        let mut all = self.row.0;
        let mut place = |chain: Chain| {
            all.iter().position(|c| same(c, &chain)).unwrap_or_else(|| {
                all.push(chain);
                all.len() - 1
            })
        };
        let along_u = self.u.unwrap_or_default().into_iter().map(&mut place).collect();
        let along_v = self.v.unwrap_or_default().into_iter().map(&mut place).collect();
        (all, along_u, along_v)
    }
}

/// Whether two values are the same run of curves in the same direction.
fn same(a: &Chain, b: &Chain) -> bool {
    let run = |x: &network::Run, y: &network::Run| x.s0 == y.s0 && x.s1 == y.s1 && network::chain::same_curve(&x.curve, &y.curve);
    a.runs().len() == b.runs().len() && a.runs().iter().zip(b.runs()).all(|(x, y)| run(x, y))
}

/// What decides a flow beside the curves.
struct Said {
    pole: Option<Point>,
    closed: bool,
    reparam: ReparamWord,
    method: Method,
}

/// A surface over a grid of curves, its flow found.
fn over_grid(cx: &mut Cx, curves: Curves, said: &Said) -> Result<Surface, Stop> {
    let tolerance = cx.tolerance()?;
    let (chains, along_u, along_v) = curves.listed();
    let options = ChainFlow { along_u, along_v, pole: said.pole.map(|p| p.0), closed: said.closed };
    let (flow, nodes) = network::of_chains(&chains, &options, &tolerance)?;
    let poles = (flow.poles.0.map(|n| nodes[n]), flow.poles.1.map(|n| nodes[n]));
    let reparam = match said.reparam {
        ReparamWord::Smooth => Reparam::Smooth,
        ReparamWord::Linear => Reparam::Linear,
    };
    let settings = Settings { method: said.method, reparam, origin: cx.origin() };
    let (surface, notes) = coons::build(&Grid { chains: &chains, flow: &flow, poles }, &settings, &tolerance)?;
    finished(cx, surface, &notes)
}

/// Says the notes of a surface and what a look at it finds.
fn finished(cx: &mut Cx, surface: Surface, notes: &[Fault]) -> Result<Surface, Stop> {
    notes.iter().for_each(|note| cx.say(note));
    let tolerance = cx.tolerance()?;
    surface.review(&tolerance).iter().for_each(|warning| cx.say(warning));
    Ok(surface)
}

builtins! {
    /// Composite Coons surface through a closed loop or a grid of curves.
    ///
    /// Curves come in any order and direction: what they span is found from the nodes they share. The surface
    /// contains every curve and is C1 across inner ones. The first curve written runs along u.
    /// ```loft
    /// curve south = line((0, 0, 0), (4m, 0, 0))
    /// curve north = arc((0, 3m, 0), (4m, 3m, 0), through: (2m, 3m, 1m))
    /// curve west = line(south.start, north.start)
    /// curve east = line(south.end, north.end)
    /// surface roof = coons(south, east, north, west)
    /// ```
    fn coons(
        /// Boundary curves, and inner ones where there are.
        curves: Rest<Chain>,
        /// Those that run along u, where the curves alone do not tell.
        u: Option<Vec<Chain>>,
        /// Those that run along v.
        v: Option<Vec<Chain>>,
        /// The point where a side shrinks to nothing, where the curves alone do not tell.
        pole: Option<Point>,
        /// Whether the surface closes in u, where the curves alone do not tell.
        closed: bool = "false",
        /// How curves are matched between their meetings.
        reparam: ReparamWord = "smooth",
    ) -> Surface = |cx, row, u, v, pole, closed, reparam| {
        over_grid(cx, Curves { row, u, v }, &Said { pole, closed, reparam, method: Method::Composite })
    };

    /// Transfinite surface through a grid of curves: one polynomial blend over the whole grid.
    ///
    /// With more than three curves one way it may swing between them; `coons` does not.
    /// ```loft
    /// curve south = line((0, 0, 0), (4m, 0, 0))
    /// curve north = line((0, 3m, 1m), (4m, 3m, 0))
    /// curve west = line(south.start, north.start)
    /// curve middle = line(south.at(50%), north.at(50%))
    /// curve east = line(south.end, north.end)
    /// surface roof = transfinite(u: [south, north], v: [west, middle, east])
    /// ```
    fn transfinite(
        /// Boundary curves, and inner ones where there are.
        curves: Rest<Chain>,
        /// Those that run along u, where the curves alone do not tell.
        u: Option<Vec<Chain>>,
        /// Those that run along v.
        v: Option<Vec<Chain>>,
        /// The point where a side shrinks to nothing, where the curves alone do not tell.
        pole: Option<Point>,
        /// Whether the surface closes in u, where the curves alone do not tell.
        closed: bool = "false",
        /// How curves are matched between their meetings.
        reparam: ReparamWord = "smooth",
    ) -> Surface = |cx, row, u, v, pole, closed, reparam| {
        over_grid(cx, Curves { row, u, v }, &Said { pole, closed, reparam, method: Method::Lagrange })
    };
}
