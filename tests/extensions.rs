//! Curves and surfaces made longer: what was there stays, what is added is the circle, the conic, the polynomial that it was, and as long as
//! asked for.

use glam::DVec3;
use lofting::base::origin::Origin;
use lofting::base::quadrature::gauss_legendre;
use lofting::base::tolerance::Tolerance;
use lofting::geometry::construct::build::{self, arc_center, arc_through, bezier, circle, ellipse, helix, line, polyline};
use lofting::geometry::construct::extend::{End, Onward, extend};
use lofting::geometry::{Curve, Kind};
use lofting::network::Chain;
use lofting::surface::points::control_net::{Net, bezier as bezier_net, nurbs as nurbs_net};
use lofting::surface::swept::revolve::{Axis, revolve};
use lofting::surface::{self, OneSided, Rim, Surface, extrude};

use crate::support::random::{Random, cases};

const NONE: Origin = Origin::NONE;
const TAU: f64 = std::f64::consts::TAU;
const RIMS: [Rim; 4] = [Rim::Start, Rim::End, Rim::Left, Rim::Right];

fn tolerance() -> Tolerance {
    Tolerance::new(1e-6, 5.0)
}

fn point(numbers: &mut Random) -> DVec3 {
    DVec3::new(numbers.share(), numbers.share(), numbers.share()) * 2.0 - DVec3::ONE
}

/// Bernstein polynomials at any parameter.
fn bernstein(points: &[DVec3], t: f64) -> DVec3 {
    let mut row = points.to_vec();
    for r in 1..row.len() {
        for i in 0..row.len() - r {
            row[i] = row[i] * (1.0 - t) + row[i + 1] * t;
        }
    }
    row[0]
}

/// ∫ |d| over from…to, in many pieces.
fn integral(from: f64, to: f64, speed: impl Fn(f64) -> f64) -> f64 {
    const PIECES: usize = 40;
    let half = 0.5 * (to - from) / PIECES as f64;
    let piece = |k: usize| {
        let middle = from + (2 * k + 1) as f64 * half;
        gauss_legendre(16).iter().map(|(x, w)| w * half * speed(middle + half * x)).sum::<f64>()
    };
    (0..PIECES).map(piece).sum()
}

fn code(result: lofting::base::fault::Result<impl std::fmt::Debug>) -> &'static str {
    result.unwrap_err().code().0
}

/// The curve is the first one, then `by` more, at its end; returns where the old end is.
fn check_curve(curve: &Curve, longer: &Curve, end: End, by: f64, what: &str) {
    let (old, new) = (curve.length(), longer.length());
    assert!((new - old - by).abs() <= 1e-9 * (old + by), "{what}: {old} and {by} make {new}");
    let before = if end == End::Start { by } else { 0.0 };
    for k in 0..=40 {
        let s = old * f64::from(k) / 40.0;
        let (a, b) = (curve.point(curve.param_at_length(s)), longer.point(longer.param_at_length(before + s)));
        assert!(a.distance(b) <= 1e-9 * new, "{what}: {:e} off at {s} of {old}", a.distance(b));
    }
}

#[test]
fn arcs_stay_on_their_circles_and_lines_are_lines() {
    let mut numbers = Random(0x00e4_7e4d);
    for case in 0..cases(300) {
        let end = if case % 2 == 0 { End::Start } else { End::End };
        let [a, b, c] = [point(&mut numbers), point(&mut numbers), point(&mut numbers)];
        let straight = line(a, b, NONE).unwrap();
        let by = 3.0 * numbers.share() + 1e-3;
        for how in [Onward::Linear, Onward::Curvature] {
            let longer = extend(&straight, end, by, how, NONE).unwrap();
            assert_eq!(longer.kind(), Kind::Line);
            check_curve(&straight, &longer, end, by, "line");
        }
        let sweep = 0.1 + 4.0 * numbers.share();
        let normal = (b - a).cross(c - a);
        let arc = arc_center(a, b, sweep, normal, NONE).unwrap();
        let (radius, rest) = (a.distance(b), TAU - sweep);
        let by = radius * rest * (0.01 + 0.98 * numbers.share());
        let longer = extend(&arc, end, by, Onward::Curvature, NONE).unwrap();
        assert_eq!(longer.kind(), Kind::Arc);
        check_curve(&arc, &longer, end, by, "arc");
        for k in 0..=40 {
            let p = longer.point(longer.domain().1 * f64::from(k) / 40.0);
            assert!((p.distance(a) - radius).abs() < 1e-14 && (p - a).dot(normal).abs() < 1e-13);
        }
        let most = radius * rest * (1.001 + numbers.share());
        assert_eq!(code(extend(&arc, end, most, Onward::Curvature, NONE)), "E418");
        let image = arc.length().min(radius * rest) * numbers.share() + 1e-9;
        assert_eq!(extend(&arc, end, image, Onward::Reflect, NONE).unwrap().kind(), Kind::Arc);
        let legs = polyline(&[a, b, c], false, NONE).unwrap();
        let longer = extend(&legs, end, by, Onward::Linear, NONE).unwrap();
        assert_eq!((longer.kind(), longer.knots().len()), (Kind::Polyline, 3));
        check_curve(&legs, &longer, end, by, "polyline");
    }
}

#[test]
fn ellipses_and_helices_go_on() {
    let mut numbers = Random(0x00e1_195e);
    for case in 0..cases(200) {
        let (from, sweep, more) = (TAU * numbers.share(), 0.2 + 3.0 * numbers.share(), 0.1 + 2.5 * numbers.share());
        let (major, minor) = (DVec3::X * (1.0 + numbers.share()), DVec3::Y * (0.1 + numbers.share()));
        let arc = ellipse(DVec3::ONE, major, minor, from, sweep, NONE).unwrap();
        let wanted = ellipse(DVec3::ONE, major, minor, from, sweep + more, NONE).unwrap();
        let by = wanted.length() - arc.length();
        let longer = extend(&arc, End::End, by, Onward::Curvature, NONE).unwrap();
        check_curve(&arc, &longer, End::End, by, "ellipse");
        assert!(longer.end().distance(wanted.end()) < 1e-10 && longer.kind() == arc.kind(), "case {case}");
        let (pitch, turns) = (numbers.share() + 0.1, 0.2 + 3.0 * numbers.share());
        let screw = |turns: f64| helix(DVec3::ZERO, DVec3::Z, DVec3::X, pitch, turns, NONE).unwrap();
        let (short, long) = (screw(turns), screw(turns + more));
        let longer = extend(&short, End::End, long.length() - short.length(), Onward::Curvature, NONE).unwrap();
        assert!(longer.end().distance(long.end()) < 1e-10 && longer.kind() == Kind::Helix);
    }
}

#[test]
fn polynomials_go_on_as_themselves() {
    let mut numbers = Random(0x0090_170e);
    for case in 0..cases(400) {
        let degree = 2 + case % 6;
        let poles: Vec<DVec3> = (0..=degree).map(|k| DVec3::X * k as f64 + point(&mut numbers)).collect();
        let whole = bezier(&poles, None, NONE).unwrap();
        let by = whole.length() * (0.01 + 1.5 * numbers.share());
        let longer = match extend(&whole, End::End, by, Onward::Curvature, NONE) {
            Ok(longer) => longer,
            Err(fault) => panic!("case {case}: {fault:?}"),
        };
        let (from, to) = longer.domain();
        assert!(from == 0.0 && to > 1.0 && longer.kind() == Kind::Nurbs);
        for k in 0..=60 {
            let t = to * f64::from(k) / 60.0;
            let (p, q) = (longer.point(t), bernstein(&poles, t));
            assert!(p.distance(q) <= 1e-10 * (1.0 + q.length()), "case {case} at {t}: {:e}", p.distance(q));
        }
        let speed = |t: f64| {
            let h = 1e-6;
            (bernstein(&poles, t + h) - bernstein(&poles, t - h)).length() / (2.0 * h)
        };
        let length = integral(1.0, to, speed);
        assert!((length - by).abs() <= 1e-7 * by, "case {case}: {length} instead of {by}");
        check_curve(&whole, &longer, End::End, by, "polynomial");
        // A part made as long as the whole is the whole.
        let (a, b) = (0.5 * numbers.share(), 0.5 + 0.5 * numbers.share());
        let part = whole.part(a, b);
        let by = whole.length_at(a);
        if by > 1e-3 {
            let back = extend(&part, End::Start, by, Onward::Curvature, NONE).unwrap();
            // Rounding of the poles of a short part grows as a polynomial of that degree does beyond its ends.
            let grown = (0..degree).fold(1.0, |all, _| all * 2.0 * b / (b - a));
            let off = back.start().distance(whole.start());
            assert!(off < 1e-15 * (1.0 + whole.length()) * grown.max(1e6), "case {case}: {off:e}");
            check_curve(&part, &back, End::Start, by, "part");
        }
    }
}

#[test]
fn splines_go_on_with_all_derivatives() {
    let mut numbers = Random(0x59_11e5);
    let mut rational = 0;
    for case in 0..cases(300) {
        let (n, degree) = (5 + case % 5, 2 + case % 3);
        let poles: Vec<DVec3> = (0..n).map(|k| DVec3::X * k as f64 + point(&mut numbers)).collect();
        let inner = n - degree - 1;
        let mut knots = vec![0.0; degree + 1];
        knots.extend((1..=inner).map(|k| k as f64 + 0.6 * numbers.share()));
        knots.extend(std::iter::repeat_n(inner as f64 + 1.6, degree + 1));
        let weights: Vec<f64> = (0..n).map(|_| if case % 2 == 0 { 1.0 } else { 0.5 + numbers.share() }).collect();
        let curve = build::nurbs(&poles, &weights, &knots, degree, NONE).unwrap();
        let by = 0.8 * numbers.share() + 0.05;
        let end = if case % 4 < 2 { End::End } else { End::Start };
        let longer = match extend(&curve, end, by, Onward::Curvature, NONE) {
            Ok(longer) => longer,
            Err(fault) if case % 2 == 1 && fault.code().0 == "E418" => continue,
            Err(fault) => panic!("case {case}: {fault:?}"),
        };
        rational += case % 2;
        check_curve(&curve, &longer, end, by, "spline");
        let seam = longer.param_at_length(if end == End::End { curve.length() } else { by });
        let near = longer.knots().into_iter().min_by(|a, b| (a - seam).abs().total_cmp(&(b - seam).abs())).unwrap();
        let (before, after) = (longer.jet_before(near), longer.jet(near));
        assert!(before.d1.distance(after.d1) <= 1e-9 * after.d1.length(), "case {case}");
        assert!(before.d2.distance(after.d2) <= 1e-7 * (after.d2.length() + after.d1.length()), "case {case}");
    }
    assert!(rational > 30, "{rational} rational ones were extended");
}

#[test]
fn circles_as_nurbs_stay_circles() {
    let mut numbers = Random(0xc19c1e);
    let mut refused = 0;
    for case in 0..cases(200) {
        let sweep = 0.3 + 1.2 * numbers.share();
        let arc = arc_center(DVec3::ZERO, DVec3::X, sweep, DVec3::Z, NONE).unwrap();
        let net = arc.exact_nurbs().unwrap();
        let poles: Vec<DVec3> = (0..net.poles.len()).map(|i| net.pole(i)).collect();
        let weights: Vec<f64> = net.poles.iter().map(|q| q.w).collect();
        let curve = build::nurbs(&poles, &weights, &net.knots, 2, NONE).unwrap();
        let end = if case % 2 == 0 { End::End } else { End::Start };
        // A conic that goes on without end comes to the point opposite the middle of its last span.
        let span = sweep / (net.knots.len() / 2 - 2) as f64;
        let most = 0.5 * (TAU - span);
        let by = 1.5 * most * numbers.share() + 1e-3;
        if (by - most).abs() < 1e-3 {
            continue;
        }
        let longer = match extend(&curve, end, by, Onward::Curvature, NONE) {
            Ok(longer) => longer,
            Err(fault) => {
                assert!(fault.code().0 == "E418" && by > most, "case {case}: {by} of {most} {fault:?}");
                refused += 1;
                continue;
            }
        };
        assert!(by < most, "case {case}: {by} of {most}");
        check_curve(&curve, &longer, end, by, "circle");
        let weights = longer.exact_nurbs().unwrap().poles;
        assert!(weights.iter().all(|q| q.w > 0.0), "case {case}");
        for k in 0..=100 {
            let (a, b) = longer.domain();
            let p = longer.point(a + (b - a) * f64::from(k) / 100.0);
            assert!((p.length() - 1.0).abs() < 1e-9 && p.z == 0.0, "case {case}: {:e}", p.length() - 1.0);
        }
    }
    assert!(refused > 20, "{refused} were too long");
}

#[test]
fn tangents_and_mirror_images_are_joined_on() {
    let mut numbers = Random(0x0031_7709);
    for case in 0..cases(200) {
        let poles: Vec<DVec3> = (0..5).map(|k| DVec3::X * f64::from(k) + point(&mut numbers)).collect();
        let curve = bezier(&poles, None, NONE).unwrap();
        let by = curve.length() * (0.05 + 0.9 * numbers.share());
        let tangent = (poles[4] - poles[3]).normalize();
        let longer = extend(&curve, End::End, by, Onward::Linear, NONE).unwrap();
        check_curve(&curve, &longer, End::End, by, "linear");
        assert!(longer.end().distance(poles[4] + tangent * by) < 1e-12);
        let image = extend(&curve, End::End, by, Onward::Reflect, NONE).unwrap();
        check_curve(&curve, &image, End::End, by, "reflect");
        for k in 0..=30 {
            let s = by * f64::from(k) / 30.0;
            let (here, there) = [curve.length() - s, curve.length() + s].map(|s| image.point(image.param_at_length(s))).into();
            let mirrored: DVec3 = here - tangent * (2.0 * (here - poles[4]).dot(tangent));
            assert!(mirrored.distance(there) < 1e-10, "case {case}: {:e}", mirrored.distance(there));
        }
        // Tangent and curvature are those before.
        let joint = image.param_at_length(curve.length());
        let bend = |jet: lofting::geometry::Jet| (jet.d1.normalize(), jet.d2.reject_from(jet.d1) / jet.d1.length_squared());
        let joint = image.knots().into_iter().min_by(|a, b| (a - joint).abs().total_cmp(&(b - joint).abs())).unwrap();
        let ((t0, k0), (t1, k1)) = (bend(image.jet_before(joint)), bend(image.jet(joint)));
        assert!(t0.distance(t1) < 1e-12 && k0.distance(k1) < 1e-10 * (1.0 + k0.length()), "case {case}");
        assert_eq!(code(extend(&curve, End::End, 1.01 * curve.length(), Onward::Reflect, NONE)), "E418");
    }
}

#[test]
fn what_has_no_end_is_refused() {
    let ring = circle(DVec3::ZERO, 1.0, DVec3::Z, NONE).unwrap();
    assert_eq!(code(extend(&ring, End::End, 1.0, Onward::Linear, NONE)), "E417");
    let bow = arc_through(DVec3::ZERO, DVec3::X, DVec3::new(0.5, 0.3, 0.0), NONE).unwrap();
    for by in [0.0, -1.0] {
        assert_eq!(code(extend(&bow, End::End, by, Onward::Linear, NONE)), "E306");
    }
    for by in [f64::NAN, f64::INFINITY] {
        assert_eq!(code(extend(&bow, End::End, by, Onward::Linear, NONE)), "E408");
    }
    // Two poles at the end: no direction there.
    let still = bezier(&[DVec3::ZERO, DVec3::Y, DVec3::X, DVec3::X], None, NONE).unwrap();
    for how in [Onward::Linear, Onward::Curvature, Onward::Reflect] {
        assert_eq!(code(extend(&still, End::End, 0.1, how, NONE)), "E417");
        assert!(extend(&still, End::Start, 0.1, how, NONE).is_ok());
    }
}

fn sides(rim: Rim) -> (OneSided, OneSided) {
    match rim {
        Rim::End => (OneSided::Before, OneSided::After),
        Rim::Right => (OneSided::After, OneSided::Before),
        _ => (OneSided::After, OneSided::After),
    }
}

/// (u, v) with `x` across the side and `y` along it.
fn place(rim: Rim, x: f64, y: f64) -> (f64, f64) {
    if rim.in_u() { (x, y) } else { (y, x) }
}

/// The x of the longer surface at which the old border lies, by the points of it.
fn old_border(old: &Surface, new: &Surface, rim: Rim) -> f64 {
    let (xs, ys) = new.breaks();
    let breaks = if rim.in_u() { xs } else { ys };
    let border = if rim.at_start() { 0.0 } else { 1.0 };
    let off = |x: &f64| {
        let far = |k: u32| {
            let y = f64::from(k) / 8.0;
            let ((u, v), (a, b)) = (place(rim, *x, y), place(rim, border, y));
            new.point(u, v).distance(old.point(a, b))
        };
        (0..=8).map(far).fold(0.0, f64::max)
    };
    let best = breaks.into_iter().min_by(|a, b| off(a).total_cmp(&off(b))).unwrap();
    assert!(off(&best) < 1e-9, "the old border is {:e} off", off(&best));
    best
}

/// What was there is there, evenly in the parameter across, and the longest line across gets `by`.
fn check_surface(old: &Surface, new: &Surface, rim: Rim, by: f64, what: &str) -> f64 {
    let seam = old_border(old, new, rim);
    let (low, high) = if rim.at_start() { (seam, 1.0) } else { (0.0, seam) };
    for i in 0..=10 {
        for j in 0..=10 {
            let (x, y) = (f64::from(i) / 10.0, f64::from(j) / 10.0);
            let ((u, v), (a, b)) = (place(rim, low + (high - low) * x, y), place(rim, x, y));
            let off = new.point(u, v).distance(old.point(a, b));
            assert!(off < 1e-9, "{what} {rim:?}: {off:e} off at {a} {b}");
        }
    }
    let (from, to) = if rim.at_start() { (0.0, seam) } else { (seam, 1.0) };
    let line = |y: f64| {
        integral(from, to, |x| {
            let (u, v) = place(rim, x, y);
            let jet = new.jet_one_sided(u, v, sides(rim));
            if rim.in_u() { jet.du.length() } else { jet.dv.length() }
        })
    };
    let longest = (0..=64).map(|k| line(f64::from(k) / 64.0)).fold(0.0, f64::max);
    assert!(longest <= by * (1.0 + 1e-8) && longest >= by * (1.0 - 1e-2), "{what} {rim:?}: {longest} instead of {by}");
    seam
}

/// Derivatives on both sides of the old border.
fn beside(new: &Surface, rim: Rim, seam: f64, y: f64) -> [surface::Jet2; 2] {
    let (u, v) = place(rim, seam, y);
    [OneSided::Before, OneSided::After]
        .map(|side| new.jet_one_sided(u, v, if rim.in_u() { (side, OneSided::After) } else { (OneSided::After, side) }))
}

fn net(numbers: &mut Random, (nu, nv): (usize, usize), rational: bool) -> (Vec<Vec<DVec3>>, Vec<Vec<f64>>) {
    let at = |i: usize, j: usize, numbers: &mut Random| DVec3::new(i as f64, j as f64, 0.0) + 0.4 * point(numbers);
    let rows = (0..nv).map(|j| (0..nu).map(|i| at(i, j, numbers)).collect()).collect();
    let weights = (0..nv).map(|_| (0..nu).map(|_| if rational { 0.6 + 0.8 * numbers.share() } else { 1.0 }).collect()).collect();
    (rows, weights)
}

#[test]
fn bicubic_polynomials_go_on_as_themselves() {
    let mut numbers = Random(0x0b1c_0b1c);
    for case in 0..cases(100) {
        let rim = RIMS[case % 4];
        let (rows, _) = net(&mut numbers, (4, 4), false);
        let flat = bezier_net(&Net { rows: &rows, weights: None }, NONE, &tolerance()).unwrap();
        let old = if case % 8 < 4 { flat } else { flat.flipped() };
        let by = 0.1 + 1.4 * numbers.share();
        let (new, notes) = surface::extend(&old, rim, by, Onward::Curvature, NONE, &tolerance()).unwrap();
        assert!(notes.is_empty());
        let seam = check_surface(&old, &new, rim, by, "bicubic");
        // The polynomial itself at parameters beyond 0…1.
        for i in 0..=12 {
            for j in 0..=6 {
                let (x, y) = (f64::from(i) / 12.0, f64::from(j) / 6.0);
                let own = if rim.at_start() { (x - seam) / (1.0 - seam) } else { x / seam };
                let (u, v) = place(rim, own, y);
                let v = if case % 8 < 4 { v } else { 1.0 - v };
                let lines: Vec<DVec3> = rows.iter().map(|row| bernstein(row, u)).collect();
                let (a, b) = place(rim, x, y);
                let off = new.point(a, b).distance(bernstein(&lines, v));
                assert!(off < 1e-9, "case {case} {rim:?}: {off:e}");
            }
        }
    }
}

#[test]
fn nets_go_on_smoothly() {
    let mut numbers = Random(0x4e75);
    for case in 0..cases(60) {
        let rim = RIMS[case % 4];
        let counts = (4 + case % 4, 4 + case % 3);
        let (rows, weights) = net(&mut numbers, counts, case % 2 == 1);
        let old = nurbs_net(&Net { rows: &rows, weights: Some(&weights) }, (2 + case % 2, 3), (None, None), NONE, &tolerance()).unwrap();
        let by = 0.05 + 0.4 * numbers.share();
        for how in [Onward::Linear, Onward::Curvature] {
            let (new, _) = match surface::extend(&old, rim, by, how, NONE, &tolerance()) {
                Ok(made) => made,
                Err(fault) => panic!("case {case} {rim:?} {how:?}: {fault:?}"),
            };
            let seam = check_surface(&old, &new, rim, by, "net");
            for k in 0..=20 {
                let y = f64::from(k) / 20.0;
                let [a, b] = beside(&new, rim, seam, y);
                let (a1, b1, a2, b2) = if rim.in_u() { (a.du, b.du, a.duu, b.duu) } else { (a.dv, b.dv, a.dvv, b.dvv) };
                assert!(a1.distance(b1) < 1e-9 * a1.length(), "case {case} {rim:?} {how:?}");
                if how == Onward::Curvature {
                    assert!(a2.distance(b2) < 1e-7 * (a2.length() + a1.length()), "case {case} {rim:?}");
                    continue;
                }
                // Straight along the tangent.
                let tip = if rim.at_start() { 0.0 } else { 1.0 };
                let way = if rim.at_start() { -a1.normalize() } else { a1.normalize() };
                for x in [tip, 0.3 * seam + 0.7 * tip, 0.8 * seam + 0.2 * tip] {
                    let (u, v) = place(rim, x, y);
                    let arm = new.point(u, v) - a.p;
                    assert!(arm.cross(way).length() < 1e-9 && arm.dot(way) > 0.0, "case {case} {rim:?}");
                }
            }
        }
    }
}

#[test]
fn spheres_cylinders_and_planes_stay_what_they_are() {
    let mut numbers = Random(0x59_4e7e);
    let axis = Axis { about: DVec3::ZERO, direction: DVec3::Z };
    for case in 0..cases(60) {
        let rim = RIMS[case % 4];
        let (low, wide) = (-0.6 + 0.4 * numbers.share(), 0.3 + 0.5 * numbers.share());
        let from = DVec3::new(low.cos(), 0.0, low.sin());
        let meridian = Chain::of_curve(&arc_center(DVec3::ZERO, from, wide, -DVec3::Y, NONE).unwrap());
        let zone = revolve(&meridian, &axis, 0.4 + numbers.share(), NONE, &tolerance()).unwrap();
        let zone = if case % 8 < 4 { zone } else { zone.flipped() };
        let by = 0.05 + 0.3 * numbers.share();
        let (new, notes) = surface::extend(&zone, rim, by, Onward::Curvature, NONE, &tolerance()).unwrap();
        assert!(notes.is_empty() && new.kind() == zone.kind());
        // The same sphere as a net.
        let (as_net, _) = zone.as_net(NONE, &tolerance()).unwrap();
        let (more, _) = surface::extend(&as_net, rim, by, Onward::Curvature, NONE, &tolerance()).unwrap();
        check_surface(&as_net, &more, rim, by, "sphere");
        for s in [&new, &more] {
            for k in 0..100 {
                let p = s.point(f64::from(k % 10) / 9.0, f64::from(k / 10) / 9.0);
                assert!((p.length() - 1.0).abs() < 1e-9, "case {case} {rim:?}: {:e}", p.length() - 1.0);
            }
        }
        let side = |s: &Surface, rim: Rim, y: f64| {
            let (u, v) = place(rim, if rim.at_start() { 0.0 } else { 1.0 }, y);
            s.point(u, v)
        };
        let across = RIMS[(case % 4) ^ 1];
        for k in 0..=8 {
            let y = f64::from(k) / 8.0;
            assert!(side(&new, across, y).distance(side(&zone, across, y)) < 1e-12, "case {case} {rim:?}");
        }
        // A wall of an arc: a cylinder.
        let bow = Chain::of_curve(&arc_center(DVec3::ZERO, DVec3::X, 0.5 + numbers.share(), DVec3::Z, NONE).unwrap());
        let wall = extrude(&bow, DVec3::new(0.0, 0.0, 2.0), NONE, &tolerance()).unwrap();
        let (new, _) = surface::extend(&wall, rim, by, Onward::Curvature, NONE, &tolerance()).unwrap();
        let (high, long) = if rim.in_u() { (2.0 + by, bow.length()) } else { (2.0, bow.length() + by) };
        let [a, b, c] = [new.point(0.0, 0.0), new.point(1.0, 0.0), new.point(0.0, 1.0)];
        assert!((a.distance(b) - high).abs() < 1e-12 && (a.distance(c) - 2.0 * (0.5 * long).sin()).abs() < 1e-12);
        assert!((new.point(0.4, 0.7).truncate().length() - 1.0).abs() < 1e-12 && new.kind() == wall.kind());
        // A plane net stays plane and its sides straight.
        let rows = vec![vec![DVec3::ZERO, DVec3::X], vec![DVec3::Y, DVec3::X + DVec3::Y]];
        let square = bezier_net(&Net { rows: &rows, weights: None }, NONE, &tolerance()).unwrap();
        let (new, _) = surface::extend(&square, rim, by, Onward::Linear, NONE, &tolerance()).unwrap();
        let corner = new.point(1.0, 1.0) - new.point(0.0, 0.0);
        let wanted = if rim.in_u() { DVec3::new(1.0 + by, 1.0, 0.0) } else { DVec3::new(1.0, 1.0 + by, 0.0) };
        assert!(corner.distance(wanted) < 1e-12);
    }
}

#[test]
fn turned_surfaces_leave_their_turn_straight() {
    let axis = Axis { about: DVec3::ZERO, direction: DVec3::Z };
    let profile = Chain::of_curve(&line(DVec3::X, DVec3::new(2.0, 0.0, 1.0), NONE).unwrap());
    let cone = revolve(&profile, &axis, 1.0, NONE, &tolerance()).unwrap();
    let (new, notes) = surface::extend(&cone, Rim::End, 0.5, Onward::Linear, NONE, &tolerance()).unwrap();
    assert!(notes.is_empty());
    let seam = old_border(&cone, &new, Rim::End);
    for k in 0..=10 {
        let v = f64::from(k) / 10.0;
        let foot = new.point(seam, v);
        let way = DVec3::Z.cross(foot).normalize();
        // The widest line gets all of it, others in proportion to their radius.
        let wanted = foot + way * (0.5 * foot.truncate().length() / 2.0);
        assert!(new.point(1.0, v).distance(wanted) < 1e-9, "{v}");
    }
    assert_eq!(code(surface::extend(&cone, Rim::End, 20.0, Onward::Curvature, NONE, &tolerance())), "E418");
    let whole = revolve(&profile, &axis, TAU, NONE, &tolerance()).unwrap();
    assert_eq!(code(surface::extend(&whole, Rim::End, 0.5, Onward::Linear, NONE, &tolerance())), "E417");
    assert!(surface::extend(&whole, Rim::Left, 0.5, Onward::Linear, NONE, &tolerance()).is_ok());
    let cap = Chain::of_curve(&arc_center(DVec3::ZERO, DVec3::X, 0.25 * TAU, -DVec3::Y, NONE).unwrap());
    let dome = revolve(&cap, &axis, 1.0, NONE, &tolerance()).unwrap();
    assert_eq!(code(surface::extend(&dome, Rim::Right, 0.5, Onward::Linear, NONE, &tolerance())), "E417");
    let (turned, _) = surface::extend(&dome, Rim::Start, 0.5, Onward::Curvature, NONE, &tolerance()).unwrap();
    assert!(turned.point(1.0, 0.0).distance(dome.point(1.0, 0.0)) < 1e-12);
    assert!((turned.point(0.0, 0.0).truncate().angle_to(dome.point(0.0, 0.0).truncate()).abs() - 0.5).abs() < 1e-12);
    assert_eq!(code(surface::extend(&cone, Rim::End, 0.5, Onward::Reflect, NONE, &tolerance())), "E417");
}
