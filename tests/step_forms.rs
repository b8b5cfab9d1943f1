//! STEP files that models write of lines and arcs in a row, of smooth curves, and of parts that came in: forms, knots, sides and names.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use super::step_out::{of_type, records, run};

/// Faces along lines and arcs are planes, cylinders, tori and spheres with lines and circles as edges, each with the name of its face; what
/// is written reads back with the same areas.
#[test]
fn lines_and_arcs_in_a_row_leave_as_their_forms() {
    let model = r#"units mm
curve rim = polyline([(0, 0), (40, 0), (40, 30), (0, 30)], closed: true, round: 8mm)
surface wall = extrude(rim, by: (0, 0, 10))
surface foot = plane(rim)
surface lid = move(foot, by: (0, 0, 10))
shell box of foot, lid, wall
curve section = polyline([(60, 0, 0), (80, 0, 0), (80, 0, 20), (60, 0, 20)], closed: true, round: 4mm)
surface tyre = revolve(section)
shell ring of tyre
curve bullet = arc((0, 0, -30), (10, 0, -20), through: (10 * sqrt(0.5), 0, -20 - 10 * sqrt(0.5))) + line((10, 0, -20), (10, 0, -5)) + line((10, 0, -5), (0, 0, -5))
surface pin = revolve(bullet)
shell stud of pin
surface lens = revolve(ellipse(center: (100, 0, 0), major: (5, 0, 0), minor: (0, 2, 0)), axis: (0, 1, 0), about: (120, 0, 0), angle: 90deg)
export box to "box.step"
export ring to "ring.step"
export stud to "stud.step"
export lens to "lens.step"
export foot to "foot.step"
export box to "box.igs"
export foot to "foot.igs"
"#;
    let files = run("rows", model);
    let forms = |name: &str| {
        let all = records(&files[name]);
        let names = ["PLANE", "CYLINDRICAL_SURFACE", "CONICAL_SURFACE", "SPHERICAL_SURFACE", "TOROIDAL_SURFACE", "LINE", "CIRCLE"];
        assert!(!files[name].contains("B_SPLINE"), "{name}");
        names.map(|form| of_type(&all, form).len())
    };
    assert_eq!(forms("box.step"), [6, 4, 0, 0, 0, 16, 8]);
    assert_eq!(forms("ring.step"), [2, 2, 0, 0, 4, 2, 12]);
    assert_eq!(forms("stud.step"), [1, 1, 0, 1, 0, 1, 3]);
    assert_eq!(forms("foot.step"), [1, 0, 0, 0, 0, 4, 4]);
    assert_eq!(files["lens.step"].matches("SURFACE_OF_REVOLUTION").count(), 1);
    let named = |name: &str, face: &str| of_type(&records(&files[name]), "ADVANCED_FACE").iter().filter(|f| f.1.contains(face)).count();
    assert_eq!((named("box.step", "'wall'"), named("box.step", "'foot'"), named("ring.step", "'tyre'")), (8, 1, 8));
    let entities = |name: &str, kind: u32| {
        files[name]
            .lines()
            .filter(|l| {
                l.ends_with(|c: char| c.is_ascii_digit()) && l.as_bytes()[72] == b'D' && l.trim_start().starts_with(&format!("{kind} "))
            })
            .count()
            / 2
    };
    assert_eq!([190, 192, 110, 100, 126, 128].map(|kind| entities("box.igs", kind)), [6, 4, 16, 8, 0, 0]);
    assert_eq!([190, 514, 126, 128].map(|kind| entities("foot.igs", kind)), [1, 1, 0, 0]);
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("step_out_rows");
    let back = ["box.step", "ring.step", "stud.step", "box.igs"]
        .map(|name| format!("import \"{}\" as {}\n", folder.join(name).display(), name.replace('.', "_")))
        .concat();
    let checks = r#"check "box": box_step.volume == (1200 - (4 - pi) * 64) * 10mm3 within 1e-9
check "again": box_igs.volume == box_step.volume within 1e-9
check "ring": ring_step.volume == 2 * pi * 70 * (400 - (4 - pi) * 16) * 1mm3 within 1e-7
check "stud": stud_step.volume == pi * (1500 + 2000 / 3) * 1mm3 within 1e-8
check "names": len(box_step.faces) == 10 and area(box_step["wall_8"]) == area(box_step["wall_4"]) within 1e-9
"#;
    run("rows_back", &format!("units mm\n{back}{checks}"));
}

/// A trimmed face is cut where the pieces of its profile meet, at its seam too; a plane has no seam.
#[test]
fn trimmed_faces_are_cut_where_pieces_meet() {
    let model = r#"units mm
curve rim = polyline([(0, 0), (40, 0), (40, 30), (0, 30)], closed: true, round: 8mm)
surface sides = extrude(rim, by: (0, 0, 10))
surface foot = plane(rim)
surface lid = move(foot, by: (0, 0, 10))
surface drill = extrude(circle(center: (20, -5, 5), radius: 3, normal: (0, 1, 0)), by: (0, 50, 0))
surface wall = trim(sides, by: drill, keep: sides.at(0.01, 0.1))
surface bore = trim(drill, by: sides, keep: (20, 15, 8))
shell box of foot, lid, wall, bore
export box to "box.step"
"#;
    let files = run("trimmed", model);
    let all = records(&files["box.step"]);
    let count = |form: &str| of_type(&all, form).len();
    assert_eq!((count("PLANE"), count("CYLINDRICAL_SURFACE"), count("B_SPLINE_SURFACE_WITH_KNOTS")), (6, 5, 0));
    assert_eq!(
        (count("MANIFOLD_SOLID_BREP"), of_type(&all, "ADVANCED_FACE").iter().filter(|face| face.1.contains("'wall'")).count()),
        (1, 8)
    );
}

/// No inner knot stands as often as the degree where the curve has no corner: other programs cut curves there.
#[test]
fn smooth_curves_have_no_knots_like_corners() {
    let files =
        run("smooth", "units mm\ncurve h = helix(center: (0, 0, 0), start: (20, 0, 0), pitch: 10mm, turns: 3)\nexport h to \"h.step\"\n");
    let all = records(&files["h.step"]);
    let (_, curve) = of_type(&all, "B_SPLINE_CURVE_WITH_KNOTS")[0];
    let times = curve.split("(4,").nth(1).unwrap().split(",4)").next().unwrap();
    assert!(times.split(',').all(|k| k == "2") && times.len() > 100, "{times}");
}

/// Faces of a file without common edges show one side where they hang together, closed or open, and enclose what they close round.
#[test]
fn faces_of_unsewn_files_have_one_orientation() {
    let loose = r#"units mm
curve rim = polyline([(0, 0), (10, 0), (10, 20), (0, 20)], closed: true)
surface foot = plane(rim)
surface head = move(foot, by: (0, 0, 30))
let walls = [for pair in [[(0, 0, 0), (10, 0, 0)], [(10, 0, 0), (10, 20, 0)], [(10, 20, 0), (0, 20, 0)], [(0, 20, 0), (0, 0, 0)]]: extrude(line(pair[0], pair[1]), by: (0, 0, 30))]
surface bubble = revolve(arc((5, 10, 10), (5, 10, 16), through: (8, 10, 13)), axis: line((5, 10, 0), (5, 10, 1)))
export foot, head, walls[0], -walls[1], walls[2], -walls[3], bubble to "closed.step"
export foot, walls[0], -walls[1], walls[2], -walls[3] to "open.step"
"#;
    run("loose", loose);
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("step_out_loose");
    let back = |name: &str| format!("import \"{}\" as {}\n", folder.join(format!("{name}.step")).display(), name);
    let model = format!(
        "units mm\n{}{}check \"volume\": closed.volume == (6000 - 36 * pi) * 1mm3 within 1e-6\nmesh shut of closed {{ size: 4 }}\nmesh tub of open {{ size: 4 }}\ncheck \"watertight\": shut.watertight\nexport tub to \"tub.obj\"\n",
        back("closed"),
        back("open")
    );
    let files = run("loose_back", &model);
    let mut ways: BTreeMap<(u32, u32), usize> = BTreeMap::new();
    for line in files["tub.obj"].lines().filter(|line| line.starts_with("f ")) {
        let nodes: Vec<u32> = line[2..].split(' ').map(|node| node.split('/').next().unwrap().parse().unwrap()).collect();
        (0..nodes.len()).for_each(|k| *ways.entry((nodes[k], nodes[(k + 1) % nodes.len()])).or_default() += 1);
    }
    assert!(ways.len() > 100 && ways.values().all(|n| *n == 1), "edges that run the same way in both faces");
}

/// A file that is read and written keeps the names of its product, solid and faces; what has no name there goes out without one.
#[test]
fn an_imported_part_keeps_its_names_and_gets_no_others() {
    let model = "units mm\ncurve rim = circle(center: (0, 0, 0), radius: 5mm)\nsurface wall = extrude(rim, by: (0, 0, 9))\nsurface foot = plane(rim)\nsurface lid = move(foot, by: (0, 0, 9))\nshell can of foot, lid, wall\nexport can to \"can.step\"\n";
    let text = run("own_names", model).remove("can.step").unwrap();
    let text = text
        .replace("PRODUCT('can','can'", "PRODUCT('Bracket','Bracket'")
        .replace("MANIFOLD_SOLID_BREP('can'", "MANIFOLD_SOLID_BREP('Block'");
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("step_out_own_names").join("part.step");
    fs::write(&path, text.replace("'foot'", "''").replace("'lid'", "''")).unwrap();
    let model = format!(
        "units mm\nimport \"{}\" as part\nexport part to \"again.step\"\nexport part to \"again.igs\"\nshell own of part\nexport own to \"own.step\"\n",
        path.display()
    );
    let files = run("own_names_again", &model);
    let all = records(&files["again.step"]);
    assert!(of_type(&all, "PRODUCT")[0].1.starts_with("PRODUCT('Bracket','Bracket'"));
    assert!(of_type(&all, "MANIFOLD_SOLID_BREP")[0].1.starts_with("MANIFOLD_SOLID_BREP('Block'"));
    let faces: Vec<&str> = of_type(&all, "ADVANCED_FACE").iter().map(|face| face.1.split('\'').nth(1).unwrap()).collect();
    assert_eq!(faces, ["", "", "wall"]);
    assert!(!files["again.igs"].contains("part"), "names of the script in IGES");
    assert!(files["own.step"].contains("PRODUCT('own','own'") && files["own.step"].contains("MANIFOLD_SOLID_BREP('own'"));
}
