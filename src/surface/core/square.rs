//! Every surface over the unit square: a triangle is read through (x, y) ↦ (x (1 − y), y).

use crate::surface::core::surface::Surface;
use crate::surface::data::jet::Jet2;
use crate::surface::data::kind::Domain;
use crate::surface::data::one_sided::OneSided;

impl Surface {
    /// Surface parameters of a place in the unit square.
    pub fn from_square(&self, x: f64, y: f64) -> (f64, f64) {
        if self.domain() == Domain::Triangle { (x * (1.0 - y), y) } else { (x, y) }
    }

    /// Point and derivatives with respect to the unit square's x and y (in the fields of u and v).
    ///
    /// The area element |du × dv| is that of the square too, so integrals need no further factor.
    pub fn square_jet(&self, x: f64, y: f64) -> Jet2 {
        let (u, v) = self.from_square(x, y);
        let jet = self.jet(u, v);
        if self.domain() == Domain::Triangle { squared(&jet, x, y) } else { jet }
    }

    /// [`Surface::square_jet`] on a tensor grid, x fastest.
    pub fn square_jets(&self, xs: &[f64], ys: &[f64]) -> Vec<Jet2> {
        if self.domain() == Domain::Triangle {
            return ys.iter().flat_map(|&y| xs.iter().map(move |&x| (x, y))).map(|(x, y)| self.square_jet(x, y)).collect();
        }
        let after = |list: &[f64]| list.iter().map(|&x| (x, OneSided::After)).collect::<Vec<_>>();
        self.jets(&after(xs), &after(ys))
    }
}

/// The chain rule for u = x (1 − y), v = y.
fn squared(jet: &Jet2, x: f64, y: f64) -> Jet2 {
    let z = 1.0 - y;
    Jet2 {
        p: jet.p,
        du: jet.du * z,
        dv: jet.dv - jet.du * x,
        duu: jet.duu * (z * z),
        duv: (jet.duv - jet.duu * x) * z - jet.du,
        dvv: jet.duu * (x * x) - jet.duv * (2.0 * x) + jet.dvv,
    }
}
