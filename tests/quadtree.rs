//! The quadtree: leaf counts against an exact reference, and what meshes gain by it.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use glam::DVec2;
use lofting::mesh::tri::tree::{Class, Halt, MAX_DEPTH, Tree, TreeCell};
use serde_json::Value;

use crate::support::borders::closed;
use crate::support::reference::reference;

/// Leaves by level and class.
fn counts(tree: &Tree) -> BTreeMap<(String, &'static str), u64> {
    let mut found = BTreeMap::new();
    for cell in tree.cells().iter().filter(|c| c.is_leaf()) {
        let class = match cell.class {
            Class::Interior => "interior",
            Class::Partial => "partial",
            Class::Exterior => "exterior",
        };
        *found.entry((cell.level.to_string(), class)).or_insert(0) += 1;
    }
    found
}

fn check(tree: &Tree, expected: &Value) {
    let found = counts(tree);
    assert_eq!(found.values().sum::<u64>(), expected["total"].as_u64().unwrap(), "{found:?}");
    for (level, classes) in expected["by_level"].as_object().unwrap() {
        for class in ["interior", "partial", "exterior"] {
            let wanted = classes[class].as_u64().unwrap();
            assert_eq!(found.get(&(level.clone(), class)).copied().unwrap_or(0), wanted, "level {level} {class}");
        }
    }
    for class in ["interior", "partial", "exterior"] {
        let sum: u64 = found.iter().filter(|(k, _)| k.1 == class).map(|(_, n)| n).sum();
        assert_eq!(sum, expected["by_class"][class].as_u64().unwrap(), "{class}");
    }
}

/// No leaf has a neighbour over an edge of less than half its side.
fn check_balance(tree: &Tree) {
    for cell in tree.cells().iter().filter(|c| c.is_leaf()) {
        let (i, j) = cell.at;
        let next = [(Some(i + 1), Some(j)), (i.checked_sub(1), Some(j)), (Some(i), Some(j + 1)), (Some(i), j.checked_sub(1))];
        for at in next.into_iter().filter_map(|(i, j)| i.zip(j)) {
            let Some(other) = tree.find(cell.level, at) else { continue };
            assert!(tree.cells()[other as usize].level + 1 >= cell.level, "{cell:?}");
        }
    }
}

#[test]
fn a_square_with_a_round_hole() {
    let all = reference("quadtree");
    let point = |p: &Value| DVec2::new(p[0].as_f64().unwrap(), p[1].as_f64().unwrap());
    let outer: Vec<DVec2> = all["square_with_hole"]["outer"].as_array().unwrap().iter().map(point).collect();
    let vertex = |k: usize| {
        let angle = 2.0 * PI * (k as f64 + 0.5) / 32.0;
        DVec2::new(0.5 + 0.2 * angle.cos(), 0.5 + 0.2 * angle.sin())
    };
    let hole: Vec<DVec2> = (0..32).rev().map(vertex).collect();
    let segments = [closed(&outer), closed(&hole)].concat();
    let lengths: Vec<f64> = segments.iter().map(|[a, b]| a.distance(*b)).collect();
    let given = all["square_with_hole"]["hole_segment_length"].as_f64().unwrap();
    assert!((lengths[4] - given).abs() < 1e-15);
    let mut tree = Tree::new(&segments, segments.len(), (DVec2::ZERO, DVec2::ONE), (4, 4));
    let wants = |tree: &Tree, cell: &TreeCell| {
        let shortest = cell.segments.iter().map(|s| lengths[*s as usize]).fold(f64::INFINITY, f64::min);
        tree.side(cell.level).max_element() > shortest
    };
    assert_eq!(tree.refine(&wants, 10_000), Ok(()));
    check(&tree, &all["square_with_hole"]["plain"]);
    tree.balance();
    check(&tree, &all["square_with_hole"]["balanced_2_to_1_edge"]);
    check_balance(&tree);
}

#[test]
fn a_quadrilateral_to_given_depths() {
    let all = reference("quadtree");
    let given = &all["quadrilateral"];
    let point = |p: &Value| DVec2::new(p[0].as_f64().unwrap(), p[1].as_f64().unwrap());
    let segments = closed(&given["polygon"].as_array().unwrap().iter().map(point).collect::<Vec<_>>());
    for (depth, results) in given["results"].as_object().unwrap() {
        let depth: u8 = depth.parse().unwrap();
        let mut tree = Tree::new(&segments, segments.len(), (DVec2::ZERO, DVec2::ONE), (1, 1));
        assert_eq!(tree.refine(&|_, cell| cell.class == Class::Partial && cell.level < depth, 100_000), Ok(()));
        check(&tree, &results["plain"]);
        let area = |class: Class| {
            let own = tree.cells().iter().filter(|c| c.is_leaf() && c.class == class);
            own.map(|c| tree.side(c.level).element_product()).sum::<f64>()
        };
        let exact = given["area"].as_f64().unwrap();
        assert!(area(Class::Interior) <= exact && exact <= area(Class::Interior) + area(Class::Partial));
        if depth == 6 {
            assert_eq!(area(Class::Interior), given["depth6_interior_area"].as_f64().unwrap());
            assert_eq!(area(Class::Partial), given["depth6_partial_area"].as_f64().unwrap());
        }
        tree.balance();
        check_balance(&tree);
        if let Some(balanced) = results.get("balanced") {
            check(&tree, balanced);
        }
    }
}

/// The plate of figure 13 of [Yoo & Yoon 2000]: minimum angle (degrees) and mean quality of its triangles.
mod plate {
    use super::*;
    use glam::DVec3;
    use lofting::base::job::Job;
    use lofting::base::triangulate_points::points;
    use lofting::mesh::chart::outline::Outline;
    use lofting::mesh::chart::parametric_surface::{ParametricSurface, Spot, UniformSize};
    use lofting::mesh::tri::build::{NodePlacement, Task, triangulate};
    use lofting::mesh::tri::optimize::{FINEST, OptimizeSettings, SearchBudget};
    use lofting::mesh::tri::shape::quality;

    struct Flat;

    impl ParametricSurface for Flat {
        fn spot(&self, xy: DVec2) -> Spot {
            Spot { p: xy.extend(0.0), dx: DVec3::X, dy: DVec3::Y }
        }
        fn clamp(&self, xy: DVec2) -> DVec2 {
            xy
        }
    }

    fn outline(size: f64) -> Outline {
        let holes = [(40.0, 60.0, 20.0), (100.0, 35.0, 12.0), (100.0, 85.0, 15.0), (160.0, 60.0, 25.0)];
        let mut out = Outline::default();
        let mut add = |loop_: Vec<DVec2>| {
            let first = out.xy.len() as u32;
            let n = loop_.len() as u32;
            out.loops.extend((0..n).map(|k| [first + k, first + (k + 1) % n]));
            out.p.extend(loop_.iter().map(|xy| xy.extend(0.0)));
            out.xy.extend(loop_);
        };
        let corners = [(0.0, 0.0), (200.0, 0.0), (200.0, 120.0), (0.0, 120.0)].map(DVec2::from);
        let side = |k: usize| {
            let (a, b) = (corners[k], corners[(k + 1) % 4]);
            let n = (a.distance(b) / size).ceil() as usize;
            (0..n).map(move |i| a.lerp(b, i as f64 / n as f64))
        };
        add((0..4).flat_map(side).collect());
        for (x, y, r) in holes {
            let n = (2.0 * PI * r / size).ceil() as usize;
            let at = |k: usize| 2.0 * PI * k as f64 / n as f64;
            add((0..n).rev().map(|k| DVec2::new(x + r * at(k).cos(), y + r * at(k).sin())).collect());
        }
        out
    }

    fn figures(p: &[DVec3], triangles: impl Iterator<Item = [u32; 3]>) -> (f64, f64, f64) {
        let (mut least, mut sum, mut n, mut area) = (f64::INFINITY, 0.0, 0.0, 0.0);
        for t in triangles {
            let c = t.map(|n| p[n as usize]);
            for k in 0..3 {
                least = least.min((c[(k + 1) % 3] - c[k]).angle_between(c[(k + 2) % 3] - c[k]).to_degrees());
            }
            sum += quality(c[0], c[1], c[2]);
            area += 0.5 * (c[1] - c[0]).cross(c[2] - c[0]).z;
            n += 1.0;
        }
        (least, sum / n, area)
    }

    #[test]
    fn angles_and_quality_rise_with_the_tree_and_with_smoothing() {
        let outline = outline(4.0);
        let all = points(&outline.xy, &outline.loops).unwrap();
        let segments: Vec<[DVec2; 2]> = outline.loops.iter().map(|e| e.map(|n| outline.xy[n as usize])).collect();
        let tree = Tree::new(&segments, segments.len(), (DVec2::ZERO, DVec2::new(200.0, 120.0)), (1, 1));
        let inside = |t: &[u32; 3]| tree.holds(t.map(|n| outline.xy[n as usize]).into_iter().sum::<DVec2>() / 3.0);
        let bare = figures(&outline.p, all.corners.iter().copied().filter(inside));
        let mesh = |smooth: usize| {
            let settings = OptimizeSettings {
                smoothing_rounds: smooth,
                relaxation: 1.0,
                still_quality: FINEST,
                min_quality: 0.8,
                fair_quality: 1.0,
                max_length_ratio: 1.3,
                searches: SearchBudget::FEW,
            };
            let (field, lattice) = (UniformSize(4.0 * 0.8), NodePlacement::Tree);
            let task = Task {
                interpolated: None,
                chart_surface: &Flat,
                field: &field,
                outline: &outline,
                lattice,
                settings,
                most: 100_000,
                limit_check: None,
                sliding: None,
            };
            let triangulation = triangulate(&task, &Job::new()).unwrap().unwrap().triangulation;
            figures(&triangulation.p, triangulation.tri.iter().copied())
        };
        let (plain, smoothed) = (mesh(0), mesh(30));
        assert!(bare.0 < plain.0 && plain.0 < smoothed.0, "{bare:?} {plain:?} {smoothed:?}");
        assert!(bare.1 < plain.1 && plain.1 < smoothed.1, "{bare:?} {plain:?} {smoothed:?}");
        // What is missing are the segments of the circles: 2/3 of sagitta times chord each.
        let exact = 19_620.619_840_895_83;
        assert!(((smoothed.2 - exact) / exact).abs() < 0.005 && (plain.2 - smoothed.2).abs() < 1e-9 * exact, "{smoothed:?}");
        assert!(smoothed.0 > 30.0, "{smoothed:?}");
    }
}

/// Lines inside part nothing: cells beside them are inside, wherever the line ends.
#[test]
fn lines_inside_are_no_borders() {
    let corners = [DVec2::ZERO, DVec2::new(1.0, 0.0), DVec2::ONE, DVec2::new(0.0, 1.0)];
    let mut segments = closed(&corners);
    segments.extend([[DVec2::new(0.61, 0.13), DVec2::new(0.67, 0.83)], [DVec2::new(0.2, 0.9), DVec2::new(0.9, 0.35)]]);
    let mut tree = Tree::new(&segments, 4, (DVec2::ZERO, DVec2::ONE), (2, 2));
    assert_eq!(tree.refine(&|_, cell| cell.class == Class::Partial && cell.level < 5, 100_000), Ok(()));
    tree.balance();
    assert!(tree.cells().iter().all(|c| c.class != Class::Exterior));
    for (x, y) in [(0.1, 0.5), (0.64, 0.05), (0.3, 0.55), (0.99, 0.4)] {
        assert!(tree.holds(DVec2::new(x, y)), "({x}, {y})");
    }
}

#[test]
fn the_deepest_level_is_told() {
    let segments = closed(&[DVec2::ZERO, DVec2::new(1.0, 0.0), DVec2::new(0.0, 1.0)]);
    let mut tree = Tree::new(&segments, 3, (DVec2::ZERO, DVec2::ONE), (1, 1));
    let at = DVec2::new(1e-9, 1e-9);
    let holds = |tree: &Tree, cell: &TreeCell| {
        let low = tree.corner(cell.level, cell.at);
        low.cmple(at).all() && (low + tree.side(cell.level)).cmpgt(at).all()
    };
    let Err(Halt::Deep(cell)) = tree.refine(&holds, 10_000) else { panic!("a tree without end") };
    assert_eq!((tree.cells()[cell as usize].level, tree.cells()[cell as usize].at), (MAX_DEPTH, (0, 0)));
}
