//! What is written reads back: the same curves, surfaces, names and groups.

use std::f64::consts::PI;

use glam::DVec3;
use lofting::base::origin::Origin;
use lofting::base::tolerance::Tolerance;
use lofting::geometry::closest;
use lofting::geometry::construct::build;
use lofting::geometry::{Curve, Ends, Spline};
use lofting::io::iges::Part;
use lofting::io::iges::write::{IgesScale, IgesShape, IgesThing, sheet, write};
use lofting::model::measure;
use lofting::network::Chain;
use lofting::surface::blended::plane_face;
use lofting::surface::core::plane;
use lofting::surface::points::control_net;
use lofting::surface::{self, Surface};

use super::{OPTIONS, area, read};

const NONE: Origin = Origin::NONE;

fn tolerance() -> Tolerance {
    Tolerance::new(1e-7, 10.0)
}

fn text(things: &[IgesThing], unit: &'static str, model: f64) -> String {
    let scale = IgesScale { unit, model, tolerance: tolerance() };
    let sheet = sheet(things, &scale).unwrap();
    let mut out = Vec::new();
    write(&sheet, "part", &scale, &mut out).unwrap();
    String::from_utf8(out).unwrap()
}

fn back(things: &[IgesThing], unit: &'static str, model: f64) -> Part {
    let text = text(things, unit, model);
    assert!(text.lines().all(|line| line.len() == 80), "80 columns:\n{text}");
    let part = read(text.as_bytes(), &OPTIONS).unwrap();
    assert_eq!(part.warnings, [], "nothing to remark");
    part
}

fn thing(name: &str, group: &str, shown: IgesShape) -> IgesThing {
    IgesThing { name: name.to_owned(), group: group.to_owned(), layers: Vec::new(), color: None, shown }
}

fn curves() -> Vec<Curve> {
    let at = DVec3::new;
    let points = [at(0.0, 0.0, 0.0), at(1.0, 2.0, 0.5), at(3.0, 1.0, 1.0), at(4.0, 0.0, 0.0)];
    let line = build::line(at(1.0, 2.0, 3.0), at(1.1, -2e-7, 1e3 / 3.0), NONE).unwrap();
    let arc = build::arc_center(at(1.0, 0.0, 2.0), at(3.0, 0.0, 2.0), 1.25, DVec3::Z, NONE).unwrap();
    let tilted = build::arc_center(at(1.0, 0.0, 2.0), at(1.0, 2.0, 2.0), 4.0, at(1.0, 0.0, 1.0), NONE).unwrap();
    let clockwise = build::arc_center(at(0.0, 0.0, 0.0), at(2.0, 0.0, 0.0), 1.0, -DVec3::Z, NONE).unwrap();
    let circle = build::circle(at(0.0, 1.0, 0.0), 2.5, at(0.0, 1.0, 1.0), NONE).unwrap();
    let ellipse = build::ellipse(DVec3::ZERO, at(3.0, 0.0, 0.0), at(0.0, 1.0, 0.0), 0.3, 2.0, NONE).unwrap();
    let spline = build::spline(&points, &Spline { start: Ends::Natural, end: Ends::Natural, closed: false }, NONE).unwrap();
    let helix = build::helix(DVec3::ZERO, DVec3::Z, at(1.0, 0.0, 0.0), 0.5, 1.5, NONE).unwrap();
    let corner = build::line(arc.end(), at(0.0, 0.0, 2.0), NONE).unwrap();
    let row = build::composite(&[arc.clone(), corner], NONE).unwrap();
    let polyline = build::polyline(&points, true, NONE).unwrap();
    vec![line, arc, tilted, clockwise, circle, ellipse, spline, helix, row, polyline]
}

#[test]
fn curves_come_back_where_they_were() {
    let curves = curves();
    let things: Vec<IgesThing> =
        curves.iter().enumerate().map(|(k, c)| thing(&format!("rib {k}"), "", IgesShape::Curve(Chain::of_curve(c)))).collect();
    for (unit, model) in [("mm", 1.0), ("m", 1000.0), ("in", 25.4)] {
        let part = back(&things, unit, model);
        assert_eq!(part.curves.len(), curves.len());
        for (k, (found, curve)) in part.curves.iter().zip(&curves).enumerate() {
            let room = if k == 7 { 1e-7 } else { 1e-14 * curve.bbox().max.abs().max_element().max(10.0) };
            assert_eq!(found.name, format!("rib {k}"));
            assert!(found.value.start().distance(curve.start()) <= room && found.value.end().distance(curve.end()) <= room, "{k}");
            for p in curve.points_along(33) {
                assert!(
                    closest(&found.value, p).distance <= room * 4.0,
                    "curve {k} in {unit} at {p}: {}",
                    closest(&found.value, p).distance
                );
            }
        }
        // Lines and arcs stay what they are.
        let kinds: Vec<&str> = part.curves.iter().map(|c| c.value.kind().name()).collect();
        assert_eq!(kinds, ["line", "arc", "arc", "arc", "circle", "nurbs", "nurbs", "nurbs", "composite", "nurbs"]);
    }
}

fn chain(curve: &Curve) -> Chain {
    Chain::of_curve(curve)
}

/// Surfaces with their areas.
fn surfaces() -> Vec<(Surface, f64)> {
    let at = DVec3::new;
    let t = tolerance();
    let (a, b) =
        (build::line(DVec3::ZERO, at(2.0, 0.0, 0.0), NONE).unwrap(), build::line(at(0.0, 1.0, 0.0), at(2.0, 1.0, 2.0), NONE).unwrap());
    let ruled = surface::ruled(&chain(&a), &chain(&b), NONE, &t).unwrap().0;
    let arc = build::arc_center(DVec3::ZERO, at(2.0, 0.0, 0.0), 2.0, DVec3::Z, NONE).unwrap();
    let upper = build::arc_center(at(0.0, 0.0, 1.0), at(3.0, 0.0, 1.0), 2.0, DVec3::Z, NONE).unwrap();
    let cone = surface::ruled(&chain(&arc), &chain(&upper), NONE, &t).unwrap().0;
    let pillar = surface::extrude(&chain(&arc), at(0.0, 0.0, 3.0), NONE, &t).unwrap();
    let profile = build::line(at(2.0, 0.0, 0.0), at(2.0, 0.0, 3.0), NONE).unwrap();
    let axis = surface::swept::revolve::Axis { about: DVec3::ZERO, direction: DVec3::Z };
    let drum = surface::revolve(&chain(&profile), &axis, 2.0 * PI, NONE, &t).unwrap();
    let half = build::arc_center(DVec3::ZERO, at(0.0, 0.0, -2.0), PI, at(0.0, -1.0, 0.0), NONE).unwrap();
    let ball = surface::revolve(&chain(&half), &axis, -1.0, NONE, &t).unwrap();
    let rows = [vec![DVec3::ZERO, at(1.0, 0.0, 1.0), at(2.0, 0.0, 0.0)], vec![at(0.0, 2.0, 0.0), at(1.0, 2.0, 1.0), at(2.0, 2.0, 0.0)]];
    let weights = [vec![1.0, 0.5, 1.0], vec![1.0, 0.5, 1.0]];
    let net = control_net::Net { rows: &rows, weights: Some(&weights) };
    let vault = control_net::nurbs(&net, (2, 1), (None, None), NONE, &t).unwrap();
    let grid: Vec<Vec<DVec3>> = (0..5).map(|j| (0..6).map(|i| at(f64::from(i), f64::from(j), f64::from(i * j % 3))).collect()).collect();
    let hills = surface::grid(&grid, NONE, &t).unwrap().0;
    let all = [ruled, cone, pillar, drum, ball, vault, hills];
    all.into_iter().map(|s| (s.clone(), area(&s))).collect()
}

#[test]
fn surfaces_keep_their_area_names_and_groups() {
    let surfaces = surfaces();
    let mut things: Vec<IgesThing> = surfaces
        .iter()
        .enumerate()
        .map(|(k, (s, _))| thing(&format!("skin{k}"), if k < 3 { "hall" } else { "" }, IgesShape::Surface(s.clone())))
        .collect();
    things.extend(surfaces.iter().map(|(s, _)| thing("", "", IgesShape::Surface(s.flipped()))));
    things.push(thing("A", "hall", IgesShape::Point(DVec3::new(1.0, 2.0, 3.0))));
    let part = back(&things, "m", 1000.0);
    assert_eq!(part.surfaces.len(), 2 * surfaces.len());
    for (k, found) in part.surfaces.iter().enumerate() {
        let (known, known_area) = &surfaces[k % surfaces.len()];
        let now = area(&found.value.base);
        assert!((now / known_area - 1.0).abs() < 1e-7, "surface {k}: {now} {known_area}");
        let turned = k >= surfaces.len();
        for (u, v) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
            let (p, q) = (found.value.base.point(u, v), known.point(u, if turned { 1.0 - v } else { v }));
            assert!(p.distance(q) < 1e-9, "surface {k} at {u} {v}: {p} {q}");
        }
        let (n, m) = (found.value.base.normal(0.4, 0.4), known.normal(0.4, if turned { 0.6 } else { 0.4 }));
        assert!(n.dot(m) * if turned { -1.0 } else { 1.0 } > 0.99, "surface {k} looks the same way");
    }
    assert_eq!((part.groups[0].name.as_str(), part.groups[0].surfaces.len(), part.groups[0].points.len()), ("hall", 3, 1));
    assert_eq!((part.surfaces[4].name.as_str(), part.points[0].value[0]), ("skin4", DVec3::new(1.0, 2.0, 3.0)));
}

#[test]
fn a_plane_inside_a_loop_is_a_trimmed_surface() {
    let corners: Vec<DVec3> =
        (0..6).map(|k| f64::from(k) * PI / 3.0).map(|a| DVec3::new(2.0 * a.cos(), 2.0 * a.sin(), 1.0 + a.cos())).collect();
    let border = build::polyline(&corners, true, NONE).unwrap();
    let (face, _) = plane_face::bounded(&[chain(&border)], NONE, &tolerance()).unwrap();
    let part = back(&[thing("deck", "", IgesShape::Surface(face))], "mm", 1.0);
    let found = &part.surfaces[0].value;
    let outer = found.outer.as_ref().unwrap();
    assert!(found.off.distance < 1e-13 && outer.iter().all(|b| b.uv.is_some()), "{}", found.off.distance);
    let length: f64 = outer.iter().map(|b| b.space.length()).sum();
    assert!((length - border.length()).abs() < 1e-12);
}

/// A model writes its curves and surfaces; another one reads them and checks them.
#[test]
fn models_exchange_curves_and_surfaces() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("iges-written");
    std::fs::create_dir_all(&folder).unwrap();
    let writes = r#"
units m
point top = (0, 0, 3m)
curve south = arc((0, 0, 0), (4m, 0, 0), through: (2m, 0, 1m))
curve north = line((0, 3m, 0), (4m, 3m, 0))
curve west = line((0, 0, 0), (0, 3m, 0))
curve east = line((4m, 0, 0), (4m, 3m, 0))
surface vault = coons(south, east, north, west)
surface wall = extrude(north, (0, 0, 2m))
shell hall of vault, wall
curve foot = arc((10m, 0, 0), (14m, 0, 0), through: (12m, -1m, 0))
curve luff = line((14m, 0, 0), (12m, 3m, 1m))
curve leech = spline([(12m, 3m, 1m), (10.5m, 2m, 1m), (10m, 0, 0)])
surface sail = coons(foot, luff, leech)
export hall, south, top, sail, -sail to "hall.igs" { units: mm }
"#;
    let reads = r#"
units cm
import "hall.igs" as part
use "writes.loft" as model
let hall = part.hall
check len(part.surfaces) == 4 and len(hall.surfaces) == 2 and len(part.points) == 1
check length(part["south"]) == length(model.south) within 1e-9
check area(part.wall) == 8m2 within 1e-9
check distance(part.points[0], (0, 0, 300)) <= 1e-9mm
check area(part.vault) == area(model.vault) within 0.0001%
check area(part.sail) == area(model.sail) within 0.0001%
check area(part["sail_2"]) == area(model.sail) within 0.0001%
"#;
    for (name, script) in [("writes.loft", writes), ("reads.loft", reads)] {
        std::fs::write(folder.join(name), script).unwrap();
        let run = std::process::Command::new(env!("CARGO_BIN_EXE_loft")).args(["run", name]).current_dir(&folder).output().unwrap();
        assert!(run.status.success(), "{name}: {}{}", String::from_utf8_lossy(&run.stdout), String::from_utf8_lossy(&run.stderr));
    }
    // A mesh has no place in such a file.
    let script = "curve a = line((0, 0, 0), (1m, 0, 0))\nmesh m of a { size: 1m }\nexport m to \"m.igs\"\n";
    std::fs::write(folder.join("mesh.loft"), script).unwrap();
    let run = std::process::Command::new(env!("CARGO_BIN_EXE_loft")).args(["run", "mesh.loft"]).current_dir(&folder).output().unwrap();
    let said = String::from_utf8_lossy(&run.stderr).into_owned();
    assert!(!run.status.success() && said.contains("igs holds curves, surfaces, shells and points, not meshes"), "{said}");
}

/// A face that crosses the seam of its torus, read and written again: the border that is cut there stays the part that it is.
#[test]
fn borders_over_a_seam_come_back_as_they_were() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("iges-over-a-seam");
    std::fs::create_dir_all(&folder).unwrap();
    let made = r#"
units mm
let at = (6.7139 + 2.4301 * cos(3.8232deg), 0, 2.4301 * sin(3.8232deg))
surface strip = revolve(arc(center: (6.7139, 0, 0), start: at, angle: -7.5819deg, normal: (0, -1, 0)), angle: 30.3978deg)
surface rounded = revolve(polyline([(1, 0, 0.5), (2.6, 0, -2.1), (2.2, 0, -2.8)], round: 0.16), angle: 73deg)
"#;
    let run = |name: &str, script: &str| {
        std::fs::write(folder.join(name), script).unwrap();
        let run = std::process::Command::new(env!("CARGO_BIN_EXE_loft")).args(["run", name]).current_dir(&folder).output().unwrap();
        assert!(run.status.success(), "{name}: {}{}", String::from_utf8_lossy(&run.stdout), String::from_utf8_lossy(&run.stderr));
    };
    for which in ["strip", "rounded"] {
        run("model.loft", &format!("{made}export {which} to \"first.igs\"\n"));
        run("again.loft", "units mm\nimport \"first.igs\" as part\nexport part to \"second.igs\"\n");
        let compared = format!(
            "units mm\nuse \"model.loft\" as model\nimport \"second.igs\" as part\ncheck area(part) == area(model.{which}) within 1e-6\n"
        );
        run("compared.loft", &compared);
    }
}

/// Faces of other programs, written and read again: the same areas, and (u, v) that agree with the curves in space.
#[test]
fn trimmed_surfaces_come_back_with_their_borders() {
    for name in ["45-trimmed/example_45_faces.iges", "fuselage-solidworks/fuse.igs", "rounded-cube/single_rounded_cube.iges"] {
        let bytes = std::fs::read(super::folder(&format!("iges-{name}"))).unwrap();
        let part = read(&bytes, &OPTIONS).unwrap();
        let built: Vec<&Surface> = part.built.iter().flatten().collect();
        let things: Vec<IgesThing> = built.iter().map(|s| thing("", "", IgesShape::Surface((*s).clone()))).collect();
        let again = read(text(&things, "mm", 1.0).as_bytes(), &OPTIONS).unwrap();
        assert_eq!(again.built.iter().flatten().count(), built.len(), "{name}: {:?}", again.warnings);
        for (a, b) in again.built.iter().flatten().zip(&built) {
            let (a, b) = (measure::area(a), measure::area(b));
            assert!((a / b - 1.0).abs() < 1e-6, "{name}: {a} {b}");
        }
        let borders = again.surfaces.iter().flat_map(|s| s.value.outer.iter().chain(&s.value.holes).flatten());
        assert!(borders.into_iter().all(|b| b.uv.is_some()), "{name}");
    }
}

#[test]
fn a_plane_with_holes_keeps_them() {
    let ring = |radius: f64, x: f64| chain(&build::circle(DVec3::new(x, 0.0, 1.0), radius, DVec3::Z, NONE).unwrap());
    let ground = plane::unbounded(DVec3::Z, DVec3::Z, NONE).unwrap();
    let plate = surface::trim(&ground, &[ring(4.0, 0.0)], &[vec![ring(1.0, 2.0)], vec![ring(1.0, -2.0)]], NONE, &tolerance()).unwrap();
    let part = back(&[thing("plate", "", IgesShape::Surface(plate))], "mm", 1.0);
    assert_eq!(part.surfaces[0].value.holes.len(), 2);
    let found = measure::area(&part.built[0][0]);
    assert!((found / (14.0 * PI) - 1.0).abs() < 1e-9, "{found}");
}
