//! Layouts of closed surfaces, poles, seams, holes, shared borders, curves and points inside state their conditions; each condition
//! is seen to fail where a layout is broken on purpose.

use std::f64::consts::TAU;

use glam::DVec3;
use lofting::base::job::Job;
use lofting::base::origin::Origin;
use lofting::base::tolerance::Tolerance;
use lofting::geometry::construct::build::{arc_through, circle, line};
use lofting::mesh::border::inside;
use lofting::mesh::border::layout::Layout;
use lofting::mesh::{Input, Plan};
use lofting::model::segments::SegmentUse;
use lofting::model::topology::Named;
use lofting::model::{Model, SurfaceId};
use lofting::network::{Chain, Network};
use lofting::surface::swept::revolve::Axis;
use lofting::surface::{Outlined, Surface, extrude, outlined, revolve};

fn tolerance() -> Tolerance {
    Tolerance::new(1e-5, 20.0)
}

fn p(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

fn straight(a: DVec3, b: DVec3) -> Chain {
    Chain::of_curve(&line(a, b, Origin::NONE).unwrap())
}

fn ring(center: DVec3, radius: f64, normal: DVec3) -> Chain {
    Chain::of_curve(&circle(center, radius, normal, Origin::NONE).unwrap())
}

fn round(profile: &Chain, angle: f64) -> Surface {
    revolve(profile, &Axis { about: DVec3::ZERO, direction: DVec3::Z }, angle, Origin::NONE, &tolerance()).unwrap()
}

fn swept(profile: &Chain, by: DVec3) -> Surface {
    extrude(profile, by, Origin::NONE, &tolerance()).unwrap()
}

/// A ball: two poles and a seam.
fn ball() -> Surface {
    round(&Chain::of_curve(&arc_through(p(0., 0., -5.), p(0., 0., 5.), p(5., 0., 0.), Origin::NONE).unwrap()), TAU)
}

/// A square of 10 × 10 over the plane z = 0, from a corner on.
fn square(at: DVec3) -> Surface {
    swept(&straight(at, at + DVec3::X * 10.0), DVec3::Y * 10.0)
}

fn cut(base: &Surface, loops: &[Vec<Chain>], has_outer: bool) -> Vec<Surface> {
    outlined(base, loops, Outlined { has_outer, inside: None, against: false }, Origin::NONE, &tolerance()).unwrap().0
}

/// A model with the plan of a mesh.
struct Case {
    model: Model,
    network: Network,
    plan: Plan,
    tolerance: Tolerance,
}

impl Case {
    fn new(surfaces: Vec<Surface>) -> Self {
        let (network, tolerance) = (Network::default(), tolerance());
        let named = surfaces.into_iter().enumerate().map(|(k, surface)| Named { name: format!("s{k}"), surface }).collect();
        let model = Model::build(named, &network, &tolerance, &Job::new()).unwrap();
        model.check().unwrap();
        let plan = Plan::of("m", (0..model.surfaces.len()).map(|k| (SurfaceId::at(k), false)).collect());
        Self { model, network, plan, tolerance }
    }

    fn with(mut self, curves: &[Chain], points: &[DVec3]) -> Self {
        self.plan.curves = curves.iter().enumerate().map(|(k, chain)| (format!("c{k}"), chain.clone())).collect();
        self.plan.points = points.to_vec();
        self
    }

    fn input(&self) -> Input<'_> {
        Input { plan: &self.plan, model: &self.model, network: &self.network, tolerance: &self.tolerance }
    }

    fn layout(&self) -> Layout {
        let input = self.input();
        let patches: Vec<_> =
            self.plan.surfaces.iter().flat_map(|(s, flipped)| self.model.patches_of(*s).map(move |p| (p, *flipped))).collect();
        let mut layout = Layout::new(&input, &patches, true);
        layout.check(&input).unwrap();
        inside::place(&input, &mut layout);
        layout
    }

    /// Faces, segments, uses of segments, poles.
    fn counts(&self) -> [usize; 4] {
        let layout = self.layout();
        layout.check(&self.input()).unwrap();
        let sides = || layout.faces.iter().flat_map(|f| &f.sides);
        let (uses, poles) = (sides().map(|s| s.uses.len()).sum(), sides().filter(|s| s.uses.is_empty()).count());
        [layout.faces.len(), layout.pieces.segments.len(), uses, poles]
    }
}

#[test]
fn layouts_of_closed_surfaces_and_shared_borders_are_sound() {
    assert_eq!(Case::new(vec![ball()]).counts(), [1, 1, 2, 2], "a ball");
    let can = swept(&ring(DVec3::ZERO, 3.0, DVec3::Z), DVec3::Z * 4.0);
    assert_eq!(Case::new(vec![can]).counts(), [1, 3, 4, 0], "a can");
    assert_eq!(Case::new(vec![round(&ring(p(6., 0., 0.), 2.0, DVec3::Y), TAU)]).counts(), [1, 2, 4, 0], "a torus");
    assert_eq!(Case::new(vec![round(&straight(p(4., 0., 0.), p(0., 0., 6.)), TAU)]).counts(), [1, 2, 3, 1], "a cone");
    // Two squares side by side, and one that meets both of them at half of their sides.
    assert_eq!(Case::new(vec![square(DVec3::ZERO), square(p(10., 0., 0.))]).counts(), [2, 7, 8, 0], "two squares");
    let three = vec![square(DVec3::ZERO), square(p(10., 0., 0.)), square(p(5., 10., 0.))];
    assert_eq!(Case::new(three).counts(), [3, 12, 15, 0], "bricks");
    // A plate with two holes, and what was cut out of one of them.
    let holes = [ring(p(3., 5., 0.), 1.5, DVec3::Z), ring(p(7., 5., 0.), 1.5, DVec3::Z)];
    let loops: Vec<Vec<Chain>> = holes.iter().map(|hole| vec![hole.clone()]).collect();
    let mut plate = cut(&square(DVec3::ZERO), &loops, false);
    assert_eq!(Case::new(plate.clone()).counts()[0], plate.len(), "a plate");
    plate.extend(cut(&square(DVec3::ZERO), &loops[..1], true));
    let [faces, segments, uses, _] = Case::new(plate).counts();
    assert!(faces == 2 && uses == segments + 1, "{faces} faces, {segments} segments, {uses} uses");
    // A belt of a ball between two rings, over its seam.
    let belt = cut(&ball(), &[vec![ring(p(0., 0., -2.), 21_f64.sqrt(), DVec3::Z)], vec![ring(p(0., 0., 3.), 4.0, -DVec3::Z)]], true);
    assert_eq!(Case::new(belt).counts()[0], 1, "a belt");
}

/// A square and a ball, with a line across the square, one along its border, a point inside and one at a corner.
fn sample() -> Case {
    let curves =
        [straight(p(10., 4., 0.), p(20., 4., 0.)), straight(p(12., 6., 0.), p(18., 7., 0.)), straight(p(10., 0., 0.), p(16., 0., 0.))];
    Case::new(vec![ball(), square(p(10., 0., 0.))]).with(&curves, &[p(15., 2., 0.), p(20., 10., 0.)])
}

#[test]
fn curves_and_points_have_their_places() {
    let case = sample();
    let layout = case.layout();
    layout.check(&case.input()).unwrap();
    let [ball, square] = &layout.faces[..] else { panic!("{} faces", layout.faces.len()) };
    assert_eq!((ball.lines.len(), ball.points.len(), square.lines.len(), square.points.len()), (0, 0, 2, 1));
    // The border is cut where the lines end: two more on the sides, one more below.
    assert_eq!(square.segments().count() - square.lines.len(), 7);
}

#[track_caller]
fn is_told(what: &str, damage: impl FnOnce(&mut Layout)) {
    let case = sample();
    let mut layout = case.layout();
    assert_eq!(layout.check(&case.input()), Ok(()));
    damage(&mut layout);
    let told = layout.check(&case.input()).unwrap_err();
    assert!(told.contains(what), "{told}");
}

/// A track of several segments.
fn long(layout: &Layout) -> usize {
    layout.pieces.of_track.iter().position(|uses| uses.len() > 1).unwrap()
}

#[test]
fn each_condition_on_tracks_and_segments_is_seen_to_fail() {
    is_told("tracks differ in length", |l| _ = l.pieces.starts.pop());
    is_told("tracks differ in length", |l| _ = l.pieces.of_track.pop());
    is_told("runs along segment 99", |l| l.pieces.of_track[0][0].segment = 99);
    is_told("do not follow each other", |l| l.pieces.of_track[long(&sample().layout())].swap(0, 1));
    is_told("do not follow each other", |l| _ = l.pieces.of_track[long(&sample().layout())].pop());
    is_told("do not follow each other", |l| l.pieces.of_track[long(&sample().layout())][0].against ^= true);
    is_told("do not follow each other", |l| l.pieces.of_track[0][0].s.0 += 0.5);
    is_told("does not start at its junction", |l| {
        let track = long(l);
        l.pieces.starts[track] = l.pieces.junctions.len() - 1 - l.pieces.starts[track];
    });
    is_told("ends at no junction", |l| l.pieces.junctions.truncate(1));
    is_told("does not run along it", |l| l.pieces.segments[0].s.1 *= 0.5);
    is_told("does not run along it", |l| l.pieces.segments[0].track = 99);
    is_told("a junction is nowhere", |l| l.pieces.junctions[0].x = f64::NAN);
    // A track that is there twice, with a segment of its own each time.
    is_told("are one", |l| {
        let track = (0..l.parts.len()).find(|t| l.pieces.of_track[*t].len() == 1).unwrap();
        let mut used = l.pieces.of_track[track][0];
        let (mut segment, part) = (l.pieces.segments[used.segment].clone(), l.parts[track].clone());
        (segment.track, segment.s) = (l.parts.len(), used.s);
        if used.against {
            segment.ends = (segment.ends.1, segment.ends.0);
        }
        (used.segment, used.against) = (l.pieces.segments.len(), false);
        l.pieces.segments.push(segment);
        l.pieces.of_track.push(vec![used]);
        l.pieces.starts.push(l.pieces.starts[track]);
        l.parts.push(part);
    });
}

#[test]
fn each_condition_on_lists_is_seen_to_fail() {
    is_told("edges are not in their order", |l| l.edges.swap(0, 1));
    is_told("links are not in their order", |l| {
        let link = lofting::network::LinkId::at(0);
        l.of_link = vec![(link, Vec::new()), (link, Vec::new())];
    });
    is_told("a link or curve", |l| l.curves[0][0].segment = 99);
    is_told("a link or curve", |l| l.curves[0][0].s = (1.0, 1.0));
    is_told("a link or curve", |l| {
        let used = l.curves[0][0];
        l.curves[0] = vec![SegmentUse { s: (1.0, 2.0), ..used }, SegmentUse { s: (0.0, 1.0), ..used }];
    });
    is_told("is at no junction", |l| l.points[1] = Some(99));
    is_told("a line inside a face", |l| l.creases.push((9, Vec::new())));
    is_told("a line inside a face", |l| l.creases.push((0, vec![99])));
    is_told("a line inside a face", |l| l.meets.push(99));
}

#[test]
fn each_condition_on_faces_is_seen_to_fail() {
    is_told("is not what its patch says", |l| l.faces[0].surface = SurfaceId::at(1));
    is_told("is not what its patch says", |l| _ = l.faces[1].sides.pop());
    is_told("has neither segments nor a pole", |l| l.faces[1].sides[0].uses.clear());
    is_told("has neither segments nor a pole", |l| l.faces[0].sides.iter_mut().for_each(|side| side.pole = None));
    is_told("runs along a segment that is not there", |l| l.faces[1].sides[0].uses[0].segment = 99);
    is_told("is broken", |l| l.faces[1].sides[0].length += 1.0);
    is_told("is broken", |l| l.faces[1].sides.iter_mut().find(|side| side.uses.len() > 1).unwrap().uses.swap(0, 1));
    is_told("does not close", |l| l.faces[1].sides.swap(0, 2));
    is_told("does not close", |l| {
        let side = l.faces[0].sides.iter_mut().find(|side| side.pole.is_some()).unwrap();
        side.pole = side.pole.map(|pole| pole + 1);
    });
    is_told("holds a point that is not there", |l| l.faces[1].points.push(9));
    is_told("holds a line that is not there", |l| l.faces[1].lines.push(99));
    is_told("as a line inside", |l| {
        let on_border = l.faces[1].sides[0].uses[0].segment;
        l.faces[1].lines.push(on_border);
    });
    is_told("as a line inside", |l| {
        let line = l.faces[1].lines[0];
        l.faces[1].lines.push(line);
    });
    // A face that is there twice.
    is_told("more or less often", |l| l.faces.push(l.faces[0].clone()));
}
