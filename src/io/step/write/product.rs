//! What stands round the geometry: head of the file, units, the product and its representations.

use glam::DVec3;

use crate::geometry::Motion;
use crate::io::step::write::records::{Id, RecordValues, SectionRecords};

/// An application protocol.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Schema {
    /// AP 242, managed model based 3D engineering.
    #[default]
    Ap242,
    /// AP 214, automotive design.
    Ap214,
    /// AP 203, configuration controlled design, second edition.
    Ap203,
}

impl Schema {
    /// Words of scripts.
    pub const WORDS: &[&str] = &["ap242", "ap214", "ap203"];

    /// The one that a word names.
    pub fn of(word: &str) -> Option<Self> {
        [Self::Ap242, Self::Ap214, Self::Ap203].into_iter().find(|s| s.word() == word)
    }

    fn word(self) -> &'static str {
        Self::WORDS[match self {
            Self::Ap242 => 0,
            Self::Ap214 => 1,
            Self::Ap203 => 2,
        }]
    }

    /// Name of the schema with its object identifier.
    pub fn schema(self) -> &'static str {
        match self {
            Self::Ap242 => "AP242_MANAGED_MODEL_BASED_3D_ENGINEERING_MIM_LF { 1 0 10303 442 1 1 4 }",
            Self::Ap214 => "AUTOMOTIVE_DESIGN { 1 0 10303 214 3 1 1 }",
            Self::Ap203 => "AP203_CONFIGURATION_CONTROLLED_3D_DESIGN_OF_MECHANICAL_PARTS_AND_ASSEMBLIES_MIM_LF { 1 0 10303 403 2 1 2 }",
        }
    }

    /// The application, the protocol's name and its year.
    fn application(self) -> (&'static str, &'static str, usize) {
        match self {
            Self::Ap242 => ("managed model based 3d engineering", "ap242_managed_model_based_3d_engineering", 2014),
            Self::Ap214 => ("core data for automotive mechanical design processes", "automotive_design", 2009),
            Self::Ap203 => {
                ("configuration controlled 3D design of mechanical parts and assemblies", "ap203_configuration_controlled_3d_design", 2011)
            }
        }
    }
}

/// The context of the geometry: its units and its accuracy.
#[derive(Clone, Copy, Debug)]
pub struct Context {
    /// The context of representations.
    pub context: Id,
    /// The unit of length.
    pub length: Id,
}

/// Prefixes of the metre by the units of scripts.
const METRES: &[(&str, &str)] = &[("um", ".MICRO."), ("mm", ".MILLI."), ("cm", ".CENTI."), ("m", "$"), ("km", ".KILO.")];
/// Units of scripts that are so many millimetres.
const CONVERTED: &[(&str, &str, f64)] = &[("in", "INCH", 25.4), ("ft", "FOOT", 304.8)];

fn metre(records: &mut SectionRecords, prefix: &str) -> Id {
    records.put_complex(|v| {
        v.part("LENGTH_UNIT", |_| {});
        v.part("NAMED_UNIT", |v| {
            v.word("*");
        });
        v.part("SI_UNIT", |v| {
            v.word(prefix).word(".METRE.");
        });
    })
}

fn length_unit(records: &mut SectionRecords, unit: &str) -> Id {
    if let Some((_, name, size)) = CONVERTED.iter().find(|u| u.0 == unit) {
        let dimensions = records.put("DIMENSIONAL_EXPONENTS", |v| {
            [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0].into_iter().for_each(|x| {
                v.real(x);
            });
        });
        let millimetre = metre(records, ".MILLI.");
        let measure = records.put("LENGTH_MEASURE_WITH_UNIT", |v| {
            v.typed("LENGTH_MEASURE", *size).id(millimetre);
        });
        return records.put_complex(|v| {
            v.part("CONVERSION_BASED_UNIT", |v| {
                v.text(name).id(measure);
            });
            v.part("LENGTH_UNIT", |_| {});
            v.part("NAMED_UNIT", |v| {
                v.id(dimensions);
            });
        });
    }
    metre(records, METRES.iter().find(|u| u.0 == unit).map_or(".MILLI.", |u| u.1))
}

fn angle_unit(records: &mut SectionRecords, kind: &str, name: &str) -> Id {
    records.put_complex(|v| {
        v.part("NAMED_UNIT", |v| {
            v.word("*");
        });
        let si = |v: &mut RecordValues| {
            v.word("$").word(name);
        };
        // Types of one record stand in the order of their letters.
        if kind < "SI_UNIT" {
            v.part(kind, |_| {});
            v.part("SI_UNIT", si);
        } else {
            v.part("SI_UNIT", si);
            v.part(kind, |_| {});
        }
    })
}

/// Units and accuracy; `accuracy` in units of the file.
pub fn context(records: &mut SectionRecords, unit: &str, accuracy: f64) -> Context {
    let length = length_unit(records, unit);
    let plane = angle_unit(records, "PLANE_ANGLE_UNIT", ".RADIAN.");
    let solid = angle_unit(records, "SOLID_ANGLE_UNIT", ".STERADIAN.");
    let uncertainty = records.put("UNCERTAINTY_MEASURE_WITH_UNIT", |v| {
        v.typed("LENGTH_MEASURE", accuracy).id(length).text("distance_accuracy_value").text("tolerance of the model");
    });
    let context = records.put_complex(|v| {
        v.part("GEOMETRIC_REPRESENTATION_CONTEXT", |v| {
            v.int(3);
        });
        v.part("GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT", |v| {
            v.ids(&[uncertainty]);
        });
        v.part("GLOBAL_UNIT_ASSIGNED_CONTEXT", |v| {
            v.ids(&[length, plane, solid]);
        });
        v.part("REPRESENTATION_CONTEXT", |v| {
            v.text("").text("3D");
        });
    });
    Context { context, length }
}

/// A product as records.
#[derive(Clone, Copy, Debug)]
pub struct ProductRecords {
    /// Its definition.
    definition: Id,
    /// The definition of its shape.
    pub shape: Id,
}

/// The application that all products of a file belong to.
pub fn application(records: &mut SectionRecords, schema: Schema) -> Id {
    let (application, protocol, year) = schema.application();
    let context = records.put("APPLICATION_CONTEXT", |v| {
        v.text(application);
    });
    records.put("APPLICATION_PROTOCOL_DEFINITION", |v| {
        v.text("international standard").text(protocol).int(year).id(context);
    });
    context
}

/// A product by its name.
pub fn product(records: &mut SectionRecords, application: Id, name: &str) -> ProductRecords {
    let mechanical = records.put("PRODUCT_CONTEXT", |v| {
        v.text("").id(application).text("mechanical");
    });
    let product = records.put("PRODUCT", |v| {
        v.text(name).text(name).text("").ids(&[mechanical]);
    });
    records.put("PRODUCT_RELATED_PRODUCT_CATEGORY", |v| {
        v.text("part").text("").ids(&[product]);
    });
    let formation = records.put("PRODUCT_DEFINITION_FORMATION", |v| {
        v.text("").text("").id(product);
    });
    let design = records.put("PRODUCT_DEFINITION_CONTEXT", |v| {
        v.text("part definition").id(application).text("design");
    });
    let definition = records.put("PRODUCT_DEFINITION", |v| {
        v.text("design").text("").id(formation).id(design);
    });
    let shape = records.put("PRODUCT_DEFINITION_SHAPE", |v| {
        v.text("").text("").id(definition);
    });
    ProductRecords { definition, shape }
}

/// The shape of a product as records.
#[derive(Clone, Debug)]
pub struct ShapeRecords {
    representation: Id,
    /// Its own frame.
    frame: Id,
    /// Frames in which parts of it stand.
    places: Vec<Id>,
}

/// The shape of a product: one representation of everything in it, so that readers find each thing under its name. `places`, in units
/// of the file, are those of its parts.
pub fn shape(
    records: &mut SectionRecords,
    product: ProductRecords,
    name: &str,
    context: Context,
    kind: &str,
    items: &[Id],
    places: &[Motion],
) -> ShapeRecords {
    let frame = records.frame(DVec3::ZERO, DVec3::Z, DVec3::X);
    let place = |to: &Motion| records.frame(to.point(DVec3::ZERO), to.vector(DVec3::Z), to.vector(DVec3::X));
    let places: Vec<Id> = places.iter().map(place).collect();
    let representation = records.put(kind, |v| {
        v.text(name).ids(&[&[frame], items, &places].concat()).id(context.context);
    });
    records.put("SHAPE_DEFINITION_REPRESENTATION", |v| {
        v.id(product.shape).id(representation);
    });
    ShapeRecords { representation, frame, places }
}

/// A product in another one, at one of the places of that; `number` tells it from all others of the file. Gives the definition of its
/// shape there.
pub fn occurrence(
    records: &mut SectionRecords,
    number: usize,
    name: &str,
    part: (ProductRecords, &ShapeRecords),
    whole: (ProductRecords, &ShapeRecords),
    place: usize,
) -> Id {
    let used = records.put("NEXT_ASSEMBLY_USAGE_OCCURRENCE", |v| {
        v.text(&number.to_string()).text(name).text("").id(whole.0.definition).id(part.0.definition).word("$");
    });
    let shape = records.put("PRODUCT_DEFINITION_SHAPE", |v| {
        v.text("Placement").text("Placement of an item").id(used);
    });
    let moved = records.put("ITEM_DEFINED_TRANSFORMATION", |v| {
        v.text("").text("").id(part.1.frame).id(whole.1.places[place]);
    });
    let relation = records.put_complex(|v| {
        v.part("REPRESENTATION_RELATIONSHIP", |v| {
            v.text("").text("").id(part.1.representation).id(whole.1.representation);
        });
        v.part("REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION", |v| {
            v.id(moved);
        });
        v.part("SHAPE_REPRESENTATION_RELATIONSHIP", |_| {});
    });
    records.put("CONTEXT_DEPENDENT_SHAPE_REPRESENTATION", |v| {
        v.id(relation).id(shape);
    });
    shape
}

/// What a style of a product at one of its places refers to.
pub fn place(records: &mut SectionRecords, shape: Id, whole: &ShapeRecords, place: usize, context: Context) -> Id {
    let representation = records.put("SHAPE_REPRESENTATION", |v| {
        v.text("").ids(&[whole.places[place]]).id(context.context);
    });
    records.put("SHAPE_DEFINITION_REPRESENTATION", |v| {
        v.id(shape).id(representation);
    });
    representation
}
