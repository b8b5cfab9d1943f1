//! Faces whose borders do not quite meet.

use glam::DVec3;
use lofting::base::fault::{Fault, PlainWords};
use lofting::base::origin::Origin;
use lofting::base::tolerance::Tolerance;
use lofting::geometry::construct::build::{arc_through, circle, line};
use lofting::mesh::Mesh;
use lofting::model::fault::GluingFault;
use lofting::network::Chain;
use lofting::surface::Surface;
use lofting::surface::blended::plane_face::bounded;

use super::{Census, Skin, census, of_surfaces};

fn tolerance() -> Tolerance {
    Tolerance::new(1e-6, 10.0)
}

fn inside(chains: &[Chain]) -> Surface {
    bounded(chains, Origin::NONE, &tolerance()).unwrap().0
}

/// A flat face between corners that are told in order.
fn flat(corners: &[[f64; 3]]) -> Surface {
    let at = |k: usize| DVec3::from(corners[k % corners.len()]);
    let side = |k: usize| Chain::of_curve(&line(at(k), at(k + 1), Origin::NONE).unwrap());
    inside(&(0..corners.len()).map(side).collect::<Vec<_>>())
}

fn glued(faces: &[Surface], snap: f64) -> Result<Skin, Fault> {
    of_surfaces(faces.to_vec(), tolerance(), Some(snap))
}

fn codes(skin: &Skin) -> Vec<&'static str> {
    skin.said.iter().map(|f| f.code().0).collect()
}

fn meshed(skin: &Skin, size: f64) -> (Mesh, Census) {
    let mesh = skin.mesh(&skin.plan(size));
    let census = census(&mesh, 2.0 * skin.shell.near);
    (mesh, census)
}

/// Sorted places of the nodes for which `on` holds.
fn places(mesh: &Mesh, on: impl Fn(DVec3) -> bool) -> Vec<DVec3> {
    let mut found: Vec<DVec3> = mesh.nodes.iter().copied().filter(|p| on(*p)).collect();
    found.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)).then(a.z.total_cmp(&b.z)));
    found
}

/// `meshing.json`, `boundary_pretreatment`: corners at 0, 4, 10 and at 0, 6, 10 of one line make nodes at 0, 2, 4, 6, 8, 10.
#[test]
fn neighbours_with_other_corners_take_the_same_nodes() {
    let json = std::fs::read(std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/reference/meshing.json")).unwrap();
    let facts: serde_json::Value = serde_json::from_slice(&json).unwrap();
    let facts = &facts["boundary_pretreatment"];
    let numbers = |list: &serde_json::Value| list.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect::<Vec<f64>>();
    let points = &facts["characteristic_points"];
    let (one, two) = (numbers(&points["face1"]), numbers(&points["face2"]));
    for gap in [0.0, 0.001] {
        let upper: Vec<[f64; 3]> = one.iter().map(|x| [*x, gap, 0.0]).chain([[10.0, 5.0, 0.0], [0.0, 5.0, 0.0]]).collect();
        let lower: Vec<[f64; 3]> =
            [[0.0, -5.0, 0.0], [10.0, -5.0, 0.0]].into_iter().chain(two.iter().rev().map(|x| [*x, 0.0, 0.0])).collect();
        let skin = glued(&[flat(&upper), flat(&lower)], 0.002).unwrap();
        let (mesh, census) = meshed(&skin, facts["max_edge"].as_f64().unwrap());
        assert_eq!((census.euler, census.loops), (1, 1));
        let found: Vec<f64> = places(&mesh, |p| p.y.abs() < 0.01).iter().map(|p| p.x).collect();
        let expected = numbers(&facts["nodes"]);
        assert_eq!(found.len(), expected.len(), "{found:?}");
        assert!(found.iter().zip(&expected).all(|(a, b)| (a - b).abs() <= 1e-9), "{found:?}");
    }
}

fn two_squares(gap: f64) -> [Surface; 2] {
    let left = flat(&[[0.0, 0.0, 0.0], [5.0, 0.0, 0.0], [5.0, 5.0, 0.0], [0.0, 5.0, 0.0]]);
    let right = flat(&[[5.0 + gap, 0.0, 0.0], [10.0, 0.0, 2.0], [10.0, 5.0, 2.0], [5.0 + gap, 5.0, 0.0]]);
    [left, right]
}

#[test]
fn a_gap_as_wide_as_stated_is_glued_and_a_wider_one_is_an_error() {
    let skin = glued(&two_squares(0.01), 0.01).unwrap();
    assert_eq!(codes(&skin), ["N513", "N615"]);
    let (_, census) = meshed(&skin, 1.0);
    assert_eq!((census.euler, census.loops), (1, 1));
    for (gap, code) in [(0.01 + 1e-7, "E711"), (0.0299, "E711"), (0.0301, "E618")] {
        let fault = glued(&two_squares(gap), 0.01).err().unwrap();
        assert_eq!(fault.code().0, code, "{gap}: {fault:?}");
        let help = fault.describe(&PlainWords).help.unwrap_or_default();
        assert!(code == "E711" || help.contains("`snap: 0.05`"), "{help}");
    }
    let fault = glued(&two_squares(0.02), 0.01).err().unwrap();
    let Some(&GluingFault::EdgeMismatch { gap, at, .. }) = fault.of() else { panic!("another fault: {fault:?}") };
    assert!((gap - 0.02).abs() < 1e-9 && (at.x - 5.0).abs() < 0.021, "{gap} {at}");
    // Nothing stated: they are two faces.
    assert_eq!(of_surfaces(two_squares(0.02).to_vec(), tolerance(), None).err().unwrap().code().0, "E618");
}

/// One long edge, two short ones that miss it and each other.
#[test]
fn a_long_edge_meets_two_short_ones() {
    let long = flat(&[[0.0, 0.0, 0.0], [10.0, 0.0, 0.0], [10.0, 5.0, 0.0], [0.0, 5.0, 0.0]]);
    let one = flat(&[[0.0, -5.0, 0.0], [4.004, -5.0, 0.0], [4.004, -0.006, 0.0], [0.0, -0.003, 0.0]]);
    let two = flat(&[[4.0, -5.0, 1.003], [10.0, -5.0, 1.003], [10.0, -0.002, 0.003], [4.0, -0.002, 0.003]]);
    let skin = glued(&[long, one, two], 0.01).unwrap();
    let (mesh, census) = meshed(&skin, 1.3);
    // Between the short ones a wedge stays open.
    assert_eq!((census.euler, census.loops), (1, 1));
    assert_eq!(places(&mesh, |p| p.distance(DVec3::new(4.0, 0.0, 0.0)) < 0.02).len(), 1);
}

#[test]
fn three_faces_on_an_edge_share_its_nodes_and_make_no_shell() {
    let mut faces = two_squares(0.004).to_vec();
    faces.push(flat(&[[5.0, 0.0, 0.005], [5.0, 5.0, 0.005], [5.0, 5.0, 4.0], [5.0, 0.0, 4.0]]));
    assert_eq!(glued(&faces, 0.01).err().unwrap().code().0, "E617");
}

#[test]
fn a_circle_is_glued_to_two_half_circles() {
    let turn = |r: f64, angle: f64, z: f64| DVec3::new(r * angle.to_radians().cos(), r * angle.to_radians().sin(), z);
    let hole = circle(DVec3::ZERO, 2.0, DVec3::Z, Origin::NONE).unwrap();
    let square = flat(&[[-5.0, -5.0, 0.0], [5.0, -5.0, 0.0], [5.0, 5.0, 0.0], [-5.0, 5.0, 0.0]]);
    let ring = lofting::surface::trim(&square, &[], &[vec![Chain::of_curve(&hole)]], Origin::NONE, &tolerance()).unwrap();
    // Two half discs whose ends are elsewhere than the start of the circle, smaller by 0.003 and a little higher.
    let half = |a: f64| {
        let (p, m, q) = (turn(1.997, a, 0.002), turn(1.997, a + 90.0, 0.002), turn(1.997, a + 180.0, 0.002));
        let arc = arc_through(p, q, m, Origin::NONE).unwrap();
        inside(&[Chain::of_curve(&arc), Chain::of_curve(&line(q, p, Origin::NONE).unwrap())])
    };
    let skin = glued(&[ring, half(33.0), half(213.0)], 0.01).unwrap();
    let (_, census) = meshed(&skin, 0.7);
    assert_eq!((census.euler, census.loops), (1, 1));
    assert!((census.free - 40.0).abs() < 1e-9, "the square alone is free: {}", census.free);
}

/// Edges no longer than what is glued become corners, and a note says so.
#[test]
fn edges_shorter_than_the_reach_become_corners() {
    let nicked = flat(&[[0.0, 0.0, 0.0], [5.0, 0.0, 0.0], [5.008, 0.002, 0.0], [5.0, 5.0, 0.0], [0.0, 5.0, 0.0]]);
    let [_, right] = two_squares(0.004);
    let skin = glued(&[nicked, right], 0.02).unwrap();
    assert_eq!(codes(&skin), ["N712", "N513", "N615"]);
    let (_, census) = meshed(&skin, 1.0);
    assert_eq!((census.euler, census.loops), (1, 1));
    assert!(census.least_angle > 30.0, "{}", census.least_angle);
}

/// Faces thinner than the reach, as wide all along or to a point, become the edge between their neighbours.
#[test]
fn slivers_become_edges() {
    for width in [0.006, 0.0] {
        let [left, _] = two_squares(0.0);
        let right = flat(&[[5.0 + width, 0.0, 0.0], [10.0, 0.0, 0.0], [10.0, 5.0, 0.0], [5.008, 5.0, 0.0]]);
        let mut strip = vec![[5.0, 0.0, 0.0], [5.0 + width, 0.0, 0.0], [5.008, 5.0, 0.0], [5.0, 5.0, 0.0]];
        if width == 0.0 {
            strip.remove(1);
        }
        let skin = glued(&[flat(&strip), left, right], 0.01).unwrap();
        assert_eq!(codes(&skin).iter().filter(|c| **c == "N712").count(), 2, "{:?}", skin.said);
        let (mesh, census) = meshed(&skin, 1.0);
        assert_eq!((census.euler, census.loops), (1, 1), "{width}");
        assert_eq!(mesh.faces.len(), 2);
        assert!(census.least_angle > 30.0);
    }
}

/// A fillet in steps shorter than the reach keeps its steps: corners are not passed on along it.
#[test]
fn a_row_of_short_edges_stays_a_row() {
    let bend = |k: u32| {
        let angle = f64::from(k) * std::f64::consts::FRAC_PI_2 / 40.0;
        [4.5 + 0.5 * angle.sin(), 0.5 - 0.5 * angle.cos(), 0.0]
    };
    let mut corners = vec![[0.0, 0.0, 0.0]];
    corners.extend((0..=40).map(bend));
    corners.extend([[5.0, 5.0, 0.0], [0.0, 5.0, 0.0]]);
    let [_, right] = two_squares(0.004);
    let right_low = flat(&[[5.004, 0.5, 0.0], [10.0, 0.5, 2.0], [10.0, 5.0, 2.0], [5.004, 5.0, 0.0]]);
    let skin = glued(&[flat(&corners), right_low], 0.03).unwrap();
    let (mesh, census) = meshed(&skin, 1.0);
    assert_eq!((census.euler, census.loops), (1, 1));
    let area: f64 = 25.0 - 0.25 + std::f64::consts::FRAC_PI_4 * 0.25;
    let flat_area: f64 = mesh.triangles[mesh.faces[0].triangles.start as usize..mesh.faces[0].triangles.end as usize]
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|n| mesh.nodes[n as usize]);
            0.5 * (b - a).cross(c - a).length()
        })
        .sum();
    assert!((flat_area - area).abs() < 0.01, "{flat_area} {area}");
    drop(right);
}

/// The same nodes whatever the order of the faces.
#[test]
fn the_order_of_faces_does_not_matter() {
    let mut faces = two_squares(0.004).to_vec();
    faces.push(flat(&[[0.0, 5.003, 0.001], [5.002, 5.003, 0.001], [5.0, 9.0, 1.0], [0.0, 9.0, 1.0]]));
    faces.push(flat(&[[5.002, 5.002, 0.002], [10.0, 5.002, 2.002], [10.0, 9.0, 3.002], [5.002, 9.0, 1.002]]));
    let mut known: Option<Vec<DVec3>> = None;
    for order in [[0, 1, 2, 3], [3, 2, 1, 0], [2, 0, 3, 1], [1, 3, 0, 2]] {
        let skin = glued(&order.map(|k: usize| faces[k].clone()), 0.01).unwrap();
        let (mesh, census) = meshed(&skin, 1.1);
        assert_eq!((census.euler, census.loops), (1, 1), "{order:?}");
        let found = places(&mesh, |_| true);
        let known = known.get_or_insert_with(|| found.clone());
        assert_eq!(found.len(), known.len(), "{order:?}");
        let worst = found.iter().zip(known.iter()).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        assert!(worst <= 1e-9, "{order:?}: {worst}");
    }
}
