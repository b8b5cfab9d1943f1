//! Loops as CAD systems write them: seams run twice, poles and apexes, faces without an outer loop, loops round the surface.

use std::f64::consts::PI;

use lofting::io::iges::Part;
use lofting::model::measure;

use super::file::File;
use super::{OPTIONS, read};

fn part(f: impl FnOnce(&mut File)) -> Part {
    let mut file = File::default();
    f(&mut file);
    read(file.text().as_bytes(), &OPTIONS).unwrap()
}

/// Areas of all faces; nothing may be remarked.
fn areas(part: &Part) -> Vec<f64> {
    assert_eq!(part.warnings, [], "nothing to remark");
    part.built.iter().flatten().map(measure::area).collect()
}

fn assert_areas(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (found, expected) in found.iter().zip(expected) {
        assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
    }
}

/// The origin and the directions of z and x.
fn frame(f: &mut File) -> [u32; 3] {
    [f.part(116, 0, "0.,0.,0.,0"), f.part(123, 0, "0.,0.,1."), f.part(123, 0, "1.,0.,0.")]
}

/// A cylinder without ends about the z axis.
fn cylinder(f: &mut File, radius: f64) -> u32 {
    let [at, axis, start] = frame(f);
    f.part(192, 1, &format!("{at},{axis},{radius:?},{start}"))
}

/// A circle about the z axis at a height, from its point of y = 0.
fn circle(f: &mut File, z: f64, radius: f64) -> u32 {
    f.part(100, 0, &format!("{z:?},0.,0.,{radius:?},0.,{radius:?},0."))
}

/// The wall of a cylinder whose loop runs its seam up and down, as an edge of a solid and as curves of a bordered surface.
#[test]
fn a_seam_run_twice_bounds_nothing() {
    let wall = |as_edges: bool| {
        part(|f: &mut File| {
            let base = cylinder(f, 2.0);
            let (top, foot, seam) = (circle(f, 3.0, 2.0), circle(f, 0.0, 2.0), f.part(110, 0, "2.,0.,0.,2.,0.,3."));
            if as_edges {
                let ends = f.part(502, 1, "2,2.,0.,3.,2.,0.,0.");
                let edges = f.part(504, 1, &format!("3,{top},{ends},1,{ends},1,{seam},{ends},2,{ends},1,{foot},{ends},2,{ends},2"));
                let border = f.part(508, 1, &format!("4,0,{edges},1,0,0,0,{edges},2,0,0,0,{edges},3,1,0,0,{edges},2,1,0"));
                f.part(510, 1, &format!("{base},1,1,{border}"));
            } else {
                let row = f.part(102, 0, &format!("4,{foot},{seam},{top},{seam}"));
                let border = f.part(142, 0, &format!("1,{base},0,{row},2"));
                f.free(144, 0, &format!("{base},1,0,{border}"));
            }
        })
    };
    assert_areas(&areas(&wall(true)), &[12.0 * PI]);
    assert_areas(&areas(&wall(false)), &[12.0 * PI]);
}

/// Cones end at their apex, whichever way they open.
#[test]
fn a_loop_through_an_apex_closes_there() {
    for (height, axis) in [(2.0, "0.,0.,-1."), (-2.0, "0.,0.,1.")] {
        let cone = part(|f: &mut File| {
            let (at, axis, start) = (f.part(116, 0, "0.,0.,0.,0"), f.part(123, 0, axis), f.part(123, 0, "1.,0.,0."));
            let base = f.part(194, 1, &format!("{at},{axis},2.,45.,{start}"));
            let (rim, side) = (circle(f, 0.0, 2.0), f.part(110, 0, &format!("2.,0.,0.,0.,0.,{height:?}")));
            let ends = f.part(502, 1, &format!("2,2.,0.,0.,0.,0.,{height:?}"));
            let edges = f.part(504, 1, &format!("2,{rim},{ends},1,{ends},1,{side},{ends},1,{ends},2"));
            let border = f.part(508, 1, &format!("4,0,{edges},1,1,0,0,{edges},2,1,0,1,{ends},2,1,0,0,{edges},2,0,0"));
            f.part(510, 1, &format!("{base},1,1,{border}"));
        });
        assert_areas(&areas(&cone), &[PI * 2.0 * 8.0_f64.sqrt()]);
    }
}

/// A circle on a ball bounds two parts: the one on its left is meant, and a loop that has no outer one round it takes it away.
#[test]
fn the_direction_of_a_loop_decides_where_nothing_else_does() {
    let cap = |forwards: u8, has_outer: u8| {
        part(|f: &mut File| {
            let [at, axis, start] = frame(f);
            let base = f.part(196, 1, &format!("{at},5.,{axis},{start}"));
            let rim = circle(f, 3.0, 4.0);
            let ends = f.part(502, 1, "1,4.,0.,3.");
            let edges = f.part(504, 1, &format!("1,{rim},{ends},1,{ends},1"));
            let border = f.part(508, 1, &format!("1,0,{edges},1,{forwards},0"));
            f.part(510, 1, &format!("{base},1,{has_outer},{border}"));
        })
    };
    let (small, large) = (2.0 * PI * 5.0 * 2.0, 2.0 * PI * 5.0 * 8.0);
    for has_outer in [0, 1] {
        assert_areas(&areas(&cap(1, has_outer)), &[small]);
        assert_areas(&areas(&cap(0, has_outer)), &[large]);
    }
}

/// A cylinder has no ends: the part between two circles is meant, also where no loop is said to be the outer one.
#[test]
fn what_has_no_ends_is_bounded_by_its_loops() {
    for (has_outer, first) in [(1, 1), (0, 1), (0, 0), (1, 0)] {
        let wall = part(|f: &mut File| {
            let base = cylinder(f, 2.0);
            let (foot, top, ends) = (circle(f, 0.0, 2.0), circle(f, 5.0, 2.0), f.part(502, 1, "2,2.,0.,0.,2.,0.,5."));
            let edges = f.part(504, 1, &format!("2,{foot},{ends},1,{ends},1,{top},{ends},2,{ends},2"));
            let borders = [first, 1 - first].into_iter().enumerate().map(|(k, o)| f.part(508, 1, &format!("1,0,{edges},{},{o},0", k + 1)));
            let borders: Vec<String> = borders.map(|d| d.to_string()).collect();
            f.part(510, 1, &format!("{base},2,{has_outer},{}", borders.join(",")));
        });
        assert_areas(&areas(&wall), &[20.0 * PI]);
    }
}

/// A circle or an arc across the axis about which it is turned; the whole turn and half of it, from one end of x to the other.
#[test]
fn a_profile_across_its_axis_covers_its_surface_once() {
    let turned = |x: f64, [a, b]: [f64; 2], to: f64| {
        let made = part(|f: &mut File| {
            // x and y of the arc are x and z.
            let upright = f.free(124, 0, "1.,0.,0.,0.,0.,0.,-1.,0.,0.,1.,0.,0.");
            let at = |t: f64| format!("{:?},{:?}", x + 2.0 * t.cos(), 2.0 * t.sin());
            let placed = super::file::Fields { transform: upright, ..super::file::DEPENDENT };
            let arc = f.add(100, 0, placed, &format!("0.,{x:?},0.,{},{}", at(a), at(b)));
            let axis = f.part(110, 0, "0.,0.,0.,0.,0.,1.");
            f.free(120, 0, &format!("{axis},{arc},0.,{to:?}"));
        });
        areas(&made).iter().sum::<f64>()
    };
    let (turn, corner) = (2.0 * PI, 2.0 * PI / 3.0);
    let apple = 4.0 * PI * (2.0 * corner + 4.0 * corner.sin());
    let lemon = 4.0 * PI * (12.0_f64.sqrt() - corner);
    for (found, area) in [
        (turned(0.0, [0.3, 0.3], turn), 16.0 * PI),
        (turned(0.0, [0.3, 0.3], PI), 16.0 * PI),
        (turned(0.0, [PI / 6.0, 5.0 * PI / 6.0], turn), 4.0 * PI),
        (turned(0.0, [PI / 6.0, 5.0 * PI / 6.0], PI), 4.0 * PI),
        // Nothing bounds it: both of its parts.
        (turned(1.0, [0.3, 0.3], turn), apple + lemon),
    ] {
        assert!((found / area - 1.0).abs() < 1e-9, "{found} {area}");
    }
}

/// Curves in (u, v) near 0 that the file does not mark as such are no part of how far things reach.
#[test]
fn what_is_in_the_parameters_of_a_surface_is_not_where_it_is() {
    let mut f = File::default();
    let (at, axis, start) = (f.part(116, 0, "1.E5,-2.E5,3.E5,0"), f.part(123, 0, "0.,0.,1."), f.part(123, 0, "1.,0.,0."));
    let base = f.part(192, 1, &format!("{at},{axis},2.,{start}"));
    let rim = |f: &mut File, z: f64| {
        let there = f.free(124, 0, &format!("1.,0.,0.,1.E5,0.,1.,0.,-2.E5,0.,0.,1.,{:?}", 3e5 + z));
        f.add(100, 0, super::file::Fields { transform: there, ..super::file::DEPENDENT }, "0.,0.,0.,2.,0.,2.,0.")
    };
    let (foot, top) = (rim(&mut f, 0.0), rim(&mut f, 5.0));
    let ends = f.part(502, 1, "2,100002.,-2.E5,3.E5,100002.,-2.E5,300005.");
    let edges = f.part(504, 1, &format!("2,{foot},{ends},1,{ends},1,{top},{ends},2,{ends},2"));
    let along = [0.0, 5.0].map(|v| f.part(110, 0, &format!("0.,{v:?},0.,360.,{v:?},0.")));
    let borders = [0, 1].map(|k| f.part(508, 1, &format!("1,0,{edges},{},{},1,0,{}", k + 1, 1 - k, along[k])));
    f.part(510, 1, &format!("{base},2,1,{},{}", borders[0], borders[1]));
    let reach = lofting::io::iges::open(f.text().as_bytes(), &OPTIONS).unwrap().reach();
    assert!(reach.diagonal() < 10.0, "{reach:?}");
}

/// A face with two parts is two surfaces.
#[test]
fn several_outer_loops_are_several_surfaces() {
    let bands = part(|f: &mut File| {
        let base = cylinder(f, 1.0);
        let rims = [0.0, 1.0, 4.0, 6.0].map(|z| circle(f, z, 1.0));
        let ends = f.part(502, 1, "4,1.,0.,0.,1.,0.,1.,1.,0.,4.,1.,0.,6.");
        let each = (0..4).map(|k| format!("{},{ends},{},{ends},{}", rims[k], k + 1, k + 1)).collect::<Vec<_>>().join(",");
        let edges = f.part(504, 1, &format!("4,{each}"));
        let borders = (0..4).map(|k| f.part(508, 1, &format!("1,0,{edges},{},{},0", k + 1, 1 - k % 2)).to_string());
        let borders = borders.collect::<Vec<_>>().join(",");
        f.part(510, 1, &format!("{base},4,1,{borders}"));
    });
    let mut found = areas(&bands);
    found.sort_by(f64::total_cmp);
    assert_areas(&found, &[2.0 * PI, 4.0 * PI]);
}

/// What a model cuts of turned surfaces, over seams, round poles and through, comes back with its area.
#[test]
fn parts_of_closed_surfaces_come_back() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("iges-loops");
    std::fs::create_dir_all(&folder).unwrap();
    let writes = r#"
units mm
let z = line((0, 0, 0), (0, 0, 1))
curve side = line((10, 0, 0), (10, 0, 30))
surface drum = revolve(side, axis: z)
curve meridian = arc((0, 0, -12), (0, 0, 12), through: (12, 0, 0))
surface ball = revolve(meridian, axis: z)
curve rim = circle(center: (0, 0, 4), radius: sqrt(128) * 1mm, normal: (0, 0, 1))
surface cap = trim(ball, by: rim, keep: (0, 0, 12))
surface rest = trim(ball, by: rim, keep: (0, 0, -12))
curve profile = circle(center: (20, 0, 0), radius: 6mm, normal: (0, 1, 0))
surface ring = revolve(profile, axis: z)
curve wave = meet(drum, plane(at: (0, 0, 15), normal: (1, 0, 4)))[0]
surface stump = trim(drum, by: wave, keep: (10, 0, 1))
surface bore = revolve(line((-30, 4, 15), (30, 4, 15)), axis: line((0, 0, 15), (1, 0, 15)))
let mouths = meet(drum, bore)
surface pierced = trim(drum, holes: [for m in mouths: [m]])
surface mouth = trim(drum, mouths[0])
curve bite = meet(ball, plane(at: (3, 0, 0), normal: (3, 1, 0)))[0]
surface side_cap = trim(ball, by: bite, keep: (12, 0, 0))
surface upper = trim(ring, by: [
  circle(center: (0, 0, 0), radius: 26mm, normal: (0, 0, 1)),
  circle(center: (0, 0, 0), radius: 14mm, normal: (0, 0, 1)),
], keep: (20, 0, 6))
export drum, ball, cap, rest, ring, stump, pierced, mouth, side_cap, upper to "cut.igs"
"#;
    let reads = r#"
import "cut.igs" as part
use "writes.loft" as model
check len(part.surfaces) == 10
check area(part.cap) == area(model.cap) within 0.0001%
check area(part.rest) == area(model.rest) within 0.0001%
check area(part.stump) == area(model.stump) within 0.0001%
check area(part.pierced) == area(model.pierced) within 0.0001%
check area(part.mouth) == area(model.mouth) within 0.0001%
check area(part.side_cap) == area(model.side_cap) within 0.0001%
check area(part.upper) == area(model.upper) within 0.0001%
"#;
    for (name, script) in [("writes.loft", writes), ("reads.loft", reads)] {
        std::fs::write(folder.join(name), script).unwrap();
        let run = std::process::Command::new(env!("CARGO_BIN_EXE_loft")).args(["run", name]).current_dir(&folder).output().unwrap();
        let (out, err) = (String::from_utf8_lossy(&run.stdout), String::from_utf8_lossy(&run.stderr));
        assert!(run.status.success() && !err.contains("W810"), "{name}: {out}{err}");
    }
}
