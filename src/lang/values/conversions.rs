//! Values of the language to and from the Rust types that builtins take and return.

use std::sync::Arc;

use glam::DVec3;

use crate::draw::Drawing;
use crate::lang::values::table::Table;
use crate::lang::values::types::Ty;
use crate::lang::values::units;
use crate::lang::values::value::{Dim, MeshValue, Plane, Quantity, Record, ShellValue, Value};
use crate::network::Chain;
use crate::surface::Surface;

/// A Rust type that a builtin may take. `from_value` gets what `bind` coerced to `TY`.
pub trait FromValue: Sized {
    /// The type shown in signatures and enforced before the call.
    const TY: Ty;
    /// The value as this type; `None` only when `bind` did not coerce it (a bug).
    fn from_value(value: Value) -> Option<Self>;
}

/// A Rust type that a builtin may return.
pub trait IntoValue {
    /// The type shown in signatures.
    const TY: Ty;
    /// As a value.
    fn into_value(self) -> Value;
}

macro_rules! quantities {
    ($($(#[$doc:meta])* $name:ident = $dim:expr),+ $(,)?) => { $(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
        pub struct $name(pub f64);
        impl FromValue for $name {
            const TY: Ty = Ty::Quantity($dim);
            fn from_value(value: Value) -> Option<Self> {
                match value { Value::Number(q) => Some(Self(q.value)), _ => None }
            }
        }
        impl IntoValue for $name {
            const TY: Ty = Ty::Quantity($dim);
            fn into_value(self) -> Value {
                Value::quantity(self.0, $dim)
            }
        }
    )+ };
}
quantities! {
    /// A length in model units.
    Length = Dim::LENGTH,
    /// An area in square model units.
    Area = Dim::AREA,
    /// A volume in cubic model units.
    Volume = Dim::VOLUME,
    /// A mass in kg.
    Mass = Dim::MASS,
    /// A density in kg a cubic model unit.
    Density = Dim { length: -3, angle: 0, mass: 1 },
}

/// An angle in **radians** (values hold degrees; this converts).
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Angle(pub f64);

/// An angle in degrees, as values hold it: for functions that are exact at round degrees.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Degrees(pub f64);

impl FromValue for Degrees {
    const TY: Ty = Ty::Quantity(Dim::ANGLE);
    fn from_value(value: Value) -> Option<Self> {
        match value {
            Value::Number(q) => Some(Self(q.value)),
            _ => None,
        }
    }
}

impl FromValue for Angle {
    const TY: Ty = Ty::Quantity(Dim::ANGLE);
    fn from_value(value: Value) -> Option<Self> {
        match value {
            Value::Number(q) => Some(Self(units::radians(q.value))),
            _ => None,
        }
    }
}

impl IntoValue for Angle {
    const TY: Ty = Ty::Quantity(Dim::ANGLE);
    fn into_value(self) -> Value {
        Value::angle(self.0)
    }
}

macro_rules! convert {
    ($($ty:ty : $kind:expr, $from:pat => $out:expr, $self:ident => $into:expr;)+) => { $(
        impl FromValue for $ty {
            const TY: Ty = $kind;
            fn from_value(value: Value) -> Option<Self> {
                match value { $from => Some($out), _ => None }
            }
        }
        impl IntoValue for $ty {
            const TY: Ty = $kind;
            fn into_value($self) -> Value {
                $into
            }
        }
    )+ };
}

/// A point in model units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point(pub DVec3);

/// A direction of any length but zero (the builtin checks that); dimension dropped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Direction(pub DVec3);

/// A node by its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NodePlace(pub DVec3);

/// A vector with its dimension.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vector(pub DVec3, pub Dim);

/// A whole number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Whole(pub i64);

convert! {
    bool: Ty::Bool, Value::Bool(b) => b, self => Value::Bool(self);
    f64: Ty::Number, Value::Number(q) => q.value, self => Value::number(self);
    usize: Ty::Count, Value::Number(q) => q.value as usize, self => Value::number(self as f64);
    Whole: Ty::Whole, Value::Number(q) => Self(q.value as i64), self => Value::number(self.0 as f64);
    Quantity: Ty::Measure, Value::Number(q) => q, self => Value::Number(self);
    Arc<str>: Ty::Text, Value::Text(t) => t, self => Value::Text(self);
    Point: Ty::Point, Value::Vector(p, _) | Value::Node(p) => Self(p), self => Value::point(self.0);
    NodePlace: Ty::Node, Value::Vector(p, _) | Value::Node(p) => Self(p), self => Value::Node(self.0);
    Direction: Ty::Direction, Value::Vector(p, _) | Value::Node(p) => Self(p), self => Value::Vector(self.0, Dim::NONE);
    Vector: Ty::Vector, Value::Vector(p, dim) => Self(p, dim), self => Value::Vector(self.0, self.1);
    Chain: Ty::Curve, Value::Curve(c) => c, self => Value::Curve(self);
    Surface: Ty::Surface, Value::Surface(s) => s, self => Value::Surface(self);
    Arc<ShellValue>: Ty::Shell, Value::Shell(s) => s, self => Value::Shell(self);
    Arc<MeshValue>: Ty::Mesh, Value::Mesh(m) => m, self => Value::Mesh(self);
    Arc<Plane>: Ty::Plane, Value::Plane(p) => p, self => Value::Plane(self);
    Arc<Record>: Ty::Record, Value::Record(r) => r, self => Value::Record(self);
    Arc<Table>: Ty::Table, Value::Table(t) => t, self => Value::Table(self);
}

impl IntoValue for Drawing {
    const TY: Ty = Ty::Drawing;
    fn into_value(self) -> Value {
        Value::Drawing(Arc::new(self))
    }
}

impl FromValue for Value {
    const TY: Ty = Ty::Any;
    fn from_value(value: Value) -> Option<Self> {
        Some(value)
    }
}

impl IntoValue for Value {
    const TY: Ty = Ty::Any;
    fn into_value(self) -> Value {
        self
    }
}

/// A direction or a straight curve, for `axis:`.
#[derive(Clone, Debug)]
pub enum Axis {
    /// A direction of any length; the axis goes through wherever the builtin says.
    Direction(DVec3),
    /// A curve; the builtin checks that it is straight.
    Curve(Chain),
}

impl FromValue for Axis {
    const TY: Ty = Ty::Axis;
    fn from_value(value: Value) -> Option<Self> {
        match value {
            Value::Vector(v, _) => Some(Self::Direction(v)),
            Value::Curve(c) => Some(Self::Curve(c)),
            _ => None,
        }
    }
}

/// A place along a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Station {
    /// Fraction of the arc length.
    Fraction(f64),
    /// Arc length from the start, model units.
    Length(f64),
}

impl FromValue for Station {
    const TY: Ty = Ty::Station;
    fn from_value(value: Value) -> Option<Self> {
        match value {
            Value::Number(q) if q.dim.is_none() => Some(Self::Fraction(q.value)),
            Value::Number(q) => Some(Self::Length(q.value)),
            _ => None,
        }
    }
}

/// All remaining positional arguments, nested lists flattened.
#[derive(Clone, Debug)]
pub struct Rest<T>(pub Vec<T>);

impl<T: FromValue> FromValue for Rest<T> {
    const TY: Ty = Ty::Rest(&T::TY);
    fn from_value(value: Value) -> Option<Self> {
        Vec::from_value(value).map(Self)
    }
}

impl<T: FromValue> FromValue for Vec<T> {
    const TY: Ty = Ty::List(&T::TY);
    fn from_value(value: Value) -> Option<Self> {
        match value {
            Value::List(items) => match Arc::try_unwrap(items) {
                Ok(items) => items.into_iter().map(T::from_value).collect(),
                Err(shared) => shared.iter().cloned().map(T::from_value).collect(),
            },
            other => (0..other.len()?).map(|i| T::from_value(other.item(i)?)).collect(),
        }
    }
}

impl<T: IntoValue> IntoValue for Vec<T> {
    const TY: Ty = Ty::List(&T::TY);
    fn into_value(self) -> Value {
        Value::list(self.into_iter().map(T::into_value).collect())
    }
}

impl<T: FromValue> FromValue for Option<T> {
    const TY: Ty = Ty::Optional(&T::TY);
    fn from_value(value: Value) -> Option<Self> {
        match value {
            Value::None => Some(None),
            other => T::from_value(other).map(Some),
        }
    }
}

impl<T: IntoValue> IntoValue for Option<T> {
    const TY: Ty = Ty::Optional(&T::TY);
    fn into_value(self) -> Value {
        self.map_or(Value::None, T::into_value)
    }
}

/// Declares an enum whose variants are words of the language.
///
/// `choices! { /// How … pub enum Reparam { /// C1. Smooth = "smooth", /// As in the paper. Linear = "linear" } }`
#[doc(hidden)]
#[macro_export]
macro_rules! choices {
    ($(#[$doc:meta])* pub enum $name:ident { $($(#[$vdoc:meta])* $variant:ident = $word:literal),+ $(,)? }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum $name { $($(#[$vdoc])* $variant),+ }
        impl $crate::lang::values::conversions::FromValue for $name {
            const TY: $crate::lang::values::types::Ty = $crate::lang::values::types::Ty::Choice(&[$($word),+]);
            fn from_value(value: $crate::lang::values::value::Value) -> Option<Self> {
                match value {
                    $crate::lang::values::value::Value::Word(w) => match &*w { $($word => Some(Self::$variant),)+ _ => None },
                    _ => None,
                }
            }
        }
    };
}
