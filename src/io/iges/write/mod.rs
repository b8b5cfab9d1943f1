//! Writes IGES 5.3: curves, surfaces and their groups by name.
//!
//! | thing | entity |
//! |---|---|
//! | point | 116 |
//! | line | 110 |
//! | arc of a circle | 100, placed by a 124 unless it runs counter-clockwise about z |
//! | any other curve | 126 |
//! | curves in a row | 102 |
//! | surface | 128 |
//! | surface inside loops | 144, 142 over a 128 |
//! | closed shell | 186, its faces share edges: 514, 510, 508, 504, 502 |
//! | open shell | 514 form 2 |
//! | shell as trimmed surfaces, several bodies of one shell | 402 form 7 |
//! | name, colour | 406 form 15, 314 |
//! | layer | a level, named by 406 form 3; several by 406 form 1 |

mod curves;
mod solids;
mod surfaces;
mod trimmed;

use std::io::{self, Write};

use glam::DVec3;

use super::sheet::{Role, Sheet, Values, counted, real};
use crate::base::job;
use crate::base::tolerance::Tolerance;
use crate::io::cad::bodies::Faces;
use crate::io::cad::damage::Damage;
use crate::io::deck::Loss;
use crate::network::Chain;
use crate::surface::Surface;

/// One thing to write.
#[derive(Clone, Debug)]
pub enum Shown {
    /// A point, model units.
    Point(DVec3),
    /// A curve.
    Curve(Chain),
    /// A surface by itself.
    Surface(Surface),
    /// Faces that share their edges: a solid where they close.
    Faces(Box<Faces>),
}

/// Things with their names; those under one group name become a group.
#[derive(Clone, Debug)]
pub struct Thing {
    /// Name as declared, empty for none.
    pub name: String,
    /// The shell or group it belongs to, empty for none.
    pub group: String,
    /// Layers that it is on.
    pub layers: Vec<String>,
    /// Red, green and blue from 0 to 1, where it has a colour.
    pub color: Option<[f64; 3]>,
    /// What it is.
    pub shown: Shown,
}

impl Thing {
    /// Layers that it or a face of it is on.
    fn all_layers(&self) -> impl Iterator<Item = &str> {
        let faces = if let Shown::Faces(faces) = &self.shown { Some(faces.layers.values().flatten()) } else { None };
        self.layers.iter().chain(faces.into_iter().flatten()).map(String::as_str)
    }
}

/// Unit and accuracy of a file.
#[derive(Clone, Copy, Debug)]
pub struct Scale {
    /// Name of the file's unit as scripts have it.
    pub unit: &'static str,
    /// Model units in one unit of the file.
    pub model: f64,
    /// Of the model: surfaces that are no B-splines are within it.
    pub tolerance: Tolerance,
}

/// Flag and name of the units that scripts know.
const UNITS: &[(&str, i64, &str)] =
    &[("um", 9, "UM"), ("mm", 2, "MM"), ("cm", 10, "CM"), ("m", 6, "M"), ("km", 7, "KM"), ("in", 1, "INCH"), ("ft", 4, "FT")];

/// Makes the file of things; fails for a thing that the format or the tolerance cannot hold, with its name.
pub fn sheet(things: &[Thing], scale: &Scale) -> Result<Sheet, String> {
    let mut maker = Maker { sheet: Sheet::default(), scale, off: 0.0, sampled: false, left_out: Vec::new() };
    maker.sheet.layers(things.iter().flat_map(Thing::all_layers));
    maker.sheet.keep(things.iter().flat_map(|thing| [thing.name.as_str(), thing.group.as_str()]));
    let mut groups: Vec<(&str, Vec<u32>)> = Vec::new();
    for thing in things {
        job::look();
        let made = match &thing.shown {
            Shown::Point(p) => Ok(maker.sheet.add(116, 0, Role::Free, Values::new().point(*p / scale.model).int(0))),
            Shown::Curve(chain) => chain.to_curve().map_err(Damage::from).and_then(|curve| maker.curve(&curve, Role::Free, true)),
            Shown::Surface(surface) => maker.surface(surface),
            Shown::Faces(faces) => maker.bodies(thing, faces),
        };
        let d = made.map_err(|Damage(why)| if thing.name.is_empty() { why } else { format!("`{}`: {why}", thing.name) })?;
        if !thing.name.is_empty() {
            maker.sheet.name(d, &thing.name);
        }
        if let Some(rgb) = thing.color {
            maker.sheet.paint(d, rgb);
        }
        maker.sheet.put_on(d, &thing.layers);
        if thing.group.is_empty() {
            continue;
        }
        match groups.iter_mut().find(|g| g.0 == thing.group) {
            Some(group) => group.1.push(d),
            None => groups.push((&thing.group, vec![d])),
        }
    }
    for (name, members) in groups {
        let d = maker.sheet.add(402, 7, Role::Free, Values::new().int(members.len() as u32).ints(members));
        maker.sheet.name(d, name);
    }
    if maker.off > 0.0 {
        let how = if maker.sampled { ", as sampled" } else { "" };
        maker.sheet.remark(format!(
            "Surfaces that are no B-splines are off by at most {:.2e} {}{how}",
            maker.off / scale.model,
            scale.unit
        ));
    }
    maker.sheet.left_out = maker.left_out;
    Ok(maker.sheet)
}

/// Writes a file; `name` stands in its head. Returns what the format has no place for.
pub fn write(sheet: &Sheet, name: &str, scale: &Scale, out: &mut dyn Write) -> io::Result<Vec<Loss>> {
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

struct Maker<'s> {
    sheet: Sheet,
    scale: &'s Scale,
    /// How far nets are from their surfaces at most, model units, and whether all that is known of one are samples.
    off: f64,
    sampled: bool,
    /// What is not in the file, in words.
    left_out: Vec<String>,
}
