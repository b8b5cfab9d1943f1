//! The blending algebra of curve grids [Koh & Park 1990, §4.1].
//!
//! ```text
//! U(u,v) = Σ_i a_i(u) F_i(v) + Σ_j b_j(v) G_j(u) − ΣΣ a_i(u) b_j(v) P_ij
//! ```
//!
//! `F_i` run along v at `u_i`, `G_j` along u at `v_j`, `P_ij` are their nodes. Composite Coons, Lagrange and Gordon
//! surfaces differ in the functions a and b alone. Without curves along v the sum is a ruled surface. Where the rule is a
//! spline the slopes of curves and nodes across a direction are terms of the sum like the curves and nodes themselves.
//!
//! A Hermite blended Coons patch with twists x_ij [Coons 1967; Farin 2002, chapter 22] is such a sum too: derivatives across the curves are the
//! cubics of their values and twists at the nodes, h₀, h₃ for values and h₁, h₂ for slopes, so in r₁ + r₂ − r₃ they cancel and leave
//! Σ h₀ F + Σ h₀ G − ΣΣ h₀ h₀ P + ΣΣ h₁ h₁ x. Slopes are terms without curves, and a twist is the negative P_ij of two slopes.

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::tolerance::SLIVER;
use crate::geometry::{Jet, Motion};
use crate::surface::data::breaks::tidy;
use crate::surface::data::jet::Jet2;
use crate::surface::data::one_sided::OneSided;
use crate::surface::rails::rail::Rail;
use crate::surface::shapes::blend_terms::{active_lines, with_slopes};
use crate::surface::shapes::rule::Rule;
use crate::surface::shapes::weights::{BlendAxis, Weights};

/// A surface blended from a grid of curves.
#[derive(Clone, Debug)]
pub struct Blend {
    u: BlendAxis,
    v: BlendAxis,
    /// F_i, one per node of `u`, or none (ruled).
    along_v: Vec<Rail>,
    /// G_j, one per node of `v`.
    along_u: Vec<Rail>,
    /// P_ij of all terms, `i` fastest.
    corners: Vec<DVec3>,
}

crate::content!(Blend { u, v, along_v, along_u, corners });

impl Blend {
    /// A surface from its rails: `along_v` one per node of `u` (or none: ruled), `along_u` one per node of `v`.
    ///
    /// The node of two curves is taken in the middle of what the two say, a pole's where it is.
    pub fn new(u: BlendAxis, v: BlendAxis, along_v: Vec<Rail>, along_u: Vec<Rail>) -> Self {
        let mut corners = Vec::with_capacity(along_v.len() * along_u.len());
        for (g, &y) in along_u.iter().zip(&v.nodes) {
            for (f, &x) in along_v.iter().zip(&u.nodes) {
                corners.push(match (f, g) {
                    (Rail::Point(p), _) | (_, Rail::Point(p)) => *p,
                    _ => 0.5 * (f.point(y) + g.point(x)),
                });
            }
        }
        let corners = with_slopes(&corners, along_v.len(), &u, &v);
        Self { u, v, along_v, along_u, corners }
    }

    /// The same with given mixed derivatives ∂uv at the nodes, `i` fastest, by [`Rule::Hermite`] in both directions. Curves stay what they are.
    pub fn with_twists(mut self, twists: &[DVec3]) -> Self {
        let nodes = self.nodes();
        let (n, m) = (self.along_v.len(), self.along_u.len());
        self.u = BlendAxis::new(self.u.nodes, Rule::Hermite);
        self.v = BlendAxis::new(self.v.nodes, Rule::Hermite);
        self.corners = with_slopes(&nodes, n, &self.u, &self.v);
        let width = self.u.terms();
        for (row, twists) in self.corners.chunks_exact_mut(width).skip(m).zip(twists.chunks_exact(n)) {
            row[n..].iter_mut().zip(twists).for_each(|(corner, twist)| *corner = -*twist);
        }
        self
    }

    /// ∂uv at the nodes, `i` fastest; none unless the rule is [`Rule::Hermite`].
    pub fn twists(&self) -> Vec<DVec3> {
        if self.u.rule != Rule::Hermite {
            return Vec::new();
        }
        let (n, m) = (self.along_v.len(), self.along_u.len());
        (0..m).flat_map(|j| (0..n).map(move |i| (n + i, m + j))).map(|(i, j)| -self.corner(i, j)).collect()
    }

    /// Parameters and rule across u (first) and v (second).
    pub fn axes(&self) -> (&BlendAxis, &BlendAxis) {
        (&self.u, &self.v)
    }

    /// Curves along v, at ascending u.
    pub fn along_v(&self) -> &[Rail] {
        &self.along_v
    }

    /// Curves along u, at ascending v.
    pub fn along_u(&self) -> &[Rail] {
        &self.along_u
    }

    /// Both families, curves along u first.
    pub fn rails_mut(&mut self) -> (&mut [Rail], &mut [Rail]) {
        (&mut self.along_u, &mut self.along_v)
    }

    /// P_ij; beyond the nodes slopes across them.
    pub(crate) fn corner(&self, i: usize, j: usize) -> DVec3 {
        self.corners[j * self.u.terms() + i]
    }

    /// P_ij of the nodes, `i` fastest.
    fn nodes(&self) -> Vec<DVec3> {
        let i = 0..self.along_v.len();
        (0..self.along_u.len()).flat_map(|j| i.clone().map(move |i| self.corner(i, j))).collect()
    }

    /// Point and derivatives, from the given sides where they jump.
    pub fn jet(&self, u: f64, v: f64, side: (OneSided, OneSided)) -> Jet2 {
        let (a, b) = (self.u.weights(u, side.0), self.v.weights(v, side.1));
        let mut row = BlendSum::default();
        let along_v = |i: usize| self.along_v[i].jet(v, side.1);
        let along_u = |j: usize| self.along_u[j].jet(u, side.0);
        if self.u.slopes().is_empty() {
            self.row(&a, &b, |_, i| along_v(i), &mut row);
        } else if !self.along_v.is_empty() {
            let lines = active_lines(&self.u, a.cell(), along_v);
            self.row(&a, &b, |k, _| lines[k], &mut row);
        }
        if self.v.slopes().is_empty() {
            b.iter().for_each(|(j, w)| row.add_along_u(&along_u(j), w));
        } else {
            let lines = active_lines(&self.v, b.cell(), along_u);
            lines.iter().zip(b.values()).for_each(|(line, w)| row.add_along_u(line, w));
        }
        row.0
    }

    /// Adds the sums over the terms along v and the nodes; `along_v` by place among the active terms, and by term.
    fn row(&self, a: &Weights, b: &Weights, along_v: impl Fn(usize, usize) -> Jet, row: &mut BlendSum) {
        if self.along_v.is_empty() {
            return;
        }
        for (k, (i, w)) in a.iter().enumerate() {
            let mut f = along_v(k, i);
            self.less_nodes(i, b, &mut f);
            row.add_along_v(&f, w);
        }
    }

    /// Takes the nodes of term `i` along v from its curve.
    pub(super) fn less_nodes(&self, i: usize, b: &Weights, f: &mut Jet) {
        for (j, z) in b.iter() {
            let p = self.corner(i, j);
            f.p -= p * z[0];
            f.d1 -= p * z[1];
            f.d2 -= p * z[2];
        }
    }

    /// Interior parameters where the surface is less than smooth, in u (first) and v (second).
    pub fn breaks(&self) -> (Vec<f64>, Vec<f64>) {
        let inner = |axis: &BlendAxis, rails: &[Rail]| {
            let mut all = if axis.is_piecewise() { axis.nodes.clone() } else { Vec::new() };
            rails.iter().for_each(|rail| rail.breaks(&mut all));
            tidy(all, SLIVER)
        };
        (inner(&self.u, &self.along_u), inner(&self.v, &self.along_v))
    }

    /// Interior network lines and kinks.
    pub fn cells(&self) -> (Vec<f64>, Vec<f64>) {
        let inner = |axis: &BlendAxis, rails: &[Rail]| {
            let kinks = rails.iter().flat_map(Rail::kinks).map(|k| k.0);
            tidy(axis.nodes.iter().copied().chain(kinks).collect(), SLIVER)
        };
        (inner(&self.u, &self.along_u), inner(&self.v, &self.along_v))
    }

    /// A box of the curves, grown by the blending's reach; holds the surface.
    ///
    /// |U| is at most Λ_u max|F| + Λ_v max|G| + Λ_u Λ_v max|P| about any centre, Λ the sums of absolute blending values.
    pub fn hull(&self) -> Box3 {
        let rails = self.along_u.iter().chain(&self.along_v);
        let box3 = rails.fold(Box3::of(self.nodes()), |all, rail| all.union(rail.hull()));
        let (a, b) = (self.u.lebesgue(), self.v.lebesgue());
        let reach = if self.along_v.is_empty() { b } else { a + b + a * b };
        // In a cell of width h the sizes of both cubics of slopes sum to h t (1 − t), h / 4 at most.
        let widest = |axis: &BlendAxis| axis.nodes.windows(2).map(|x| x[1] - x[0]).fold(0.0, f64::max);
        let twisted =
            self.twists().iter().fold(DVec3::ZERO, |most, twist| most.max(twist.abs())) * (widest(&self.u) * widest(&self.v) / 16.0);
        let (center, half) = (box3.center(), (box3.max - box3.min) * (0.5 * reach) + twisted);
        Box3 { min: center - half, max: center + half }
    }

    /// Carried by a motion.
    pub fn moved(&self, motion: &Motion) -> Self {
        let nodes: Vec<DVec3> = self.nodes().iter().map(|p| motion.point(*p)).collect();
        let moved = Self {
            u: self.u.clone(),
            v: self.v.clone(),
            along_v: self.along_v.iter().map(|r| r.moved(motion)).collect(),
            along_u: self.along_u.iter().map(|r| r.moved(motion)).collect(),
            corners: with_slopes(&nodes, self.along_v.len(), &self.u, &self.v),
        };
        let twists: Vec<DVec3> = self.twists().iter().map(|twist| motion.vector(*twist)).collect();
        if twists.is_empty() { moved } else { moved.with_twists(&twists) }
    }
}

/// The sum under construction.
#[derive(Default)]
pub(super) struct BlendSum(pub(super) Jet2);

impl BlendSum {
    pub(super) fn add_along_v(&mut self, f: &Jet, a: &[f64; 3]) {
        let jet = &mut self.0;
        jet.p += f.p * a[0];
        jet.du += f.p * a[1];
        jet.duu += f.p * a[2];
        jet.dv += f.d1 * a[0];
        jet.duv += f.d1 * a[1];
        jet.dvv += f.d2 * a[0];
    }

    pub(super) fn add_along_u(&mut self, g: &Jet, b: &[f64; 3]) {
        let jet = &mut self.0;
        jet.p += g.p * b[0];
        jet.dv += g.p * b[1];
        jet.dvv += g.p * b[2];
        jet.du += g.d1 * b[0];
        jet.duv += g.d1 * b[1];
        jet.duu += g.d2 * b[0];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::math;

    type Formula = fn(f64, f64) -> DVec3;

    /// The grid of curves of a formula over its own parameters.
    fn grid_of(f: Formula, us: &[f64], vs: &[f64], rule: Rule) -> Blend {
        let along_v = us.iter().map(|&at| Rail::Formula { f, at, along_u: false }).collect();
        let along_u = vs.iter().map(|&at| Rail::Formula { f, at, along_u: true }).collect();
        Blend::new(BlendAxis::new(us.to_vec(), rule), BlendAxis::new(vs.to_vec(), rule), along_v, along_u)
    }

    fn check(f: Formula, samples: &[(f64, f64, [f64; 3], f64)]) {
        let blend = grid_of(f, &[0.0, 0.4, 1.0], &[0.0, 0.5, 1.0], Rule::Lagrange);
        for &(u, v, point, error) in samples {
            let p = blend.jet(u, v, (OneSided::After, OneSided::After)).p;
            assert!(p.distance(point.into()) < 1e-12, "{u} {v}: {p}");
            assert!((p.distance(f(u, v)) - error).abs() < 1e-12, "{u} {v}");
            let mut grid = [DVec3::ZERO];
            blend.grid(&[u], &[v], &mut grid);
            assert!(grid[0].distance(p) < 1e-15);
        }
    }

    #[test]
    fn lagrange_map_of_a_general_network() {
        check(
            |u, v| {
                let (pi, half) = (std::f64::consts::PI, std::f64::consts::FRAC_PI_2);
                DVec3::new(u + 0.1 * math::sin(3.0 * v), v + 0.05 * u * v, math::sin(pi * u) * math::cos(half * v) + 0.3 * u * u * v)
            },
            &[
                (0.2, 0.3, [0.27833269096274826, 0.3029999999999998, 0.5281084892272703], 0.0007879946129708548),
                (0.7, 0.8, [0.7675463180551151, 0.8280000000000003, 0.36705507386745634], 0.0005449261325436994),
                (0.5, 0.25, [0.5681638760023334, 0.2562499999999999, 0.9424567234762948], 0.00017280903499194977),
                (0.9, 0.1, [0.929552020666134, 0.10450000000000002, 0.33013784898283166], 0.0006253665929427665),
                (0.4, 0.77, [0.47390052780594705, 0.77 + 0.05 * 0.4 * 0.77, 0.3731345535226739], 5.551115123125783e-17),
                (0.33, 0.5, [0.42974949866040546, 0.5082500000000001, 0.624971524146743], 1.1102230246251565e-16),
            ],
        );
    }

    #[test]
    fn lagrange_map_is_exact_for_low_degree_in_one_direction() {
        check(
            |u, v| DVec3::new(u, v, u * u * math::powi(v, 5) + 3.0 * u * v - 2.0 * u * math::exp(v)),
            &[
                (0.2, 0.3, [0.19999999999999996, 0.3, -0.35984632303040126], 5.551115123125783e-17),
                (0.7, 0.8, [0.7, 0.8000000000000003, -1.275194099889455], 3.1401849173675503e-16),
                (0.5, 0.25, [0.5, 0.25, -0.9087812760627416], 2.220446049250313e-16),
                (0.9, 0.1, [0.9000000000000001, 0.10000000000000002, -1.719299552536166], 2.486410087150353e-16),
                (0.4, 0.77, [0.4, 0.77, -0.760504456515932], 0.0),
                (0.33, 0.5, [0.33000000000000007, 0.5, -0.5897529136620847], 5.551115123125783e-17),
            ],
        );
    }

    #[test]
    fn lagrange_swings_out_and_coons_stays() {
        let f: Formula = |u, v| {
            let bell = |x: f64| 1.0 / (1.0 + 25.0 * (2.0 * x - 1.0) * (2.0 * x - 1.0));
            DVec3::new(u, v, bell(u) * bell(v))
        };
        let nodes: Vec<f64> = (0..7).map(|k| f64::from(k) / 6.0).collect();
        let stations: Vec<f64> = (0..61).map(|k| f64::from(k) / 60.0).collect();
        for (rule, error, low) in
            [(Rule::Lagrange, 0.3710992524525961, -0.36854275706060013), (Rule::Cubic, 0.0024755120666331704, 0.0014792899408284025)]
        {
            let blend = grid_of(f, &nodes, &nodes, rule);
            let mut points = vec![DVec3::ZERO; 61 * 61];
            blend.grid(&stations, &stations, &mut points);
            let off = points.iter().enumerate().map(|(k, p)| (p.z - f(stations[k % 61], stations[k / 61]).z).abs()).fold(0.0, f64::max);
            let (least, most) = points.iter().fold((f64::MAX, f64::MIN), |(a, b), p| (a.min(p.z), b.max(p.z)));
            assert!((off - error).abs() < 1e-6 && (least - low).abs() < 1e-6 && (most - 1.0).abs() < 1e-6, "{off} {least} {most}");
        }
    }

    /// Cubic in u: exact whatever the other direction; reference samples of `gordon.json`.
    #[test]
    fn spline_sum_of_a_cubic_net_is_exact() {
        let f: Formula = |u, v| DVec3::new(u, v, u * u * u * v * v * v - 2.0 * u * u * v + v * v * v);
        let blend = grid_of(f, &[0.0, 0.3, 0.7, 1.0], &[0.0, 0.5, 1.0], Rule::Spline);
        let samples = [(0.15, 0.25, 0.004427734374999997), (0.5, 0.75, 0.09960937499999992), (0.85, 0.4, -0.47469599999999995)];
        for (u, v, z) in samples {
            let p = blend.jet(u, v, (OneSided::After, OneSided::After)).p;
            assert!(p.distance(DVec3::new(u, v, z)) < 1e-14, "{p}");
            let mut grid = [DVec3::ZERO];
            blend.grid(&[u], &[v], &mut grid);
            assert!(grid[0].distance(p) < 1e-15);
        }
    }

    #[test]
    fn spline_sum_contains_its_net_whatever_the_surface() {
        let f: Formula = |u, v| DVec3::new(u, v, math::sin(2.0 * u) * math::cos(1.5 * v));
        let (us, vs) = ([0.0, 0.3, 0.7, 1.0], [0.0, 0.5, 1.0]);
        let blend = grid_of(f, &us, &vs, Rule::Spline);
        let at = |u: f64, v: f64| blend.jet(u, v, (OneSided::After, OneSided::After)).p;
        for k in 0..=100 {
            let x = f64::from(k) / 100.0;
            us.iter().for_each(|&u| assert!(at(u, x).distance(f(u, x)) < 1e-15));
            vs.iter().for_each(|&v| assert!(at(x, v).distance(f(x, v)) < 1e-15));
        }
        // The reference has exact end slopes, which no net has; both are near the surface the net was taken from.
        for (u, v, z) in [(0.15, 0.25, 0.2749839308201486), (0.5, 0.75, 0.36282226268018547), (0.85, 0.4, 0.8184562035105998)] {
            assert!((at(u, v).z - z).abs() < 2e-4, "{}", at(u, v).z - z);
        }
    }
}
