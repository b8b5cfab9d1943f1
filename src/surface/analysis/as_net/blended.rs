//! Surfaces blended from a net of curves as one bicubic net.
//!
//! ```text
//! U ≈ Σ a_i(u) F*_i(v) + Σ b_j(v) G*_j(u) − ΣΣ a_i(u) b_j(v) P_ij
//! ```
//!
//! F* and G* are splines that meet their curves at the crossings; a and b are piecewise cubic over the same breaks. The net is
//! off by at most Λ_u max|F* − F| + Λ_v max|G* − G|, Λ the largest sums of |a_i| and |b_j|.

use glam::{DVec3, DVec4};

use crate::base::tolerance::EPSILON;
use crate::geometry::Jet;
use crate::surface::analysis::as_net::family::{Family, Fitted, Target};
use crate::surface::analysis::as_net::splines::{Breaks, Hermite};
use crate::surface::analysis::as_net::{DEGREES, NetForm, Off};
use crate::surface::data::breaks::tidy;
use crate::surface::data::one_sided::OneSided;
use crate::surface::rails::line::Line;
use crate::surface::rails::rail::Rail;
use crate::surface::shapes::blend::Blend;
use crate::surface::shapes::nurbs::NurbsSurface;
use crate::surface::shapes::rule::Rule;
use crate::surface::shapes::weights::BlendAxis;

/// Parts of a cell over which blending functions are bounded.
const PARTS: usize = 16;

impl Target for &Rail {
    fn jet(&self, x: f64, side: OneSided) -> Jet {
        Rail::jet(self, x, side)
    }

    fn line(&self, x0: f64, x1: f64) -> Line {
        Rail::line(self, x0, x1)
    }

    fn corners(&self) -> Vec<f64> {
        self.kinks().iter().map(|kink| kink.0).collect()
    }

    fn breaks(&self) -> Vec<f64> {
        let mut all = Vec::new();
        Rail::breaks(self, &mut all);
        tidy(all, EPSILON)
    }
}

/// The net of a blend within a distance of it at equal (u, v), model units; `None` where its blending functions are no cubics.
///
/// Where too many pieces would be needed: the share of u or v at which.
pub fn blended(blend: &Blend, within: f64) -> Option<Result<NetForm, (f64, f64)>> {
    let (u, v) = blend.axes();
    let alone = blend.along_v().is_empty();
    if !(is_cubic(v) && (alone || is_cubic(u))) {
        return None;
    }
    Some(made(blend, within))
}

fn made(blend: &Blend, within: f64) -> Result<NetForm, (f64, f64)> {
    let (u, v) = blend.axes();
    let alone = blend.along_v().is_empty();
    let (across_u, across_v) = (if alone { 0.0 } else { reach(u) }, reach(v));
    let families = if alone { 1.0 } else { 2.0 };
    let one = |rails: &[Rail], fixed: [Breaks; 2], across: f64| {
        let targets = rails.iter().map(|rail| Box::new(rail) as Box<dyn Target>).collect();
        Family { targets, allowed: within / (families * across) }.fitted(fixed)
    };
    let along_u =
        one(blend.along_u(), DEGREES.map(|p| if alone { Breaks::none(p) } else { lines(u, p) }), across_v).map_err(|x| (x, 0.0))?;
    if alone {
        return Ok(NetForm { net: skinned(&along_u, v), off: Off::Bounded(across_v * along_u.off) });
    }
    let along_v = one(blend.along_v(), DEGREES.map(|p| lines(v, p)), across_u).map_err(|y| (0.0, y))?;
    let off = across_v * along_u.off + across_u * along_v.off;
    let (a, b) = (cardinals(u, &along_u.breaks), cardinals(v, &along_v.breaks));
    let (f, g) = (poles(&along_v), poles(&along_u));
    let counts = (g[0].len(), f[0].len());
    // What F* has beside the nodes: each i along v.
    let rest: Vec<Vec<DVec3>> = f
        .iter()
        .enumerate()
        .map(|(i, f)| (0..counts.1).map(|l| (0..g.len()).fold(f[l], |p, j| p - blend.corner(i, j) * b[j][l])).collect())
        .collect();
    let mut net = Vec::with_capacity(counts.0 * counts.1);
    for l in 0..counts.1 {
        for k in 0..counts.0 {
            let along = (0..g.len()).fold(DVec3::ZERO, |p, j| p + g[j][k] * b[j][l]);
            net.push((0..rest.len()).fold(along, |p, i| p + rest[i][l] * a[i][k]).extend(1.0));
        }
    }
    let twists = blend.twists();
    if twists.iter().any(|twist| *twist != DVec3::ZERO) {
        let (a, b) = (slopes(u, &along_u.breaks), slopes(v, &along_v.breaks));
        for (l, row) in net.chunks_exact_mut(counts.0).enumerate() {
            // Of each i along v what its twists are at this row.
            let row_twists: Vec<DVec3> = (0..a.len()).map(|i| (0..b.len()).map(|j| twists[j * a.len() + i] * b[j][l]).sum()).collect();
            for (k, pole) in row.iter_mut().enumerate() {
                *pole += (0..a.len()).map(|i| row_twists[i] * a[i][k]).sum::<DVec3>().extend(0.0);
            }
        }
    }
    let knots = (along_u.breaks.vector(), along_v.breaks.vector());
    Ok(NetForm {
        net: NurbsSurface { degree: (along_u.breaks.degree, along_v.breaks.degree), knots, poles: net, counts },
        off: Off::Bounded(off),
    })
}

/// Curves along u alone, blended across; straight from one to the next where the rule is.
fn skinned(along_u: &Fitted, v: &BlendAxis) -> NurbsSurface {
    let g = poles(along_u);
    let width = g[0].len();
    let (degree, knots, shares) = if v.rule == Rule::Linear {
        let ends = |x: f64| std::iter::once(x);
        let knots = ends(0.0).chain(v.nodes.iter().copied()).chain(ends(1.0)).collect::<Vec<f64>>();
        let share = |j: usize| (0..g.len()).map(|l| if l == j { 1.0 } else { 0.0 }).collect::<Vec<f64>>();
        (1, knots, (0..g.len()).map(share).collect())
    } else {
        let breaks = lines(v, DEGREES[0]);
        (DEGREES[0], breaks.vector(), cardinals(v, &breaks))
    };
    let height = shares[0].len();
    let at = |k: usize, l: usize| (0..g.len()).fold(DVec3::ZERO, |p, j| p + g[j][k] * shares[j][l]).extend(1.0);
    let net: Vec<DVec4> = (0..height).flat_map(|l| (0..width).map(move |k| (k, l))).map(|(k, l)| at(k, l)).collect();
    NurbsSurface { degree: (along_u.breaks.degree, degree), knots: (along_u.breaks.vector(), knots), poles: net, counts: (width, height) }
}

fn poles(fitted: &Fitted) -> Vec<Vec<DVec3>> {
    fitted.splines.iter().map(|spline| fitted.breaks.control(spline)).collect()
}

/// Whether the blending functions of a direction are piecewise cubic.
fn is_cubic(axis: &BlendAxis) -> bool {
    axis.is_piecewise() || axis.nodes.len() <= DEGREES[0] + 1
}

/// Lines at which the blending functions of a direction change, with how many derivatives go on.
fn lines(axis: &BlendAxis, degree: usize) -> Breaks {
    let mut breaks = Breaks::none(degree);
    if axis.is_piecewise() {
        (1..axis.nodes.len() - 1).for_each(|k| breaks.put(axis.nodes[k], axis.smoothness(k), 0.0));
    }
    breaks
}

/// Bound of the largest sum of the sizes of all blending functions: of their Bézier points over parts of cells.
fn reach(axis: &BlendAxis) -> f64 {
    if axis.slopes().is_empty() {
        return axis.lebesgue();
    }
    let mut largest = 1.0_f64;
    for cell in axis.nodes.windows(2) {
        let h = (cell[1] - cell[0]) / PARTS as f64;
        for k in 0..PARTS {
            let ends = [k, k + 1]
                .map(|k| whole(axis, (cell[0] + h * k as f64).min(cell[1]), if k == 0 { OneSided::After } else { OneSided::Before }));
            let most = |(a, b): (&[f64; 3], &[f64; 3])| {
                let points = [a[0], a[0] + a[1] * h / 3.0, b[0] - b[1] * h / 3.0, b[0]];
                points.into_iter().map(f64::abs).fold(0.0, f64::max)
            };
            largest = largest.max(ends[0].iter().zip(&ends[1]).map(most).sum());
        }
    }
    largest
}

/// Control values of the blending function of each node over breaks that hold the lines of the axis.
fn cardinals(axis: &BlendAxis, breaks: &Breaks) -> Vec<Vec<f64>> {
    controls(axis.nodes.len(), breaks, |x, side| whole(axis, x, side))
}

/// The same of the functions of the slopes at the nodes.
fn slopes(axis: &BlendAxis, breaks: &Breaks) -> Vec<Vec<f64>> {
    let (n, rows) = (axis.nodes.len(), axis.slopes().len());
    controls(rows, breaks, |x, side| {
        let mut all = vec![[0.0; 3]; rows];
        axis.weights(x, side).iter().filter(|(term, _)| *term >= n).for_each(|(term, w)| all[term - n] = *w);
        all
    })
}

/// Control values over breaks of `n` functions, known by their values and derivatives.
fn controls(n: usize, breaks: &Breaks, of: impl Fn(f64, OneSided) -> Vec<[f64; 3]>) -> Vec<Vec<f64>> {
    let mut all = vec![Hermite { value: Vec::new(), slope: Vec::new(), bend: Vec::new() }; n];
    for x in &breaks.at {
        let (before, after) = (of(*x, OneSided::Before), of(*x, OneSided::After));
        for (own, (before, after)) in all.iter_mut().zip(before.into_iter().zip(after)) {
            own.value.push(after[0]);
            own.slope.push([before[1], after[1]]);
            own.bend.push([before[2], after[2]]);
        }
    }
    all.iter().map(|own| breaks.control(own)).collect()
}

/// Value and derivatives of every node's blending function, slopes across the nodes counted to the nodes that they are sums of.
fn whole(axis: &BlendAxis, x: f64, side: OneSided) -> Vec<[f64; 3]> {
    let mut sums = vec![[0.0; 3]; axis.nodes.len()];
    for (term, w) in axis.weights(x, side).iter() {
        match term.checked_sub(sums.len()) {
            None => (0..3).for_each(|d| sums[term][d] += w[d]),
            Some(k) => {
                for (sum, by) in sums.iter_mut().zip(&axis.slopes()[k]) {
                    (0..3).for_each(|d| sum[d] += by * w[d]);
                }
            }
        }
    }
    sums
}
