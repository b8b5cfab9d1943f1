//! Hydrostatics of hulls at given positions.

use glam::DVec3;

use crate::builtins;
use crate::hydrostatics::particulars::{Position, particulars};
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::std::floating::{Floating, Reference, Trim, body, density_of, record, reference};
use crate::lang::values::conversions::{Angle, Density, Length};
use crate::lang::values::value::{Dim, Value};

/// What is stated beside the draft.
struct Stated {
    trim: Trim,
    heel: Angle,
    density: Density,
    kg: Option<Length>,
    base: Length,
    midship: Option<Length>,
    length: Option<Length>,
    beam: Option<Length>,
}

/// A record for each draft.
fn forms(cx: &mut Cx, hull: &Floating, drafts: &[Length], at: &Stated) -> Result<Vec<Value>, Halt> {
    let body = body(cx, hull)?;
    let to = Reference { density: density_of(cx, at.density)?, length: at.length.map(|l| l.0), beam: at.beam.map(|b| b.0) };
    let level = Position { trim: at.trim.angle(cx, &body, at.length)?, heel: at.heel.0, ..reference(&body, at.base, at.midship) };
    let form = |draft: &Length| {
        let position = level.with_draft(draft.0);
        let gravity = at.kg.map(|kg| position.keel() + DVec3::Z * kg.0);
        Ok(record(cx, &position, &particulars(&body, &position)?, to, gravity))
    };
    drafts.iter().map(form).collect()
}

builtins! {
    /// Hydrostatics of a hull at a draft, from its surfaces themselves.
    ///
    /// The model's x runs forward, y to port and z up. The hull is a closed shell, one that is open at the top, half of one (on one side
    /// of y = 0 and open there: it counts twice), or a mesh. Only what is above the water and the plane y = 0 of a half may be open:
    /// E656 names edges that are open below the water. Several hulls that share no edge float together; room that is inside two of them
    /// counts twice.
    ///
    /// `draft` is the height of the water over the base line (`base:`, else z = 0), at midship on the centre line. `trim` is positive by the
    /// stern (small x deeper), `heel` to starboard (negative y deeper). `lcb` and `lcf` are counted from `midship:`, forward positive;
    /// without it midship is in the middle of the hull's length. `kb`, `kmt`, `kml` are heights over the base line at midship, upright to the
    /// water. `cb cp cm cw` take `length:` and `beam:`, else those of the waterline, and the draft; `cm` and `cp` the section at midship.
    /// `gmt`, `gml` and `mct` (the moment to change the trim by 1 cm over that length) need `kg:`; `tpc` is the mass a centimetre of
    /// draft takes. What there is none of, as `lcb` out of the water, is `none`.
    ///
    /// Each surface is integrated up to the exact waterline: `errors` holds estimates of what that leaves. A surface that lies in the
    /// water plane counts as above it.
    /// ```loft
    /// units m
    /// let side = bezier_surface([[(-5, 0, -0.625), (0, 0, -0.625), (5, 0, -0.625)], [(-5, 0, -0.3125), (0, 1, -0.3125), (5, 0, -0.3125)], [(-5, 0, 0), (0, 1, 0), (5, 0, 0)]])
    /// let wigley = hydrostatics(side, draft: 0.625m, base: -0.625m)
    /// check wigley.volume == 25m3 / 9 within 1e-12
    /// check wigley.kb == 0.390625m within 1e-12
    /// ```
    fn hydrostatics(
        /// What floats.
        hull: Floating,
        /// Height of the water over the base line.
        draft: Length,
        /// Trim by the stern: an angle, or the draft aft less that forward over `length:`, else over the hull's length.
        trim: Trim = "0deg",
        /// Heel to starboard.
        heel: Angle = "0deg",
        /// Density of the water.
        density: Density = "1025kg/m3",
        /// Height of the centre of gravity over the base line.
        kg: Option<Length>,
        /// z of the base line.
        base: Length = "0",
        /// x of midship; when left out the middle of the hull.
        midship: Option<Length>,
        /// Length of the coefficients; when left out that of the waterline.
        length: Option<Length>,
        /// Beam of the coefficients; when left out that of the waterline.
        beam: Option<Length>,
    ) -> Value = |cx, hull, draft, trim, heel, density, kg, base, midship, length, beam| {
        let at = Stated { trim, heel, density, kg, base, midship, length, beam };
        Ok(forms(cx, &hull, &[draft], &at)?.remove(0))
    };
    /// Hydrostatics at several drafts: one record for each, as `hydrostatics` gives it.
    ///
    /// ```loft
    /// units m
    /// surface barge = extrude(polyline([(0, -2, 3), (0, -2, 0), (0, 2, 0), (0, 2, 3)]), by: (10, 0, 0))
    /// let ends = [plane([polyline([(0, -2, 3), (0, -2, 0), (0, 2, 0), (0, 2, 3)], closed: true)]), plane([polyline([(10, -2, 3), (10, -2, 0), (10, 2, 0), (10, 2, 3)], closed: true)])]
    /// let rows = curves_of_form([barge, ends], drafts: [1m, 2m])
    /// check rows[1].volume == 80m3 within 1e-9
    /// ```
    fn curves_of_form(
        /// What floats.
        hull: Floating,
        /// Heights of the water over the base line.
        drafts: Vec<Length>,
        /// Trim by the stern: an angle, or the draft aft less that forward over `length:`, else over the hull's length.
        trim: Trim = "0deg",
        /// Heel to starboard.
        heel: Angle = "0deg",
        /// Density of the water.
        density: Density = "1025kg/m3",
        /// Height of the centre of gravity over the base line.
        kg: Option<Length>,
        /// z of the base line.
        base: Length = "0",
        /// x of midship; when left out the middle of the hull.
        midship: Option<Length>,
        /// Length of the coefficients; when left out that of the waterline.
        length: Option<Length>,
        /// Beam of the coefficients; when left out that of the waterline.
        beam: Option<Length>,
    ) -> Vec<Value> = |cx, hull, drafts, trim, heel, density, kg, base, midship, length, beam| {
        let at = Stated { trim, heel, density, kg, base, midship, length, beam };
        forms(cx, &hull, &drafts, &at)
    };
    /// Areas of cross sections of a hull below the water: records of `x` and `area`.
    ///
    /// ```loft
    /// units m
    /// let side = bezier_surface([[(-5, 0, -0.625), (0, 0, -0.625), (5, 0, -0.625)], [(-5, 0, -0.3125), (0, 1, -0.3125), (5, 0, -0.3125)], [(-5, 0, 0), (0, 1, 0), (5, 0, 0)]])
    /// let rows = sectional_areas(side, draft: 0.625m, base: -0.625m, stations: [0m, 2.5m])
    /// check rows[1].area == 0.75 * rows[0].area within 1e-9
    /// ```
    fn sectional_areas(
        /// What floats.
        hull: Floating,
        /// Height of the water over the base line.
        draft: Length,
        /// x of the sections.
        stations: Vec<Length>,
        /// Trim by the stern: an angle, or the draft aft less that forward over the hull's length.
        trim: Trim = "0deg",
        /// Heel to starboard.
        heel: Angle = "0deg",
        /// z of the base line.
        base: Length = "0",
        /// x of midship; when left out the middle of the hull.
        midship: Option<Length>,
    ) -> Vec<Value> = |cx, hull, draft, stations, trim, heel, base, midship| {
        let body = body(cx, &hull)?;
        let at = Position { trim: trim.angle(cx, &body, None)?, heel: heel.0, ..reference(&body, base, midship) }.with_draft(draft.0);
        let water = at.water();
        body.wet(&water)?;
        let row = |cx: &mut Cx, x: f64| {
            let area = Value::quantity(body.section_area(x, &water), Dim::AREA);
            cx.record([("x", Value::length(x)), ("area", area)])
        };
        Ok(stations.into_iter().map(|x| row(cx, x.0)).collect())
    };
}
