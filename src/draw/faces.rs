//! Surfaces as triangles fine enough for the picture: each patch by itself, with its own normals.

use glam::DVec3;

use super::scene::{Paint, Sheet};
use crate::base::par;
use crate::model::{Model, Patch, SurfaceId};
use crate::surface::{Domain, Jet2, OneSided, Surface};

/// Places along each direction where a patch is asked how much it bends.
pub(super) const MAX_SAMPLES: usize = 9;
/// Most steps along each direction of a patch.
pub(super) const MOST: usize = 400;

/// What each point of a sheet shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Show {
    /// Nothing but light.
    Light,
    /// A curvature with its sign.
    Curvature(Bend),
    /// Gauss and mean curvature beside light, at the points that light needs.
    Bends,
    /// Reflections, which need normals close together.
    Stripes,
}

/// Which curvature is shown. Those by length are above zero where the surface bends away from its normal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bend {
    /// The larger of the two principal ones, 1/model unit.
    Principal,
    /// Half the sum of the two, 1/model unit.
    Mean,
    /// Their product, 1/model unit².
    Gauss,
}

impl Show {
    /// Least steps of a patch that is bent: what is shown between points is as smooth as they are dense.
    pub(super) fn least(self) -> usize {
        match self {
            Self::Light | Self::Bends => 4,
            Self::Curvature(_) => 32,
            Self::Stripes => 96,
        }
    }
}

/// The patches of a surface as sheets; `fine` is how far a triangle may be from the surface, model units.
pub fn surface(model: &Model, id: SurfaceId, flipped: bool, fine: f64, show: Show) -> Vec<Sheet> {
    let named = &model.surfaces[id.index()];
    let patches: Vec<&Patch> = model.patches_of(id).map(|p| &model.patches[p.index()]).collect();
    par::map(patches.len(), |k| {
        let mut sheet = patch(&named.surface, patches[k], fine, show);
        sheet.name = named.name.clone();
        if flipped {
            sheet.normals.iter_mut().for_each(|n| *n = -*n);
            // Seen from the other side a valley is a hill.
            sheet.bends.iter_mut().for_each(|bend| bend[1] = -bend[1]);
            sheet.triangles.iter_mut().for_each(|t| t.swap(1, 2));
        }
        sheet
    })
}

/// One patch as a sheet without a name.
pub fn patch(surface: &Surface, patch: &Patch, fine: f64, show: Show) -> Sheet {
    match surface.domain() {
        Domain::Loop => super::trimmed::sheet(surface, fine, show),
        Domain::Triangle => triangle(surface, fine, show),
        Domain::Square | Domain::Unbounded => square(surface, patch, fine, show),
    }
}

/// A sheet without a name, with what its points show beside light.
pub(super) fn shown(sheet: (Vec<DVec3>, Vec<DVec3>, Vec<[u32; 3]>), show: Show, jet: &mut dyn FnMut(usize) -> Jet2) -> Sheet {
    let (points, normals, triangles) = sheet;
    let (mut paint, mut bends) = (Paint::Even(super::color::FACE), Vec::new());
    match show {
        Show::Light | Show::Stripes => {}
        Show::Curvature(bend) => {
            paint = Paint::OfPoints(normals.iter().enumerate().map(|(k, n)| curvature(&jet(k), *n, bend) as f32).collect());
        }
        Show::Bends => {
            let both = |(k, n): (usize, &DVec3)| {
                let jet = jet(k);
                [Bend::Gauss, Bend::Mean].map(|bend| curvature(&jet, *n, bend) as f32)
            };
            bends = normals.iter().enumerate().map(both).collect();
        }
    }
    Sheet { name: String::new(), points, normals, triangles, edges: Vec::new(), paint, bends }
}

/// Places between two parameters, each leaning into the range.
fn places((low, high): (f64, f64), n: usize) -> Vec<(f64, OneSided)> {
    let at = |k: usize| if k == n { (high, OneSided::Before) } else { (low + (high - low) * k as f64 / n as f64, OneSided::After) };
    (0..=n).map(at).collect()
}

/// Steps along u and v that keep the distance of triangles from the surface.
fn steps(jets: &[Jet2], (du, dv): (f64, f64), fine: f64, show: Show) -> (usize, usize) {
    let largest = |of: &dyn Fn(&Jet2) -> f64| jets.iter().map(of).filter(|x| x.is_finite()).fold(0.0, f64::max);
    // A chord of a bend a over h is a·h²/8 away; the twist adds to both directions.
    let twist = largest(&|j| j.duv.length()) * du * dv;
    let n = |bend: f64| {
        let n = ((bend + twist) / (8.0 * fine)).sqrt().ceil().min(MOST as f64) as usize;
        if n <= 1 { 1 } else { n.max(show.least()) }
    };
    (n(largest(&|j| j.duu.length()) * du * du), n(largest(&|j| j.dvv.length()) * dv * dv))
}

fn square(surface: &Surface, patch: &Patch, fine: f64, show: Show) -> Sheet {
    let look = surface.jets(&places(patch.u, MAX_SAMPLES - 1), &places(patch.v, MAX_SAMPLES - 1));
    let (nu, nv) = steps(&look, (patch.u.1 - patch.u.0, patch.v.1 - patch.v.0), fine, show);
    let (us, vs) = (places(patch.u, nu), places(patch.v, nv));
    let jets = surface.jets(&us, &vs);
    let normal = |k: usize| {
        let ((u, lu), (v, lv)) = (us[k % us.len()], vs[k / us.len()]);
        let cross = jets[k].du.cross(jets[k].dv);
        let scale = jets[k].du.length() * jets[k].dv.length();
        // Where the cross product all but vanishes (a pole) the surface knows better.
        if cross.length() > crate::base::tolerance::PARALLEL * scale && scale > 0.0 {
            cross.normalize()
        } else {
            surface.normal_one_sided(u, v, (lu, lv))
        }
    };
    let normals: Vec<DVec3> = (0..jets.len()).map(normal).collect();
    let at = |i: usize, j: usize| (j * (nu + 1) + i) as u32;
    let mut triangles = Vec::with_capacity(2 * nu * nv);
    for j in 0..nv {
        for i in 0..nu {
            triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    shown((jets.iter().map(|j| j.p).collect(), normals, triangles), show, &mut |k| jets[k])
}

/// A curvature; not a number where the surface is singular.
pub fn curvature(jet: &Jet2, normal: DVec3, bend: Bend) -> f64 {
    let (mean, spread) = jet.curvatures(normal);
    // Bending towards the normal is a valley seen from its side.
    match bend {
        Bend::Principal if mean >= 0.0 => -(mean + spread),
        Bend::Principal => spread - mean,
        Bend::Mean => -mean,
        Bend::Gauss => (mean - spread) * (mean + spread),
    }
}

fn triangle(surface: &Surface, fine: f64, show: Show) -> Sheet {
    let inner: Vec<Jet2> = (0..MAX_SAMPLES)
        .flat_map(|j| (0..MAX_SAMPLES - j).map(move |i| (i, j)))
        .map(|(i, j)| jet_of(surface, i, j, MAX_SAMPLES - 1))
        .collect();
    let (a, b) = steps(&inner, (1.0, 1.0), fine, show);
    let n = a.max(b);
    let index = |i: usize, j: usize| (j * (n + 1) - j * j.saturating_sub(1) / 2 + i) as u32;
    let (mut points, mut normals, mut jets, mut triangles) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for j in 0..=n {
        for i in 0..=n - j {
            let jet = jet_of(surface, i, j, n);
            let normal = surface.normal(i as f64 / n as f64, j as f64 / n as f64);
            points.push(jet.p);
            normals.push(normal);
            jets.push(jet);
            if i + j < n {
                triangles.push([index(i, j), index(i + 1, j), index(i, j + 1)]);
            }
            if i + j + 1 < n {
                triangles.push([index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)]);
            }
        }
    }
    shown((points, normals, triangles), show, &mut |k| jets[k])
}

fn jet_of(surface: &Surface, i: usize, j: usize, n: usize) -> Jet2 {
    surface.jet(i as f64 / n as f64, j as f64 / n as f64)
}
