//! Nearest points of surfaces are no farther than any other point of them: creases, seams, poles of a stretch, folds, sharp bends of
//! swept profiles and holes.

use glam::DVec3;
use lofting::session::disk::{Disk, Outputs};
use lofting::surface::{Domain, Nearest, Surface};

use crate::support::random::Random;
use crate::support::script;

const MODEL: &str = "
units mm
let skirt = polyline([(0, 0, 0), (0, -10, 0), (0, -8, 30), (0, 0, 30)])
let ring = polyline([(0, 0, 0), (100, 0, 0), (100, 80, 0), (0, 80, 0)], closed: true)
surface frame = along(skirt, ring, corner: round)
let way = polyline([(0, 0, 0), (100, 0, 0), (100, 80, 0)])
surface pipe = along(circle(center: (0, 0, 0), radius: 5, normal: (1, 0, 0)), way, corner: round)
surface mitred = along(circle(center: (0, 0, 0), radius: 5, normal: (1, 0, 0)), way, corner: miter)
let coil = helix(center: (0, 0, 0), start: (20, 0, 0), pitch: 10mm, turns: 2, axis: (0, 0, 1))
surface spring = along(circle(center: coil.start, radius: 2mm, normal: (0, 1, 0)), coil)
let teeth = polyline([for i in 0..12: (i * 5mm, mod(i, 2) * 20mm, 0)])
surface comb = extrude(teeth, by: (0, 0, 30))
surface torus = revolve(circle(center: (30, 0, 0), radius: 8, normal: (0, 1, 0)))
let wave = spline([for i in 0..8: (i * 10mm, mod(i, 2) * 15mm, 0)])
surface sheet = extrude(wave, by: (0, 0, 60))
surface holed = trim(sheet, holes: [
  project(circle(center: (20, 0, 30), radius: 12, normal: (0, 1, 0)), onto: sheet, along: (0, 1, 0))
])
let parabola = bezier([(240, -31, 0), (-240, 0, 0), (240, 31, 0)])
surface leaning = extrude(parabola, by: (20, 90, 10))
surface bowl = revolve(bezier([(30, 0, 0), (90, 0, 5), (10, 0, 40), (60, 0, 50)]), angle: 250deg)
mesh frame_mesh of frame { size: 20mm, method: delaunay }
mesh pipe_mesh of pipe { size: 20mm, method: mapped }
mesh mitred_mesh of mitred { size: 20mm, method: mapped }
mesh spring_mesh of spring { size: 20mm, method: mapped }
mesh comb_mesh of comb { size: 20mm, method: mapped }
mesh torus_mesh of torus { size: 20mm, method: mapped }
mesh sheet_mesh of sheet { size: 20mm, method: mapped }
mesh leaning_mesh of leaning { size: 20mm, method: mapped }
mesh bowl_mesh of bowl { size: 20mm, method: mapped }
mesh holed_mesh of holed { size: 5mm, method: delaunay }
";

/// Points of a surface on a fine grid of parameters.
fn points(surface: &Surface) -> Vec<DVec3> {
    const FINE: u32 = 160;
    let at = |k: u32| f64::from(k) / f64::from(FINE);
    let each = (0..=FINE).flat_map(|i| (0..=FINE).map(move |j| (at(i), at(j))));
    each.filter(|(u, v)| surface.domain() != Domain::Loop || surface.keeps(*u, *v)).map(|(u, v)| surface.point(u, v)).collect()
}

#[test]
fn no_other_point_is_nearer() {
    let disk = Disk::new(None, None, &[], Outputs::Counted).unwrap();
    let outcome = script::outcome("nearest.loft", MODEL.as_bytes(), &[], &disk);
    assert_eq!(outcome.meshes.len(), 10, "{:?}", outcome.report.meshes.len());
    let mut random = Random(7);
    for (name, mesh) in &outcome.meshes {
        let surface = &mesh.geometries.0[0].surface;
        let (near, all) = (Nearest::new(surface), points(surface));
        assert!(all.len() > 1000, "{name}");
        let (low, high) = all.iter().fold((DVec3::MAX, DVec3::MIN), |(low, high), p| (low.min(*p), high.max(*p)));
        let size = low.distance(high);
        for case in 0..400 {
            // Anywhere in the box and a little round it, on the surface, and beside it.
            let share = DVec3::new(random.share(), random.share(), random.share());
            let anywhere = low + (high - low) * (share * 1.4 - 0.2);
            let on = all[random.below(all.len())];
            let p = match case % 3 {
                0 => anywhere,
                1 => on,
                _ => on.lerp(anywhere, 0.03),
            };
            let found = near.at(p);
            let best = all.iter().map(|q| q.distance(p)).fold(f64::INFINITY, f64::min);
            assert!(found.distance <= best + 1e-7 * size, "{name}: {p} is {} from a point of it, {} was found", best, found.distance);
            assert!((found.point.distance(p) - found.distance).abs() <= 1e-12 * size, "{name}");
            assert!(surface.point(found.uv.0, found.uv.1).distance(found.point) <= 1e-6 * size, "{name}");
        }
    }
}
