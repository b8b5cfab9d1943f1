//! Surfaces over nets of curves: Coons, Hermite blended Coons and transfinite.

use crate::base::fault::ValueFault;
use crate::base::tolerance::Tolerance;
use crate::builtins;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::std::surfaces::reported;
use crate::lang::values::conversions::{Point, Rest};
use crate::network::{self, Chain, ChainFlow, FlowKind};
use crate::surface::blended::coons::{self, BlendMethod, CoonsSettings, Grid};
use crate::surface::blended::hermite;
use crate::surface::blended::twists::Twist;
use crate::surface::faults::LoopFault;
use crate::surface::{Reparam, Surface};

crate::choices! {
    /// How curves are matched between their meetings.
    pub enum ReparamWord {
        /// Smoothly, so that the surface is C1 across its curves.
        Smooth = "smooth",
        /// Piecewise linear, as first published; the surface is C0 across its curves.
        Linear = "linear",
    }
}

crate::choices! {
    /// How neighbouring curves of a grid are blended.
    pub enum BlendWord {
        /// Linearly inside one loop, cubically where inner curves make several cells.
        Auto = "auto",
        /// Linearly between neighbours; across inner curves the surface has a kink.
        Linear = "linear",
        /// Cubically between neighbours, so that the surface is C1 across inner curves.
        Cubic = "cubic",
    }
}

crate::choices! {
    /// Mixed derivatives ∂uv at the nodes of a net.
    pub enum TwistWord {
        /// They are 0: the surface is flat about its corners, by a few percent of a radius.
        Zero = "zero",
        /// As bilinearly blended Coons patches have them (Adini).
        Adini = "adini",
        /// As curves have that are carried along their neighbours, turned and scaled: best at poles and for round shapes.
        Similar = "similar",
    }
}

/// Curves as a builtin gets them: those in a row, and those said to run along u and v.
struct Curves {
    row: Rest<Chain>,
    u: Option<Vec<Chain>>,
    v: Option<Vec<Chain>>,
}

impl Curves {
    /// E663 for a curve that stands twice in one of the lists.
    fn each_once(&self, tolerance: &Tolerance) -> Result<(), Halt> {
        let lists = [("curves", Some(&self.row.0)), ("u", self.u.as_ref()), ("v", self.v.as_ref())];
        for (argument, list) in lists {
            let Some(list) = list else { continue };
            if let Some(places) = network::given_twice(list, tolerance) {
                return Err(LoopFault::Twice { of: list[places.1].origin(), argument, places, hole: None }.into());
            }
        }
        Ok(())
    }

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
struct FlowSettings {
    pole: Option<Point>,
    closed: bool,
    reparam: ReparamWord,
    method: BlendMethod,
}

/// A surface over a grid of curves, its flow found.
fn over_grid(cx: &mut Cx, curves: Curves, said: &FlowSettings) -> Result<Surface, Halt> {
    let tolerance = cx.tolerance()?;
    curves.each_once(&tolerance)?;
    let (chains, along_u, along_v) = curves.listed();
    let options = ChainFlow { along_u, along_v, pole: said.pole.map(|p| p.0), closed: said.closed };
    let (flow, nodes) = network::of_chains(&chains, &options, &tolerance)?;
    let blend = match said.method {
        BlendMethod::Linear => Some("linear"),
        BlendMethod::Cubic => Some("cubic"),
        BlendMethod::Coons | BlendMethod::Lagrange | BlendMethod::Gordon | BlendMethod::Hermite => None,
    };
    if let Some(word) = blend.filter(|_| flow.kind == FlowKind::UniformTrilateral) {
        let range = "auto where three curves have no pole: they are blended in one way".to_owned();
        return Err(ValueFault::OutsideRange { argument: "blend", found: word.to_owned(), range }.into());
    }
    let poles = (flow.poles.0.map(|n| nodes[n]), flow.poles.1.map(|n| nodes[n]));
    let reparam = match said.reparam {
        ReparamWord::Smooth => Reparam::Smooth,
        ReparamWord::Linear => Reparam::Linear,
    };
    let settings = CoonsSettings { method: said.method, reparam, origin: cx.origin() };
    let (surface, notes) = coons::build(&Grid { chains: &chains, flow: &flow, poles }, &settings, &tolerance)?;
    reported(cx, surface, &notes)
}

/// A Hermite blended surface over a grid of curves. Of three curves without a word about it the corner whose sides are nearest in length is
/// the pole.
fn hermite_over(cx: &mut Cx, curves: Curves, pole: Option<Point>, closed: bool, twist: TwistWord) -> Result<Surface, Halt> {
    let tolerance = cx.tolerance()?;
    curves.each_once(&tolerance)?;
    let (chains, along_u, along_v) = curves.listed();
    let mut options = ChainFlow { along_u, along_v, pole: pole.map(|p| p.0), closed };
    let (mut flow, mut nodes) = network::of_chains(&chains, &options, &tolerance)?;
    if flow.kind == FlowKind::UniformTrilateral {
        options.pole = hermite::default_pole(&chains, &flow, &tolerance);
        (flow, nodes) = network::of_chains(&chains, &options, &tolerance)?;
    }
    let poles = (flow.poles.0.map(|n| nodes[n]), flow.poles.1.map(|n| nodes[n]));
    let twist = match twist {
        TwistWord::Zero => Twist::Zero,
        TwistWord::Adini => Twist::Adini,
        TwistWord::Similar => Twist::Similar,
    };
    let (surface, notes) = hermite::build(&Grid { chains: &chains, flow: &flow, poles }, twist, cx.origin(), &tolerance)?;
    reported(cx, surface, &notes)
}

builtins! {
    /// Coons surface through a closed loop or a grid of curves.
    ///
    /// Curves come in any order and direction: what they span is found from the nodes they share. The surface
    /// contains every curve. The first curve written runs along u. Inside one loop curves are blended linearly (four
    /// straight lines give the hyperbolic paraboloid); where inner curves make several cells the blend is cubic, and
    /// the surface is C1 across them. Three curves or more from pole to pole that none crosses are joined by C2 splines.
    /// ```loft
    /// curve south = line((0, 0, 0), (4m, 0, 0))
    /// curve north = arc((0, 3m, 0), (4m, 3m, 0), through: (2m, 3m, 1m))
    /// curve west = line(south.start, north.start)
    /// curve east = line(south.end, north.end)
    /// surface roof = coons(south, east, north, west)
    /// ```
    fn coons(
        /// Boundary curves and inner curves.
        curves: Rest<Chain>,
        /// Those that run along u, where the curves alone do not decide.
        u: Option<Vec<Chain>>,
        /// Those that run along v.
        v: Option<Vec<Chain>>,
        /// The point to which a side shrinks, where the curves alone do not decide.
        pole: Option<Point>,
        /// Whether the surface closes in u, where the curves alone do not decide.
        closed: bool = "false",
        /// How curves are matched between their meetings.
        reparam: ReparamWord = "smooth",
        /// How neighbouring curves are blended: `auto` is `linear` for one cell and `cubic` for several; three curves without a
        /// pole are blended in one way, `auto`.
        blend: BlendWord = "auto",
    ) -> Surface = |cx, row, u, v, pole, closed, reparam, blend| {
        let method = match blend {
            BlendWord::Auto => BlendMethod::Coons,
            BlendWord::Linear => BlendMethod::Linear,
            BlendWord::Cubic => BlendMethod::Cubic,
        };
        over_grid(cx, Curves { row, u, v }, &FlowSettings { pole, closed, reparam, method })
    };

    /// Hermite blended Coons patch through a loop of curves, or a net of patches.
    ///
    /// Curves come in any order and direction, as `coons` takes them, and the surface contains every curve. Across a curve each cell has the
    /// derivatives that the crossing curves have at the nodes, so nets are C1 across their curves whatever the widths of the cells.
    /// Curves from pole to pole that none crosses have no such derivatives: two are ruled, more are joined by C2 splines, and `twist` other
    /// than `zero` gives derivatives across them that are cubics along them.
    /// Three curves are a triangle: one corner is the pole, to which a side shrinks. `twist: similar` takes much of the flatness
    /// about corners away: of the octant of a sphere below it leaves 0.44 % of the radius, `zero` 4.2 % and `adini` 4.9 %.
    /// ```loft
    /// point P = (0, 0, 1m)
    /// curve west = arc(center: (0, 0, 0), start: P, angle: 90deg, normal: (0, 1, 0))
    /// curve south = arc(center: (0, 0, 0), start: P, angle: 90deg, normal: (-1, 0, 0))
    /// curve equator = arc(center: (0, 0, 0), start: west.end, angle: 90deg, normal: (0, 0, 1))
    /// surface octant = hermite(west, south, equator, pole: P, twist: similar)
    /// check norm(octant.at(50%, 50%) - (0, 0, 0)) == 1m within 5mm
    /// ```
    fn hermite(
        /// Boundary curves and inner curves.
        curves: Rest<Chain>,
        /// Those that run along u, where the curves alone do not decide.
        u: Option<Vec<Chain>>,
        /// Those that run along v.
        v: Option<Vec<Chain>>,
        /// The point to which a side shrinks; of three curves else the corner whose two sides are nearest to each other in length.
        pole: Option<Point>,
        /// Whether the surface closes in u, where the curves alone do not decide.
        closed: bool = "false",
        /// Mixed derivatives at the nodes. `adini`: the mean of the bilinear Coons patches round each node; `similar`: the mean of what
        /// the cells round it say, where each curve is carried along the sides as its chord is.
        twist: TwistWord = "zero",
    ) -> Surface = |cx, row, u, v, pole, closed, twist| {
        hermite_over(cx, Curves { row, u, v }, pole, closed, twist)
    };

    /// Transfinite surface through a grid of curves: one blend over the whole grid.
    ///
    /// With more than three curves one way it may oscillate between them; `coons` does not.
    /// ```loft
    /// curve south = line((0, 0, 0), (4m, 0, 0))
    /// curve north = line((0, 3m, 1m), (4m, 3m, 0))
    /// curve west = line(south.start, north.start)
    /// curve middle = line(south.at(50%), north.at(50%))
    /// curve east = line(south.end, north.end)
    /// surface roof = transfinite(u: [south, north], v: [west, middle, east])
    /// ```
    fn transfinite(
        /// Boundary curves and inner curves.
        curves: Rest<Chain>,
        /// Those that run along u, where the curves alone do not decide.
        u: Option<Vec<Chain>>,
        /// Those that run along v.
        v: Option<Vec<Chain>>,
        /// The point to which a side shrinks, where the curves alone do not decide.
        pole: Option<Point>,
        /// Whether the surface closes in u, where the curves alone do not decide.
        closed: bool = "false",
        /// How curves are matched between their meetings.
        reparam: ReparamWord = "smooth",
    ) -> Surface = |cx, row, u, v, pole, closed, reparam| {
        over_grid(cx, Curves { row, u, v }, &FlowSettings { pole, closed, reparam, method: BlendMethod::Lagrange })
    };
}
