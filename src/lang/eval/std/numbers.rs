//! Functions on numbers and quantities.

use crate::base::fault::ValueFault;
use crate::base::math;
use crate::builtins;
use crate::lang::eval::context::{Cx, Halt};
use crate::lang::values::types::{Angle, Degrees, Rest, dim_words};
use crate::lang::values::units::{number_text, radians};
use crate::lang::values::value::{Dim, Quantity, Value};

/// All of one dimension, with it; a 0 fits any.
fn one_dim(of: &[Quantity], argument: &'static str) -> Result<Dim, Halt> {
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

fn outside(argument: &'static str, x: f64, range: &str) -> Halt {
    ValueFault::OutsideRange { argument, found: number_text(x), range: range.to_owned() }.into()
}

/// The same of a quantity, with its unit.
fn outside_of(cx: &Cx, argument: &'static str, x: Quantity, range: &str) -> Halt {
    ValueFault::OutsideRange { argument, found: cx.quantity(x), range: range.to_owned() }.into()
}

/// Sine and cosine of degrees, exact at multiples of 30° where they are rational.
fn sin_cos_degrees(x: f64) -> (f64, f64) {
    let turn = x.rem_euclid(360.0);
    let sine = |t: f64| match t {
        0.0 | 180.0 => Some(0.0),
        90.0 => Some(1.0),
        270.0 => Some(-1.0),
        30.0 | 150.0 => Some(0.5),
        210.0 | 330.0 => Some(-0.5),
        _ => None,
    };
    let angle = radians(turn);
    (sine(turn).unwrap_or_else(|| math::sin(angle)), sine((turn + 90.0).rem_euclid(360.0)).unwrap_or_else(|| math::cos(angle)))
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

    /// Sine of an angle; exact where it is 0, ½ or 1.
    ///
    /// ```loft
    /// let a = sin(30deg) // => 0.5
    /// ```
    fn sin(
        /// An angle with its unit.
        angle: Degrees,
    ) -> f64 = |_, angle| Ok(sin_cos_degrees(angle.0).0);

    /// Cosine of an angle; exact where it is 0, ½ or 1.
    ///
    /// ```loft
    /// let a = cos(180deg) // => -1
    /// ```
    fn cos(
        /// An angle with its unit.
        angle: Degrees,
    ) -> f64 = |_, angle| Ok(sin_cos_degrees(angle.0).1);

    /// Tangent of an angle; not finite at 90 degrees.
    ///
    /// ```loft
    /// let a = tan(0deg) // => 0
    /// ```
    fn tan(
        /// An angle with its unit.
        angle: Degrees,
    ) -> f64 = |cx, angle| {
        let (sine, cosine) = sin_cos_degrees(angle.0);
        if cosine == 0.0 {
            let angle = Quantity::new(angle.0, Dim::ANGLE);
            return Err(outside_of(cx, "angle", angle, "an angle that has a tangent"));
        }
        Ok(if sine == 0.0 { 0.0 } else { math::tan(radians(angle.0)) })
    };

    /// The angle between -90 and 90 degrees that has this sine.
    ///
    /// ```loft
    /// let a = asin(1) // => 90deg
    /// ```
    fn asin(
        /// A number between -1 and 1.
        x: f64,
    ) -> Angle = |_, x| if x.abs() <= 1.0 { Ok(Angle(math::asin(x))) } else { Err(outside("x", x, "between -1 and 1")) };

    /// The angle between 0 and 180 degrees that has this cosine.
    ///
    /// ```loft
    /// let a = acos(-1) // => 180deg
    /// ```
    fn acos(
        /// A number between -1 and 1.
        x: f64,
    ) -> Angle = |_, x| if x.abs() <= 1.0 { Ok(Angle(math::acos(x))) } else { Err(outside("x", x, "between -1 and 1")) };

    /// The angle between -90 and 90 degrees that has this tangent.
    ///
    /// ```loft
    /// let a = atan(1) // => 45deg
    /// ```
    fn atan(
        /// A number.
        x: f64,
    ) -> Angle = |_, x| Ok(Angle(math::atan(x)));

    /// Angle of the point (x, y) seen from the origin, -180 to 180 degrees.
    ///
    /// ```loft
    /// let a = atan2(1m, -1m) // => 135deg
    /// ```
    fn atan2(
        /// The y coordinate.
        y: Quantity,
        /// The x coordinate, of the same dimension.
        x: Quantity,
    ) -> Angle = |_, y, x| {
        one_dim(&[y, x], "x")?;
        Ok(Angle(math::atan2(y.value, x.value)))
    };

    /// The power of Euler's number.
    ///
    /// ```loft
    /// let a = exp(0) // => 1
    /// ```
    fn exp(
        /// A number.
        x: f64,
    ) -> f64 = |_, x| Ok(math::exp(x));

    /// Natural logarithm, or that to another base.
    ///
    /// ```loft
    /// let a = log(1000, base: 10) // => 3
    /// ```
    fn log(
        /// A number above 0.
        x: f64,
        /// Base above 0, not 1; Euler's number when left out.
        base: Option<f64>,
    ) -> f64 = |_, x, base| match (x > 0.0, base) {
        (false, _) => Err(outside("x", x, "more than 0")),
        (_, None) => Ok(math::log(x)),
        (_, Some(10.0)) => Ok(math::log10(x)),
        (_, Some(2.0)) => Ok(math::log2(x)),
        (_, Some(b)) if b > 0.0 && b != 1.0 => Ok(math::log(x) / math::log(b)),
        (_, Some(b)) => Err(outside("base", b, "more than 0 and not 1")),
    };

    /// Circumference of a circle over its diameter; `pi` alone means the same.
    ///
    /// ```loft
    /// let a = pi * 2mm // => 6.283185307179586mm
    /// ```
    fn pi() -> f64 = |_| Ok(std::f64::consts::PI);

    /// Hyperbolic sine.
    ///
    /// ```loft
    /// let a = sinh(0) // => 0
    /// ```
    fn sinh(
        /// A number.
        x: f64,
    ) -> f64 = |_, x| Ok(math::sinh(x));

    /// Hyperbolic cosine.
    ///
    /// ```loft
    /// let a = cosh(0) // => 1
    /// ```
    fn cosh(
        /// A number.
        x: f64,
    ) -> f64 = |_, x| Ok(math::cosh(x));

    /// The number that has this hyperbolic sine.
    ///
    /// ```loft
    /// let a = asinh(0) // => 0
    /// ```
    fn asinh(
        /// A number.
        x: f64,
    ) -> f64 = |_, x| Ok(math::asinh(x));

    /// The number, 0 or more, that has this hyperbolic cosine.
    ///
    /// ```loft
    /// let a = acosh(1) // => 0
    /// ```
    fn acosh(
        /// A number, 1 or more.
        x: f64,
    ) -> f64 = |_, x| if x >= 1.0 { Ok(math::acosh(x)) } else { Err(outside("x", x, "1 or more")) };

    /// Numbers or quantities at equal steps from one to another, both included.
    ///
    /// ```loft
    /// let a = linspace(0mm, 1mm, 3) // => [0mm, 0.5mm, 1mm]
    /// ```
    fn linspace(
        /// The first.
        from: Quantity,
        /// The last, of the same dimension.
        to: Quantity,
        /// How many, at least 2.
        count: usize,
    ) -> Vec<Value> = |cx, from, to, count| {
        let dim = one_dim(&[from, to], "to")?;
        if count < 2 {
            return Err(outside("count", count as f64, "2 or more"));
        }
        cx.room(count)?;
        let at = |i: usize| {
            let t = i as f64 / (count - 1) as f64;
            if i + 1 == count { to.value } else { from.value + (to.value - from.value) * t }
        };
        Ok((0..count).map(|i| Value::quantity(at(i), dim)).collect())
    };
}
