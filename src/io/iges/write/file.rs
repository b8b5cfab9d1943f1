//! Makes the entities of a file from the things that it is to hold, and writes them with the global section.

use std::io::{self, Write};

use crate::base::job;
use crate::io::cad::defect::Defect;
use crate::io::files::loss::Loss;
use crate::io::iges::entity_writer::{EntityValues, IgesFile, Role, counted, real};
use crate::io::iges::write::file_builder::FileBuilder;
use crate::io::iges::write::things::{IgesScale, IgesShape, IgesThing};

/// Flag and name of the units that scripts know.
const UNITS: &[(&str, i64, &str)] =
    &[("um", 9, "UM"), ("mm", 2, "MM"), ("cm", 10, "CM"), ("m", 6, "M"), ("km", 7, "KM"), ("in", 1, "INCH"), ("ft", 4, "FT")];

/// Makes the file of things; fails for a thing that the format or the tolerance cannot hold, with its name.
pub fn sheet(things: &[IgesThing], scale: &IgesScale) -> Result<IgesFile, String> {
    let mut builder = FileBuilder { sheet: IgesFile::default(), scale, off: 0.0, sampled: false, left_out: Vec::new() };
    builder.sheet.layers(things.iter().flat_map(IgesThing::all_layers));
    builder.sheet.keep(things.iter().flat_map(|thing| [thing.name.as_str(), thing.group.as_str()]));
    let mut groups: Vec<(&str, Vec<u32>)> = Vec::new();
    for thing in things {
        job::poll();
        let made = match &thing.shown {
            IgesShape::Point(p) => Ok(builder.sheet.add(116, 0, Role::Free, EntityValues::new().point(*p / scale.model).int(0))),
            IgesShape::Curve(chain) => chain.to_curve().map_err(Defect::from).and_then(|curve| builder.curve(&curve, Role::Free, true)),
            IgesShape::Surface(surface) => builder.surface(surface),
            IgesShape::Faces(faces) => faces.bodies(&scale.tolerance).and_then(|bodies| builder.bodies(thing, &bodies)),
            IgesShape::Face(faces, surface) => match faces.bodies(&scale.tolerance) {
                Ok(bodies) => builder.bodies(thing, &bodies),
                Err(_) => builder.surface(surface),
            },
        };
        let d = made.map_err(|Defect(why)| if thing.name.is_empty() { why } else { format!("`{}`: {why}", thing.name) })?;
        if !thing.name.is_empty() {
            builder.sheet.name(d, &thing.name);
        }
        if let Some(rgb) = thing.color {
            builder.sheet.paint(d, rgb);
        }
        builder.sheet.put_on(d, &thing.layers);
        if thing.group.is_empty() {
            continue;
        }
        match groups.iter_mut().find(|g| g.0 == thing.group) {
            Some(group) => group.1.push(d),
            None => groups.push((&thing.group, vec![d])),
        }
    }
    for (name, members) in groups {
        let d = builder.sheet.add(402, 7, Role::Free, EntityValues::new().int(members.len() as u32).ints(members));
        builder.sheet.name(d, name);
    }
    if builder.off > 0.0 {
        let how = if builder.sampled { ", as sampled" } else { "" };
        builder.sheet.remark(format!(
            "Surfaces that are no B-splines are off by at most {:.2e} {}{how}",
            builder.off / scale.model,
            scale.unit
        ));
    }
    builder.sheet.left_out = builder.left_out;
    Ok(builder.sheet)
}

/// Writes a file; `name` stands in its head. Returns what the format has no place for.
pub fn write(sheet: &IgesFile, name: &str, scale: &IgesScale, out: &mut dyn Write) -> io::Result<Vec<Loss>> {
    let (_, flag, unit) = UNITS.iter().find(|u| u.0 == scale.unit).copied().unwrap_or(("", 3, scale.unit));
    let file = real(scale.tolerance.point / scale.model);
    let program = concat!("loft ", env!("CARGO_PKG_VERSION"));
    // The same input gives the same bytes: no clock.
    let date = "15H20000101.000000";
    let plain = |text: &str| text.to_owned();
    let head = [counted(name), counted(name), counted(program), counted(program)];
    let mut global = vec![plain("1H,"), plain("1H;")];
    global.extend(head);
    global.extend(["32", "308", "15", "308", "15"].map(plain));
    global.extend([
        counted(name),
        plain("1."),
        flag.to_string(),
        counted(unit),
        plain("1"),
        plain("1."),
        plain(date),
        file,
        real(sheet.largest()),
    ]);
    global.extend([String::new(), String::new(), plain("11"), plain("0"), plain(date)]);
    sheet.write(&global, out)?;
    let left_out = sheet.left_out.iter().cloned().map(Loss::LeftOut);
    Ok(sheet.renamed().into_iter().chain(left_out).collect())
}
