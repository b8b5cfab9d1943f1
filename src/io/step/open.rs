//! Files read as far as their records and the places of their products, and the box that holds them.

use std::collections::BTreeMap;

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::io::cad::part::ReadOptions;
use crate::io::files::fault::Malformed;
use crate::io::step::assembly::{Assembly, assembly};
use crate::io::step::part21;
use crate::io::step::reader::Step;
use crate::io::step::records::File;
use crate::io::step::units::Units;

/// A file read as far as its records and the places of its products, no geometry yet.
#[derive(Debug)]
pub struct OpenedStep<'b> {
    pub(super) file: File<'b>,
    pub(super) options: ReadOptions,
    pub(super) assembly: Assembly,
    pub(super) warnings: Vec<Malformed>,
}

/// Reads a file, or says where it stops being one.
pub fn open<'b>(bytes: &'b [u8], options: &ReadOptions) -> Result<OpenedStep<'b>, Malformed> {
    let mut file = part21::read(bytes)?;
    if file.records.is_empty() {
        let why = file.warnings.first().map_or(String::new(), |w| format!(": {}", w.what));
        return Err(Malformed::line(1, format!("the file holds no entity that can be read{why}")));
    }
    let mut warnings = std::mem::take(&mut file.warnings);
    let mut step = Step::new(&file, *options);
    let assembly = assembly(&mut step);
    warnings.append(&mut step.warnings);
    if assembly.placed.is_empty() {
        warnings.push(Malformed::line(1, "the file has no shapes: no shape representation has an item"));
    }
    Ok(OpenedStep { file, options: *options, assembly, warnings })
}

impl OpenedStep<'_> {
    /// A box that holds about all that is shown, model units: for the tolerance of the model.
    pub fn reach(&self) -> Box3 {
        let mut step = Step::new(&self.file, self.options);
        let mut boxes: Vec<(u32, Units, Box3)> = Vec::new();
        let mut known: BTreeMap<u32, usize> = BTreeMap::new();
        let mut seen = vec![u32::MAX; self.file.records.len()];
        let mut reach = Box3::EMPTY;
        for placed in &self.assembly.placed {
            let k = match known.get(&placed.item).filter(|k| boxes[**k].1 == placed.units) {
                Some(k) => *k,
                None => {
                    step.measure_in(placed.units);
                    let own = step.reach(placed.item, &mut seen, boxes.len() as u32);
                    boxes.push((placed.item, placed.units, own));
                    known.insert(placed.item, boxes.len() - 1);
                    boxes.len() - 1
                }
            };
            let own = boxes[k].2;
            if !own.is_empty() {
                let corner = |k: usize| {
                    let pick = |bit: usize, low: f64, high: f64| if k >> bit & 1 == 0 { low } else { high };
                    DVec3::new(pick(0, own.min.x, own.max.x), pick(1, own.min.y, own.max.y), pick(2, own.min.z, own.max.z))
                };
                reach = (0..8).fold(reach, |reach, k| reach.with(placed.motion.point(corner(k))));
            }
        }
        reach
    }
}
