//! What is read of a file and what is known while it is read: points, directions, frames.

use std::collections::BTreeMap;

use glam::{DMat3, DVec3};

use crate::base::origin::Origin;
use crate::base::tolerance::{PARALLEL, Tolerance};
use crate::base::{limits, math};
use crate::geometry::{Curve, Motion};
use crate::io::cad::base_surface::Base;
use crate::io::cad::defect::{Defect, defect};
use crate::io::cad::part::{ReadOptions, Unusable};
use crate::io::files::fault::Malformed;
use crate::io::step::records::File;
use crate::io::step::units::Units;

/// Curves, surfaces and other things that are made of things of their kind.
pub const NESTED: usize = 32;
/// What may be copied for each byte of the file: an honest file uses each entity a few times.
const COPIES_PER_BYTE: usize = 4;

/// A place with three unit vectors at right angles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// The place, model units.
    pub at: DVec3,
    /// First direction.
    pub x: DVec3,
    /// Second direction.
    pub y: DVec3,
    /// Third direction, the axis.
    pub z: DVec3,
}

impl Frame {
    fn matrix(&self) -> DMat3 {
        DMat3::from_cols(self.x, self.y, self.z)
    }

    /// The motion that takes this frame to another.
    pub fn to(&self, other: &Self) -> Motion {
        Motion::rigid(other.matrix() * self.matrix().transpose(), self.at, other.at)
    }
}

/// A file with the model it comes into.
#[derive(Debug)]
pub struct Step<'f> {
    /// Its records.
    pub file: &'f File<'f>,
    /// The model.
    pub options: ReadOptions,
    /// Of the model.
    pub tolerance: Tolerance,
    /// The import.
    pub origin: Origin,
    /// Units of what is read now.
    pub units: Units,
    /// Model units in one unit of length of what is read now.
    pub scale: f64,
    /// What was repaired or skipped.
    pub warnings: Vec<Malformed>,
    /// Faces, and what holds faces, of which nothing could be made.
    pub unusable: Vec<Unusable>,
    /// Surfaces that are meant beside the last one, where nothing bounds it.
    pub also: Vec<Base>,
    /// What the loops of the face that is made now span at least.
    pub spanned: f64,
    /// What may still be copied.
    left: usize,
    /// Curves of edges made so far, in the units of now.
    pub edges: BTreeMap<u32, Result<Curve, Defect>>,
}

impl<'f> Step<'f> {
    /// Nothing made yet.
    pub fn new(file: &'f File<'f>, options: ReadOptions) -> Self {
        Self {
            file,
            options,
            tolerance: Tolerance::new(0.0, 0.0),
            origin: options.origin,
            units: Units::NONE,
            scale: options.file.unwrap_or(1.0) / options.model,
            warnings: Vec::new(),
            unusable: Vec::new(),
            also: Vec::new(),
            spanned: 0.0,
            left: limits::PART_COPIES + COPIES_PER_BYTE * file.bytes.len(),
            edges: BTreeMap::new(),
        }
    }

    /// Takes `n` from what may be copied: pieces of curves, control points, faces.
    pub fn spend(&mut self, n: usize) -> Result<(), Defect> {
        match self.left.checked_sub(n) {
            Some(left) => {
                self.left = left;
                Ok(())
            }
            None => Err(defect("it repeats other entities more often than a file of this size may")),
        }
    }

    /// Reads in other units from now on.
    pub fn measure_in(&mut self, units: Units) {
        let millimetres = self.options.file.or(units.millimetres).unwrap_or(1.0);
        if units != self.units {
            self.edges.clear();
        }
        self.units = units;
        self.scale = millimetres / self.options.model;
    }

    /// What may lie between two points that the file calls one, model units.
    pub fn slack(&self) -> f64 {
        self.tolerance.point.max(self.units.uncertainty / self.options.model)
    }

    /// The number and name of an entity, for messages.
    pub fn label(&self, k: u32) -> String {
        format!("#{} {}", self.file.id(k), String::from_utf8_lossy(self.file.name(k)))
    }

    /// Says something about an entity, at its line.
    pub fn warn(&mut self, k: u32, what: impl std::fmt::Display) {
        let name = self.file.parameters(k).text(0);
        let name = if name.is_empty() { name } else { format!(" '{name}'") };
        let what = format!("{}{name}: {what}", self.label(k));
        self.warnings.push(Malformed::line(self.file.line(k), what));
    }

    /// Leaves out a face, or what holds faces.
    pub fn unusable(&mut self, k: u32, cause: String) {
        let name = self.file.parameters(k).text(0);
        let name = if name.is_empty() { name } else { format!(" '{name}'") };
        let entity = format!("{}{name}", self.label(k));
        self.unusable.push(Unusable { face: None, entity, line: self.file.line(k), cause, least_area: std::mem::take(&mut self.spanned) });
    }

    /// A length of the model in words, roughly.
    pub fn length(&self, x: f64) -> String {
        format!("{x:.1e} {}", self.options.unit)
    }

    fn three(&self, k: u32, what: &[u8], word: &str) -> Result<DVec3, Defect> {
        let Some(row) = self.file.under(k, what) else { return Err(defect(format!("{} is not a {word}", self.label(k)))) };
        let list = row.list(if self.file.is_complex(k) { 0 } else { 1 })?;
        let mut p = DVec3::ZERO;
        for (axis, value) in list.values().take(3).enumerate() {
            p[axis] = value.number().map_err(|Defect(why)| defect(format!("{}: {why}", self.label(k))))?;
        }
        Ok(p)
    }

    /// A point in model units; one of two coordinates lies in z = 0.
    pub fn point(&self, k: u32) -> Result<DVec3, Defect> {
        Ok(self.three(k, b"CARTESIAN_POINT", "point")? * self.scale)
    }

    /// A unit vector.
    pub fn direction(&self, k: u32) -> Result<DVec3, Defect> {
        let v = self.three(k, b"DIRECTION", "direction")?;
        math::unit(v, 0.0).ok_or_else(|| defect(format!("{} has no length", self.label(k))))
    }

    /// A vector in model units.
    pub fn vector(&self, k: u32) -> Result<DVec3, Defect> {
        let Some(row) = self.file.under(k, b"VECTOR") else { return Err(defect(format!("{} is not a vector", self.label(k)))) };
        Ok(self.direction(row.entity(1)?)? * (row.number(2)? * self.scale))
    }

    /// The point of a vertex.
    pub fn vertex(&self, k: u32) -> Result<DVec3, Defect> {
        let Some(row) = self.file.under(k, b"VERTEX_POINT") else { return Err(defect(format!("{} is not a vertex", self.label(k)))) };
        self.point(row.entity(if self.file.is_complex(k) { 0 } else { 1 })?)
    }

    /// A placement in space or in a plane, or an axis alone.
    pub fn frame(&self, k: u32) -> Result<Frame, Defect> {
        let row = self.file.parameters(k);
        let inside = |Defect(why): Defect| defect(format!("{}: {why}", self.label(k)));
        let at = self.point(row.entity(1).map_err(inside)?)?;
        let direction = |n: usize| row.maybe(n).map_err(inside)?.map(|d| self.direction(d)).transpose();
        let (z, x) = match self.file.name(k) {
            b"AXIS2_PLACEMENT_3D" => (direction(2)?.unwrap_or(DVec3::Z), direction(3)?),
            b"AXIS1_PLACEMENT" => (direction(2)?.unwrap_or(DVec3::Z), None),
            b"AXIS2_PLACEMENT_2D" => (DVec3::Z, direction(2)?),
            _ => return Err(defect(format!("{} is not a placement", self.label(k)))),
        };
        let x = x.and_then(|x| math::unit(x.reject_from_normalized(z), PARALLEL));
        let x = x.unwrap_or_else(|| math::unit(DVec3::X.reject_from_normalized(z), PARALLEL).unwrap_or(DVec3::Y));
        Ok(Frame { at, x, y: z.cross(x), z })
    }
}
