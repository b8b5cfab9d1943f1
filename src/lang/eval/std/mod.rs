//! The words of the language: functions and fields, each declared once with its docs.
//!
//! A function is an entry of a `BUILTINS` table, a field (`c.start`, also written `start(c)`) one of a `FIELDS`
//! table; help, reference, signatures and suggestions are read from these.

pub mod blends;
pub mod choosing;
pub mod curve_nets;
pub mod curves;
pub mod data;
pub mod distances;
pub mod drawings;
pub mod elementary;
pub mod extensions;
pub mod fairs;
pub mod fills;
pub mod fits;
pub mod floating;
pub mod hull_lines;
pub mod hydrostatics;
pub mod imprint;
pub mod joins;
pub mod kinds;
mod lines_plans;
pub mod lists;
pub mod measures;
pub mod mesh;
pub mod nets;
pub mod network;
pub mod numbers;
mod offsets;
mod offsets_grid;
mod offsets_lines;
mod offsets_points;
pub mod offsets_tables;
pub mod parts;
pub mod point_nets;
pub mod roundings;
pub mod rows;
pub mod scatters;
pub mod slopes;
pub mod splines;
pub mod stability;
pub mod surfaces;
pub mod sweeps;
pub mod text;
pub mod topology;
pub mod topology_fields;
pub mod transforms;
pub mod vectors;
pub mod walls;

use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
pub(crate) use crate::lang::eval::std::topology::curve_of;
use crate::lang::values::types::Ty;
use crate::lang::values::value::Value;

/// A parameter of a function.
#[derive(Debug)]
pub struct Param {
    /// As written before the colon.
    pub name: &'static str,
    /// What it means, with units.
    pub docs: &'static str,
    /// What it takes.
    pub ty: Ty,
    /// Loft source of its default.
    pub default: Option<&'static str>,
}

impl Param {
    /// Whether a call may leave it out.
    pub fn is_optional(&self) -> bool {
        self.default.is_some() || matches!(self.ty, Ty::Optional(_) | Ty::Rest(_))
    }
}

/// Arguments of a call in the order of the parameters: bound, defaulted and coerced to their types.
pub type Args = Vec<Value>;

/// A function of the language, or a field when it stands in a `FIELDS` table.
#[derive(Debug)]
pub struct Builtin {
    /// Its name.
    pub name: &'static str,
    /// First a sentence, then more, with an example in a `loft` fence.
    pub docs: &'static str,
    /// Parameters.
    pub params: &'static [Param],
    /// What it gives.
    pub returns: Ty,
    /// Does it.
    pub call: fn(&mut Cx, Args) -> Result<Value, Halt>,
}

impl Builtin {
    /// `coons(curves: curve…, reparam: smooth|linear = smooth) → surface`.
    pub fn signature(&self) -> String {
        let params: Vec<String> = self
            .params
            .iter()
            .map(|p| {
                let default = p.default.map(|d| format!(" = {d}")).unwrap_or_default();
                let optional = if matches!(p.ty, Ty::Optional(_)) { "?" } else { "" };
                format!("{}{optional}: {}{default}", p.name, p.ty.signature())
            })
            .collect();
        format!("{}({}) → {}", self.name, params.join(", "), self.returns.signature())
    }

    /// The first sentence of the docs.
    pub fn summary(&self) -> &'static str {
        self.docs.trim_start().split(['\n', '.']).next().unwrap_or("").trim()
    }
}

/// All tables of functions.
pub const BUILTINS: &[&[Builtin]] = &[
    numbers::BUILTINS,
    elementary::BUILTINS,
    lists::BUILTINS,
    text::BUILTINS,
    vectors::BUILTINS,
    distances::BUILTINS,
    data::BUILTINS,
    curves::BUILTINS,
    slopes::BUILTINS,
    splines::BUILTINS,
    fairs::BUILTINS,
    fills::BUILTINS,
    fits::BUILTINS,
    hull_lines::BUILTINS,
    offsets_tables::BUILTINS,
    hydrostatics::BUILTINS,
    stability::BUILTINS,
    roundings::BUILTINS,
    extensions::BUILTINS,
    network::BUILTINS,
    curve_nets::BUILTINS,
    surfaces::BUILTINS,
    point_nets::BUILTINS,
    sweeps::BUILTINS,
    nets::BUILTINS,
    transforms::BUILTINS,
    topology::BUILTINS,
    blends::BUILTINS,
    rows::BUILTINS,
    scatters::BUILTINS,
    walls::BUILTINS,
    imprint::BUILTINS,
    joins::BUILTINS,
    mesh::BUILTINS,
    measures::BUILTINS,
    drawings::BUILTINS,
    parts::BUILTINS,
];

/// All tables of fields.
pub const FIELDS: &[&[Builtin]] = &[
    vectors::FIELDS,
    data::FIELDS,
    network::FIELDS,
    mesh::FIELDS,
    topology_fields::FIELDS,
    sweeps::FIELDS,
    joins::FIELDS,
    measures::FIELDS,
    parts::FIELDS,
];

/// All functions.
pub fn builtins() -> impl Iterator<Item = &'static Builtin> {
    BUILTINS.iter().flat_map(|t| t.iter())
}

/// All fields.
pub fn fields() -> impl Iterator<Item = &'static Builtin> {
    FIELDS.iter().flat_map(|t| t.iter())
}

/// Declares functions: docs, name, typed parameters with docs and defaults (loft text), result and body.
///
/// The body is a closure without captures `|cx, a, b| -> Result<_, Halt>`; kernel faults convert with `?`.
#[doc(hidden)]
#[macro_export]
macro_rules! builtins {
    ($($body:tt)+) => { $crate::builtin_table! { BUILTINS $($body)+ } };
}

/// Declares fields: functions of one value, written `x.f` or `f(x)`; entries of one name differ by what they take.
#[doc(hidden)]
#[macro_export]
macro_rules! fields {
    ($($body:tt)+) => { $crate::builtin_table! { FIELDS $($body)+ } };
}

/// The table behind [`builtins!`] and [`fields!`].
#[doc(hidden)]
#[macro_export]
macro_rules! builtin_table {
    ($table:ident $(
        $(#[doc = $doc:literal])* fn $name:ident (
            $( $(#[doc = $pdoc:literal])* $p:ident : $ty:ty $(= $default:literal)? ),* $(,)?
        ) -> $ret:ty = $body:expr;
    )+) => {
        /// Entries in the order of the reference.
        pub const $table: &[$crate::lang::eval::std::Builtin] = &[ $( $crate::lang::eval::std::Builtin {
            name: stringify!($name),
            docs: concat!($($doc, "\n"),*),
            returns: <$ret as $crate::lang::values::conversions::IntoValue>::TY,
            params: &[ $( $crate::lang::eval::std::Param {
                name: stringify!($p),
                docs: concat!($($pdoc, "\n"),*),
                ty: <$ty as $crate::lang::values::conversions::FromValue>::TY,
                default: $crate::optional_default!($($default)?),
            } ),* ],
            call: |cx, args| {
                #[allow(unused_mut)]
                let mut args = args.into_iter();
                $( let $p = $crate::lang::eval::std::take::<$ty>(&mut args)?; )*
                let _ = args;
                let run: fn(&mut $crate::lang::eval::context::Cx, $($ty),*) -> Result<$ret, $crate::lang::eval::halt::Halt> = $body;
                run(cx, $($p),*).map($crate::lang::values::conversions::IntoValue::into_value)
            },
        } ),+ ];
    };
}

/// `Some(text)` or `None`.
#[doc(hidden)]
#[macro_export]
macro_rules! optional_default {
    () => {
        None
    };
    ($default:literal) => {
        Some($default)
    };
}

/// The next argument as its Rust type; `bind` has made sure that it fits.
pub fn take<T: crate::lang::values::conversions::FromValue>(args: &mut impl Iterator<Item = Value>) -> Result<T, Halt> {
    args.next().and_then(T::from_value).ok_or(Halt::Bug("an argument was not coerced to its type"))
}
