//! Cuts a surface into patches at its kink lines: a grid of raw vertices, edges and patches before gluing.

use glam::DVec3;

use super::on_chain::OnChain;
use super::topology::{EdgeCurve, Named, SurfaceId};
use super::trace::Track;
use crate::base::tolerance::Tolerance;
use crate::geometry::closest;
use crate::network::{Chain, Network};
use crate::surface::{Domain, Side, Surface};

/// An edge between two corners of its own surface.
pub(super) struct RawEdge {
    pub ends: (usize, usize),
    pub curve: EdgeCurve,
    pub length: f64,
    pub probes: [DVec3; 3],
}

/// One side of a raw patch: edges in ascending direction, or the corner that is its pole.
#[derive(Clone, Default)]
pub(super) struct RawSide {
    pub edges: Vec<usize>,
    pub pole: Option<usize>,
}

/// A patch before gluing.
pub(super) struct RawPatch {
    pub u: (f64, f64),
    pub v: (f64, f64),
    pub sides: Vec<RawSide>,
}

/// A surface in pieces; indices are into its own lists.
#[derive(Default)]
pub(super) struct Pieces {
    pub vertices: Vec<DVec3>,
    pub edges: Vec<RawEdge>,
    pub patches: Vec<RawPatch>,
}

/// Where a line runs: side number, or a line inside.
#[derive(Clone, Copy)]
enum LinePlace {
    Side(usize),
    Inside,
}

/// Everything that cutting one surface needs.
struct Cutter<'a> {
    id: SurfaceId,
    surfaces: &'a [Named],
    surface: &'a Surface,
    network: &'a Network,
    tolerance: &'a Tolerance,
    lines: &'a Lines,
    pieces: Pieces,
}

/// Lines of a surface along which it is cut although it is smooth there: values of u and of v.
#[derive(Clone, Debug, Default)]
pub struct Lines {
    /// Values of u.
    pub u: Vec<f64>,
    /// Values of v.
    pub v: Vec<f64>,
}

/// Both lists as one, ascending, each value once.
fn merged(a: &[f64], b: &[f64], tolerance: &Tolerance) -> Vec<f64> {
    let inside = |x: &f64| *x > tolerance.parameter && *x < 1.0 - tolerance.parameter;
    let mut all: Vec<f64> = a.to_vec();
    // Where both have a line, the first list's is it.
    all.extend(b.iter().copied().filter(|x| inside(x) && !a.iter().any(|y| (x - y).abs() <= tolerance.parameter)));
    all.sort_by(f64::total_cmp);
    all.dedup_by(|x, y| *x - *y <= tolerance.parameter);
    all
}

/// The pieces of one surface: patches row by row (u fastest), corners likewise.
pub(super) fn cut(id: SurfaceId, surfaces: &[Named], lines: &Lines, network: &Network, tolerance: &Tolerance) -> Pieces {
    let surface = &surfaces[id.index()].surface;
    let cutter = Cutter { id, surfaces, surface, network, tolerance, lines, pieces: Pieces::default() };
    match surface.domain() {
        Domain::Square => cutter.square(),
        Domain::Triangle => cutter.triangle(),
        Domain::Loop => cutter.around(),
        Domain::Unbounded => cutter.pieces,
    }
}

impl Cutter<'_> {
    fn square(mut self) -> Pieces {
        let (kinks_u, kinks_v) = self.surface.kinks();
        let with_ends = |inner: &[f64]| [&[0.0], inner, &[1.0]].concat();
        let inner = |kinks: &[f64], lines: &[f64]| with_ends(&merged(kinks, lines, self.tolerance));
        let (us, vs) = (inner(kinks_u, &self.lines.u), inner(kinks_v, &self.lines.v));
        let (nu, nv) = (us.len() - 1, vs.len() - 1);
        for &v in &vs {
            for &u in &us {
                self.pieces.vertices.push(self.surface.point(u, v));
            }
        }
        let corner = |i: usize, j: usize| j * (nu + 1) + i;
        let mut along_u = Vec::new();
        for (j, &v) in vs.iter().enumerate() {
            let place = if j == 0 {
                LinePlace::Side(0)
            } else if j == nv {
                LinePlace::Side(2)
            } else {
                LinePlace::Inside
            };
            let corners: Vec<_> = us.iter().enumerate().map(|(i, &u)| ((u, v), corner(i, j))).collect();
            along_u.push(self.line(place, &corners));
        }
        let mut along_v = Vec::new();
        for (i, &u) in us.iter().enumerate() {
            let place = if i == 0 {
                LinePlace::Side(3)
            } else if i == nu {
                LinePlace::Side(1)
            } else {
                LinePlace::Inside
            };
            let corners: Vec<_> = vs.iter().enumerate().map(|(j, &v)| ((u, v), corner(i, j))).collect();
            along_v.push(self.line(place, &corners));
        }
        for j in 0..nv {
            for i in 0..nu {
                let sides = vec![along_u[j][i].clone(), along_v[i + 1][j].clone(), along_u[j + 1][i].clone(), along_v[i][j].clone()];
                self.pieces.patches.push(RawPatch { u: (us[i], us[i + 1]), v: (vs[j], vs[j + 1]), sides });
            }
        }
        self.pieces
    }

    /// One patch; kinks of a side become corners on it.
    fn triangle(mut self) -> Pieces {
        let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)];
        for (u, v) in corners {
            self.pieces.vertices.push(self.surface.point(u, v));
        }
        let mut sides = Vec::new();
        for (k, (first, last)) in [(0, 1), (1, 2), (0, 2)].into_iter().enumerate() {
            let at = |t: f64| match k {
                0 => (t, 0.0),
                1 => (1.0 - t, t),
                _ => (0.0, t),
            };
            let mut line = vec![(corners[first], first)];
            for t in self.side_kinks(k) {
                let (u, v) = at(t);
                line.push(((u, v), self.pieces.vertices.len()));
                self.pieces.vertices.push(self.surface.point(u, v));
            }
            line.push((corners[last], last));
            let edges = self.line(LinePlace::Side(k), &line).into_iter().flat_map(|side| side.edges).collect();
            sides.push(RawSide { edges, pole: None });
        }
        self.pieces.patches.push(RawPatch { u: (0.0, 1.0), v: (0.0, 1.0), sides });
        self.pieces
    }

    /// One patch inside loops of sides; kinks become corners.
    fn around(mut self) -> Pieces {
        let mut sides = Vec::new();
        let mut begin = 0;
        for n in self.surface.loops() {
            let first: Vec<usize> = (begin..begin + n)
                .map(|k| {
                    self.pieces.vertices.push(self.surface.border_start(k).unwrap_or_default());
                    self.pieces.vertices.len() - 1
                })
                .collect();
            for k in 0..n {
                sides.push(self.border(begin + k, (first[k], first[(k + 1) % n])));
            }
            begin += n;
        }
        self.pieces.patches.push(RawPatch { u: (0.0, 1.0), v: (0.0, 1.0), sides });
        self.pieces
    }

    /// One border of a loop between two corners.
    fn border(&mut self, k: usize, (first, last): (usize, usize)) -> RawSide {
        let (chain, from, to) = match self.surface.side(k) {
            Side::Chain { chain, from, to } => (chain, from, to),
            Side::Pole(_) => return RawSide { edges: Vec::new(), pole: Some(first) },
            Side::Seam | Side::Free => {
                let Some((from, to)) = self.surface.border_line(k) else { return RawSide::default() };
                let curve = EdgeCurve::Iso { surface: self.id, from, to };
                return match self.edge(curve, (first, last)) {
                    Some(edge) => RawSide { edges: vec![edge], pole: None },
                    None => RawSide { edges: Vec::new(), pole: Some(first) },
                };
            }
        };
        let mut stops = vec![(from, first)];
        let mut kinks = chain.kinks(self.tolerance);
        kinks.retain(|f| (f - from) * (f - to) < 0.0);
        kinks.sort_by(|a, b| (a - from).abs().total_cmp(&(b - from).abs()));
        for f in kinks {
            stops.push((f, self.pieces.vertices.len()));
            self.pieces.vertices.push(chain.point(f));
        }
        stops.push((to, last));
        let on = OnChain::new(&chain, stops.iter().map(|s| s.0).collect(), self.network, self.tolerance);
        let edges = (0..stops.len() - 1)
            .filter_map(|n| {
                let curve = on.edge_curve(n, self.network, self.tolerance);
                self.edge(curve, (stops[n].1, stops[n + 1].1))
            })
            .collect();
        RawSide { edges, pole: None }
    }

    /// Adds an edge unless it is shorter than the tolerance.
    fn edge(&mut self, curve: EdgeCurve, ends: (usize, usize)) -> Option<usize> {
        let track = Track::of(&curve, self.surfaces, self.network);
        let length = track.length();
        (length > self.tolerance.point).then(|| {
            self.pieces.edges.push(RawEdge { ends, curve, length, probes: track.probes() });
            self.pieces.edges.len() - 1
        })
    }

    /// Side parameters of the kinks of the chain along a side, ascending, ends left out.
    fn side_kinks(&self, k: usize) -> Vec<f64> {
        let Side::Chain { chain, from, to } = self.surface.side(k) else {
            return Vec::new();
        };
        let mut found: Vec<f64> = chain
            .kinks(self.tolerance)
            .into_iter()
            .filter(|f| (f - from) * (f - to) < 0.0)
            .map(|f| self.surface.side_parameter(k, f))
            .filter(|t| *t > self.tolerance.parameter && *t < 1.0 - self.tolerance.parameter)
            .collect();
        found.sort_by(f64::total_cmp);
        found.dedup_by(|a, b| *a - *b <= self.tolerance.parameter);
        found
    }

    /// The edges between neighbouring corners of a line, as one side each; poles have none.
    fn line(&mut self, place: LinePlace, corners: &[((f64, f64), usize)]) -> Vec<RawSide> {
        if let LinePlace::Side(k) = place
            && let Side::Pole(_) = self.surface.side(k)
        {
            return corners.windows(2).map(|w| RawSide { edges: Vec::new(), pole: Some(w[0].1) }).collect();
        }
        let support = self.support(place, corners);
        let mut sides = Vec::new();
        for (n, w) in corners.windows(2).enumerate() {
            let curve = support.as_ref().map(|on| on.edge_curve(n, self.network, self.tolerance)).unwrap_or(EdgeCurve::Iso {
                surface: self.id,
                from: w[0].0,
                to: w[1].0,
            });
            match self.edge(curve, (w[0].1, w[1].1)) {
                Some(edge) => sides.push(RawSide { edges: vec![edge], pole: None }),
                None => sides.push(RawSide { edges: Vec::new(), pole: Some(w[0].1) }),
            }
        }
        sides
    }

    /// The chain a line lies on, when its links are known to the network.
    fn support(&self, place: LinePlace, corners: &[((f64, f64), usize)]) -> Option<OnChain> {
        if let LinePlace::Side(k) = place {
            let along_u = k % 2 == 0 && self.surface.domain() == Domain::Square || k == 0;
            let parameter = |uv: (f64, f64)| if along_u { uv.0 } else { uv.1 };
            // A seam lies on the chain of the opposite side.
            for side in [k, (k + 2) % 4] {
                match self.surface.side(side) {
                    Side::Chain { chain, .. } => {
                        let fractions = corners.iter().map(|(uv, _)| self.surface.side_fraction(side, parameter(*uv))).collect();
                        return Some(OnChain::new(&chain, fractions, self.network, self.tolerance));
                    }
                    Side::Seam => {}
                    Side::Pole(_) | Side::Free => break,
                }
            }
        }
        self.surface.chains().iter().find_map(|chain| self.lies_on(chain, corners))
    }

    /// Whether a line inside lies on a chain: its corners and the quarters between them do, one after the other. A ring that begins
    /// elsewhere than the chain is none of it.
    fn lies_on(&self, chain: &Chain, corners: &[((f64, f64), usize)]) -> Option<OnChain> {
        const QUARTERS: usize = 4;
        let curve = chain.to_curve().ok()?;
        let mut places = Vec::new();
        for w in corners.windows(2) {
            for step in 0..QUARTERS {
                let t = step as f64 / QUARTERS as f64;
                let (a, b) = (w[0].0, w[1].0);
                let p = self.surface.point(a.0 + (b.0 - a.0) * t, a.1 + (b.1 - a.1) * t);
                let foot = closest(&curve, p);
                if foot.distance > self.tolerance.point {
                    return None;
                }
                places.push(curve.length_at(foot.t) / curve.length());
            }
        }
        let (u, v) = corners.last()?.0;
        let foot = closest(&curve, self.surface.point(u, v));
        if foot.distance > self.tolerance.point {
            return None;
        }
        places.push(curve.length_at(foot.t) / curve.length());
        let ascending = places.windows(2).all(|w| w[0] < w[1]);
        let descending = places.windows(2).all(|w| w[0] > w[1]);
        (ascending || descending).then(|| OnChain::new(chain, places.into_iter().step_by(QUARTERS).collect(), self.network, self.tolerance))
    }
}
