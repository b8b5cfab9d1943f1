//! A closed curve as a ring: about where it lies, and which way round it runs.

use glam::{DQuat, DVec3};

use crate::base::tolerance::PARALLEL;
use crate::network::Chain;

/// Places at which a ring is looked at.
pub const PLACES: usize = 32;
/// Products of cosines below which rings lie beside each other, not behind: then their normals decide which way they run.
const BESIDE: f64 = 0.01;

/// A closed curve from outside.
#[derive(Clone, Copy, Debug)]
pub struct Ring {
    /// The mean of its points.
    pub center: DVec3,
    /// The root of the mean of their squared distances from it, model units.
    pub size: f64,
    /// The unit normal of the area inside, right-handed; 0 where it encloses none.
    normal: DVec3,
}

impl Ring {
    /// Of a closed curve.
    pub fn of(chain: &Chain) -> Self {
        let points: Vec<DVec3> = (0..PLACES).map(|k| chain.point(k as f64 / PLACES as f64)).collect();
        let center = points.iter().sum::<DVec3>() / PLACES as f64;
        let arms: Vec<DVec3> = points.iter().map(|p| *p - center).collect();
        let twice: DVec3 = (0..PLACES).map(|k| arms[k].cross(arms[(k + 1) % PLACES])).sum();
        let squares = arms.iter().map(|arm| arm.length_squared());
        let reach = squares.clone().fold(0.0, f64::max);
        let normal = if twice.length() > PARALLEL * reach { twice.normalize_or_zero() } else { DVec3::ZERO };
        let size = (squares.sum::<f64>() / PLACES as f64).sqrt();
        Self { center, size, normal }
    }

    /// The same run backwards.
    pub fn turned(self) -> Self {
        Self { normal: -self.normal, ..self }
    }

    /// Whether the next ring of a tube runs the other way round; `None` where nothing decides.
    ///
    /// A tube passes both from the same side, however it bends between them. Rings in about one plane run alike where their normals
    /// do.
    pub fn runs_against(&self, next: &Self) -> Option<bool> {
        let way = (next.center - self.center).normalize_or_zero();
        let through = self.normal.dot(way) * next.normal.dot(way);
        let alike = if through.abs() > BESIDE { through } else { self.normal.dot(next.normal) };
        (alike.abs() > PARALLEL).then_some(alike < 0.0)
    }

    /// The least rotation from its plane to that of the next one, both of which run the same way round.
    pub fn rotation_to(&self, next: &Self) -> DQuat {
        if self.normal == DVec3::ZERO || next.normal == DVec3::ZERO {
            return DQuat::IDENTITY;
        }
        if self.normal.dot(next.normal) < -1.0 + PARALLEL {
            // Half a turn in the plane of the way from one to the other.
            let axis = self.normal.cross(next.center - self.center).normalize_or_zero();
            return DQuat::from_xyzw(axis.x, axis.y, axis.z, 0.0);
        }
        DQuat::from_rotation_arc(self.normal, next.normal)
    }
}
