//! The closed set of shapes a surface may have, each evaluated exactly.

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::digest::{StableHash, StableHasher};
use crate::base::tolerance::EPSILON;
use crate::base::work;
use crate::geometry::Motion;
use crate::surface::core::joined::Joined;
use crate::surface::core::surface::Surface;
use crate::surface::data::breaks::tidy;
use crate::surface::data::jet::Jet2;
use crate::surface::data::one_sided::OneSided;
use crate::surface::shapes::blend::Blend;
use crate::surface::shapes::frame::Frame;
use crate::surface::shapes::framed::Framed;
use crate::surface::shapes::height_field::Field;
use crate::surface::shapes::nurbs::NurbsSurface;
use crate::surface::shapes::sweep::Sweep;
use crate::surface::shapes::trilateral::Trilateral;

/// The exact shape of a surface over its own u and v.
#[derive(Clone, Debug)]
#[allow(clippy::large_enum_variant, reason = "one per surface, and that behind an Arc")]
pub enum Shape {
    /// Blended from a grid of curves.
    Blend(Blend),
    /// Blended from three borders.
    Trilateral(Trilateral),
    /// A profile translated or turned along a path.
    Sweep(Sweep),
    /// A plane over its frame.
    Plane(Frame),
    /// A net.
    Nurbs(NurbsSurface),
    /// A profile moved with a frame.
    Framed(Framed),
    /// A height over triangles.
    Scatter(Field),
    /// Others one after another.
    Joined(Joined),
}

impl StableHash for Shape {
    fn hash_into(&self, to: &mut StableHasher) {
        match self {
            Self::Blend(blend) => (0u8, blend).hash_into(to),
            Self::Trilateral(trilateral) => (1u8, trilateral).hash_into(to),
            Self::Sweep(sweep) => (2u8, sweep).hash_into(to),
            Self::Plane(frame) => (3u8, frame).hash_into(to),
            Self::Nurbs(net) => (4u8, net).hash_into(to),
            Self::Framed(framed) => (5u8, framed).hash_into(to),
            Self::Scatter(field) => (6u8, field).hash_into(to),
            Self::Joined(joined) => (7u8, joined).hash_into(to),
        }
    }
}

impl Shape {
    /// Point and derivatives, from the given sides where they jump.
    pub fn jet(&self, u: f64, v: f64, side: (OneSided, OneSided)) -> Jet2 {
        work::spend(1);
        match self {
            Self::Blend(s) => s.jet(u, v, side),
            Self::Trilateral(s) => s.jet(u, v),
            Self::Sweep(s) => s.jet(u, v, side),
            Self::Plane(s) => s.jet(u, v),
            Self::Nurbs(s) => s.jet(u, v, side),
            Self::Framed(s) => s.jet(u, v, side),
            Self::Scatter(s) => s.jet(u, v),
            Self::Joined(s) => s.jet(u, v, side),
        }
    }

    /// Points of the tensor grid, u fastest.
    pub fn grid(&self, us: &[f64], vs: &[f64], out: &mut [DVec3]) {
        work::spend((us.len() * vs.len()) as u64);
        match self {
            Self::Blend(s) => s.grid(us, vs, out),
            Self::Sweep(s) => s.grid(us, vs, out),
            Self::Nurbs(s) => s.grid(us, vs, out),
            Self::Framed(s) => s.grid(us, vs, out),
            _ => {
                for (row, &v) in out.chunks_exact_mut(us.len().max(1)).zip(vs) {
                    for (p, &u) in row.iter_mut().zip(us) {
                        *p = self.jet(u, v, (OneSided::After, OneSided::After)).p;
                    }
                }
            }
        }
    }

    /// Evaluations of a curve that a jet in a grid is worth, beside those of the curves that it is made of.
    fn weight(&self) -> u64 {
        /// Curves that are blended in the time of one evaluation.
        const BLENDED: usize = 40;
        let Self::Blend(blend) = self else { return 1 };
        1 + ((blend.along_u().len() + blend.along_v().len()) / BLENDED) as u64
    }

    /// Jets of the tensor grid, u fastest.
    pub fn jets(&self, us: &[(f64, OneSided)], vs: &[(f64, OneSided)], out: &mut Vec<Jet2>) {
        work::spend((us.len() * vs.len()) as u64 * self.weight());
        match self {
            Self::Blend(s) => s.jets(us, vs, out),
            Self::Sweep(s) => s.jets(us, vs, out),
            Self::Framed(s) => s.jets(us, vs, out),
            Self::Nurbs(s) => s.jets(us, vs, out),
            _ => {
                for &(v, side_v) in vs {
                    out.extend(us.iter().map(|&(u, side_u)| self.jet(u, v, (side_u, side_v))));
                }
            }
        }
    }

    /// Interior parameters where the shape is less than analytic.
    pub fn breaks(&self) -> (Vec<f64>, Vec<f64>) {
        match self {
            Self::Blend(s) => s.breaks(),
            Self::Sweep(s) => s.breaks(),
            Self::Plane(_) => (Vec::new(), Vec::new()),
            Self::Nurbs(s) => s.breaks(),
            Self::Framed(s) => s.breaks(),
            Self::Scatter(s) => s.lines(),
            Self::Joined(s) => s.all_lines(Surface::breaks),
            Self::Trilateral(s) => {
                let (mut us, mut vs) = (Vec::new(), Vec::new());
                s.sides()[0].breaks(&mut us);
                s.sides()[2].breaks(&mut vs);
                (tidy(us, EPSILON), tidy(vs, EPSILON))
            }
        }
    }

    /// Interior ends of the cells in which the report samples.
    pub fn cells(&self) -> (Vec<f64>, Vec<f64>) {
        match self {
            Self::Blend(s) => s.cells(),
            Self::Sweep(s) => s.cells(),
            Self::Nurbs(s) => s.breaks(),
            Self::Framed(s) => s.cells(),
            Self::Scatter(s) => s.lines(),
            Self::Joined(s) => s.all_lines(Surface::cells),
            Self::Trilateral(_) | Self::Plane(_) => (Vec::new(), Vec::new()),
        }
    }

    /// A box that holds the shape.
    pub fn hull(&self) -> Box3 {
        match self {
            Self::Blend(s) => s.hull(),
            Self::Trilateral(s) => s.hull(),
            Self::Sweep(s) => s.hull(),
            Self::Plane(s) => s.hull(),
            Self::Nurbs(s) => s.hull(),
            Self::Framed(s) => s.hull(),
            Self::Scatter(s) => s.hull(),
            Self::Joined(s) => s.hull(),
        }
    }

    /// Carried by a motion.
    pub fn moved(&self, motion: &Motion) -> Self {
        match self {
            Self::Blend(s) => Self::Blend(s.moved(motion)),
            Self::Trilateral(s) => Self::Trilateral(s.moved(motion)),
            Self::Sweep(s) => Self::Sweep(s.moved(motion)),
            Self::Plane(s) => Self::Plane(s.moved(motion)),
            Self::Nurbs(s) => Self::Nurbs(s.moved(motion)),
            Self::Framed(s) => Self::Framed(s.moved(motion)),
            Self::Scatter(s) => Self::Scatter(s.moved(motion)),
            Self::Joined(s) => Self::Joined(s.moved(motion)),
        }
    }
}
