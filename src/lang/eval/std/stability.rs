//! Positions of rest and righting arms of hulls.

use glam::DVec3;

use crate::builtins;
use crate::hydrostatics::equilibrium::{HeelSeries, Load, equilibrium};
use crate::hydrostatics::particulars::{center_of_buoyancy, particulars};
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::std::floating::{Floating, Reference, above_zero, body, density_of, record, reference};
use crate::lang::values::conversions::{Angle, Density, Length, Mass, Point};
use crate::lang::values::value::Value;

/// The weight of a mass in the water.
fn load(cx: &Cx, mass: Mass, density: Density, cog: Point) -> Result<Load, Halt> {
    let density = density_of(cx, density)?;
    let mass = above_zero("mass", mass.0, format!("{} kg", mass.0))?;
    Ok(Load { volume: mass / density, center: cog.0 })
}

builtins! {
    /// How a hull of a mass comes to rest, with its hydrostatics there.
    ///
    /// Draft, trim and heel are found to rounding; the record is that of `hydrostatics`, its metacentric heights those over the centre
    /// of gravity. Upright is tried first, then heeled positions: the first stable one is given, else one that is not (`gmt` below 0). A mass
    /// that the hull cannot carry is E306.
    /// ```loft
    /// units m
    /// let side = bezier_surface([[(-5, 0, -0.625), (0, 0, -0.625), (5, 0, -0.625)], [(-5, 0, -0.3125), (0, 1, -0.3125), (5, 0, -0.3125)], [(-5, 0, 0), (0, 1, 0), (5, 0, 0)]])
    /// let rest = equilibrium(side, mass: 1500kg, cog: (0.1, 0, -0.4), base: -0.625m)
    /// check rest.displacement == 1500kg within 1e-9%
    /// check rest.trim < 0deg
    /// ```
    fn equilibrium(
        /// What floats.
        hull: Floating,
        /// Its mass.
        mass: Mass,
        /// Its centre of gravity.
        cog: Point,
        /// Density of the water.
        density: Density = "1025kg/m3",
        /// z of the base line.
        base: Length = "0",
        /// x of midship; when left out the middle of the hull.
        midship: Option<Length>,
        /// Length of the coefficients; when left out that of the waterline.
        length: Option<Length>,
        /// Beam of the coefficients; when left out that of the waterline.
        beam: Option<Length>,
    ) -> Value = |cx, hull, mass, cog, density, base, midship, length, beam| {
        let load = load(cx, mass, density, cog)?;
        let body = body(cx, &hull)?;
        let at = equilibrium(&body, &load, None, reference(&body, base, midship))?;
        let found = particulars(&body, &at)?;
        let to = Reference { density: density_of(cx, density)?, length: length.map(|l| l.0), beam: beam.map(|b| b.0) };
        Ok(record(cx, &at, &found, to, Some(cog.0)))
    };
    /// Righting arms (GZ) of a hull at some heels.
    ///
    /// At each heel draft and trim are those at which it carries the mass level with the centre of gravity.
    /// Records of `heel`, `gz` (positive where the hull is turned back), `kn` (the arm about the base line at midship), `draft` and `trim`. For
    /// heels that bring the deck under the water the shell must be closed by one.
    /// ```loft
    /// units m
    /// curve frame = polyline([(0, -2, 3), (0, -2, 0), (0, 2, 0), (0, 2, 3)], closed: true)
    /// let rows = righting_arms([extrude(frame, by: (10, 0, 0)), plane([frame]), plane([move(frame, by: (10, 0, 0))])], mass: 41t, cog: (5, 0, 1.5), heels: [0deg, 10deg])
    /// // A wall-sided box: GZ = sin φ (GM + ½ BM tan² φ).
    /// check rows[1].gz == sin(10deg) * (0.3333333333333333m + 0.5 * 1.3333333333333333m * tan(10deg) ^ 2) within 1e-6m
    /// ```
    fn righting_arms(
        /// What floats.
        hull: Floating,
        /// Its mass.
        mass: Mass,
        /// Its centre of gravity.
        cog: Point,
        /// Heels to starboard.
        heels: Vec<Angle>,
        /// Density of the water.
        density: Density = "1025kg/m3",
        /// z of the base line.
        base: Length = "0",
        /// x of midship; when left out the middle of the hull.
        midship: Option<Length>,
    ) -> Vec<Value> = |cx, hull, mass, cog, heels, density, base, midship| {
        let load = load(cx, mass, density, cog)?;
        let body = body(cx, &hull)?;
        let mut series = HeelSeries::new(reference(&body, base, midship));
        let mut rows = Vec::with_capacity(heels.len());
        for heel in heels {
            let at = series.at(&body, &load, heel.0)?;
            let water = at.water();
            let wet = body.wet(&water)?;
            let across = |p: DVec3| water.local(p).y - water.local(center_of_buoyancy(&wet, &water)).y;
            let (gz, kn) = (across(cog.0), across(at.keel()));
            rows.push(cx.record([
                ("heel", Value::angle(at.heel)),
                ("gz", Value::length(gz)),
                ("kn", Value::length(kn)),
                ("draft", at.draft().map_or(Value::None, Value::length)),
                ("trim", Value::angle(at.trim)),
            ]));
        }
        Ok(rows)
    };
}
