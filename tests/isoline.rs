//! Cells between lines of constant u and v: the marks of [Jeong & Park 2000] against a reference, and against the winding.

use std::f64::consts::PI;

use glam::DVec2;
use lofting::mesh::tri::isoline::{Cut, IsolineCells};
use lofting::mesh::tri::marks::{corners, marks};
use lofting::mesh::tri::tree::{Class, Tree};
use serde_json::Value;

use crate::support::borders::closed;
use crate::support::reference::reference;

fn given(value: &Value) -> (Vec<[DVec2; 2]>, (DVec2, DVec2)) {
    let number = |v: &Value| v.as_f64().unwrap();
    let points: Vec<DVec2> = value["loop"].as_array().unwrap().iter().map(|p| DVec2::new(number(&p[0]), number(&p[1]))).collect();
    let cell = &value["cell"];
    let at = |k: usize| number(&cell[k]);
    (closed(&points), (DVec2::new(at(0), at(1)), DVec2::new(at(2), at(3))))
}

/// What is outside a loop that runs counter-clockwise is kept.
fn kept(segments: &[[DVec2; 2]], at: DVec2) -> bool {
    !Tree::new(segments, segments.len(), (DVec2::splat(-1.0), DVec2::splat(2.0)), (1, 1)).holds(at)
}

#[test]
fn marks_at_the_corners_of_a_cell() {
    for name in ["corner_cut", "same_edge_in_and_out"] {
        let value = &reference("trim_marking")[name];
        let (segments, cell) = given(value);
        let wanted: Vec<u64> = value["values"].as_array().unwrap().iter().map(|v| v.as_u64().unwrap()).collect();
        assert_eq!(marks(cell, segments.iter().copied()).map(u64::from).to_vec(), wanted, "{name}");
        let truth: Vec<bool> = value["true_kept"].as_array().unwrap().iter().map(|v| v.as_bool().unwrap()).collect();
        assert_eq!(corners(cell).map(|at| kept(&segments, at)).to_vec(), truth, "{name}");
    }
    let (segments, cell) = given(&reference("trim_marking")["corner_cut"]);
    assert_eq!(marks(cell, segments.into_iter()), [0, 2, 2, 2]);
}

#[test]
fn where_marks_fail_the_winding_does_not() {
    let round = |center: DVec2, radius: f64| -> Vec<DVec2> {
        let at = |k: usize| 2.0 * PI * k as f64 / 48.0;
        (0..48).map(|k| center + radius * DVec2::new(at(k).cos(), at(k).sin())).collect()
    };
    let spike = [(0.3, 0.3), (0.9, 0.32), (0.3, 0.34)].map(DVec2::from).to_vec();
    let trials = [("circle", round(DVec2::new(0.52, 0.47), 0.31)), ("small", round(DVec2::new(0.56, 0.44), 0.03)), ("sharp", spike)];
    let all = reference("trim_marking");
    for (name, points) in &trials {
        let wanted = all["grid_trials"].as_object().unwrap().iter().find(|(n, _)| n.starts_with(name)).unwrap().1;
        let segments = closed(points);
        let (mut checks, mut wrong, mut unseen) = (0, 0, 0);
        for k in 0..64 {
            let low = DVec2::new(f64::from(k % 8), f64::from(k / 8)) / 8.0;
            let cell = (low, low + 0.125);
            let found = marks(cell, segments.iter().copied());
            if found == [0; 4] {
                unseen += u64::from(points.iter().any(|p| p.cmpgt(cell.0).all() && p.cmplt(cell.1).all()));
                continue;
            }
            checks += 4;
            wrong += corners(cell).iter().zip(found).filter(|(at, mark)| kept(&segments, **at) != (*mark == 2)).count() as u64;
        }
        let said = |key: &str| wanted[key].as_u64().unwrap();
        assert_eq!((checks, wrong, unseen), (said("corner_checks"), said("disagreements"), said("cells_with_undetected_loop")), "{name}");
    }
}

/// A loop inside one cell crosses none of its sides, and makes it a crossed one all the same.
#[test]
fn a_small_loop_crosses_its_cell() {
    let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(DVec2::from);
    let eye = [(0.4, 0.4), (0.4, 0.41), (0.41, 0.41), (0.41, 0.4)].map(DVec2::from);
    let segments = [closed(&square), closed(&eye)].concat();
    let mut cells = IsolineCells::new(&segments, segments.len(), Default::default());
    assert_eq!(cells.all()[0].class, Class::Partial);
    cells.split(0, Cut { axis: 0, parts: 2 }, lofting::mesh::request::decider::Why::Size);
    let classes: Vec<Class> = cells.all()[1..].iter().map(|c| c.class).collect();
    assert_eq!(classes, [Class::Partial, Class::Interior]);
    assert!(!cells.holds(DVec2::splat(0.405)) && cells.holds(DVec2::splat(0.2)));
}
