//! Validation properties: areas, volumes and centroids that the file states of products and shapes.

use std::collections::BTreeMap;

use crate::io::step::records::File;
use crate::io::step::units::unit_of_length;

/// A stated figure, in millimetres; a centroid still in the units of its context.
#[derive(Clone, Copy, Debug)]
pub enum Given {
    /// Of all faces.
    Area(f64),
    /// Inside them.
    Volume(f64),
    /// The entity of the point.
    Centroid(u32),
}

/// What a property is of.
#[derive(Clone, Debug)]
pub enum Of {
    /// A product definition.
    Product(u32),
    /// Items of a representation.
    Items(Vec<u32>),
}

/// All figures with what they are of and the entity that states them.
pub fn given(file: &File) -> Vec<(Of, Given, u32)> {
    let mut properties: BTreeMap<u32, u32> = BTreeMap::new();
    let mut shapes: BTreeMap<u32, u32> = BTreeMap::new();
    let mut stated = Vec::new();
    for k in 0..file.records.len() as u32 {
        let row = file.parameters(k);
        match file.name(k) {
            b"PROPERTY_DEFINITION" | b"PRODUCT_DEFINITION_SHAPE" => drop(row.entity(2).map(|of| properties.insert(k, of))),
            b"SHAPE_DEFINITION_REPRESENTATION" => drop(row.entity(0).and_then(|of| Ok(shapes.insert(of, row.entity(1)?)))),
            b"PROPERTY_DEFINITION_REPRESENTATION" => stated.extend(row.entity(0).ok().zip(row.entity(1).ok()).map(|pair| (k, pair))),
            _ => {}
        }
    }
    // The representation of a shape aspect, by the property that is of it.
    let aspects: BTreeMap<u32, u32> = shapes.iter().filter_map(|(property, of)| Some((*properties.get(property)?, *of))).collect();
    let mut all = Vec::new();
    for (k, (property, representation)) in stated {
        if !file.parameters(property).text(0).starts_with("geometric validation") {
            continue;
        }
        let Some(of) = properties.get(&property) else { continue };
        let target = match file.name(*of) {
            b"PRODUCT_DEFINITION_SHAPE" => properties.get(of).map(|product| Of::Product(*product)),
            b"PRODUCT_DEFINITION" => Some(Of::Product(*of)),
            _ => aspects.get(of).map(|r| Of::Items(file.parameters(*r).entities(1).unwrap_or_default())),
        };
        let Some(target) = target else { continue };
        for item in file.parameters(representation).entities(1).unwrap_or_default() {
            if let Some(given) = figure(file, item) {
                all.push((target.clone(), given, k));
            }
        }
    }
    all
}

fn figure(file: &File, item: u32) -> Option<Given> {
    let row = file.parameters(item);
    let name = row.text(0);
    if file.name(item) == b"CARTESIAN_POINT" {
        return (name == "centre point").then_some(Given::Centroid(item));
    }
    if file.name(item) != b"MEASURE_REPRESENTATION_ITEM" {
        return None;
    }
    let value = row.number(1).ok().filter(|x| *x > 0.0)?;
    let unit = row.entity(2).ok()?;
    let elements = file.under(unit, b"DERIVED_UNIT").and_then(|r| r.entities(0).ok())?;
    let element = file.parameters(*elements.first()?);
    let (length, power) = (unit_of_length(file, element.entity(0).ok()?)?, element.number(1).ok()?);
    match (name.as_str(), power) {
        ("surface area measure", 2.0) => Some(Given::Area(value * length * length)),
        ("volume measure", 3.0) => Some(Given::Volume(value * length * length * length)),
        _ => None,
    }
}
