//! Things of several types where a function takes any of them.

use std::sync::Arc;

use glam::DVec3;

use crate::base::origin::Origin;
use crate::lang::values::conversions::{FromValue, IntoValue, Point};
use crate::lang::values::types::Ty;
use crate::lang::values::value::{EntityHome, MeshValue, ModuleId, Plane, ShellValue, Value};
use crate::model::{PatchId, SharedEdge, VertexId};
use crate::network::{Chain, LinkId};
use crate::surface::Surface;

/// Declares an enum whose variants are types of the language.
macro_rules! one_of {
    ($(#[$doc:meta])* $name:ident { $($(#[$vdoc:meta])* $variant:ident($($inner:ty),*) = $ty:expr, $pattern:pat => $out:expr;)+ }) => {
        $(#[$doc])*
        #[derive(Clone, Debug)]
        pub enum $name { $($(#[$vdoc])* $variant($($inner),*)),+ }
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
    /// Control points, or a surface that has or gets some.
    PointsOrSurface {
        /// Control points.
        Points(Vec<Point>) = Ty::List(&Ty::Point), Value::List(items) => Self::Points(FromValue::from_value(Value::List(items))?);
        /// A surface.
        Surface(Surface) = Ty::Surface, Value::Surface(s) => Self::Surface(s);
    }
}

one_of! {
    /// Things to choose from, or a curve that has many points.
    ThingsOrCurve {
        /// A curve.
        Curve(Chain) = Ty::Curve, Value::Curve(c) => Self::Curve(c);
        /// A list of points, curves or surfaces.
        Things(Vec<Value>) = Ty::List(&Ty::OneOf(&[Ty::Point, Ty::Curve, Ty::Surface])), Value::List(items) => Self::Things(items.to_vec());
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
        /// An unbounded plane.
        Plane(Arc<Plane>) = Ty::Plane, Value::Plane(p) => Self::Plane(p);
        /// A mesh.
        Mesh(Arc<MeshValue>) = Ty::Mesh, Value::Mesh(m) => Self::Mesh(m);
    }
}

one_of! {
    /// What edges may lie on.
    Carrier {
        /// A curve.
        Curve(Chain) = Ty::Curve, Value::Curve(c) => Self::Curve(c);
        /// A surface.
        Surface(Surface) = Ty::Surface, Value::Surface(s) => Self::Surface(s);
        /// A shell.
        Shell(Arc<ShellValue>) = Ty::Shell, Value::Shell(s) => Self::Shell(s);
        /// An unbounded plane.
        Plane(Arc<Plane>) = Ty::Plane, Value::Plane(p) => Self::Plane(p);
    }
}

one_of! {
    /// What is trimmed.
    Trimmed {
        /// A surface.
        Surface(Surface) = Ty::Surface, Value::Surface(s) => Self::Surface(s);
        /// An unbounded plane.
        Plane(Arc<Plane>) = Ty::Plane, Value::Plane(p) => Self::Plane(p);
    }
}

one_of! {
    /// What cuts a surface.
    Cutter {
        /// A curve.
        Curve(Chain) = Ty::Curve, Value::Curve(c) => Self::Curve(c);
        /// A surface.
        Surface(Surface) = Ty::Surface, Value::Surface(s) => Self::Surface(s);
        /// A shell.
        Shell(Arc<ShellValue>) = Ty::Shell, Value::Shell(s) => Self::Shell(s);
        /// An unbounded plane.
        Plane(Arc<Plane>) = Ty::Plane, Value::Plane(p) => Self::Plane(p);
    }
}

one_of! {
    /// A surface or a shell.
    SurfaceOrShell {
        /// A surface.
        Surface(Surface) = Ty::Surface, Value::Surface(s) => Self::Surface(s);
        /// A shell.
        Shell(Arc<ShellValue>) = Ty::Shell, Value::Shell(s) => Self::Shell(s);
    }
}

impl SurfaceOrShell {
    /// The surfaces that it is made of, in order.
    pub fn surfaces(&self) -> Vec<Surface> {
        match self {
            Self::Surface(s) => vec![s.clone()],
            Self::Shell(s) => s.surfaces.clone(),
        }
    }
}

/// What has edges: a surface, a shell or a list of them.
#[derive(Clone, Debug)]
pub struct Edged(pub Faces);

impl FromValue for Edged {
    const TY: Ty = Ty::OneOf(&[Ty::Surface, Ty::Shell, Ty::List(&Ty::OneOf(&[Ty::Surface, Ty::Shell]))]);
    fn from_value(value: Value) -> Option<Self> {
        match value {
            Value::List(items) => Some(Self(Faces(items.to_vec()))),
            one @ (Value::Surface(_) | Value::Shell(_)) => Some(Self(Faces(vec![one]))),
            _ => None,
        }
    }
}

/// Edges or curves: one, or lists of them.
#[derive(Clone, Debug)]
pub struct EdgesOrCurves(pub Vec<Value>);

impl FromValue for EdgesOrCurves {
    const TY: Ty = Ty::OneOf(&[Ty::Edge, Ty::Curve, Ty::List(&Ty::Any)]);
    fn from_value(value: Value) -> Option<Self> {
        Some(Self(if let Value::List(items) = value { items.to_vec() } else { vec![value] }))
    }
}

/// Faces of surfaces and shells.
#[derive(Clone, Debug)]
pub struct Faces(Vec<Value>);

impl FromValue for Faces {
    const TY: Ty = Ty::List(&Ty::OneOf(&[Ty::Surface, Ty::Shell]));
    fn from_value(value: Value) -> Option<Self> {
        Vec::from_value(value).map(Self)
    }
}

/// A curve, or faces.
#[derive(Clone, Debug)]
pub enum CurveOrFaces {
    /// A curve.
    Curve(Chain),
    /// Faces of surfaces and shells.
    Faces(Faces),
}

impl FromValue for CurveOrFaces {
    const TY: Ty = Ty::OneOf(&[Ty::Curve, Faces::TY]);
    fn from_value(value: Value) -> Option<Self> {
        match value {
            Value::Curve(chain) => Some(Self::Curve(chain)),
            faces => Faces::from_value(faces).map(Self::Faces),
        }
    }
}

impl Faces {
    /// Those of one shell.
    pub fn of_shell(shell: Arc<ShellValue>) -> Self {
        Self(vec![Value::Shell(shell)])
    }

    /// The surfaces and shells that they are of, in order.
    pub fn members(self) -> Vec<Value> {
        self.0
    }

    /// The surfaces they lie on, in order.
    pub fn surfaces(&self) -> Vec<Surface> {
        let of = |value: &Value| match value {
            Value::Surface(s) => vec![s.clone()],
            Value::Shell(s) => s.surfaces.clone(),
            _ => Vec::new(),
        };
        self.0.iter().flat_map(of).collect()
    }

    /// The surface or shell that they are of; none of several.
    pub fn origin(&self) -> Origin {
        match self.0.as_slice() {
            [Value::Surface(s)] => s.origin(),
            [Value::Shell(s)] => s.origin,
            _ => Origin::NONE,
        }
    }

    /// Whether a shell is among them.
    pub fn has_shell(&self) -> bool {
        self.0.iter().any(|value| matches!(value, Value::Shell(_)))
    }

    /// The distance within which shells among them say that edges are glued, model units: the largest.
    pub fn snap(&self) -> Option<f64> {
        let of = |value: &Value| if let Value::Shell(s) = value { s.snap.map(|snap| snap.0) } else { None };
        self.0.iter().filter_map(of).reduce(f64::max)
    }
}

one_of! {
    /// A section of a skin.
    SectionKind {
        /// A curve.
        Curve(Chain) = Ty::Curve, Value::Curve(c) => Self::Curve(c);
        /// A point, where it begins or ends.
        Point(DVec3) = Ty::Point, Value::Vector(p, _) | Value::Node(p) => Self::Point(p);
    }
}

one_of! {
    /// How a skin leaves its first section or arrives at its last one.
    EndKind {
        /// The word `natural`.
        Natural() = Ty::Choice(&["natural"]), Value::Word(_) => Self::Natural();
        /// A direction.
        Direction(DVec3) = Ty::Direction, Value::Vector(d, _) => Self::Direction(d);
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

/// Declares a struct for entities that live in the network or model of a script.
macro_rules! entity {
    ($($(#[$doc:meta])* $name:ident = $kind:ident($($id:ty)?);)+) => { $(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        pub struct $name(pub ModuleId, $(pub $id)?);
        impl FromValue for $name {
            const TY: Ty = Ty::$kind;
            entity! { @from $kind $($id)? }
        }
        impl IntoValue for $name {
            const TY: Ty = Ty::$kind;
            entity! { @into $kind $($id)? }
        }
    )+ };
    (@from $kind:ident $id:ty) => {
        fn from_value(value: Value) -> Option<Self> {
            match value { Value::$kind(module, id) => Some(Self(module, id)), _ => None }
        }
    };
    (@from $kind:ident) => {
        fn from_value(value: Value) -> Option<Self> {
            match value { Value::$kind(module) => Some(Self(module)), _ => None }
        }
    };
    (@into $kind:ident $id:ty) => {
        fn into_value(self) -> Value {
            Value::$kind(self.0, self.1)
        }
    };
    (@into $kind:ident) => {
        fn into_value(self) -> Value {
            Value::$kind(self.0)
        }
    };
}

entity! {
    /// A link of a script's network.
    LinkOf = Link(LinkId);
    /// The network of a script.
    NetworkOf = Network();
}

/// Declares a struct for what is numbered in a surface model.
macro_rules! in_model {
    ($($(#[$doc:meta])* $name:ident = $kind:ident($id:ty);)+) => { $(
        $(#[$doc])*
        #[derive(Clone, Debug)]
        pub struct $name(pub EntityHome, pub $id);
        impl FromValue for $name {
            const TY: Ty = Ty::$kind;
            fn from_value(value: Value) -> Option<Self> {
                match value { Value::$kind(home, id) => Some(Self(home, id)), _ => None }
            }
        }
        impl IntoValue for $name {
            const TY: Ty = Ty::$kind;
            fn into_value(self) -> Value {
                Value::$kind(self.0, self.1)
            }
        }
    )+ };
}

in_model! {
    /// A vertex of a surface model.
    VertexOf = Vertex(VertexId);
    /// A patch of a surface model.
    PatchOf = Patch(PatchId);
    /// An edge of a surface model.
    EdgeOf = Edge(Arc<SharedEdge>);
}

one_of! {
    /// What may have a gap.
    EdgeOrSurface {
        /// An edge of a surface model.
        Edge(EdgeOf) = Ty::Edge, Value::Edge(home, edge) => Self::Edge(EdgeOf(home, edge));
        /// A surface.
        Surface(Surface) = Ty::Surface, Value::Surface(s) => Self::Surface(s);
    }
}
