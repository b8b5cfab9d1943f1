//! Reads the parameters of an entity by its type.

use glam::{DAffine3, DVec3};

use crate::io::cad::defect::{Defect, defect};
use crate::io::iges::entity_data::{Data, Decoded};
use crate::io::iges::params::ParameterReader;
use crate::io::iges::records::Entry;
use crate::io::iges::{entity_curves as curves, entity_faces as faces, entity_surfaces as surfaces};

/// Reads the parameters of an entity; the reader stands behind the entity type.
pub fn decode(entry: &Entry, reader: &mut ParameterReader) -> Result<Decoded, Defect> {
    let form = entry.form;
    let data = match entry.kind {
        100 => curves::arc(reader)?,
        102 => {
            let n = reader.count("count of curves")?;
            Data::Composite(reader.pointers(n, "curves")?)
        }
        104 => curves::conic(reader)?,
        106 => curves::points(form, reader)?,
        108 => surfaces::plane(reader)?,
        110 => Data::Line { start: reader.point("start")?, end: reader.point("end")?, unbounded: form != 0 },
        112 => curves::polynomials(reader)?,
        114 => surfaces::patches(reader)?,
        116 => {
            let point = reader.point("point")?;
            // A symbol to show it by.
            reader.real_or(0.0);
            Data::Point(point)
        }
        118 => surfaces::ruled(form, reader)?,
        120 => surfaces::revolution(reader)?,
        122 => Data::Tabulated { profile: reader.pointer("profile")?, end: reader.point("end")? },
        123 => Data::Direction(reader.point("direction")?),
        124 => Data::Matrix(matrix(reader)?),
        126 => curves::spline(reader)?,
        128 => surfaces::net(reader)?,
        130 => curves::offset(reader)?,
        140 => surfaces::offset(reader)?,
        141 => faces::boundary(reader)?,
        142 => faces::curve_on_surface(reader)?,
        143 => faces::bounded(reader)?,
        144 => faces::trimmed(reader)?,
        186 => faces::solid(reader)?,
        184 => faces::assembly(reader)?,
        190 => surfaces::plane_surface(form, reader)?,
        192 | 194 | 196 | 198 => surfaces::round(entry.kind, form, reader)?,
        308 => faces::definition(reader)?,
        314 => {
            let rgb = [reader.real("red")?, reader.real("green")?, reader.real("blue")?];
            Data::Color { rgb, name: reader.text() }
        }
        402 if matches!(form, 1 | 7 | 14 | 15) => {
            let n = reader.count("count of members")?;
            Data::Group(reader.pointers(n, "members")?)
        }
        // Geometry without its levels is geometry all the same.
        406 if form == 1 => levels(reader).map_or(Data::Silent, Data::Levels),
        406 if form == 3 => {
            let (_count, _function) = (reader.real_or(0.0), reader.real_or(0.0));
            Data::LevelName(reader.text())
        }
        406 if form == 15 => {
            reader.count("count of values")?;
            Data::Name(reader.text())
        }
        408 => {
            let (of, at) = (reader.pointer("definition")?, reader.point("translation")?);
            Data::Instance { of, at, scale: reader.real_or(1.0) }
        }
        430 => Data::SolidInstance(reader.pointer("solid")?),
        502 => faces::vertices(reader)?,
        504 => faces::edges(reader)?,
        508 => faces::loop_of(reader)?,
        510 => faces::face(reader)?,
        514 => faces::shell(reader)?,
        // Structure of drawings and tables of properties.
        0 | 132 | 134 | 136 | 138 | 302 | 304 | 310 | 312 | 316 | 402 | 404 | 406 | 410 => Data::Silent,
        _ => Data::Unknown,
    };
    let (_, properties) = if matches!(data, Data::Silent | Data::Unknown) { Default::default() } else { reader.attached() };
    Ok(Decoded { data, properties })
}

fn levels(reader: &mut ParameterReader) -> Result<Vec<i32>, Defect> {
    let n = reader.count("count of levels")?;
    reader.needs(n, 1, "levels")?;
    (0..n).map(|_| Ok(reader.int("level")? as i32)).collect()
}

/// Rows of a rotation, each followed by its part of the translation.
fn matrix(reader: &mut ParameterReader) -> Result<DAffine3, Defect> {
    let m = reader.reals(12, "matrix elements")?;
    let row = |k: usize| DVec3::new(m[4 * k], m[4 * k + 1], m[4 * k + 2]);
    let rows = glam::DMat3::from_cols(row(0), row(1), row(2));
    if rows.determinant().abs() <= f64::MIN_POSITIVE {
        return Err(defect("the matrix flattens space"));
    }
    Ok(DAffine3::from_mat3_translation(rows.transpose(), DVec3::new(m[3], m[7], m[11])))
}
