//! One small file a kind of entity, with what it must become.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

use glam::DVec3;
use lofting::io::iges::Part;
use lofting::surface::Domain;

use super::file::{DEPENDENT, Fields, File, IN_UV};
use super::{OPTIONS, area, read};

/// A name and what fills the file.
type Maker = (&'static str, fn(&mut File));

/// All files by name.
pub fn all() -> Vec<(&'static str, String)> {
    let makers: &[Maker] = &[
        ("curves", curves),
        ("placed", placed),
        ("surfaces", surfaces),
        ("bordered", bordered),
        ("cube", cube),
        ("groups", groups),
        ("circles", circles),
    ];
    let make = |f: &fn(&mut File)| {
        let mut file = File::default();
        f(&mut file);
        file.text()
    };
    makers.iter().map(|(name, f)| (*name, make(f))).collect()
}

fn part(f: impl FnOnce(&mut File)) -> Part {
    let mut file = File::default();
    f(&mut file);
    read(file.text().as_bytes(), &OPTIONS).unwrap()
}

fn curves(f: &mut File) {
    // A circle, a half one, a parabola y = x², a polyline, a closed one, a cubic in two pieces, a rational quarter, an offset.
    f.free(100, 0, "3.0,1.0,0.0,3.0,0.0,3.0,0.0");
    f.free(100, 0, "0.0,0.0,0.0,2.0,0.0,-2.0,0.0");
    f.free(104, 3, "1.0,0.0,0.0,0.0,-1.0,0.0,0.0,-1.0,1.0,2.0,4.0");
    f.free(106, 12, "2,3,0.0,0.0,0.0,3.0,0.0,0.0,3.0,4.0,0.0");
    f.free(106, 63, "1,3,5.0,0.0,0.0,3.0,0.0,3.0,4.0");
    f.free(112, 0, "3,1,3,2,0.0,1.0,3.0,0.0,1.0,0.0,0.0,0.0,0.0,1.0,0.0,7.0,0.0,0.0,0.0,1.0,1.0,0.0,0.0,1.0,2.0,1.0,0.0,7.0,0.0,0.0,0.0,3.0,1.0,0.0,0.0,9.0,6.0,2.0,0.0,7.0,0.0,0.0,0.0");
    let w = FRAC_1_SQRT_2;
    f.free(126, 0, &format!("2,2,1,0,0,0,0.,0.,0.,1.,1.,1.,1.,{w},1.,1.,0.,0.,1.,1.,0.,0.,1.,0.,0.,1.,0.,0.,1."));
    let base = f.part(100, 0, "0.0,0.0,0.0,2.0,0.0,2.0,0.0");
    f.free(130, 0, &format!("{base},1,0,0,0,0.5,0.0,0.0,0.0,0.0,0.0,1.0,0.0,6.283185307179586"));
    // Lines in a row, the second one written backwards, inside another row with a point.
    let (a, b) = (f.part(110, 0, "0.,0.,0.,1.,0.,0."), f.part(110, 0, "1.,1.,0.,1.,0.,0."));
    let inner = f.part(102, 0, &format!("2,{a},{b}"));
    let (c, p) = (f.part(110, 0, "1.,1.,0.,0.,1.,0."), f.part(116, 0, "1.,1.,0.,0"));
    f.free(102, 0, &format!("3,{inner},{p},{c}"));
    // Only the middle of a spline's parameters.
    f.free(126, 0, "1,1,0,0,1,0,0.,0.,4.,4.,1.,1.,0.,0.,0.,8.,0.,0.,1.,3.");
}

#[test]
fn each_kind_of_curve_is_what_it_describes() {
    let part = part(curves);
    assert_eq!(part.warnings, [], "nothing is wrong with them");
    let found: Vec<(&str, f64)> = part.curves.iter().map(|c| (c.value.kind().name(), c.value.length())).collect();
    // ∫√(1 + 4x²) from −1 to 2, and from 0 to 3.
    let parabola = |x: f64| 0.5 * x * (1.0 + 4.0 * x * x).sqrt() + 0.25 * (2.0 * x).asinh();
    let expected = [
        ("circle", 4.0 * PI),
        ("arc", 2.0 * PI),
        ("conic", parabola(2.0) + parabola(1.0)),
        ("polyline", 7.0),
        ("polyline", 12.0),
        ("spline", parabola(3.0)),
        ("nurbs", 0.5 * PI),
        ("offset", 3.0 * PI),
        ("composite", 3.0),
        ("line", 4.0),
    ];
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        assert!(found.0 == expected.0 && (found.1 / expected.1 - 1.0).abs() < 1e-12, "{found:?} {expected:?}");
    }
    assert!(
        part.curves[8].value.end().distance(DVec3::Y) < 1e-15 && part.curves[5].value.end().distance(DVec3::new(3.0, 9.0, 7.0)) < 1e-14
    );
    assert_eq!((part.curves[9].value.start(), part.curves[9].value.end()), (DVec3::X * 2.0, DVec3::X * 6.0));
}

/// A quarter turn about z and 5 up, then 10 along x.
fn placed(f: &mut File) {
    let outer = f.free(124, 0, "1.,0.,0.,10.,0.,1.,0.,0.,0.,0.,1.,0.");
    let inner = f.add(124, 0, Fields { transform: outer, ..Fields::default() }, "0.,-1.,0.,0.,1.,0.,0.,0.,0.,0.,1.,5.");
    let at = Fields { transform: inner, ..Fields::default() };
    f.add(110, 0, at, "1.,0.,0.,2.,0.,0.");
    f.add(116, 0, at, "1.,0.,0.,0");
    f.add(100, 0, at, "0.,0.,0.,1.,0.,0.,1.");
    f.add(128, 0, at, "1,1,1,1,0,0,1,0,0,0.,0.,1.,1.,0.,0.,1.,1.,1.,1.,1.,1.,1.,0.,0.,2.,0.,0.,1.,1.,0.,2.,1.,0.,0.,1.,0.,1.");
    // A cylinder whose axis turns with it, mirrored.
    let mirror = f.free(124, 1, "1.,0.,0.,0.,0.,1.,0.,0.,0.,0.,-1.,0.");
    let (axis, profile) = (f.part(110, 0, "0.,0.,0.,0.,0.,1."), f.part(110, 0, "2.,0.,0.,2.,0.,3."));
    let turned = Fields { transform: mirror, ..Fields::default() };
    f.add(120, 0, turned, &format!("{axis},{profile},0.,1.5707963267948966"));
    // Squeezed: a circle becomes an ellipse.
    let flat = f.free(124, 0, "1.,0.,0.,0.,0.,0.5,0.,0.,0.,0.,1.,0.");
    f.add(100, 0, Fields { transform: flat, ..Fields::default() }, "0.,0.,0.,1.,0.,1.,0.");
}

#[test]
fn matrices_place_curves_surfaces_and_points() {
    let part = part(placed);
    assert_eq!(part.warnings, []);
    let line = &part.curves[0].value;
    assert_eq!(
        (line.start(), line.end(), part.points[0].value[0]),
        (DVec3::new(10.0, 1.0, 5.0), DVec3::new(10.0, 2.0, 5.0), DVec3::new(10.0, 1.0, 5.0))
    );
    let arc = &part.curves[1].value;
    assert!(arc.start().distance(DVec3::new(10.0, 1.0, 5.0)) < 1e-15 && arc.end().distance(DVec3::new(9.0, 0.0, 5.0)) < 1e-15);
    let sheet = &part.surfaces[0].value.base;
    assert!(sheet.point(1.0, 0.0).distance(DVec3::new(10.0, 2.0, 5.0)) < 1e-15 && (area(sheet) - 1.0).abs() < 1e-14);
    let turned = &part.surfaces[1].value.base;
    assert!((area(turned) / (3.0 * PI) - 1.0).abs() < 1e-12);
    let corner = turned.point(1.0, 1.0);
    assert!(corner.distance(DVec3::new(0.0, 2.0, -3.0)) < 1e-14, "{corner}");
    assert_eq!(part.curves[2].value.kind().name(), "ellipse");
}

fn surfaces(f: &mut File) {
    // z = u·v in two patches over 0…2 × 0…1, with and without the patches that mean nothing.
    let patch = |x0: f64| {
        let mut c = vec![0.0; 48];
        (c[0], c[1]) = (x0, 1.0);
        c[16 + 4] = 1.0;
        (c[32 + 4], c[32 + 5]) = (x0, 1.0);
        c.iter().map(f64::to_string).collect::<Vec<_>>().join(",")
    };
    let dummy = vec!["9"; 48].join(",");
    let head = "3,1,2,1,0.,1.,2.,0.,1.";
    f.free(114, 0, &format!("{head},{},{}", patch(0.0), patch(1.0)));
    f.free(114, 0, &format!("{head},{},{dummy},{},{dummy},{dummy},{dummy}", patch(0.0), patch(1.0)));
    // The same ruled, both ways of joining.
    let (a, b) = (f.part(110, 0, "0.,0.,0.,2.,0.,0."), f.part(110, 0, "2.,1.,2.,0.,1.,0."));
    f.free(118, 1, &format!("{a},{b},1,0"));
    f.free(118, 0, &format!("{a},{b},1,0"));
    // By length: a line and a spline of uneven speed along another line.
    let c = f.part(126, 0, "2,2,1,0,1,0,0.,0.,0.,1.,1.,1.,1.,1.,1.,0.,1.,0.,0.,1.,0.,2.,1.,0.,0.,1.");
    f.free(118, 0, &format!("{a},{c},0,0"));
    let (axis, profile) = (f.part(110, 0, "0.,0.,0.,0.,0.,1."), f.part(110, 0, "2.,0.,0.,2.,0.,3."));
    f.free(120, 0, &format!("{axis},{profile},0.,6.283185307179586"));
    let circle = f.part(100, 0, "0.,0.,0.,1.5,0.,1.5,0.");
    f.free(122, 0, &format!("{circle},1.5,0.,4."));
    // Knots beyond the stretch that counts: x from 1 to 3 of 0…4.
    f.free(128, 0, "1,1,1,1,0,0,1,0,0,0.,0.,4.,4.,0.,0.,1.,1.,1.,1.,1.,1.,0.,0.,0.,4.,0.,0.,0.,5.,0.,4.,5.,0.,1.,3.,0.,1.");
    // A sphere and a torus by their sizes.
    let (at, up) = (f.part(116, 0, "1.,2.,3.,0"), f.part(123, 0, "0.,0.,2."));
    f.free(196, 0, &format!("{at},2.0"));
    f.free(198, 0, &format!("{at},{up},3.0,1.0"));
}

#[test]
fn each_kind_of_surface_is_what_it_describes() {
    let part = part(surfaces);
    assert_eq!(part.warnings, []);
    // ∬√(1 + x² + y²) over 0…2 × 0…1.
    let saddle = {
        let rule = lofting::base::quadrature::gauss_legendre(24);
        let each = rule.iter().flat_map(|(x, a)| rule.iter().map(move |(y, b)| (1.0 + x, 0.5 + 0.5 * y, a * b * 0.5)));
        each.map(|(x, y, w)| w * (1.0 + x * x + y * y).sqrt()).sum::<f64>()
    };
    let expected = [saddle, saddle, saddle, saddle, 2.0, 12.0 * PI, 12.0 * PI, 10.0, 16.0 * PI, 12.0 * PI * PI];
    let found: Vec<f64> = part.surfaces.iter().map(|s| area(&s.value.base)).collect();
    assert_eq!(found.len(), expected.len());
    for (k, (found, expected)) in found.iter().zip(expected).enumerate() {
        assert!((found / expected - 1.0).abs() < 1e-9, "surface {k}: {found} {expected}");
    }
    // Equal lengths are joined: a quarter of the line with a quarter of the spline.
    let p = part.surfaces[4].value.base.point(0.25, 1.0);
    assert!(p.distance(DVec3::new(0.5, 1.0, 0.0)) < 1e-12, "{p}");
}

/// A plate of 4 × 4 in z = 1 (u, v from 0 to 2) with a round hole given in several ways.
fn bordered(f: &mut File) {
    let plate = |f: &mut File| {
        f.part(128, 0, "1,1,1,1,0,0,1,0,0,0.,0.,2.,2.,0.,0.,2.,2.,1.,1.,1.,1.,0.,0.,1.,4.,0.,1.,0.,4.,1.,4.,4.,1.,0.,2.,0.,2.")
    };
    let hole = |f: &mut File| f.part(100, 0, "1.,2.,2.,3.,2.,3.,2.");
    let hole_uv = |f: &mut File| f.add(100, 0, IN_UV, "0.,1.,1.,1.5,1.,1.5,1.");
    // 0: (u, v) and space agree. 1: only (u, v). 2: only space. 3: (u, v) is wrong.
    let (s, c, uv) = (plate(f), hole(f), hole_uv(f));
    let b = f.part(142, 0, &format!("1,{s},{uv},{c},3"));
    f.free(144, 0, &format!("{s},0,1,0,{b}"));
    let (s, uv) = (plate(f), hole_uv(f));
    let b = f.part(142, 0, &format!("1,{s},{uv},0,1"));
    f.free(144, 0, &format!("{s},0,1,0,{b}"));
    let (s, c) = (plate(f), hole(f));
    let b = f.part(142, 0, &format!("1,{s},0,{c},2"));
    f.free(144, 0, &format!("{s},0,1,0,{b}"));
    let (s, c) = (plate(f), hole(f));
    let uv = f.add(100, 0, IN_UV, "0.,1.,1.,1.9,1.,1.9,1.");
    let b = f.part(142, 0, &format!("1,{s},{uv},{c},3"));
    f.free(144, 0, &format!("{s},0,1,0,{b}"));
    // 4: a bounded surface (143, 141) by two half circles, the second one backwards.
    let s = plate(f);
    let (a, c) = (f.part(100, 0, "1.,2.,2.,3.,2.,1.,2."), f.part(100, 0, "1.,2.,2.,1.,2.,3.,2."));
    let b = f.part(141, 0, &format!("0,2,{s},2,{a},1,0,{c},1,0"));
    f.free(143, 0, &format!("0,{s},1,{b}"));
    // 5: a bordered plane 0x + 0y + 2z = 2; 6: the same lifted by an offset, trimmed.
    let c = hole(f);
    f.free(108, 1, &format!("0.,0.,2.,2.,{c},0.,0.,1.,1."));
    let plane = f.part(108, 0, "0.,0.,2.,2.,0,0.,0.,1.,1.");
    let s = f.part(140, 0, &format!("0.,0.,1.,3.,{plane}"));
    let c = f.part(100, 0, "4.,2.,2.,3.,2.,3.,2.");
    let b = f.part(142, 0, &format!("1,{s},0,{c},2"));
    f.free(144, 0, &format!("{s},1,0,{b}"));
    // 7: the outer loop is the plate's own border.
    let s = plate(f);
    let square =
        [(0, 0, 4, 0), (4, 0, 4, 4), (4, 4, 0, 4), (0, 4, 0, 0)].map(|(a, b, c, d)| f.part(110, 0, &format!("{a}.,{b}.,1.,{c}.,{d}.,1.")));
    let [a, b, c, d] = square;
    let c = f.part(102, 0, &format!("4,{a},{b},{c},{d}"));
    let b = f.part(142, 0, &format!("1,{s},0,{c},2"));
    f.free(144, 0, &format!("{s},1,0,{b}"));
}

#[test]
fn borders_are_read_in_every_form() {
    let part = part(bordered);
    let shapes: Vec<(Option<usize>, usize)> =
        part.surfaces.iter().map(|s| (s.value.outer.as_ref().map(Vec::len), s.value.holes.len())).collect();
    assert_eq!(shapes, [(None, 1), (None, 1), (None, 1), (None, 1), (Some(2), 0), (Some(1), 0), (Some(1), 0), (None, 0)]);
    assert_eq!(part.warnings.iter().filter(|w| w.what.contains("in (u, v) are up to")).count(), 1, "{:?}", part.warnings);
    for (k, face) in part.surfaces.iter().map(|s| &s.value).enumerate().take(7) {
        let border = face.holes.first().or(face.outer.as_ref()).unwrap();
        let length: f64 = border.iter().map(|b| b.space.length()).sum();
        assert!((length / (2.0 * PI) - 1.0).abs() < 1e-6, "face {k}: {length}");
        assert!(face.off.distance < 1e-6, "face {k}: {}", face.off.distance);
        let z = if k == 6 { 4.0 } else { 1.0 };
        assert!(border.iter().all(|b| (b.space.start().z - z).abs() < 1e-12), "face {k}");
        assert_eq!(border[0].uv.is_some(), k < 2, "face {k}");
    }
    let plate = 16.0 - PI;
    for (k, known) in [plate, plate, plate, plate, PI, PI, PI, 16.0].into_iter().enumerate() {
        let found = lofting::model::measure::area(&part.built[k][0]);
        assert!((found / known - 1.0).abs() < 1e-6, "face {k}: {found} {known}");
    }
    let uv = part.surfaces[0].value.holes[0][0].uv.as_ref().unwrap();
    assert!(uv.start().distance(DVec3::new(0.75, 0.5, 0.0)) < 1e-15);
}

/// Offsets of a quarter of a cylinder of radius 2 and height 3: outwards, against it, outwards by less than nothing, and of a ball.
fn offsets(f: &mut File) {
    for (side, distance) in [("1.,1.,0.", "1."), ("-1.,-1.,0.", "1."), ("1.,1.,0.", "-1.")] {
        let arc = f.part(100, 0, "0.,0.,0.,2.,0.,0.,2.");
        let wall = f.part(122, 0, &format!("{arc},2.,0.,3."));
        f.free(140, 0, &format!("{side},{distance},{wall}"));
    }
    let center = f.part(116, 0, "0.,0.,0.,0");
    let ball = f.part(196, 0, &format!("{center},2."));
    f.free(140, 0, &format!("-1.,0.,0.,1.,{ball}"));
}

#[test]
fn offsets_are_on_the_side_that_is_told() {
    let part = part(offsets);
    assert_eq!(part.warnings, []);
    for (k, known) in [4.5 * PI, 1.5 * PI, 1.5 * PI, 36.0 * PI].into_iter().enumerate() {
        let found = lofting::model::measure::area(&part.built[k][0]);
        assert!((found / known - 1.0).abs() < 1e-9, "surface {k}: {found} {known}");
    }
}

/// A cube of 2 as a solid by its border.
fn cube(f: &mut File) {
    let corners: Vec<[i32; 3]> = (0..8).map(|k| [k & 1, k >> 1 & 1, k >> 2 & 1].map(|c| 2 * c)).collect();
    let point = |c: &[i32; 3]| c.map(|x| format!("{x}.")).join(",");
    let vertices = f.part(502, 1, &format!("8,{}", corners.iter().map(point).collect::<Vec<_>>().join(",")));
    let mut edges = Vec::new();
    let mut lists = Vec::new();
    for a in 0..8_usize {
        for axis in [1, 2, 4] {
            if a & axis == 0 {
                let line = f.part(110, 0, &format!("{},{}", point(&corners[a]), point(&corners[a | axis])));
                edges.push((a, a | axis));
                lists.push(format!("{line},{vertices},{},{vertices},{}", a + 1, (a | axis) + 1));
            }
        }
    }
    let list = f.part(504, 1, &format!("12,{}", lists.join(",")));
    let mut faces = Vec::new();
    for (axis, high) in [(1_usize, 0_usize), (1, 1), (2, 0), (2, 1), (4, 0), (4, 1)] {
        let (b, c) = match axis {
            1 => (2, 4),
            2 => (4, 1),
            _ => (1, 2),
        };
        let first = axis * high;
        let walk = [first, first | b, first | b | c, first | c];
        let uses = (0..4).map(|k| {
            let (from, to) = (walk[k], walk[(k + 1) % 4]);
            let k = edges.iter().position(|e| *e == (from.min(to), from.max(to))).unwrap();
            format!("0,{list},{},{},0", k + 1, u8::from(from < to))
        });
        let uses = uses.collect::<Vec<_>>().join(",");
        let border = f.part(508, 1, &format!("4,{uses}"));
        let at = f.part(116, 0, &format!("{},0", point(&corners[first])));
        let normal = f.part(123, 0, ["1.,0.,0.", "0.,1.,0.", "0.,0.,1."][axis.trailing_zeros() as usize]);
        let plane = f.part(190, 0, &format!("{at},{normal}"));
        let face = f.part(510, 1, &format!("{plane},1,1,{border}"));
        faces.push(format!("{face},{high}"));
    }
    let shell = f.part(514, 1, &format!("6,{}", faces.join(",")));
    f.free(186, 0, &format!("{shell},1,0"));
}

#[test]
fn a_solid_gives_its_faces_as_a_group() {
    let part = part(cube);
    assert_eq!(part.warnings, []);
    assert_eq!((part.surfaces.len(), part.groups.len()), (6, 1));
    assert_eq!((part.groups[0].name.as_str(), part.groups[0].surfaces.len()), ("solid1", 6));
    for (k, face) in part.surfaces.iter().map(|s| &s.value).enumerate() {
        assert_eq!((face.outer.as_ref().unwrap().len(), face.flipped, face.base.domain()), (4, k % 2 == 0, Domain::Unbounded));
        assert!(face.off.distance < 1e-12, "{}", face.off.distance);
    }
    let total: f64 = part.built.iter().flatten().map(lofting::model::measure::area).sum();
    assert!((total - 24.0).abs() < 1e-12, "{total}");
}

fn groups(f: &mut File) {
    let red = f.free(314, 0, "100.,0.,50.,4Hrose");
    let name = f.free(406, 15, "1,4Hdeck");
    let group_name = f.free(406, 15, "1,7Hupper; ");
    let line = |k: u32| format!("{k}.,0.,0.,{k}.,1.,0.");
    let a = f.add(110, 0, Fields { color: -(red as i32), ..Fields::default() }, &format!("{},0,1,{name}", line(0)));
    let b = f.add(110, 0, Fields { label: "SIDE", subscript: 3, color: 3, ..Fields::default() }, &line(1));
    f.add(110, 0, Fields { label: "SIDE", subscript: 3, ..Fields::default() }, &line(2));
    let only_here = f.add(110, 0, DEPENDENT, &line(3));
    f.add(110, 0, Fields { status: 1_000_000, ..Fields::default() }, &line(4));
    f.add(110, 0, Fields { status: 10_000, ..Fields::default() }, &line(5));
    let inner = f.add(402, 7, Fields { status: 20_000, ..Fields::default() }, &format!("1,{b}"));
    f.free(402, 7, &format!("3,{a},{only_here},{inner},0,1,{group_name}"));
    f.free(110, 0, &line(6));
    f.free(212, 0, "1,2,3");
}

#[test]
fn names_groups_colours_and_visibility() {
    let part = part(groups);
    let names: Vec<&str> = part.curves.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["deck", "SIDE3", "SIDE3_2", "curve4", "curve5"]);
    assert_eq!((part.curves[0].color, part.curves[1].color), (Some([1.0, 0.0, 0.5]), Some([0.0, 1.0, 0.0])));
    let groups: Vec<(&str, &[usize])> = part.groups.iter().map(|g| (g.name.as_str(), g.curves.as_slice())).collect();
    assert_eq!(groups, [("group1", &[1][..]), ("upper;", &[0, 3, 1])]);
    let colors: Vec<(&str, &[usize])> = part.colors.iter().map(|(g, _)| (g.name.as_str(), g.curves.as_slice())).collect();
    assert_eq!(colors, [("rose", &[0][..]), ("green", &[1])]);
    let said: Vec<&str> = part.warnings.iter().map(|w| w.what.as_str()).collect();
    assert_eq!(said, ["entity of type 212 form 0 are not read"]);
}

/// Entities that point at themselves and each other, or nowhere.
fn circles(f: &mut File) {
    let d = f.next();
    f.free(102, 0, &format!("2,{d},{d}"));
    let d = f.next();
    f.free(102, 0, &format!("1,{}", d + 2));
    f.free(102, 0, &format!("1,{d}"));
    let d = f.next();
    f.add(124, 0, Fields { transform: d, ..Fields::default() }, "1.,0.,0.,0.,0.,1.,0.,0.,0.,0.,1.,0.");
    f.add(110, 0, Fields { transform: d, ..Fields::default() }, "0.,0.,0.,1.,0.,0.");
    let d = f.next();
    f.free(140, 0, &format!("0.,0.,1.,3.,{d}"));
    let d = f.next();
    f.free(402, 7, &format!("2,{d},999"));
    let d = f.next();
    f.free(144, 0, &format!("{d},1,0,{d}"));
    let d = f.next();
    f.free(118, 0, &format!("{d},{d},0,0"));
    let line = f.part(110, 0, "0.,0.,0.,1.,0.,0.");
    f.free(144, 0, &format!("{line},0,0,0"));
    // Each row of curves holds the one before twice.
    let mut last = f.part(110, 0, "0.,0.,0.,1.,0.,0.");
    for _ in 0..40 {
        last = f.free(102, 0, &format!("2,{last},{last}"));
    }
    f.free(110, 0, "0.,0.,0.,0.,7.,0.");
}

#[test]
fn circles_of_pointers_end() {
    let part = part(circles);
    assert!(part.curves.len() > 1 && part.curves.iter().any(|c| (c.value.length() - 7.0).abs() < 1e-15));
    for expected in ["made of itself", "in a circle", "not a surface", "repeats"] {
        assert!(part.warnings.iter().any(|w| w.what.contains(expected)), "{expected}: {:#?}", part.warnings);
    }
}
