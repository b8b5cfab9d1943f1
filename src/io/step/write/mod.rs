//! Writes STEP: points, curves, surfaces, shells and solids by name.
//!
//! | thing | entity |
//! |---|---|
//! | point, curve | `GEOMETRIC_CURVE_SET` |
//! | surface, open shell | `SHELL_BASED_SURFACE_MODEL` of faces that share edges |
//! | closed shell | `MANIFOLD_SOLID_BREP`, with cavities `BREP_WITH_VOIDS` |
//! | group | `PRESENTATION_LAYER_ASSIGNMENT` |
//! | colour of a solid, face or curve | `STYLED_ITEM`, of a face that differs from its solid `OVER_RIDING_STYLED_ITEM` |
//! | tolerance | `UNCERTAINTY_MEASURE_WITH_UNIT` |

mod curves;
mod looks;
mod pcurves;
mod product;
mod properties;
mod surfaces;
mod text;
mod topology;

use std::io::{self, Write};

use glam::DVec3;

pub use curves::Scale;
pub use product::Schema;
pub use properties::Measured;

use crate::base::job;
use crate::io::cad::bodies::Faces;
use crate::io::cad::damage::Damage;
use crate::network::Chain;
use looks::Painted;
use text::{Id, Records};
use topology::Made;

/// One thing to write.
#[derive(Clone, Debug)]
pub enum Shown {
    /// A point, model units.
    Point(DVec3),
    /// A curve.
    Curve(Chain),
    /// Faces.
    Faces(Box<Faces>),
}

/// A thing with its name and what is known of it.
#[derive(Clone, Debug)]
pub struct Thing {
    /// Name as declared, empty for none.
    pub name: String,
    /// Groups that it belongs to.
    pub layers: Vec<String>,
    /// What it is.
    pub shown: Shown,
    /// Red, green and blue from 0 to 1 of a curve that has a colour.
    pub color: Option<[f64; 3]>,
    /// Area and volume that a reader can compare.
    pub measured: Measured,
}

/// What a file is to be.
#[derive(Clone, Copy, Debug)]
pub struct Setup {
    /// Its application protocol.
    pub schema: Schema,
    /// Name of its unit as scripts have it.
    pub unit: &'static str,
    /// Its unit and accuracy.
    pub scale: Scale,
}

/// A file ready to be written.
#[derive(Clone, Debug)]
pub struct Sheet {
    records: Records,
    remark: Option<String>,
    /// What is not in the file, in words.
    pub left_out: Vec<String>,
}

/// Makes the file of things; `name` is its product's, but one thing names its own. Fails for a thing that the format or the tolerance cannot hold, with its name.
pub fn sheet(things: &[Thing], name: &str, setup: &Setup) -> Result<Sheet, String> {
    let mut records = Records::default();
    let name = match things {
        [one] if !one.name.is_empty() => one.name.as_str(),
        _ => name,
    };
    let context = product::context(&mut records, setup.unit, setup.scale.tolerance.point / setup.scale.model);
    let product = product::product(&mut records, setup.schema, name);
    let (mut solids, mut sheets, mut wires) = (Vec::new(), Vec::new(), Vec::new());
    let mut layers: Vec<(String, Vec<Id>)> = Vec::new();
    let (mut off, mut thin_area) = ((0.0_f64, false), 0.0);
    let (mut painted, mut left_out) = (Vec::new(), Vec::new());
    for thing in things {
        job::look();
        let own = put(&mut records, thing, setup)
            .map_err(|Damage(why)| if thing.name.is_empty() { why } else { format!("`{}`: {why}", thing.name) })?;
        off = (off.0.max(own.off.0), off.1 || own.off.1);
        let all = [own.solids.as_slice(), &own.sheets, &own.wires].concat();
        thing.layers.iter().for_each(|layer| on_layer(&mut layers, layer, &all));
        for (face, own) in &own.layered {
            own.iter().for_each(|layer| on_layer(&mut layers, layer, &[*face]));
        }
        solids.extend(own.solids);
        sheets.extend(own.sheets);
        wires.extend(own.wires);
        painted.extend(own.painted);
        left_out.extend(own.left_out);
        thin_area += own.thin_area;
    }
    let all = [solids.as_slice(), &sheets, &wires].concat();
    let kind = match [solids.is_empty(), sheets.is_empty(), wires.is_empty()] {
        [false, true, true] => "ADVANCED_BREP_SHAPE_REPRESENTATION",
        [true, false, true] => "MANIFOLD_SURFACE_SHAPE_REPRESENTATION",
        [true, true, false] => "GEOMETRICALLY_BOUNDED_WIREFRAME_SHAPE_REPRESENTATION",
        _ => "SHAPE_REPRESENTATION",
    };
    product::shape(&mut records, (product, name), context, kind, &all);
    for (layer, members) in layers {
        records.put("PRESENTATION_LAYER_ASSIGNMENT", |v| {
            v.text(&layer).text("").ids(&members);
        });
    }
    looks::put(&mut records, &painted, context);
    properties::put(&mut records, (things, thin_area), (product, context), setup);
    let remark = (off.0 > 0.0).then(|| {
        let how = if off.1 { ", as sampled" } else { "" };
        format!("Surfaces that are no B-splines are off by at most {:.2e} {}{how}", off.0 / setup.scale.model, setup.unit)
    });
    Ok(Sheet { records, remark, left_out })
}

/// Puts items on a layer.
fn on_layer(layers: &mut Vec<(String, Vec<Id>)>, layer: &str, items: &[Id]) {
    match layers.iter_mut().find(|known| known.0 == layer) {
        Some(known) => known.1.extend_from_slice(items),
        None => layers.push((layer.to_owned(), items.to_vec())),
    }
}

/// What became of a thing.
#[derive(Default)]
struct Put {
    solids: Vec<Id>,
    sheets: Vec<Id>,
    wires: Vec<Id>,
    off: (f64, bool),
    painted: Vec<Painted>,
    layered: Vec<(Id, Vec<String>)>,
    left_out: Vec<String>,
    thin_area: f64,
}

fn put(records: &mut Records, thing: &Thing, setup: &Setup) -> Result<Put, Damage> {
    let scale = &setup.scale;
    let geometry = match &thing.shown {
        Shown::Faces(faces) => {
            let Made { solids, sheets, off, painted, layered, left_out, thin_area } = topology::put(faces, records, &thing.name, scale)?;
            let left_out = left_out.into_iter().collect();
            return Ok(Put { solids, sheets, off, painted, layered, left_out, thin_area, ..Put::default() });
        }
        Shown::Point(p) => records.point(*p / scale.model),
        Shown::Curve(chain) => curves::bounded(records, &chain.to_curve()?, &thing.name, scale)?,
    };
    let set = records.put("GEOMETRIC_CURVE_SET", |v| {
        v.text(&thing.name).ids(&[geometry]);
    });
    let painted = thing.color.map(|rgb| Painted { item: geometry, rgb, curve: true, over: None });
    Ok(Put { wires: vec![set], painted: painted.into_iter().collect(), ..Put::default() })
}

/// Writes a file; `name` stands in its head.
pub fn write(sheet: &Sheet, name: &str, setup: &Setup, out: &mut dyn Write) -> io::Result<()> {
    let quoted = |text: &str| {
        let mut bytes = Vec::new();
        text::push_text(&mut bytes, text);
        String::from_utf8_lossy(&bytes).into_owned()
    };
    let about: Vec<String> = std::iter::once("Written by loft").chain(sheet.remark.as_deref()).map(quoted).collect();
    let program = quoted(concat!("loft ", env!("CARGO_PKG_VERSION")));
    writeln!(out, "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION(({}),'2;1');", about.join(","))?;
    // The same input gives the same bytes: no clock.
    writeln!(out, "FILE_NAME({},'2000-01-01T00:00:00',(''),(''),{program},{program},'');", quoted(name))?;
    writeln!(out, "FILE_SCHEMA(({}));\nENDSEC;\nDATA;", quoted(setup.schema.schema()))?;
    out.write_all(sheet.records.text())?;
    writeln!(out, "ENDSEC;\nEND-ISO-10303-21;")
}
