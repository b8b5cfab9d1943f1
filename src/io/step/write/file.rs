//! Makes the records of a file from the things that it is to hold, and writes them with their header.

use std::io::{self, Write};
use std::ops::Range;

use glam::DVec3;

use crate::base::job;
use crate::geometry::Motion;
use crate::io::cad::assembly::Node;
use crate::io::cad::defect::Defect;
use crate::io::step::write::product::{self, ProductRecords, ShapeRecords};
use crate::io::step::write::records::{self, Id, SectionRecords};
use crate::io::step::write::styles::{self, Painted};
use crate::io::step::write::things::{Setup, StepShape, StepThing};
use crate::io::step::write::{assembly, curves, topology, validation};

/// A file ready to be written.
#[derive(Clone, Debug)]
pub struct StepFile {
    records: SectionRecords,
    remark: Option<String>,
    /// What is not in the file, in words.
    pub left_out: Vec<String>,
}

/// Makes the file of things; `name` is its product's, but one thing names its own, and an imported assembly, given by its nodes, has
/// its products. Fails for a thing that the format or the tolerance cannot hold, with its name.
pub fn sheet(things: &[StepThing], nodes: &[Node], name: &str, setup: &Setup) -> Result<StepFile, String> {
    let mut records = SectionRecords::default();
    let name = match things {
        [one] if !one.name.is_empty() => one.name.as_str(),
        _ => name,
    };
    let context = product::context(&mut records, setup.unit, setup.scale.tolerance.point / setup.scale.model);
    let application = product::application(&mut records, setup.schema);
    let tree = assembly::products(things, nodes, name, &setup.scale.tolerance);
    let uses = assembly::uses(&tree);
    let mut content = FileContent::default();
    let mut shapes: Vec<(ProductRecords, ShapeRecords)> = Vec::with_capacity(tree.len());
    let mut occurrences = 0;
    for (own, uses) in tree.iter().zip(uses) {
        let whole = product::product(&mut records, application, &own.name);
        let painted = content.painted.len();
        let items = content.put(&mut records, things, own, uses, setup)?;
        content.of_product.push(painted..content.painted.len());
        let places: Vec<Motion> = own.parts.iter().map(|part| part.motion.in_units(setup.scale.model)).collect();
        let shape = product::shape(&mut records, whole, &own.name, context, items.kind(), &items.all(), &places);
        for (place, part) in own.parts.iter().enumerate() {
            occurrences += 1;
            let (of, inner) = &shapes[part.product];
            let placed = product::occurrence(&mut records, occurrences, &part.name, (*of, inner), (whole, &shape), place);
            if let Some((from, rgb)) = part.repaint {
                let at = Some(product::place(&mut records, placed, &shape, place, context));
                let own = content.painted[content.of_product[part.product].clone()].iter().filter(|painted| painted.rgb == from);
                content.repainted.extend(own.map(|painted| Painted { rgb, over: Some(painted.item), at, ..*painted }));
            }
        }
        shapes.push((whole, shape));
    }
    for (layer, members) in content.layers {
        records.put("PRESENTATION_LAYER_ASSIGNMENT", |v| {
            v.text(&layer).text("").ids(&members);
        });
    }
    content.painted.append(&mut content.repainted);
    styles::put(&mut records, &content.painted, context);
    if let (Some((whole, _)), true) = (shapes.last(), assembly::is_one(&tree)) {
        validation::put(&mut records, things, content.thin_area, whole.shape, context, setup);
    }
    let off = content.off;
    let remark = (off.0 > 0.0).then(|| {
        let how = if off.1 { ", as sampled" } else { "" };
        format!("Surfaces that are no B-splines are off by at most {:.2e} {}{how}", off.0 / setup.scale.model, setup.unit)
    });
    Ok(StepFile { records, remark, left_out: content.left_out })
}

/// What of all products stands behind them in the file, or in words.
#[derive(Default)]
pub(crate) struct FileContent {
    layers: Vec<(String, Vec<Id>)>,
    painted: Vec<Painted>,
    /// Which of these are of each product.
    of_product: Vec<Range<usize>>,
    /// Colours that products have at some of their places only.
    repainted: Vec<Painted>,
    left_out: Vec<String>,
    off: (f64, bool),
    thin_area: f64,
}

/// What one product holds by itself.
#[derive(Default)]
struct Items {
    solids: Vec<Id>,
    sheets: Vec<Id>,
    wires: Vec<Id>,
}

impl FileContent {
    /// The things of a product, which stands in the whole so many times.
    fn put(
        &mut self,
        records: &mut SectionRecords,
        things: &[StepThing],
        product: &assembly::Product,
        uses: usize,
        setup: &Setup,
    ) -> Result<Items, String> {
        let mut items = Items::default();
        let still = Motion::translation(DVec3::ZERO);
        records.set_frame((product.motion != still).then(|| product.motion.inverse().in_units(setup.scale.model)));
        for thing in product.things.iter().map(|k| &things[*k]) {
            job::poll();
            // What has the name of its place has that of the product, which may stand elsewhere too.
            let name = if product.places.contains(&thing.name) { &product.name } else { &thing.name };
            let own = put(records, thing, name, setup)
                .map_err(|Defect(why)| if thing.name.is_empty() { why } else { format!("`{}`: {why}", thing.name) })?;
            self.off = (self.off.0.max(own.off.0), self.off.1 || own.off.1);
            let all = [own.solids.as_slice(), &own.sheets, &own.wires].concat();
            thing.layers.iter().for_each(|layer| on_layer(&mut self.layers, layer, &all));
            for (face, own) in &own.layered {
                own.iter().for_each(|layer| on_layer(&mut self.layers, layer, &[*face]));
            }
            items.solids.extend(own.solids);
            items.sheets.extend(own.sheets);
            items.wires.extend(own.wires);
            self.painted.extend(own.painted);
            self.left_out.extend(own.left_out);
            self.thin_area += uses as f64 * own.thin_area;
        }
        records.set_frame(None);
        Ok(items)
    }
}

impl Items {
    fn all(&self) -> Vec<Id> {
        [self.solids.as_slice(), &self.sheets, &self.wires].concat()
    }

    /// The representation that holds them.
    fn kind(&self) -> &'static str {
        match [self.solids.is_empty(), self.sheets.is_empty(), self.wires.is_empty()] {
            [false, true, true] => "ADVANCED_BREP_SHAPE_REPRESENTATION",
            [true, false, true] => "MANIFOLD_SURFACE_SHAPE_REPRESENTATION",
            [true, true, false] => "GEOMETRICALLY_BOUNDED_WIREFRAME_SHAPE_REPRESENTATION",
            _ => "SHAPE_REPRESENTATION",
        }
    }
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
struct WrittenThing {
    solids: Vec<Id>,
    sheets: Vec<Id>,
    wires: Vec<Id>,
    off: (f64, bool),
    painted: Vec<Painted>,
    layered: Vec<(Id, Vec<String>)>,
    left_out: Vec<String>,
    thin_area: f64,
}

fn put(records: &mut SectionRecords, thing: &StepThing, name: &str, setup: &Setup) -> Result<WrittenThing, Defect> {
    let scale = &setup.scale;
    let geometry = match &thing.shown {
        StepShape::Faces(faces) => {
            let topology::WrittenFaces { solids, sheets, off, painted, layered, left_out, thin_area } =
                topology::put(faces, records, name, scale)?;
            let left_out = left_out.into_iter().collect();
            return Ok(WrittenThing { solids, sheets, off, painted, layered, left_out, thin_area, ..WrittenThing::default() });
        }
        StepShape::Point(p) => records.point(*p / scale.model),
        StepShape::Curve(chain) => curves::bounded(records, &chain.to_curve()?, name, scale)?,
    };
    let set = records.put("GEOMETRIC_CURVE_SET", |v| {
        v.text(name).ids(&[geometry]);
    });
    let painted = thing.color.map(|rgb| Painted { item: geometry, rgb, curve: true, over: None, at: None });
    Ok(WrittenThing { wires: vec![set], painted: painted.into_iter().collect(), ..WrittenThing::default() })
}

/// Writes a file; `name` stands in its head.
pub fn write(sheet: &StepFile, name: &str, setup: &Setup, out: &mut dyn Write) -> io::Result<()> {
    let quoted = |text: &str| {
        let mut bytes = Vec::new();
        records::push_text(&mut bytes, text);
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
