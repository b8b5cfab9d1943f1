//! Surfaces through scattered points: what they meet, how smooth they are, and what changes nothing.

use glam::{DVec2, DVec3};
use lofting::base::origin::Origin;
use lofting::base::tolerance::Tolerance;
use lofting::geometry::Motion;
use lofting::surface::{Surface, scatter};

use crate::support::random::{Random, cases};

/// Numbers of 0…1, the same every time.
fn cloud(numbers: &mut Random, n: usize, height: impl Fn(f64, f64) -> f64) -> Vec<DVec3> {
    (0..n)
        .map(|_| {
            let (x, y) = (numbers.share() * 3.0 - 1.0, numbers.share() * 2.0);
            DVec3::new(x, y, height(x, y))
        })
        .collect()
}

fn made(points: &[DVec3], along: Option<DVec3>) -> Surface {
    scatter(points, along, Origin::NONE, &Tolerance::new(1e-7, 3.0)).unwrap().0
}

/// (u, v) of a place of the xy-plane in a surface made along z.
fn place(points: &[DVec3]) -> impl Fn(DVec3) -> DVec2 {
    let (low, high) = points.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), p| (a.min(*p), b.max(*p)));
    move |p| ((p - low) / (high - low)).truncate()
}

#[test]
fn a_thousand_clouds_are_met_in_any_order_and_are_smooth() {
    let mut numbers = Random(0x5ca7_7e2d);
    for case in 0..1000 {
        let n = 3 + case % 40;
        let (a, b, c) = (numbers.share() * 4.0, numbers.share() * 4.0, numbers.share());
        let points = cloud(&mut numbers, n, |x, y| c * (a * x).sin() * (b * y).cos() + 0.3 * x);
        let surface = made(&points, Some(DVec3::Z));
        let uv = place(&points);
        for p in &points {
            let at = uv(*p);
            let off = surface.point(at.x, at.y).distance(*p);
            assert!(off <= 3e-12, "case {case}: {off:e} at {p}, {at}, {}", surface.flow());
        }
        let mut turned = points.clone();
        turned.rotate_left(n / 3);
        turned.swap(0, n / 2);
        let again = made(&turned, Some(DVec3::Z));
        let mut jump = 0.0_f64;
        for [p, q, r] in surface.triangles() {
            let center = (p + q + r) / 3.0;
            assert_eq!(surface.jet(center.x, center.y), again.jet(center.x, center.y), "case {case}");
            for (p, q) in [(p, q), (q, r), (r, p)] {
                for share in [0.2, 0.5, 0.9] {
                    // Steps too small for second derivatives to be seen.
                    let (at, aside) = (p.lerp(q, share), (q - p).perp().normalize() * 1e-13);
                    let (x, y) = (surface.jet(at.x + aside.x, at.y + aside.y), surface.jet(at.x - aside.x, at.y - aside.y));
                    let bent = [x, y].map(|j| j.duu.abs().max(j.duv.abs()).max(j.dvv.abs()).max_element());
                    let bend = bent[0].max(bent[1]).max(1.0);
                    jump = jump.max((x.du - y.du).abs().max((x.dv - y.dv).abs()).max_element() / bend);
                }
            }
        }
        assert!(jump < 1e-9, "case {case}: the slope jumps by {jump:e}");
    }
}

#[test]
fn planes_and_quadratics_come_back() {
    let mut numbers = Random(0x91a2_e001);
    // What neighbours determine badly is damped: in few cases a little of the quadratic is.
    let mut damped = 0;
    for case in 0..cases(200) {
        let n = 3 + case % 60;
        let flat = |x: f64, y: f64| 0.4 * x - 1.1 * y + 0.2;
        let points = cloud(&mut numbers, n, flat);
        let (surface, uv) = (made(&points, Some(DVec3::Z)), place(&points));
        let back = |at: DVec2, of: &dyn Fn(f64, f64) -> f64| {
            let p = surface.point(at.x, at.y);
            (p.z - of(p.x, p.y)).abs()
        };
        for [p, q, r] in surface.triangles() {
            let at = (p + q + r) / 3.0;
            assert!(back(at, &flat) <= 2e-12, "case {case}: {:e}", back(at, &flat));
        }
        assert!(surface.point(uv(points[0]).x, uv(points[0]).y).distance(points[0]) < 1e-13);
        let bowl = |x: f64, y: f64| 0.7 * x * x - 0.3 * x * y + 0.5 * y * y + x - 0.1;
        let points = cloud(&mut numbers, 25 + n, bowl);
        let surface = made(&points, Some(DVec3::Z));
        let off = |[p, q, r]: [DVec2; 3]| {
            let at = (p + q + r) / 3.0;
            let p = surface.point(at.x, at.y);
            (p.z - bowl(p.x, p.y)).abs()
        };
        let most = surface.triangles().into_iter().map(off).fold(0.0, f64::max);
        assert!(most <= 1e-4, "case {case}: {most:e}");
        damped += usize::from(most > 1e-8);
    }
    assert!(damped * 100 <= cases(200), "{damped} of {}", cases(200));
}

#[test]
fn motions_and_scales_go_with_the_points() {
    let mut numbers = Random(0x77_1dea);
    for case in 0..cases(60) {
        let points = cloud(&mut numbers, 5 + case % 60, |x, y| 0.4 * (2.0 * x).sin() * y + 0.2 * y * y);
        let axis = DVec3::new(numbers.share() - 0.5, numbers.share() - 0.5, numbers.share() - 0.5).normalize();
        let motion = Motion::rotation(DVec3::new(1.0, 2.0, 3.0), axis, 6.0 * numbers.share());
        let moved: Vec<DVec3> = points.iter().map(|p| motion.point(*p)).collect();
        let (a, b) = (made(&points, None).moved(&motion), made(&moved, None));
        // Both are heights along one direction, over which u and v of the second are linear.
        let along = a.jet(0.4, 0.6).duu.normalize();
        let flat = |p: DVec3| p.reject_from_normalized(along);
        let [o, x, y] = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)].map(|(u, v)| flat(b.point(u, v)));
        for k in 0..100 {
            let (u, v) = (numbers.share(), numbers.share());
            if a.keeps(u, v) {
                let (p, ex, ey) = (a.point(u, v), x - o, y - o);
                let arm = flat(p) - o;
                let off = b.point(arm.dot(ex) / ex.length_squared(), arm.dot(ey) / ey.length_squared()).distance(p);
                assert!(off <= 1e-10, "case {case}, {k}: {off:e}");
            }
        }
        for scale in [1e-3, 1e3] {
            let larger: Vec<DVec3> = points.iter().map(|p| *p * scale).collect();
            let c = scatter(&larger, None, Origin::NONE, &Tolerance::new(1e-7 * scale, 3.0 * scale)).unwrap().0;
            let first = made(&points, None);
            for (u, v) in [(0.5, 0.5), (0.3, 0.6), (0.45, 0.2)] {
                assert!(c.point(u, v).distance(first.point(u, v) * scale) <= 1e-12 * scale, "case {case}");
            }
        }
    }
}

/// Bounds over rectangles hold what is inside, over the border too.
#[test]
fn bounds_hold() {
    let mut numbers = Random(0xb0_11d5);
    for case in 0..cases(200) {
        let points = cloud(&mut numbers, 4 + case % 30, |x, y| 0.5 * (3.0 * x).sin() * (2.0 * y).cos());
        let surface = made(&points, Some(DVec3::Z));
        for _ in 0..10 {
            let size = [0.02, 0.2, 0.9][case % 3];
            let (u, v) = (numbers.share() * (1.0 - size), numbers.share() * (1.0 - size));
            let bounds = surface.enclosure((u, u + size), (v, v + size));
            for _ in 0..20 {
                let (x, y) = (u + size * numbers.share(), v + size * numbers.share());
                let jet = surface.jet(x, y);
                let room = DVec3::splat(1e-9);
                for (what, value, range) in [
                    ("p", jet.p, bounds.p),
                    ("du", jet.du, bounds.du),
                    ("dv", jet.dv, bounds.dv),
                    ("duu", jet.duu, bounds.duu),
                    ("duv", jet.duv, bounds.duv),
                    ("dvv", jet.dvv, bounds.dvv),
                ] {
                    let room = room * (1.0 + value.abs().max_element());
                    let holds = value.cmpge(range.low - room).all() && value.cmple(range.high + room).all();
                    assert!(holds, "case {case}: {what} {value} at {x} {y} is not within {range:?}");
                }
            }
        }
    }
}

/// Between noisy points a surface stays about where they are, or says that it does not.
#[test]
fn surfaces_that_stand_out_over_their_points_say_so() {
    let mut numbers = Random(0x0_0e5e);
    let (mut told, mut worst) = (0, 0.0_f64);
    for case in 0..cases(100) {
        let points = cloud(&mut numbers, 12 + case % 100, |x, y| 0.1 * (1234.5 * x).sin() * (987.6 * y).cos());
        let (surface, notes) = scatter(&points, Some(DVec3::Z), Origin::NONE, &Tolerance::new(1e-7, 3.0)).unwrap();
        let (low, high) = points.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), p| (a.min(p.z), b.max(p.z)));
        let mut out = 0.0_f64;
        for [a, b, c] in surface.triangles() {
            for (x, y) in [(0.3, 0.3), (0.1, 0.6), (0.6, 0.1), (0.2, 0.1), (0.45, 0.45)] {
                let at = a + (b - a) * x + (c - a) * y;
                let z = surface.point(at.x, at.y).z;
                out = out.max(z - high).max(low - z);
            }
        }
        let said = notes.iter().any(|note| note.code().0 == "W226");
        told += usize::from(said);
        worst = worst.max(if said { 0.0 } else { out / (high - low) });
    }
    assert!(worst <= 0.6, "a surface overshoots its heights by {worst} of their range without a word");
    assert!(told * 5 <= cases(100), "{told} of {}", cases(100));
}

/// Second derivatives jump across the sides of triangles: a net of few pieces keeps them only where they hardly do.
#[test]
fn nets_of_quadratics_are_made_and_of_rough_points_refused() {
    let mut numbers = Random(0x0_6e75);
    let tolerance = Tolerance::new(1e-6, 3.0);
    let net = |points: &[DVec3]| {
        let whole = scatter(points, Some(DVec3::Z), Origin::NONE, &tolerance).unwrap().0;
        whole.ground_net(&tolerance).map(|form| form.unwrap().net)
    };
    let bowl = |x: f64, y: f64| 0.2 * x * x - 0.1 * x * y;
    // A grid: beyond the hull of other points the slope jumps, which asks for strips too.
    let points: Vec<DVec3> =
        (0..42).map(|k| (f64::from(k % 7) * 0.5, f64::from(k / 7) * 0.4)).map(|(x, y)| DVec3::new(x, y, bowl(x, y))).collect();
    let made = net(&points).unwrap();
    for p in &points {
        let at = place(&points)(*p);
        let mut out = [DVec3::ZERO];
        made.grid(&[at.x], &[at.y], &mut out);
        assert!(out[0].distance(*p) <= 1e-6, "{p}");
    }
    let fault = net(&cloud(&mut numbers, 60, |x, y| 0.3 * (7.0 * x).sin() * (6.0 * y).cos())).unwrap_err();
    assert_eq!(fault.code().0, "E413");
    assert!(fault.to_string().contains("strips of pieces each way"), "{fault}");
}
