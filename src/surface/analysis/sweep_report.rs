//! What a net's surface says of itself: its stations, and how smooth it is across them.

use crate::base::math;
use crate::network::Chain;
use crate::surface::core::shape::Shape;
use crate::surface::core::surface::Surface;
use crate::surface::data::kind::SurfaceKind;
use crate::surface::data::one_sided::OneSided;
use crate::surface::rails::rail::Rail;

impl Surface {
    /// The curves along v that it is made through, by ascending u, or the sections of a skin, by ascending v, each once; none where
    /// it is not made through curves.
    pub fn stations(&self) -> Vec<Chain> {
        let of = |rails: &[Rail]| -> Vec<Chain> { rails.iter().filter_map(Rail::chain).cloned().collect() };
        let (mut found, closed) = match &self.parts().shape {
            Shape::Blend(blend) if blend.along_v().is_empty() && self.kind() == SurfaceKind::Skin => (of(blend.along_u()), self.closed().1),
            Shape::Blend(blend) => (of(blend.along_v()), self.closed().0),
            _ => (Vec::new(), false),
        };
        if closed && found.len() > 1 {
            found.pop();
        }
        found
    }

    /// The largest angle of the normals on both sides of the curves of its net, radians; 0 where it has none. Corners of the
    /// curves themselves are left out.
    pub fn patch_angle(&self) -> f64 {
        const PLACES: usize = 48;
        let Shape::Blend(blend) = &self.parts().shape else { return 0.0 };
        let own_kinks = |rails: &[Rail]| -> Vec<f64> { rails.iter().flat_map(Rail::kinks).map(|k| k.0).collect() };
        let inner = |nodes: &[f64], kinks: Vec<f64>| -> Vec<f64> {
            let smooth = |x: &f64| !kinks.iter().any(|k| (k - x).abs() <= crate::base::tolerance::NUDGE);
            nodes[1..nodes.len() - 1].iter().copied().filter(smooth).collect()
        };
        let (axis_u, axis_v) = blend.axes();
        let (us, vs) = (inner(&axis_u.nodes, own_kinks(blend.along_u())), inner(&axis_v.nodes, own_kinks(blend.along_v())));
        let place = |k: usize| (k as f64 + 0.5) / PLACES as f64;
        let (before, after) = (OneSided::Before, OneSided::After);
        let across_u = us.iter().flat_map(|&u| (0..PLACES).map(move |k| (u, place(k), [(before, after), (after, after)])));
        let across_v = vs.iter().flat_map(|&v| (0..PLACES).map(move |k| (place(k), v, [(after, before), (after, after)])));
        let angle = |(u, v, [a, b]): (f64, f64, [(OneSided, OneSided); 2])| {
            let (a, b) = (self.jet_one_sided(u, v, a), self.jet_one_sided(u, v, b));
            let (a, b) = (a.du.cross(a.dv), b.du.cross(b.dv));
            if a.length_squared() == 0.0 || b.length_squared() == 0.0 { 0.0 } else { math::angle_between(a, b) }
        };
        across_u.chain(across_v).map(angle).fold(0.0, f64::max)
    }
}
