//! Integrals over the outside of a body from which follow its volume, its centre and its water plane, below any plane.
//!
//! By the divergence theorem with fields that vanish in the water plane or do not cross it, so that no lid is needed: with N the
//! area vector outwards, volume = ∫ ζ N_ζ, its moments ∫ ξζ N_ζ, ∫ ηζ N_ζ, ½ ∫ ζ² N_ζ; area of the water plane = −∫ N_ζ and so on.
//! A plane of symmetry needs no face either: nothing crosses it.

use glam::{DMat3, DVec3};

use super::water::Water;

/// Integrals of a whole face: its area, and the area vector times 1, x, y, z, xx, yy, zz, xy, yz, zx of the arm from a fixed point.
pub const WHOLE: usize = 31;
/// Integrals of what is below a water plane, see [`Wet`].
pub const WET: usize = 13;

/// Densities of the integrals of whole faces.
pub fn whole_densities(arm: DVec3, n: DVec3) -> [f64; WHOLE] {
    let (x, y, z) = (arm.x, arm.y, arm.z);
    let factors = [1.0, x, y, z, x * x, y * y, z * z, x * y, y * z, z * x];
    let mut all = [n.length(); WHOLE];
    for (k, f) in factors.into_iter().enumerate() {
        (0..3).for_each(|i| all[1 + 3 * k + i] = f * n[i]);
    }
    all
}

/// Densities of the integrals below a water plane, of a point with its area vector.
pub fn wet_densities(water: &Water, p: DVec3, n: DVec3) -> [f64; WET] {
    let q = water.local(p);
    let (up, along) = (water.up.dot(n), water.forward.dot(n));
    let (x, y, z) = (q.x, q.y, q.z);
    [n.length(), up, x * up, y * up, z * up, x * x * up, x * y * up, y * y * up, x * z * up, y * z * up, z * z * up, along, x * along]
}

/// The integrals below a plane of a face that lies there, from those of the whole face about a point.
pub fn wet_of_whole(m: &[f64; WHOLE], about: DVec3, water: &Water) -> [f64; WET] {
    let vector = |k: usize| DVec3::new(m[1 + 3 * k], m[2 + 3 * k], m[3 + 3 * k]);
    let component = |k: usize, along: DVec3| vector(k).dot(along);
    let o = water.origin - about;
    let (ex, ey, ez) = (water.forward, water.port, water.up);
    let (ox, oy, oz) = (ex.dot(o), ey.dot(o), ez.dot(o));
    let n = component(0, ez);
    let q = DVec3::new(component(1, ez), component(2, ez), component(3, ez));
    let s: [f64; 6] = std::array::from_fn(|k| component(4 + k, ez));
    let second = DMat3::from_cols(DVec3::new(s[0], s[3], s[5]), DVec3::new(s[3], s[1], s[4]), DVec3::new(s[5], s[4], s[2]));
    let (qx, qy, qz) = (ex.dot(q), ey.dot(q), ez.dot(q));
    let product = |a: DVec3, b: DVec3, (oa, qa): (f64, f64), (ob, qb): (f64, f64)| a.dot(second * b) - oa * qb - ob * qa + oa * ob * n;
    let (x, y, z) = ((ox, qx), (oy, qy), (oz, qz));
    let along = component(0, ex);
    let x_along = DVec3::new(component(1, ex), component(2, ex), component(3, ex)).dot(ex) - ox * along;
    [
        m[0],
        n,
        qx - ox * n,
        qy - oy * n,
        qz - oz * n,
        product(ex, ex, x, x),
        product(ex, ey, x, y),
        product(ey, ey, y, y),
        product(ex, ez, x, z),
        product(ey, ez, y, z),
        product(ez, ez, z, z),
        along,
        x_along,
    ]
}

/// What is below a water plane, in its ξ, η, ζ.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wet {
    /// The integrals, as [`wet_densities`] has them.
    pub sums: [f64; WET],
    /// Estimated errors of each.
    pub errors: [f64; WET],
}

impl Wet {
    /// Adds integrals with their errors.
    pub fn add(&mut self, sums: &[f64; WET], errors: &[f64; WET]) {
        for k in 0..WET {
            self.sums[k] += sums[k];
            self.errors[k] += errors[k];
        }
    }

    /// The same of the mirrored body where the plane is its own mirror image: η changes its sign.
    pub fn with_mirror_image(mut self) -> Self {
        for k in 0..WET {
            let odd = matches!(k, 3 | 6 | 9);
            self.sums[k] = if odd { 0.0 } else { 2.0 * self.sums[k] };
            self.errors[k] *= 2.0;
        }
        self
    }

    /// The same with all faces turned.
    pub fn turned(mut self) -> Self {
        (1..WET).for_each(|k| self.sums[k] = -self.sums[k]);
        self
    }

    /// Wetted area, square model units.
    pub fn wetted(&self) -> f64 {
        self.sums[0]
    }

    /// Volume, cubic model units.
    pub fn volume(&self) -> f64 {
        self.sums[4]
    }

    /// The same from the flux along ξ: another sum over the same faces, equal only where they leave nothing open below the plane.
    pub fn volume_along(&self) -> f64 {
        self.sums[12]
    }

    /// ∫ N_ξ: zero where nothing is open below the plane.
    pub fn flux_along(&self) -> f64 {
        self.sums[11]
    }

    /// First moments of the volume, in ξ, η, ζ.
    pub fn moment(&self) -> DVec3 {
        DVec3::new(self.sums[8], self.sums[9], 0.5 * self.sums[10])
    }

    /// Area of the water plane, square model units.
    pub fn plane_area(&self) -> f64 {
        -self.sums[1]
    }

    /// First moments of the water plane, in ξ and η.
    pub fn plane_moment(&self) -> (f64, f64) {
        (-self.sums[2], -self.sums[3])
    }

    /// Second moments of the water plane about the origin of its frame: ξξ, ξη, ηη.
    pub fn plane_inertia(&self) -> [f64; 3] {
        [-self.sums[5], -self.sums[6], -self.sums[7]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A face below the plane has the same integrals by its whole ones and point by point.
    #[test]
    fn whole_faces_and_their_points_agree() {
        let water = Water::at(DVec3::new(3.0, -1.0, 7.0), 0.3, -0.7);
        let about = DVec3::new(-2.0, 5.0, 1.0);
        let points = [(DVec3::new(1.0, 2.0, -3.0), DVec3::new(0.1, -0.4, 0.8)), (DVec3::new(-6.0, 0.5, 2.0), DVec3::new(-1.1, 0.2, 0.3))];
        let (mut whole, mut wet) = ([0.0; WHOLE], [0.0; WET]);
        for (p, n) in points {
            let (a, b) = (whole_densities(p - about, n), wet_densities(&water, p, n));
            (0..WHOLE).for_each(|k| whole[k] += a[k]);
            (0..WET).for_each(|k| wet[k] += b[k]);
        }
        let found = wet_of_whole(&whole, about, &water);
        assert!(found.iter().zip(wet).all(|(a, b)| (a - b).abs() < 1e-12 * (1.0 + b.abs())), "{found:?}\n{wet:?}");
    }
}
