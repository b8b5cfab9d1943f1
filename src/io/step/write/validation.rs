//! Validation properties: area and volume of what was written, for readers to compare with what they find.

use crate::base::math::powi;
use crate::io::step::write::product::Context;
use crate::io::step::write::records::{Id, SectionRecords};
use crate::io::step::write::things::{Measured, Setup, StepThing};

/// Writes the sums over all things as properties of the product, without the area of what is too thin for the file.
pub fn put(records: &mut SectionRecords, things: &[StepThing], thin: f64, product: Id, context: Context, setup: &Setup) {
    let sum = |of: fn(&Measured) -> Option<f64>| things.iter().filter_map(|t| of(&t.measured)).reduce(|a, b| a + b);
    let model = setup.scale.model;
    let kinds = [
        ("surface area", "surface area measure", "AREA_MEASURE", 2, sum(|m| m.area).map(|area| area - thin)),
        ("volume", "volume measure", "VOLUME_MEASURE", 3, sum(|m| m.volume)),
    ];
    for (name, item, measure, power, value) in kinds {
        let Some(value) = value else { continue };
        let element = records.put("DERIVED_UNIT_ELEMENT", |v| {
            v.id(context.length).real(f64::from(power));
        });
        let unit = records.put("DERIVED_UNIT", |v| {
            v.ids(&[element]);
        });
        let item = records.put("MEASURE_REPRESENTATION_ITEM", |v| {
            v.text(item).typed(measure, value / powi(model, power)).id(unit);
        });
        let representation = records.put("REPRESENTATION", |v| {
            v.text(name).ids(&[item]).id(context.context);
        });
        let property = records.put("PROPERTY_DEFINITION", |v| {
            v.text("geometric validation property").text(name).id(product);
        });
        records.put("PROPERTY_DEFINITION_REPRESENTATION", |v| {
            v.id(property).id(representation);
        });
    }
}
