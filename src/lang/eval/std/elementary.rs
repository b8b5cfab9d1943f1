//! Elementary functions of angles and numbers, and numbers at equal steps.

use crate::base::math;
use crate::builtins;
use crate::lang::eval::std::numbers::{one_dim, outside, outside_of};
use crate::lang::values::conversions::{Angle, Degrees};
use crate::lang::values::units::radians;
use crate::lang::values::value::{Dim, Quantity, Value};

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

builtins! {
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
