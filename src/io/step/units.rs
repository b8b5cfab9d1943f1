//! Units of lengths and angles, and the distance within which points are one, by the context of a representation.

use crate::base::tolerance::WHOLE_NUMBER;
use crate::io::cad::defect::{Defect, defect};
use crate::io::step::parameters::Row;
use crate::io::step::records::File;

/// Units that are made of units.
const NESTED: usize = 8;

/// What numbers of a representation mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Units {
    /// Millimetres in one unit of length; `None` where the file does not say.
    pub millimetres: Option<f64>,
    /// Radians in one unit of angle.
    pub radians: f64,
    /// Points nearer than this are one, in millimetres; 0 where the file does not say.
    pub uncertainty: f64,
}

impl Units {
    /// Of a file that says nothing.
    pub const NONE: Self = Self { millimetres: None, radians: 1.0, uncertainty: 0.0 };

    /// The word for the unit of length.
    pub fn name(&self) -> &'static str {
        const NAMED: &[(f64, &str)] = &[(1.0, "MM"), (10.0, "CM"), (1000.0, "M"), (25.4, "IN"), (304.8, "FT"), (0.001, "UM"), (1e6, "KM")];
        let near = |x: f64, y: f64| (x - y).abs() <= WHOLE_NUMBER * y;
        let mm = self.millimetres.unwrap_or(1.0);
        NAMED.iter().find(|(x, _)| near(mm, *x)).map_or("of its own", |n| n.1)
    }
}

/// The units of a context; what is wrong with one of them is reported by `warn` with its record.
pub fn of_context(file: &File, context: u32, warn: &mut dyn FnMut(u32, String)) -> Units {
    let mut units = Units::NONE;
    if let Some(list) = file.under(context, b"GLOBAL_UNIT_ASSIGNED_CONTEXT") {
        let lists = list.values().filter_map(|v| v.list());
        for unit in lists.flat_map(Row::values).filter_map(|v| v.entity().ok()) {
            match size(file, unit, 0) {
                Ok((UnitKind::Length, mm)) => units.millimetres = Some(mm),
                Ok((UnitKind::Angle, radians)) => units.radians = radians,
                Ok((UnitKind::Other, _)) => {}
                Err(Defect(why)) => warn(unit, format!("the unit cannot be read: {why}")),
            }
        }
    }
    let lists = file.under(context, b"GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT").into_iter().flat_map(|r| r.values().filter_map(|v| v.list()));
    for measure in lists.flat_map(Row::values).filter_map(|v| v.entity().ok()) {
        let row = file.under(measure, b"MEASURE_WITH_UNIT").unwrap_or_else(|| file.parameters(measure));
        let unit = row.entity(1).and_then(|unit| size(file, unit, 0));
        if let (Ok(x), Ok((UnitKind::Length, mm))) = (row.number(0), unit)
            && x > 0.0
        {
            units.uncertainty = x * mm;
        }
    }
    units
}

/// Millimetres in a unit of length; none for another unit.
pub fn unit_of_length(file: &File, unit: u32) -> Option<f64> {
    size(file, unit, 0).ok().filter(|(kind, _)| *kind == UnitKind::Length).map(|(_, mm)| mm)
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum UnitKind {
    Length,
    Angle,
    Other,
}

/// What a unit measures, in millimetres or radians.
fn size(file: &File, unit: u32, depth: usize) -> Result<(UnitKind, f64), Defect> {
    if depth > NESTED {
        return Err(defect("units are defined by each other"));
    }
    let checked = |kind: UnitKind, x: f64| {
        if x > 0.0 && x.is_finite() { Ok((kind, x)) } else { Err(defect(format!("its size is {x}"))) }
    };
    if let Some(row) = file.under(unit, b"SI_UNIT") {
        // A simple entity has its dimensions first.
        let from = usize::from(row.values().count() > 2);
        let prefix = row.get(from).and_then(|v| v.word()).map_or(Ok(1.0), prefix)?;
        return match row.get(from + 1).and_then(|v| v.word()) {
            Some(b"METRE") => checked(UnitKind::Length, 1000.0 * prefix),
            Some(b"RADIAN") => checked(UnitKind::Angle, prefix),
            _ => Ok((UnitKind::Other, 1.0)),
        };
    }
    let converted = [&b"CONVERSION_BASED_UNIT"[..], b"CONVERSION_BASED_UNIT_WITH_OFFSET"].into_iter().find_map(|n| file.under(unit, n));
    if let Some(row) = converted {
        let from = usize::from(row.values().count() > 2);
        let measure = row.entity(from + 1)?;
        let of = file.under(measure, b"MEASURE_WITH_UNIT").unwrap_or_else(|| file.parameters(measure));
        let (kind, one) = size(file, of.entity(1)?, depth + 1)?;
        return checked(kind, of.number(0)? * one);
    }
    Ok((UnitKind::Other, 1.0))
}

fn prefix(word: &[u8]) -> Result<f64, Defect> {
    Ok(match word {
        b"EXA" => 1e18,
        b"PETA" => 1e15,
        b"TERA" => 1e12,
        b"GIGA" => 1e9,
        b"MEGA" => 1e6,
        b"KILO" => 1e3,
        b"HECTO" => 1e2,
        b"DECA" => 1e1,
        b"DECI" => 1.0 / 1e1,
        b"CENTI" => 1.0 / 1e2,
        b"MILLI" => 1.0 / 1e3,
        b"MICRO" => 1.0 / 1e6,
        b"NANO" => 1.0 / 1e9,
        b"PICO" => 1.0 / 1e12,
        b"FEMTO" => 1.0 / 1e15,
        b"ATTO" => 1.0 / 1e18,
        _ => return Err(defect(format!("there is no prefix {}", String::from_utf8_lossy(word)))),
    })
}
