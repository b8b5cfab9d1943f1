//! One place of a ball that touches two surfaces.

use glam::{DVec2, DVec3};

use crate::base::solve;
use crate::surface::closest::foot::step;
use crate::surface::data::jet::{slopes, unit_normal};
use crate::surface::rolling::face::Face;

/// Where a ball touches.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BallStation {
    /// Its centre.
    pub center: DVec3,
    /// Places on both surfaces.
    pub uv: [DVec2; 2],
    /// The points there.
    pub feet: [DVec3; 2],
    /// Unit direction in which the centre travels.
    pub way: DVec3,
    /// Derivatives of the points by the length of the centre's way.
    pub rates: [DVec3; 2],
}

impl BallStation {
    /// Mean length that the centre and both points go per length of the centre's way.
    pub fn speed(&self) -> f64 {
        (1.0 + self.rates[0].length() + self.rates[1].length()) / 3.0
    }

    /// Looks the other way.
    pub fn turn(&mut self) {
        (self.way, self.rates) = (-self.way, self.rates.map(|r| -r));
    }
}

/// Which one of the balls.
pub(crate) enum Place {
    /// The one with its centre in a plane: a point of it, and its normal on the side to which the centre travels.
    Plane(DVec3, DVec3),
    /// The one that touches surface `face` on a line of constant u (`axis` 0) or v (1); the centre travels about in direction `along`.
    Line { face: usize, axis: usize, at: f64, along: DVec3 },
}

impl Place {
    /// What is missed, and its derivatives by the places on both surfaces (u, v of the first, u, v of the second).
    fn miss(&self, [x, y]: [&Raised; 2], uv: &[DVec2; 2]) -> (f64, [f64; 4]) {
        match *self {
            Self::Plane(p, normal) => ((x.center - p).dot(normal), [x.cu.dot(normal), x.cv.dot(normal), 0.0, 0.0]),
            Self::Line { face, axis, at, .. } => {
                // In lengths, as the other conditions are.
                let raised = if face == 0 { x } else { y };
                let scale = if axis == 0 { raised.du } else { raised.dv }.length();
                let mut row = [0.0; 4];
                row[2 * face + axis] = scale;
                ((uv[face][axis] - at) * scale, row)
            }
        }
    }

    fn along(&self) -> DVec3 {
        match *self {
            Self::Plane(_, normal) => normal,
            Self::Line { along, .. } => along,
        }
    }
}

/// Half a ball's condition: the centre at a distance from a surface, with its derivatives.
struct Raised {
    p: DVec3,
    normal: DVec3,
    du: DVec3,
    dv: DVec3,
    center: DVec3,
    cu: DVec3,
    cv: DVec3,
}

fn raised(face: &Face, uv: DVec2, radius: f64) -> Option<Raised> {
    let jet = face.jet(uv);
    let normal = unit_normal(&jet)?;
    let (nu, nv) = slopes(&jet)?;
    let d = face.side * radius;
    Some(Raised { p: jet.p, normal, du: jet.du, dv: jet.dv, center: jet.p + normal * d, cu: jet.du + nu * d, cv: jet.dv + nv * d })
}

/// The ball at a place, from guesses of where it touches; none where Newton's method finds none.
pub(crate) fn station(faces: &[Face; 2], radius: f64, place: &Place, guess: [DVec2; 2], rounding: f64) -> Option<BallStation> {
    const STEPS: usize = 24;
    /// What is left over after the last step, in roundings.
    const LEFT: f64 = 256.0;
    let mut uv = [faces[0].hold(guess[0]), faces[1].hold(guess[1])];
    let mut best: Option<(f64, [DVec2; 2])> = None;
    for _ in 0..STEPS {
        let (x, y) = (raised(&faces[0], uv[0], radius)?, raised(&faces[1], uv[1], radius)?);
        let apart = x.center - y.center;
        let (off, row) = place.miss([&x, &y], &uv);
        let miss = apart.length().max(off.abs());
        match best {
            // No longer nearer: rounding, or no such ball.
            Some((least, _)) if least <= LEFT * rounding && miss >= 0.5 * least => break,
            Some((least, _)) if miss >= least => {}
            _ => best = Some((miss, uv)),
        }
        let mut rows = [0.0; 16];
        for (k, (columns, sign)) in [((x.cu, x.cv), 1.0), ((y.cu, y.cv), -1.0)].into_iter().enumerate() {
            for (j, column) in [columns.0, columns.1].into_iter().enumerate() {
                for (i, value) in column.to_array().into_iter().enumerate() {
                    rows[4 * i + 2 * k + j] = sign * value;
                }
            }
        }
        rows[12..].copy_from_slice(&row);
        let mut right = [-apart.x, -apart.y, -apart.z, -off];
        if !solve::dense(&mut rows, &mut right) || right.iter().any(|x| !x.is_finite()) {
            return None;
        }
        uv = [faces[0].hold(uv[0] + DVec2::new(right[0], right[1])), faces[1].hold(uv[1] + DVec2::new(right[2], right[3]))];
    }
    let (_, uv) = best.filter(|(miss, _)| *miss <= LEFT * rounding)?;
    let (x, y) = (raised(&faces[0], uv[0], radius)?, raised(&faces[1], uv[1], radius)?);
    let across = x.normal.cross(y.normal).try_normalize()?;
    let way = if across.dot(place.along()) < 0.0 { -across } else { across };
    let rate = |r: &Raised| step(r.cu, r.cv, way).map(|s| r.du * s.x + r.dv * s.y);
    Some(BallStation { center: 0.5 * (x.center + y.center), uv, feet: [x.p, y.p], way, rates: [rate(&x)?, rate(&y)?] })
}
