//! Functions on numbers and quantities.

use crate::base::fault::ValueFault;
use crate::builtins;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::values::conversions::Rest;
use crate::lang::values::types::dim_words;
use crate::lang::values::units::number_text;
use crate::lang::values::value::{Dim, Quantity};

/// All of one dimension, with it; a 0 fits any.
pub(crate) fn one_dim(of: &[Quantity], argument: &'static str) -> Result<Dim, Halt> {
    let dim = of.iter().map(|q| q.dim).find(|d| !d.is_none()).unwrap_or(Dim::NONE);
    match of.iter().find(|q| q.dim != dim && q.value != 0.0) {
        None => Ok(dim),
        Some(odd) => Err(ValueFault::Mixed { argument, found: dim_words(odd.dim), beside: dim_words(dim) }.into()),
    }
}

fn not_empty(of: &[Quantity], function: &'static str) -> Result<(), Halt> {
    if of.is_empty() {
        return Err(ValueFault::Missing { function, what: "at least one number", example: "max(1mm, 2mm)" }.into());
    }
    Ok(())
}

pub(crate) fn outside(argument: &'static str, x: f64, range: &str) -> Halt {
    ValueFault::OutsideRange { argument, found: number_text(x), range: range.to_owned() }.into()
}

/// The same of a quantity, with its unit.
pub(crate) fn outside_of(cx: &Cx, argument: &'static str, x: Quantity, range: &str) -> Halt {
    ValueFault::OutsideRange { argument, found: cx.quantity(x), range: range.to_owned() }.into()
}

/// The result of rounding, which asks for whole numbers: bare ones, or whole multiples of a step.
fn rounded(cx: &Cx, x: Quantity, to: Option<Quantity>, round: fn(f64) -> f64) -> Result<Quantity, Halt> {
    match to {
        None if x.dim.is_none() => Ok(Quantity::bare(round(x.value))),
        None => {
            Err(ValueFault::Missing { function: "round", what: "a step to round a quantity to", example: "round(12.3mm, to: 1mm)" }.into())
        }
        Some(step) if step.value <= 0.0 => Err(outside_of(cx, "to", step, "more than 0")),
        Some(step) => {
            one_dim(&[x, step], "to")?;
            // Dividing by a fraction's reciprocal keeps steps like 0.1 exact.
            let inverse = (1.0 / step.value).round();
            let value = if step.value < 1.0 && 1.0 / inverse == step.value {
                round(x.value * inverse) / inverse
            } else {
                round(x.value / step.value) * step.value
            };
            Ok(Quantity::new(value, x.dim))
        }
    }
}

fn dot_root(cx: &mut Cx, x: Quantity) -> Result<Quantity, Halt> {
    if x.value < 0.0 {
        return Err(outside_of(cx, "x", x, "0 or more"));
    }
    match x.dim.root(2) {
        Some(dim) => Ok(Quantity::new(x.value.sqrt(), dim)),
        None => Err(ValueFault::WrongKind { argument: "x", wanted: "a number or an area", found: dim_words(x.dim) }.into()),
    }
}

builtins! {
    /// Absolute value of a number or quantity.
    ///
    /// ```loft
    /// let a = abs(-3mm) // => 3mm
    /// ```
    fn abs(
        /// A number or quantity.
        x: Quantity,
    ) -> Quantity = |_, x| Ok(Quantity { value: x.value.abs(), ..x });

    /// Sign of a number or quantity: -1, 0 or 1.
    ///
    /// ```loft
    /// let a = sign(-3mm) // => -1
    /// ```
    fn sign(
        /// A number or quantity.
        x: Quantity,
    ) -> f64 = |_, x| Ok(if x.value > 0.0 { 1.0 } else if x.value < 0.0 { -1.0 } else { 0.0 });

    /// Square root; of an area it is a length.
    ///
    /// ```loft
    /// let a = sqrt(16mm2) // => 4mm
    /// ```
    fn sqrt(
        /// A number or an even power of a length, 0 or more.
        x: Quantity,
    ) -> Quantity = dot_root;

    /// The smallest of several numbers or quantities.
    ///
    /// ```loft
    /// let a = min(3mm, 1cm, [2mm]) // => 2mm
    /// ```
    fn min(
        /// Numbers or quantities of one dimension, or lists of them.
        of: Rest<Quantity>,
    ) -> Quantity = |_, of| {
        not_empty(&of.0, "min")?;
        let dim = one_dim(&of.0, "of")?;
        Ok(Quantity::new(of.0.iter().fold(f64::INFINITY, |a, q| a.min(q.value)), dim))
    };

    /// The largest of several numbers or quantities.
    ///
    /// ```loft
    /// let a = max(3mm, 1cm) // => 10mm
    /// ```
    fn max(
        /// Numbers or quantities of one dimension, or lists of them.
        of: Rest<Quantity>,
    ) -> Quantity = |_, of| {
        not_empty(&of.0, "max")?;
        let dim = one_dim(&of.0, "of")?;
        Ok(Quantity::new(of.0.iter().fold(f64::NEG_INFINITY, |a, q| a.max(q.value)), dim))
    };

    /// Sum of numbers or quantities.
    ///
    /// Of an empty list it is the bare number 0; where a list of quantities may be empty, `start: 0mm` says what they are.
    /// ```loft
    /// let a = sum([for i in 0..5: i * 1mm]) // => 10mm
    /// let b = sum([for i in 0..5 if i > 9: i * 1mm], start: 0mm) // => 0mm
    /// ```
    fn sum(
        /// Numbers or quantities of one dimension, or lists of them.
        of: Rest<Quantity>,
        /// What is added to.
        start: Option<Quantity>,
    ) -> Quantity = |_, of, start| {
        let all: Vec<Quantity> = start.into_iter().chain(of.0).collect();
        let dim = one_dim(&all, "of")?;
        Ok(Quantity::new(all.iter().map(|q| q.value).sum(), dim))
    };

    /// Arithmetic mean of numbers or quantities.
    ///
    /// ```loft
    /// let a = mean(1mm, 2mm, 6mm) // => 3mm
    /// ```
    fn mean(
        /// Numbers or quantities of one dimension, or lists of them.
        of: Rest<Quantity>,
    ) -> Quantity = |_, of| {
        not_empty(&of.0, "mean")?;
        let dim = one_dim(&of.0, "of")?;
        Ok(Quantity::new(of.0.iter().map(|q| q.value).sum::<f64>() / of.0.len() as f64, dim))
    };

    /// The largest whole number, or multiple of a step, not above a value.
    ///
    /// ```loft
    /// let a = floor(2.7) // => 2
    /// let b = floor(12.7mm, to: 5mm) // => 10mm
    /// ```
    fn floor(
        /// A number, or a quantity with `to:`.
        x: Quantity,
        /// Step of the same dimension.
        to: Option<Quantity>,
    ) -> Quantity = |cx, x, to| rounded(cx, x, to, f64::floor);

    /// The smallest whole number, or multiple of a step, not below a value.
    ///
    /// ```loft
    /// let a = ceil(2.1) // => 3
    /// ```
    fn ceil(
        /// A number, or a quantity with `to:`.
        x: Quantity,
        /// Step of the same dimension.
        to: Option<Quantity>,
    ) -> Quantity = |cx, x, to| rounded(cx, x, to, f64::ceil);

    /// The nearest whole number, or multiple of a step; halves go away from zero.
    ///
    /// ```loft
    /// let a = round(2.5) // => 3
    /// let b = round(12.34mm, to: 0.1mm) // => 12.3mm
    /// ```
    fn round(
        /// A number, or a quantity with `to:`.
        x: Quantity,
        /// Step of the same dimension.
        to: Option<Quantity>,
    ) -> Quantity = |cx, x, to| rounded(cx, x, to, f64::round);

    /// What is left after taking away whole multiples; has the sign of the second.
    ///
    /// ```loft
    /// let a = mod(7, 3) // => 1
    /// let b = mod(-1mm, 3mm) // => 2mm
    /// ```
    fn mod(
        /// A number or quantity.
        a: Quantity,
        /// Another of the same dimension, not 0.
        b: Quantity,
    ) -> Quantity = |cx, a, b| {
        let dim = one_dim(&[a, b], "b")?;
        if b.value == 0.0 {
            return Err(outside_of(cx, "b", b, "another number than 0"));
        }
        Ok(Quantity::new(a.value - b.value * (a.value / b.value).floor(), dim))
    };
}
