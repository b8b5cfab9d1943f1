//! Hydrostatic particulars of a body at a position in the water.

use glam::DVec3;

use super::body::Body;
use super::outline::Outline;
use super::sums::Wet;
use super::water::Water;
use crate::base::fault::Result;
use crate::base::tolerance::NUDGE;

/// A position of a body, and what its particulars refer to. The model's x runs forward, y to port, z up; lengths in model units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Position {
    /// Distance of the water plane from the base line at midship, square to the water.
    pub depth: f64,
    /// Trim by the stern, radians: positive with the end of small x deeper.
    pub trim: f64,
    /// Heel to starboard, radians: positive with the side of negative y deeper.
    pub heel: f64,
    /// z of the base line, from which drafts and heights are counted.
    pub base: f64,
    /// x of midship.
    pub midship: f64,
}

impl Position {
    /// The same with the water at a height over the base line, at midship on the centre line.
    pub fn with_draft(self, draft: f64) -> Self {
        Self { depth: draft * self.water().up.z, ..self }
    }

    /// Height of the water plane over the base line, at midship on the centre line; `None` where it is parallel to that.
    pub fn draft(&self) -> Option<f64> {
        let rise = self.water().up.z;
        (rise.abs() > NUDGE).then(|| self.depth / rise)
    }

    /// The water plane.
    pub fn water(&self) -> Water {
        let level = Water::at(self.keel(), self.trim, self.heel);
        Water { origin: level.origin + level.up * self.depth, ..level }
    }

    /// The point of the base line at midship.
    pub fn keel(&self) -> DVec3 {
        DVec3::new(self.midship, 0.0, self.base)
    }
}

/// What a body has in the water. Lengths, areas, volumes in powers of model units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Particulars {
    /// Volume below the water.
    pub volume: f64,
    /// Estimated error of the volume.
    pub volume_error: f64,
    /// Area of the outside below the water.
    pub wetted: f64,
    /// Estimated error of the wetted area.
    pub wetted_error: f64,
    /// Centre of buoyancy, in the model's coordinates.
    pub buoyancy: DVec3,
    /// Area of the water plane.
    pub plane_area: f64,
    /// Estimated error of the area of the water plane.
    pub plane_error: f64,
    /// Centre of flotation: of the water plane, in the model's coordinates.
    pub flotation: DVec3,
    /// Second moments of the water plane about its centre: across (for heel) and along (for trim).
    pub inertia: (f64, f64),
    /// Estimated errors of these.
    pub inertia_error: (f64, f64),
    /// Distance of the centre of buoyancy from the keel, upright to the water.
    pub kb: f64,
    /// How far the waterline reaches.
    pub outline: Option<Outline>,
    /// Area of the cross section at midship below the water.
    pub midship_area: f64,
}

impl Particulars {
    /// Distances of the metacentres for heel and for trim over the centre of buoyancy.
    pub fn bm(&self) -> (f64, f64) {
        (self.inertia.0 / self.volume, self.inertia.1 / self.volume)
    }
}

/// The particulars of a body at a position.
pub fn particulars(body: &Body, position: &Position) -> Result<Particulars> {
    let water = position.water();
    let wet = body.wet(&water)?;
    let flotation = center_of_plane(&wet, &water);
    let buoyancy = center_of_buoyancy(&wet, &water);
    let (area, (mx, my)) = (wet.plane_area(), wet.plane_moment());
    let [xx, _, yy] = wet.plane_inertia();
    let about = |second: f64, first: f64| if area > 0.0 { second - first * first / area } else { 0.0 };
    Ok(Particulars {
        volume: wet.volume(),
        volume_error: wet.errors[4].max((wet.volume() - wet.volume_along()).abs()),
        wetted: wet.wetted(),
        wetted_error: wet.errors[0],
        buoyancy,
        plane_area: area,
        plane_error: wet.errors[1],
        flotation,
        inertia: (about(yy, my), about(xx, mx)),
        inertia_error: (wet.errors[7], wet.errors[5]),
        kb: water.up.dot(buoyancy - position.keel()),
        outline: body.outline(&water),
        midship_area: body.section_area(position.midship, &water),
    })
}

/// Centre of the volume, in the model's coordinates; the origin of the plane where there is none.
pub fn center_of_buoyancy(wet: &Wet, water: &Water) -> DVec3 {
    let volume = wet.volume();
    water.global(if volume > 0.0 { wet.moment() / volume } else { DVec3::ZERO })
}

fn center_of_plane(wet: &Wet, water: &Water) -> DVec3 {
    let (area, (x, y)) = (wet.plane_area(), wet.plane_moment());
    water.global(if area > 0.0 { DVec3::new(x / area, y / area, 0.0) } else { DVec3::ZERO })
}
