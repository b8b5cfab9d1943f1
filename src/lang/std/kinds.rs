//! Things of several types where a function takes any of them.

use std::sync::Arc;

use glam::DVec3;

use crate::lang::types::{FromValue, Ty};
use crate::lang::value::{MeshValue, ModuleId, ShellValue, Value};
use crate::model::{EdgeId, PatchId};
use crate::network::{Chain, LinkId};
use crate::surface::Surface;

/// Declares an enum whose variants are types of the language.
macro_rules! one_of {
    ($(#[$doc:meta])* $name:ident { $($(#[$vdoc:meta])* $variant:ident($($inner:ty),+) = $ty:expr, $pattern:pat => $out:expr;)+ }) => {
        $(#[$doc])*
        #[derive(Clone, Debug)]
        pub enum $name { $($(#[$vdoc])* $variant($($inner),+)),+ }
        impl FromValue for $name {
            const TY: Ty = Ty::OneOf(&[$($ty),+]);
            fn from_value(value: Value) -> Option<Self> {
                match value { $($pattern => Some($out),)+ _ => None }
            }
        }
    };
}

one_of! {
    /// A curve or a surface.
    CurveOrSurface {
        /// A curve.
        Curve(Chain) = Ty::Curve, Value::Curve(c) => Self::Curve(c);
        /// A surface.
        Surface(Surface) = Ty::Surface, Value::Surface(s) => Self::Surface(s);
    }
}

one_of! {
    /// Points to choose from, or a curve that has many.
    PointsOrCurve {
        /// A curve.
        Curve(Chain) = Ty::Curve, Value::Curve(c) => Self::Curve(c);
        /// A list of points.
        Points(Vec<Value>) = Ty::List(&Ty::Point), Value::List(items) => Self::Points(items.to_vec());
    }
}

one_of! {
    /// What two things may meet in.
    Meeting {
        /// A curve.
        Curve(Chain) = Ty::Curve, Value::Curve(c) => Self::Curve(c);
        /// A surface.
        Surface(Surface) = Ty::Surface, Value::Surface(s) => Self::Surface(s);
        /// A shell.
        Shell(Arc<ShellValue>) = Ty::Shell, Value::Shell(s) => Self::Shell(s);
        /// A mesh.
        Mesh(Arc<MeshValue>) = Ty::Mesh, Value::Mesh(m) => Self::Mesh(m);
    }
}

one_of! {
    /// Anything with a length.
    Lengthy {
        /// A curve.
        Curve(Chain) = Ty::Curve, Value::Curve(c) => Self::Curve(c);
        /// A link.
        Link(ModuleId, LinkId) = Ty::Link, Value::Link(m, l) => Self::Link(m, l);
        /// An edge.
        Edge(ModuleId, EdgeId) = Ty::Edge, Value::Edge(m, e) => Self::Edge(m, e);
    }
}

one_of! {
    /// Anything with an area, a box and a centroid.
    Region {
        /// A curve (box, centroid).
        Curve(Chain) = Ty::Curve, Value::Curve(c) => Self::Curve(c);
        /// A surface.
        Surface(Surface) = Ty::Surface, Value::Surface(s) => Self::Surface(s);
        /// A patch.
        Patch(ModuleId, PatchId) = Ty::Patch, Value::Patch(m, p) => Self::Patch(m, p);
        /// A shell.
        Shell(Arc<ShellValue>) = Ty::Shell, Value::Shell(s) => Self::Shell(s);
        /// A mesh.
        Mesh(Arc<MeshValue>) = Ty::Mesh, Value::Mesh(m) => Self::Mesh(m);
    }
}

one_of! {
    /// What an edge of a surface is asked for by.
    EdgeKey {
        /// A curve it lies on.
        Curve(Chain) = Ty::Curve, Value::Curve(c) => Self::Curve(c);
        /// A point on it.
        Point(DVec3) = Ty::Point, Value::Vector(p, _) | Value::Node(p) => Self::Point(p);
    }
}
