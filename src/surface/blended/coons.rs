//! Surfaces from a grid of curves: Coons, Lagrange transfinite, and the uniform trilateral
//! [Koh & Park 1990, §4; Coons 1967].

use glam::DVec3;

use crate::base::fault::{Fault, Result};
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::network::flow::Member;
use crate::network::{Chain, Flow, FlowKind};
use crate::surface::blended::corners::spline_axis;
use crate::surface::blended::family::{GridFamily, Prepared, averages, evenly, in_order, prepare};
use crate::surface::core::shape::Shape;
use crate::surface::core::surface::{Parts, Surface};
use crate::surface::data::breaks::merge_kinks;
use crate::surface::data::kind::{Domain, SurfaceKind};
use crate::surface::faults::{BorderFault, SurfaceFault};
use crate::surface::rails::rail::Rail;
use crate::surface::rails::reparam::{Map, Reparam};
use crate::surface::rails::side::{Border, Side};
use crate::surface::shapes::blend::Blend;
use crate::surface::shapes::rule::Rule;
use crate::surface::shapes::trilateral::Trilateral;
use crate::surface::shapes::weights::BlendAxis;

/// How curves are blended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BlendMethod {
    /// Linear in a grid of one cell, so that four straight lines give the hyperbolic paraboloid; cubic where inner curves
    /// make several cells (`coons`).
    Coons,
    /// Linear between neighbours [Coons 1967], with a kink along each inner curve.
    Linear,
    /// Cubic between neighbours, C1 across the curves [Koh & Park 1990, eq. 4.3–4.5].
    Cubic,
    /// One polynomial through all curves (`transfinite`).
    Lagrange,
    /// Cubic splines through all curves, C2 in the parameters (`gordon`).
    Gordon,
    /// As cubic, with twists at the nodes to be given (`hermite`).
    Hermite,
}

impl BlendMethod {
    fn kind(self) -> SurfaceKind {
        match self {
            Self::Lagrange => SurfaceKind::Transfinite,
            Self::Gordon => SurfaceKind::Gordon,
            Self::Hermite => SurfaceKind::Hermite,
            _ => SurfaceKind::Coons,
        }
    }

    /// The rule of a direction; `one_cell`: of a grid with nothing inside.
    fn rule(self, one_cell: bool, closed: bool) -> Rule {
        match self {
            Self::Linear => Rule::Linear,
            Self::Coons if one_cell => Rule::Linear,
            Self::Coons | Self::Cubic | Self::Hermite => Rule::Cubic,
            Self::Lagrange => Rule::Lagrange,
            Self::Gordon if closed => Rule::Periodic,
            Self::Gordon => Rule::Spline,
        }
    }

    /// The rule across curves that run from pole to pole with none across them: cubics between neighbours would take the derivatives across
    /// them from crossing curves, and those are points here, so all would be 0. Two curves are ruled, more are joined by splines.
    fn rule_of_meridians(self, nodes: usize, closed: bool) -> Rule {
        match self.rule(nodes == 2, closed) {
            Rule::Cubic if nodes == 2 => Rule::Linear,
            Rule::Cubic if closed => Rule::Periodic,
            Rule::Cubic => Rule::Spline,
            rule => rule,
        }
    }
}

/// Settings of [`build`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoonsSettings {
    /// How curves are blended.
    pub method: BlendMethod,
    /// How curves are matched between their meetings.
    pub reparam: Reparam,
    /// The declaration.
    pub origin: Origin,
}

/// A grid of curves: the chains given, the flow found in them and where its poles are (v = 0 and v = 1).
#[derive(Clone, Copy, Debug)]
pub struct Grid<'a> {
    /// Chains, in the order that `flow` counts them by.
    pub chains: &'a [Chain],
    /// What they span.
    pub flow: &'a Flow,
    /// Points of the poles.
    pub poles: (Option<DVec3>, Option<DVec3>),
}

/// A surface through all curves of a grid, with notes and warnings (N608, N609, W614).
///
/// Fails with E604 when meetings coincide or come in different orders.
pub fn build(grid: &Grid, settings: &CoonsSettings, tolerance: &Tolerance) -> Result<(Surface, Vec<Fault>)> {
    if grid.flow.kind == FlowKind::UniformTrilateral {
        return trilateral(grid, settings, tolerance);
    }
    let mut notes = Vec::new();
    let (blend, made) = gridded(grid, settings, tolerance, &mut notes)?;
    if settings.method == BlendMethod::Lagrange {
        notes.extend(oscillation(&blend, settings.origin));
    }
    Ok((finish(blend, made, tolerance, &mut notes), notes))
}

/// The blend over a grid of two families and what its surface has beside it, with notes (N609).
pub(super) fn gridded(grid: &Grid, settings: &CoonsSettings, tolerance: &Tolerance, notes: &mut Vec<Fault>) -> Result<(Blend, Made)> {
    let flow = grid.flow;
    // A curve of an exact net begins at its crossing, not at an end within the tolerance of it.
    let snap = if settings.method == BlendMethod::Gordon { tolerance.rounding } else { tolerance.point };
    let ends_v = (grid.poles.0.is_some(), grid.poles.1.is_some());
    let along_u = prepare(
        grid,
        GridFamily { members: &flow.along_u, across: &flow.along_v, closed: flow.closed_u, poles: (false, false), snap },
        tolerance,
        notes,
    )?;
    let along_v = prepare(
        grid,
        GridFamily { members: &flow.along_v, across: &flow.along_u, closed: flow.closed_v, poles: ends_v, snap },
        tolerance,
        notes,
    )?;
    let nodes_u = match along_u.is_empty() {
        // Meridians alone: nothing says how far apart they are.
        true => evenly(flow.along_v.len() + usize::from(flow.closed_u)),
        false => averages(&along_u, grid, &flow.along_v, tolerance)?,
    };
    let nodes_v = averages(&along_v, grid, &flow.along_u, tolerance)?;
    let one_cell = 2 == nodes_u.len() && nodes_v.len() == 2;
    let rules = if along_u.is_empty() && ends_v == (true, true) {
        let rule = settings.method.rule_of_meridians(nodes_u.len(), flow.closed_u);
        (rule, if rule == Rule::Periodic { Rule::Spline } else { rule })
    } else {
        (settings.method.rule(one_cell, flow.closed_u), settings.method.rule(one_cell, flow.closed_v))
    };

    let rails = |curves: &[Prepared], nodes: &[f64], closed: bool| -> Vec<Rail> {
        curves.iter().map(|c| Rail::new(c.chain.clone(), Map::new(nodes.to_vec(), c.raw.clone(), settings.reparam, closed))).collect()
    };
    let mut rails_u = rails(&along_u, &nodes_u, flow.closed_u);
    let mut rails_v = rails(&along_v, &nodes_v, flow.closed_v);
    if flow.closed_v
        && let Some(first) = rails_u.first().cloned()
    {
        rails_u.push(first);
    }
    if flow.closed_u
        && let Some(first) = rails_v.first().cloned()
    {
        rails_v.push(first);
    }
    if let Some(p) = grid.poles.0 {
        rails_u.insert(0, Rail::Point(p));
    }
    if let Some(p) = grid.poles.1 {
        rails_u.push(Rail::Point(p));
    }
    let axis = |nodes: Vec<f64>, rails: &[Rail], closed: bool, rule: Rule| match settings.method {
        BlendMethod::Gordon if rule != Rule::Linear => spline_axis(nodes, rails, closed, tolerance),
        _ => BlendAxis::new(nodes, rule),
    };
    let u = axis(nodes_u, &rails_u, flow.closed_u, rules.0);
    let v = axis(nodes_v, &rails_v, flow.closed_v, rules.1);
    let blend = Blend::new(u, v, rails_v, rails_u);
    let made = Made {
        origin: settings.origin,
        kind: settings.method.kind(),
        flow: flow.phrase(),
        closed: (flow.closed_u, flow.closed_v),
        chains: in_order(&along_u, &along_v),
    };
    Ok((blend, made))
}

/// What a surface over a grid has beside its blend.
pub(crate) struct Made {
    pub origin: Origin,
    pub kind: SurfaceKind,
    pub flow: String,
    pub closed: (bool, bool),
    pub chains: Vec<Chain>,
}

/// The surface of a blend, its kink lines found.
pub(crate) fn finish(mut blend: Blend, made: Made, tolerance: &Tolerance, notes: &mut Vec<Fault>) -> Surface {
    let kinks = set_kinks(&mut blend, made.origin, tolerance, notes);
    Surface::new(Parts {
        origin: made.origin,
        kind: made.kind,
        flow: made.flow,
        domain: Domain::Square,
        closed: made.closed,
        borders: borders(&blend),
        shape: Shape::Blend(blend),
        kinks,
        chains: made.chains,
        generated: Vec::new(),
        trim: None,
        flipped: false,
    })
}

/// Finds the kink lines of both directions and sets those of the rails; W614 for slivers.
pub(crate) fn set_kinks(blend: &mut Blend, origin: Origin, tolerance: &Tolerance, notes: &mut Vec<Fault>) -> (Vec<f64>, Vec<f64>) {
    let mut lines = [Vec::new(), Vec::new()];
    let creases = [blend.axes().0.creases(), blend.axes().1.creases()];
    let (along_u, along_v) = blend.rails_mut();
    for (direction, (rails, lines)) in [along_u, along_v].into_iter().zip(&mut lines).enumerate() {
        // Where no curve runs along them lines are separated by their parameters alone.
        let longest = if rails.is_empty() { f64::INFINITY } else { rails.iter().map(Rail::length).fold(0.0, f64::max) };
        let mut own: Vec<Vec<(f64, f64)>> = rails.iter().map(|rail| rail.kink_lines(tolerance)).collect();
        own.push(creases[direction].iter().map(|&x| (x, 0.0)).collect());
        let (found, own) = merge_kinks(&own, tolerance, |a, b| (b - a) * longest);
        for (rail, own) in rails.iter_mut().zip(own) {
            rail.set_kinks(own);
        }
        notes.extend(slivers(rails, &found, ['u', 'v'][direction], origin, longest));
        *lines = found;
    }
    let [us, vs] = lines;
    (us, vs)
}

/// W614 for each strip below a hundredth of its narrower neighbour.
fn slivers(rails: &[Rail], lines: &[f64], direction: char, origin: Origin, longest: f64) -> Vec<Fault> {
    const SLIVER: f64 = 0.01;
    let mut stops = vec![0.0];
    stops.extend_from_slice(lines);
    stops.push(1.0);
    let widths: Vec<f64> = stops.windows(2).map(|w| (w[1] - w[0]) * longest).collect();
    let mut found = Vec::new();
    for (k, &width) in widths.iter().enumerate() {
        let neighbours = [k.checked_sub(1).map(|k| widths[k]), widths.get(k + 1).copied()];
        let neighbour = neighbours.into_iter().flatten().fold(f64::INFINITY, f64::min);
        if neighbour.is_finite() && width < SLIVER * neighbour {
            let from_to = (stops[k], stops[k + 1]);
            let at = rails[0].point(0.5 * (from_to.0 + from_to.1));
            found.push(SurfaceFault::SliverPatch { surface: origin, direction, from_to, width, neighbour, at }.into());
        }
    }
    found
}

/// N608 where the Lebesgue constant of a direction exceeds 4.
fn oscillation(blend: &Blend, origin: Origin) -> Vec<Fault> {
    const MOST: f64 = 4.0;
    let (u, v) = blend.axes();
    [('u', u), ('v', v)]
        .into_iter()
        .filter_map(|(direction, axis)| {
            let lebesgue = axis.lebesgue();
            let fault = SurfaceFault::TransfiniteOscillation { surface: origin, direction, curves: axis.nodes.len(), lebesgue };
            (lebesgue > MOST).then(|| fault.into())
        })
        .collect()
}

/// Sides v = 0, u = 1, v = 1, u = 0 of a blended surface.
pub(crate) fn borders(blend: &Blend) -> Vec<Border> {
    let (u, v) = (blend.along_u(), blend.along_v());
    let of = |rail: Option<&Rail>| match rail {
        Some(Rail::Point(p)) => Border::straight(Side::Pole(*p)),
        Some(Rail::Chain { chain, map, .. }) => {
            let side = Side::Chain { chain: chain.clone(), from: map.value(0.0), to: map.value(1.0) };
            Border { side, map: Some(map.clone()), turned: false }
        }
        _ => Border::straight(Side::Free),
    };
    vec![of(u.first()), of(v.last()), of(u.last()), of(v.first())]
}

/// Three borders and no pole: one along u, two along v (u = 0 and the slant). Ends that stand out beyond another border are left out with a
/// note.
fn trilateral(grid: &Grid, settings: &CoonsSettings, tolerance: &Tolerance) -> Result<(Surface, Vec<Fault>)> {
    let mut notes = Vec::new();
    // Each from the border where it begins to the one where it ends.
    let mut side = |member: Option<&Member>, meets: [Option<&Member>; 2]| -> Result<(Rail, Border)> {
        let Some(Member { curve, reversed, crossings }) = member else {
            return Ok((Rail::new(grid.chains[0].clone(), Map::identity()), Border::chain(grid.chains[0].clone(), false)));
        };
        let mut chain = grid.chains[*curve].clone();
        let near = tolerance.point / chain.length();
        let (first, last) = if *reversed { (1.0, 0.0) } else { (0.0, 1.0) };
        let mut ends = [first, last];
        for (k, (end, border)) in [first, last].into_iter().zip(meets).enumerate() {
            let here = crossings.get(k).copied().unwrap_or(end);
            if (here - end).abs() > near {
                let border = border.map_or(Origin::NONE, |m| grid.chains[m.curve].origin());
                let length = (here - end).abs() * chain.length();
                notes.push(BorderFault::EndTrimmed { curve: chain.origin(), border, end: chain.point(end), length }.into());
                ends[k] = here;
            }
        }
        if ends != [first, last] {
            chain = chain.slice(ends[0].min(ends[1]), ends[0].max(ends[1]), tolerance)?;
        }
        Ok((Rail::new(chain.clone(), if *reversed { Map::reverse() } else { Map::identity() }), Border::chain(chain, *reversed)))
    };
    let (along_u, along_v) = (&grid.flow.along_u, &grid.flow.along_v);
    let (bottom, slant, left) = (along_u.first(), along_v.get(1), along_v.first());
    let (bottom, slant, left) = (side(bottom, [left, slant])?, side(slant, [bottom, left])?, side(left, [bottom, slant])?);
    let surface = Surface::new(Parts {
        origin: settings.origin,
        kind: settings.method.kind(),
        flow: grid.flow.phrase(),
        domain: Domain::Triangle,
        closed: (false, false),
        borders: vec![bottom.1, slant.1, left.1],
        shape: Shape::Trilateral(Trilateral::new([bottom.0, slant.0, left.0])),
        kinks: (Vec::new(), Vec::new()),
        chains: grid.chains.to_vec(),
        generated: Vec::new(),
        trim: None,
        flipped: false,
    });
    Ok((surface, notes))
}
