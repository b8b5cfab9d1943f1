//! Colours of solids, faces and curves.

use std::collections::BTreeMap;

use crate::io::step::write::product::Context;
use crate::io::step::write::records::{Id, RecordValues, SectionRecords};

/// Width of coloured curves, units of the file.
const WIDTH: f64 = 0.1;

/// Something with red, green and blue from 0 to 1.
#[derive(Clone, Copy, Debug)]
pub struct Painted {
    /// The solid, face or curve.
    pub item: Id,
    /// Its colour.
    pub rgb: [f64; 3],
    /// It is a curve.
    pub curve: bool,
    /// The solid whose colour it overrides; that stands before it.
    pub over: Option<Id>,
    /// The representation of the place where it has this colour, other than everywhere else.
    pub at: Option<Id>,
}

/// Writes the styles of all that has a colour; equal ones stand once.
pub fn put(records: &mut SectionRecords, painted: &[Painted], context: Context) {
    let mut styles: Vec<([f64; 3], bool, Option<Id>, Id)> = Vec::new();
    let mut styled = Vec::with_capacity(painted.len());
    let mut of_item: BTreeMap<Id, Id> = BTreeMap::new();
    for Painted { item, rgb, curve, over, at } in painted {
        let known = styles.iter().find(|known| (known.0, known.1, known.2) == (*rgb, *curve, *at)).map(|known| known.3);
        let style = known.unwrap_or_else(|| {
            let style = style(records, *rgb, *curve, *at);
            styles.push((*rgb, *curve, *at, style));
            style
        });
        let over = over.and_then(|solid| of_item.get(&solid).copied());
        let entity = if over.is_some() { "OVER_RIDING_STYLED_ITEM" } else { "STYLED_ITEM" };
        let made = records.put(entity, |v| {
            v.text("color").ids(&[style]).id(*item);
            over.iter().for_each(|over| {
                v.id(*over);
            });
        });
        if at.is_none() {
            of_item.insert(*item, made);
        }
        styled.push(made);
    }
    if !styled.is_empty() {
        records.put("MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION", |v| {
            v.text("").ids(&styled).id(context.context);
        });
    }
}

fn style(records: &mut SectionRecords, rgb: [f64; 3], curve: bool, at: Option<Id>) -> Id {
    let color = records.put("COLOUR_RGB", |v| {
        rgb.into_iter().fold(v.text(""), RecordValues::real);
    });
    let mut one = |name: &str, fill: &dyn Fn(&mut RecordValues)| records.put(name, |v| fill(v));
    let look = if curve {
        let font = one("DRAUGHTING_PRE_DEFINED_CURVE_FONT", &|v| {
            v.text("continuous");
        });
        one("CURVE_STYLE", &|v| {
            v.text("").id(font).typed("POSITIVE_LENGTH_MEASURE", WIDTH).id(color);
        })
    } else {
        let fill = one("FILL_AREA_STYLE_COLOUR", &|v| {
            v.text("").id(color);
        });
        let area = one("FILL_AREA_STYLE", &|v| {
            v.text("").ids(&[fill]);
        });
        let area = one("SURFACE_STYLE_FILL_AREA", &|v| {
            v.id(area);
        });
        let side = one("SURFACE_SIDE_STYLE", &|v| {
            v.text("").ids(&[area]);
        });
        one("SURFACE_STYLE_USAGE", &|v| {
            v.word(".BOTH.").id(side);
        })
    };
    match at {
        Some(at) => one("PRESENTATION_STYLE_BY_CONTEXT", &|v| {
            v.ids(&[look]).id(at);
        }),
        None => one("PRESENTATION_STYLE_ASSIGNMENT", &|v| {
            v.ids(&[look]);
        }),
    }
}
