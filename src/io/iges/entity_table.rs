//! All entities of a file in memory, and the curves made of them so far.

use std::collections::BTreeMap;

use glam::DAffine3;

use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::geometry::Curve;
use crate::io::cad::defect::{Defect, defect};
use crate::io::cad::part::ReadOptions;
use crate::io::files::fault::Malformed;
use crate::io::iges::entity_data::{Data, Decoded, Pointer};
use crate::io::iges::entity_decode::decode;
use crate::io::iges::params::ParameterReader;
use crate::io::iges::records::{Entry, Records};

/// Matrices, composites, groups inside each other.
pub const NESTED: usize = 32;
/// What pieces and control points may be copied, per byte of the file: an honest file copies each a few times.
const COPIES_PER_BYTE: usize = 4;
/// What may be copied in any case.
const COPIES: usize = 1 << 20;

/// Kinds of entities that are lists: what stands behind those is lost.
const LISTS: &[u32] = &[141, 143, 144, 184, 186, 308, 502, 504, 508, 510, 514];

/// Entities by pointer, with what was made of them.
#[derive(Debug)]
pub struct EntityTable {
    /// Directory entries.
    pub entries: Vec<Entry>,
    /// Their parameters, in the same order.
    pub decoded: Vec<Decoded>,
    /// Line of the parameters of each.
    lines: Vec<u64>,
    places: BTreeMap<Pointer, usize>,
    /// Model units in one unit of the file.
    pub scale: f64,
    /// Unit of the file in words.
    pub unit: &'static str,
    /// Unit of the model in words.
    pub model_unit: &'static str,
    /// Of the model.
    pub tolerance: Tolerance,
    /// What the file calls one point, model units.
    resolution: f64,
    /// The import.
    pub origin: Origin,
    /// What was repaired or skipped.
    pub warnings: Vec<Malformed>,
    /// Curves made so far, in space and in (u, v).
    pub(super) curves: BTreeMap<(Pointer, bool), Result<Curve, Defect>>,
    /// The largest distance of a vertex from the curve of its edge, beyond what the file calls one point, with that curve.
    pub(super) vertex_off: Option<(f64, Pointer)>,
    /// Copies still allowed.
    left: usize,
}

impl EntityTable {
    /// Reads the parameters of all entities; `bytes` is the size of the file.
    pub fn new(records: Records, bytes: usize, options: &ReadOptions) -> Self {
        let scale = options.file.unwrap_or(records.global.millimetres) / options.model;
        let mut table = Self {
            entries: Vec::new(),
            decoded: Vec::with_capacity(records.entries.len()),
            lines: Vec::with_capacity(records.entries.len()),
            places: BTreeMap::new(),
            scale,
            unit: records.global.unit,
            model_unit: options.unit,
            tolerance: Tolerance::new(0.0, 0.0),
            resolution: records.global.resolution * scale,
            origin: options.origin,
            warnings: Vec::new(),
            curves: BTreeMap::new(),
            vertex_off: None,
            left: COPIES + COPIES_PER_BYTE * bytes,
        };
        let mut spilled = (0, 0);
        for k in 0..records.entries.len() {
            let parameters = records.parameters(k);
            if parameters.spilled > 0 {
                spilled = (spilled.0 + parameters.spilled, if spilled.0 == 0 { parameters.line } else { spilled.1 });
            }
            table.lines.push(parameters.line);
            let entry = &records.entries[k];
            let decoded = read_one(entry, &parameters.text, &parameters.list);
            if let Ok((_, Some(note))) = &decoded {
                table.warnings.push(Malformed::line(parameters.line, format!("{}: {note}", named(entry))));
            }
            table.decoded.push(match decoded {
                Ok((decoded, _)) => decoded,
                Err(Defect(what)) => {
                    table.warnings.push(Malformed::line(parameters.line, format!("{} is skipped: {what}", named(entry))));
                    Decoded { data: Data::Damaged, properties: Vec::new() }
                }
            });
            table.places.insert(entry.d, k);
        }
        if spilled.0 > 0 {
            let what = format!("{} lines of parameters have a separator in column 65, which must be blank; it is read", spilled.0);
            table.warnings.push(Malformed::line(spilled.1, what));
        }
        let Records { entries, warnings, .. } = records;
        table.entries = entries;
        table.warnings.splice(0..0, warnings);
        table
    }

    /// Index of the entity that a pointer means.
    pub fn place(&self, d: Pointer) -> Result<usize, Defect> {
        match self.places.get(&d) {
            Some(k) => Ok(*k),
            None if d == 0 => Err(defect("a pointer is missing")),
            None => Err(defect(format!("there is no entity D{d}"))),
        }
    }

    /// What an entity is.
    pub fn data(&self, d: Pointer) -> Result<&Data, Defect> {
        self.place(d).map(|k| &self.decoded[k].data)
    }

    /// Its entry.
    pub fn entry(&self, d: Pointer) -> Option<&Entry> {
        self.places.get(&d).map(|k| &self.entries[*k])
    }

    /// Type and directory line of an entity, for messages.
    pub fn label(&self, d: Pointer) -> String {
        self.entry(d).map_or_else(|| format!("D{d}"), named)
    }

    /// Line of the file where the parameters of an entity start.
    pub fn line(&self, d: Pointer) -> u64 {
        self.places.get(&d).map_or(0, |k| self.lines[*k])
    }

    /// Says something about an entity, at its parameters.
    pub fn warn(&mut self, d: Pointer, what: impl std::fmt::Display) {
        let line = self.line(d);
        let what = format!("{}: {what}", self.label(d));
        self.warnings.push(Malformed::line(line, what));
    }

    /// A length of the model in words, roughly.
    pub fn length(&self, x: f64) -> String {
        format!("{x:.1e} {}", self.model_unit)
    }

    /// What may lie between two points that the file calls one, model units.
    pub fn slack(&self) -> f64 {
        self.tolerance.point.max(self.resolution)
    }

    /// Takes `n` from what may be copied.
    pub fn copy(&mut self, n: usize) -> Result<(), Defect> {
        match self.left.checked_sub(n) {
            Some(left) => {
                self.left = left;
                Ok(())
            }
            None => Err(defect("it repeats other entities more often than a file of this size may")),
        }
    }

    /// The placement of an entity in model units: its matrix, then the matrix of that one, and so on.
    pub fn placement(&self, mut matrix: Pointer) -> Result<Option<DAffine3>, Defect> {
        let mut whole: Option<DAffine3> = None;
        for _ in 0..NESTED {
            if matrix == 0 {
                return Ok(whole.filter(|m| *m != DAffine3::IDENTITY));
            }
            let Data::Matrix(m) = self.data(matrix)? else {
                return Err(defect(format!("its matrix is {}, which is not a matrix", self.label(matrix))));
            };
            let m = DAffine3 { translation: m.translation * self.scale, ..*m };
            whole = Some(whole.map_or(m, |inner| m * inner));
            matrix = self.entry(matrix).map_or(0, |e| e.transform);
        }
        Err(defect("its matrices point at each other in a circle, or are nested too deep"))
    }
}

/// Type and directory line of an entity.
fn named(entry: &Entry) -> String {
    format!("entity {} at D{}", entry.kind, entry.d)
}

/// An entity with a remark about how its values were written.
type Noted = (Decoded, Option<String>);

fn read_one(entry: &Entry, text: &[u8], list: &crate::io::iges::params::Tokens) -> Result<Noted, Defect> {
    let mut reader = ParameterReader::new(text, list);
    if list.tokens.is_empty() {
        return Err(defect("it has no parameters"));
    }
    let kind = reader.int("entity type")?;
    if kind != i64::from(entry.kind) {
        return Err(defect(format!("its parameters are those of an entity {kind}")));
    }
    let decoded = decode(entry, &mut reader)?;
    let note = if reader.is_uncounted() && LISTS.contains(&entry.kind) {
        Some("more values follow than its counts say; they are not read".to_owned())
    } else if !list.ended {
        Some("the values end without the separator of records".to_owned())
    } else {
        list.miscounted.first().map(|k| format!("value {} is a text that is not as long as stated", k + 1))
    };
    Ok((decoded, note))
}
