//! Surfaces of every kind divided by curves over seams, round poles, tubes and holes: the parts are the surface again.
//!
//! `PROPTEST_CASES` makes the runs longer.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::{DVec2, DVec3};
use lofting::base::fault::{Fault, Result as Made};
use lofting::base::math::sin_cos;
use lofting::base::origin::Origin;
use lofting::base::tolerance::Tolerance;
use lofting::geometry::construct::build::{arc_through, circle, line, polyline, spline};
use lofting::geometry::{Curve, Ends, Spline};
use lofting::model::measure;
use lofting::network::Chain;
use lofting::surface::blended::plane_face;
use lofting::surface::core::plane;
use lofting::surface::faults::CutFault;
use lofting::surface::intersect::with_surfaces;
use lofting::surface::swept::revolve::Axis;
use lofting::surface::{Surface, Way, extrude, project, revolve, split, trim};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestCaseResult, TestRng, TestRunner};

fn tolerance() -> Tolerance {
    Tolerance::new(1e-5, 1.0)
}

fn chain(curve: Made<Curve>) -> Chain {
    Chain::of_curve(&curve.unwrap())
}

fn smooth(points: &[DVec3], closed: bool) -> Made<Curve> {
    let ends = Ends::Natural;
    spline(points, &Spline { start: ends, end: ends, closed }, Origin::NONE)
}

fn turned(profile: Made<Curve>, angle: f64) -> Surface {
    let axis = Axis { about: DVec3::ZERO, direction: DVec3::Z };
    revolve(&chain(profile), &axis, angle, Origin::NONE, &tolerance()).unwrap()
}

fn swept(profile: Made<Curve>) -> Surface {
    extrude(&chain(profile), DVec3::new(0.3, 0.2, 2.0), Origin::NONE, &tolerance()).unwrap()
}

/// Surfaces by name, with `true` where only some of (u, v) may be cut: what runs into a border is cut there.
fn surfaces() -> Vec<(&'static str, Surface)> {
    let o = Origin::NONE;
    let p = DVec3::new;
    let ring = || circle(p(3.0, 0.0, 0.0), 1.0, DVec3::Y, o);
    let bean: Vec<DVec3> =
        [(1.0, 0.0), (0.6, 0.9), (-0.5, 1.0), (-0.2, 0.1), (-0.6, -0.9), (0.7, -0.8)].map(|(x, y)| p(x, y, 0.0)).to_vec();
    let upright: Vec<DVec3> = bean.iter().map(|q| p(q.x + 2.5, 0.0, q.y)).collect();
    let square = [p(1.0, 0.0, 0.0), p(0.0, 1.0, 0.0), p(-1.0, 0.0, 0.0), p(0.0, -1.0, 0.0)];
    vec![
        ("tube", swept(circle(DVec3::ZERO, 1.0, DVec3::Z, o))),
        ("bean tube", swept(smooth(&bean, true))),
        ("square tube", swept(polyline(&square, true, o))),
        ("cone", turned(line(p(1.0, 0.0, 0.0), p(0.0, 0.0, 1.5), o), TAU)),
        ("frustum", turned(line(p(1.0, 0.0, 0.0), p(0.4, 0.0, 1.5), o), TAU)),
        ("ball", turned(arc_through(p(0.0, 0.0, -1.0), p(0.0, 0.0, 1.0), p(1.0, 0.0, 0.0), o), TAU)),
        ("half ball", turned(arc_through(p(0.0, 0.0, -1.0), p(0.0, 0.0, 1.0), p(1.0, 0.0, 0.0), o), PI)),
        ("torus", turned(ring(), TAU)),
        ("turned torus", turned(ring(), -TAU)),
        ("half torus", turned(ring(), FRAC_PI_2)),
        ("bean ring", turned(smooth(&upright, true), TAU)),
        ("vase", turned(smooth(&[p(0.5, 0.0, 0.0), p(1.0, 0.0, 0.7), p(0.4, 0.0, 1.4), p(0.8, 0.0, 2.0)], false), TAU)),
    ]
}

/// A cut in (u, v), by numbers between 0 and 1.
#[derive(Clone, Debug)]
enum Cut {
    /// A loop about a place, of a radius, with so many waves.
    Loop(DVec2, f64, u32),
    /// Straight over turns of u and v from a place, waving; in a direction that does not close from border to border.
    Way(DVec2, (i32, i32), f64),
}

const TAU_STEPS: usize = 24;

/// Places of a cut in (u, v); whether it is a loop there.
fn places(cut: &Cut, (closed_u, closed_v): (bool, bool)) -> (Vec<DVec2>, bool) {
    match cut {
        Cut::Loop(center, radius, waves) => {
            // Away from borders that are no seams.
            let hold = |x: f64, closed: bool| if closed { x } else { x.clamp(1.3 * radius + 0.02, 1.0 - 1.3 * radius - 0.02) };
            let center = DVec2::new(hold(center.x, closed_u), hold(center.y, closed_v));
            let at = |k: usize| {
                let t = TAU * k as f64 / TAU_STEPS as f64;
                let (s, c) = sin_cos(t);
                center + DVec2::new(c, s) * radius * (1.0 + 0.25 * sin_cos(f64::from(*waves) * t).0)
            };
            ((0..TAU_STEPS).map(at).collect(), true)
        }
        Cut::Way(from, (u, v), wave) => {
            let start = |x: f64, closed: bool, n: i32| {
                if closed {
                    (x, f64::from(n))
                } else if n == 0 {
                    (0.1 + 0.8 * x, 0.0)
                } else {
                    (0.0, 1.0)
                }
            };
            let ((u0, du), (v0, dv)) = (start(from.x, closed_u, *u), start(from.y, closed_v, *v));
            let aside = DVec2::new(-dv, du).normalize_or_zero() * *wave;
            let steps = TAU_STEPS * (1 + u.unsigned_abs() as usize + v.unsigned_abs() as usize);
            let at = |k: usize| {
                let t = k as f64 / steps as f64;
                DVec2::new(u0 + du * t, v0 + dv * t) + aside * sin_cos(TAU * t).0
            };
            ((0..=steps).map(at).collect(), false)
        }
    }
}

fn laid(surface: &Surface, cut: &Cut) -> Made<Chain> {
    let (places, closed) = places(cut, surface.closed());
    let points: Vec<DVec3> = places.iter().map(|p| p.extend(0.0)).collect();
    let flat = match cut {
        Cut::Way(_, _, wave) if *wave == 0.0 => line(points[0], points[points.len() - 1], Origin::NONE)?,
        _ => smooth(&points, closed)?,
    };
    Ok(Chain::of_curve(&project(surface, &Chain::of_curve(&flat), Way::Parameters, Origin::NONE, &tolerance())?))
}

fn number() -> impl Strategy<Value = f64> + Clone {
    prop_oneof![3 => 0.0_f64..1.0, 1 => Just(0.0), 1 => Just(0.5), 1 => -0.1_f64..0.1]
}

fn cut() -> impl Strategy<Value = Cut> {
    let place = (number(), number()).prop_map(|(u, v)| DVec2::new(u, v));
    let turns = prop_oneof![
        3 => Just((1, 0)), 3 => Just((0, 1)), 2 => Just((1, 1)), 1 => Just((1, -1)), 1 => Just((2, 1)), 1 => Just((1, 2)), 1 => Just((2, 3))
    ];
    let wave = prop_oneof![Just(0.0), 0.01_f64..0.08];
    prop_oneof![
        1 => (place.clone(), 0.03_f64..0.35, 0..4_u32).prop_map(|(at, r, n)| Cut::Loop(at, r, n)),
        1 => (place, turns, wave).prop_map(|(at, turns, wave)| Cut::Way(at, turns, wave)),
    ]
}

fn check<S: Strategy>(cases: u32, strategy: &S, test: impl Fn(S::Value) -> TestCaseResult) {
    let cases = std::env::var("PROPTEST_CASES").ok().and_then(|n| n.parse::<u32>().ok()).map_or(cases, |n| cases.max(n));
    let config = Config { cases, failure_persistence: None, max_global_rejects: 20 * cases, ..Config::default() };
    let mut runner = TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha));
    runner.run(strategy, test).unwrap();
}

/// Whether a division may fail like this: with a reason, never for a bug.
fn reason(fault: &Fault) -> bool {
    let text = format!("{fault:?}");
    text.contains("CutOpen")
}

/// The parts have the area of the whole, and every place lies in one of them.
fn whole_again(surface: &Surface, parts: &[Surface], what: &dyn std::fmt::Debug) -> TestCaseResult {
    let (all, sum) = (measure::area(surface), parts.iter().map(measure::area).sum::<f64>());
    prop_assert!((sum - all).abs() <= 1e-6 * all, "{sum} of {all} in {} parts: {what:?}", parts.len());
    for k in 0..40 {
        let at = |share: f64| (f64::from(k) + 0.37) * share % 1.0;
        let (u, v) = (at(0.618_033_988_7), at(0.754_877_666_2));
        if !surface.holds(u, v) {
            continue;
        }
        let holding = parts.iter().filter(|part| part.holds(u, v)).count();
        prop_assert!(holding == 1, "({u}, {v}) lies in {holding} of {} parts: {what:?}", parts.len());
    }
    Ok(())
}

#[test]
fn parts_of_a_surface_are_the_surface_again() {
    let all = surfaces();
    let strategy = (0..all.len(), proptest::collection::vec(cut(), 1..4), any::<bool>());
    check(60, &strategy, |(k, cuts, flipped)| {
        let (name, surface) = &all[k];
        let surface = if flipped { &surface.flipped() } else { surface };
        let what = (name, &cuts, flipped);
        let Ok(cutters) = cuts.iter().map(|cut| laid(surface, cut)).collect::<Made<Vec<Chain>>>() else {
            return Err(TestCaseError::reject("no such curve"));
        };
        let parted = |surface: &Surface, cutters: &[Chain]| match split(surface, cutters, Origin::NONE, &tolerance()) {
            Ok(parts) => Ok(parts),
            Err(fault) if reason(&fault) => Err(TestCaseError::reject("cuts nothing off")),
            Err(fault) => Err(TestCaseError::fail(format!("{fault:?}: {what:?}"))),
        };
        let parts = parted(surface, &cutters)?;
        whole_again(surface, &parts, &what)?;
        // Cut after cut as all at once: a cut that only opens a surface is none once more.
        let mut again = vec![surface.clone()];
        for cutter in &cutters {
            let each = |part: &Surface| match parted(part, std::slice::from_ref(cutter)) {
                Err(TestCaseError::Reject(_)) => Ok(vec![part.clone()]),
                done => done,
            };
            again = again.iter().map(each).collect::<Result<Vec<Vec<Surface>>, _>>()?.concat();
        }
        whole_again(surface, &again, &what)
    });
}

/// Numbers of parts that are known: curves round a tube and round the hole, contractible ones, ones that wind, through poles.
#[test]
fn as_many_parts_as_topology_says() {
    let of = |name: &str| surfaces().into_iter().find(|s| s.0 == name).unwrap().1;
    let at = DVec2::new;
    let (eye, way) = (|u, v| Cut::Loop(at(u, v), 0.1, 0), |u, v, turns| Cut::Way(at(u, v), turns, 0.0));
    let cases: Vec<(&str, Vec<Cut>, Option<usize>)> = vec![
        // An eye inside, over one seam, over both at their corner.
        ("torus", vec![eye(0.5, 0.5)], Some(2)),
        ("torus", vec![eye(0.0, 0.5)], Some(2)),
        ("torus", vec![eye(0.5, 0.0)], Some(2)),
        ("torus", vec![eye(0.0, 0.0)], Some(2)),
        ("torus", vec![eye(0.02, 0.97)], Some(2)),
        // One circle opens a torus, two of one kind part it, two of both kinds do not.
        ("torus", vec![way(0.3, 0.3, (1, 0))], Some(1)),
        ("torus", vec![way(0.3, 0.3, (0, 1))], Some(1)),
        ("torus", vec![way(0.3, 0.3, (1, 0)), way(0.3, 0.7, (1, 0))], Some(2)),
        ("torus", vec![way(0.3, 0.3, (0, 1)), way(0.8, 0.3, (0, 1))], Some(2)),
        ("torus", vec![way(0.3, 0.3, (0, 1)), way(0.3, 0.3, (1, 0))], Some(1)),
        ("torus", vec![way(0.0, 0.3, (0, 1)), way(0.3, 0.0, (1, 0))], Some(1)),
        ("torus", vec![way(0.0, 0.3, (0, 1)), way(0.5, 0.3, (0, 1))], Some(2)),
        // Curves that wind both ways.
        ("torus", vec![way(0.3, 0.1, (1, 1))], Some(1)),
        ("torus", vec![way(0.3, 0.1, (2, 3))], Some(1)),
        ("torus", vec![way(0.3, 0.1, (1, 1)), way(0.6, 0.1, (1, 1))], Some(2)),
        ("torus", vec![way(0.3, 0.1, (2, 1)), way(0.4, 0.1, (2, 1))], Some(2)),
        ("torus", vec![way(0.3, 0.1, (1, 1)), way(0.1, 0.7, (1, -1))], Some(2)),
        ("torus", vec![way(0.0, 0.0, (1, 1)), eye(0.5, 0.0)], Some(2)),
        ("bean ring", vec![way(0.3, 0.1, (1, 1)), way(0.6, 0.1, (1, 1))], Some(2)),
        // A tube: belts, rulings, a ruling alone, one that runs round, with a belt.
        ("tube", vec![way(0.4, 0.3, (0, 1))], Some(2)),
        ("tube", vec![way(0.4, 0.3, (1, 0))], Some(1)),
        ("tube", vec![way(0.4, 0.3, (1, 0)), way(0.4, 0.6, (1, 0))], Some(2)),
        ("tube", vec![way(0.4, 0.0, (1, 0)), way(0.4, 0.6, (1, 0))], Some(2)),
        ("tube", vec![way(0.4, 0.3, (0, 1)), way(0.4, 0.6, (1, 0))], Some(2)),
        ("tube", vec![way(0.4, 0.3, (0, 1)), way(0.4, 0.6, (1, 0)), way(0.4, 0.1, (1, 0))], Some(4)),
        ("tube", vec![way(0.0, 0.3, (1, 2)), way(0.0, 0.6, (1, 2))], Some(2)),
        ("tube", vec![eye(0.5, 0.0)], Some(2)),
        ("tube", vec![eye(0.5, 0.0), way(0.5, 0.0, (1, 0))], Some(3)),
        // A ball: belts, meridians, an eye at the seam.
        ("ball", vec![way(0.0, 0.5, (1, 0))], Some(2)),
        ("ball", vec![way(0.2, 0.5, (0, 1))], None),
        ("ball", vec![way(0.2, 0.5, (0, 1)), way(0.7, 0.5, (0, 1))], Some(2)),
        ("ball", vec![way(0.0, 0.5, (0, 1)), way(0.5, 0.5, (0, 1))], Some(2)),
        ("ball", vec![way(0.0, 0.5, (0, 1)), way(0.5, 0.5, (0, 1)), way(0.0, 0.5, (1, 0))], Some(4)),
        ("ball", vec![eye(0.0, 0.5), way(0.0, 0.5, (1, 0))], Some(4)),
        ("cone", vec![way(0.2, 0.5, (0, 1)), way(0.7, 0.5, (0, 1))], Some(2)),
        ("cone", vec![way(0.2, 0.5, (0, 1)), way(0.2, 0.5, (1, 0))], Some(2)),
    ];
    for (name, cuts, count) in cases {
        let surface = of(name);
        let cutters: Vec<Chain> = cuts.iter().map(|cut| laid(&surface, cut).unwrap()).collect();
        let parts = split(&surface, &cutters, Origin::NONE, &tolerance());
        match (count, parts) {
            (Some(count), Ok(parts)) => {
                assert_eq!(parts.len(), count, "{name}: {cuts:?}");
                whole_again(&surface, &parts, &(name, &cuts)).unwrap();
            }
            (None, Err(fault)) => assert!(reason(&fault), "{fault:?}: {name}: {cuts:?}"),
            (_, done) => panic!("{:?}: {name}: {cuts:?}", done.map(|parts| parts.len())),
        }
    }
}

/// A face with holes cut by loops and lines that run over its border and its holes.
#[test]
fn parts_of_a_face_with_holes_are_the_face_again() {
    let o = Origin::NONE;
    let disc = |x: f64, y: f64, r: f64| chain(circle(DVec3::new(x, y, 0.0), r, DVec3::Z, o));
    let round = (-1.2_f64..1.2, -1.2_f64..1.2, 0.1_f64..0.9);
    let straight = (-0.9_f64..0.9, 0.0_f64..PI);
    let strategy = (proptest::collection::vec(round, 0..3), proptest::collection::vec(straight, 0..3), any::<bool>());
    let (flat, _) = plane_face::bounded(&[disc(0.0, 0.0, 1.0)], o, &tolerance()).unwrap();
    let holed = trim(&flat, &[], &[vec![disc(0.3, 0.1, 0.3)], vec![disc(-0.5, 0.2, 0.15)]], o, &tolerance()).unwrap();
    check(60, &strategy, |(loops, lines, whole)| {
        let base = if whole { &flat } else { &holed };
        let what = (&loops, &lines, whole);
        let along = |(off, turn): &(f64, f64)| {
            let (s, c) = sin_cos(*turn);
            let (normal, way) = (DVec3::new(-s, c, 0.0), DVec3::new(c, s, 0.0));
            chain(line(normal * *off - way * 3.0, normal * *off + way * 3.0, o))
        };
        let cutters: Vec<Chain> = loops.iter().map(|(x, y, r)| disc(*x, *y, *r)).chain(lines.iter().map(along)).collect();
        match split(base, &cutters, o, &tolerance()) {
            Ok(parts) => {
                let (all, sum) = (measure::area(base), parts.iter().map(measure::area).sum::<f64>());
                prop_assert!((sum - all).abs() <= 1e-6 * all, "{sum} of {all} in {} parts: {what:?}", parts.len());
                Ok(())
            }
            Err(fault) if reason(&fault) => Err(TestCaseError::reject("cuts nothing off")),
            Err(fault) => Err(TestCaseError::fail(format!("{fault:?}: {what:?}"))),
        }
    });
}

/// A number of any size up to 0.1, of either sign, or none.
fn slight() -> impl Strategy<Value = f64> + Clone {
    prop_oneof![1 => Just(0.0), 4 => (1.0_f64..8.0, any::<bool>()).prop_map(|(n, minus)| if minus { -pow10(-n) } else { pow10(-n) })]
}

fn pow10(n: f64) -> f64 {
    lofting::base::math::exp(n * std::f64::consts::LN_10)
}

/// A plane through a place of a surface or a little beside it, through its axis, tangent to it or across, and a little turned.
#[derive(Clone, Debug)]
struct Beside {
    at: (f64, f64),
    kind: u32,
    off: f64,
    turn: (f64, f64),
}

impl Beside {
    fn plane(&self, surface: &Surface) -> Option<(DVec3, DVec3)> {
        let (u, v) = self.at;
        let (p, jet) = (surface.point(u, v), surface.jet(u, v));
        let normal = match self.kind {
            0 => DVec3::Y,
            1 => jet.du.cross(jet.dv).try_normalize()?,
            2 => jet.du.try_normalize().or(jet.dv.try_normalize())?,
            _ => DVec3::Z,
        };
        let (x, y) = normal.any_orthonormal_pair();
        let normal = (normal + x * self.turn.0 + y * self.turn.1).normalize();
        // Through the axis, or through the place.
        let p = if self.kind == 0 { DVec3::ZERO } else { p };
        Some((p + normal * self.off, normal))
    }
}

#[test]
fn planes_beside_seams_poles_and_tangents_part_a_surface() {
    let tolerance = Tolerance::new(1e-6, 1.0);
    let axis = Axis { about: DVec3::ZERO, direction: DVec3::Z };
    let p = DVec3::new;
    let (low, out, top) = (p(0.0, 1e-6, -1.0), p(1.0, 0.0, 0.0), p(0.0, 0.0, 1.0));
    let wide = chain(arc_through(low, top, out, Origin::NONE));
    let mut all = surfaces();
    all.push(("ball with a wide pole", revolve(&wide, &axis, TAU, Origin::NONE, &tolerance).unwrap()));
    all.push(("half ball with a wide pole", revolve(&wide, &axis, PI, Origin::NONE, &tolerance).unwrap()));
    let place = || prop_oneof![2 => Just(0.0), 2 => Just(1.0), 1 => Just(0.5), 1 => 0.0_f64..1.0];
    let beside = ((place(), place()), 0..4_u32, slight(), (slight(), slight()));
    let beside = beside.prop_map(|(at, kind, off, turn)| Beside { at, kind, off, turn });
    check(10, &(0..all.len(), beside), |(k, beside)| {
        let (name, surface) = &all[k];
        let what = (name, &beside);
        let Some((at, normal)) = beside.plane(surface) else { return Err(TestCaseError::reject("no plane")) };
        let flat = plane::unbounded(at, normal, Origin::NONE).unwrap();
        let fault = |fault: Fault| match format!("{fault:?}").contains("NotDivided") {
            true => TestCaseError::fail(format!("{fault:?}: {what:?}")),
            false => TestCaseError::reject("refused"),
        };
        let cutters = with_surfaces::with_surfaces(std::slice::from_ref(surface), &[flat], Origin::NONE, &tolerance).map_err(fault)?.curves;
        if cutters.is_empty() {
            return Err(TestCaseError::reject("no cut"));
        }
        let parts = split(surface, &cutters, Origin::NONE, &tolerance).map_err(fault)?;
        let (all, sum) = (measure::area(surface), parts.iter().map(measure::area).sum::<f64>());
        prop_assert!((sum - all).abs() <= 1e-5 * all, "{sum} of {all} in {} parts: {what:?}", parts.len());
        // What lies on one side of the plane lies in no part with what lies on the other.
        let mut sides: Vec<(bool, bool)> = vec![(false, false); parts.len()];
        for (i, j) in (0..24).flat_map(|i| (0..24).map(move |j| (i, j))) {
            let (u, v) = ((f64::from(i) + 0.513) / 24.0, (f64::from(j) + 0.487) / 24.0);
            let off = (surface.point(u, v) - at).dot(normal);
            if off.abs() <= 100.0 * tolerance.point || !surface.holds(u, v) {
                continue;
            }
            let holding: Vec<usize> = (0..parts.len()).filter(|k| parts[*k].holds(u, v)).collect();
            prop_assert!(holding.len() == 1, "({u}, {v}) lies in {} of {} parts: {what:?}", holding.len(), parts.len());
            let side = &mut sides[holding[0]];
            if off > 0.0 { side.0 = true } else { side.1 = true }
        }
        prop_assert!(!sides.contains(&(true, true)), "a part on both sides, of {}: {what:?}", parts.len());
        Ok(())
    });
}

#[test]
fn parts_that_are_not_the_surface_are_refused() {
    let tolerance = tolerance();
    let tube = swept(circle(DVec3::ZERO, 1.0, DVec3::Z, Origin::NONE));
    let whole = measure::area(&tube);
    let cut = [chain(circle(DVec3::Z, 1.0, DVec3::Z, Origin::NONE))];
    measure::adds_up(&tube, &cut, &[(0.25 * whole, 0.0), (0.75 * whole, 0.0)], &tolerance).unwrap();
    for parts in [&[0.25 * whole, 0.74 * whole][..], &[whole, 1e-4 * whole], &[0.5 * whole], &[]] {
        let fault = measure::adds_up(&tube, &cut, &parts.iter().map(|area| (*area, 0.0)).collect::<Vec<_>>(), &tolerance).unwrap_err();
        assert!(matches!(fault.of(), Some(CutFault::PartsNotWhole { .. })), "{parts:?}: {fault:?}");
    }
}
