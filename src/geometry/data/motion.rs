//! Motions that keep shape: translation, rotation, mirror and uniform scale.

use glam::{DAffine3, DMat3, DVec3};

use crate::base::math;

/// A similarity of space: rotation or mirror, uniform scale, then translation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    affine: DAffine3,
    scale: f64,
    mirrors: bool,
}

impl Motion {
    /// Translation by `by`, model units.
    pub fn translation(by: DVec3) -> Self {
        Self { affine: DAffine3::from_translation(by), scale: 1.0, mirrors: false }
    }

    /// Rotation by `angle` radians about the unit vector `axis` through `about`.
    pub fn rotation(about: DVec3, axis: DVec3, angle: f64) -> Self {
        let (s, c) = math::sin_cos(angle);
        // Rodrigues' formula keeps quarter turns exact.
        let column = |v: DVec3| v * c + axis.cross(v) * s + axis * axis.dot(v) * (1.0 - c);
        let matrix = DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z));
        Self { affine: DAffine3::from_mat3_translation(matrix, about - matrix * about), scale: 1.0, mirrors: false }
    }

    /// The rotation of an orthonormal matrix that takes one point to another.
    pub fn rigid(rotation: DMat3, from: DVec3, to: DVec3) -> Self {
        Self { affine: DAffine3::from_mat3_translation(rotation, to - rotation * from), scale: 1.0, mirrors: false }
    }

    /// Uniform scale by `by > 0` about a fixed point.
    pub fn scaling(about: DVec3, by: f64) -> Self {
        Self {
            affine: DAffine3::from_mat3_translation(DMat3::from_diagonal(DVec3::splat(by)), about * (1.0 - by)),
            scale: by,
            mirrors: false,
        }
    }

    /// Mirror in the plane through `at` with unit normal `normal`.
    pub fn mirror(at: DVec3, normal: DVec3) -> Self {
        let column = |v: DVec3| v - normal * (2.0 * normal.dot(v));
        let matrix = DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z));
        Self { affine: DAffine3::from_mat3_translation(matrix, normal * (2.0 * normal.dot(at))), scale: 1.0, mirrors: true }
    }

    /// First this motion, then `next`.
    pub fn then(&self, next: &Self) -> Self {
        Self { affine: next.affine * self.affine, scale: self.scale * next.scale, mirrors: self.mirrors != next.mirrors }
    }

    /// The motion back.
    pub fn inverse(&self) -> Self {
        let matrix = self.affine.matrix3.transpose() * (1.0 / (self.scale * self.scale));
        let translation = -(matrix * self.affine.translation);
        Self { affine: DAffine3 { matrix3: matrix, translation }, scale: 1.0 / self.scale, mirrors: self.mirrors }
    }

    /// The same where lengths are given in units of this size.
    pub fn in_units(&self, size: f64) -> Self {
        let affine = DAffine3 { translation: self.affine.translation / size, ..self.affine };
        Self { affine, ..*self }
    }

    /// The image of a point.
    pub fn point(&self, p: DVec3) -> DVec3 {
        self.affine.transform_point3(p)
    }

    /// The image of a derivative or direction (no translation).
    pub fn vector(&self, v: DVec3) -> DVec3 {
        self.affine.transform_vector3(v)
    }

    /// Ratio of lengths after to lengths before.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// Whether it turns left into right.
    pub fn mirrors(&self) -> bool {
        self.mirrors
    }
}
