//! Nets of curves as B-splines: how near, how smooth, and with how many control points.

use glam::DVec3;
use lofting::base::math;
use lofting::base::origin::Origin;
use lofting::base::tolerance::Tolerance;
use lofting::geometry::construct::build::{arc_center, circle, line};
use lofting::geometry::construct::spline::{Ends, Spline, spline};
use lofting::network::Chain;
use lofting::surface::blended::skin::{Across, SkinSettings, skin};
use lofting::surface::blended::skin_align::SkinSection;
use lofting::surface::blended::skin_ends::Leaving;
use lofting::surface::swept::along::{AlongSettings, along};
use lofting::surface::swept::laws::Law;
use lofting::surface::swept::revolve::Axis;
use lofting::surface::swept::sweep::sweep;
use lofting::surface::swept::sweep_input::{Input, NetMethod};
use lofting::surface::{NetForm, Off, Surface, extrude, revolve};

use crate::support::networks::{NETWORKS, as_given};

/// Largest distance of a net from its surface at equal (u, v), as a share of the size.
fn off(surface: &Surface, form: &NetForm, size: f64) -> f64 {
    let n = 400;
    let places: Vec<f64> = (0..=n).map(|k| f64::from(k) / f64::from(n)).collect();
    let mut found = vec![DVec3::ZERO; places.len() * places.len()];
    let mut wanted = found.clone();
    form.net.grid(&places, &places, &mut found);
    surface.grid(&places, &places, &mut wanted);
    found.iter().zip(&wanted).map(|(p, q)| p.distance(*q)).fold(0.0, f64::max) / size
}

/// The control points of each direction are counted where nothing of the surface is missed by more than 1e-7 of the size.
#[test]
fn networks_become_nets_of_few_points() {
    // Control points of an independent builder that misses the same nets by 1e-4 to 9e-4 of the size.
    let others = [(22, 61), (54, 25), (16, 17), (76, 20), (81, 64), (87, 78)];
    for ((name, gap), other) in NETWORKS.into_iter().zip(others) {
        let (surface, size) = as_given(name, gap, 1.0);
        let form = surface.to_net(&Tolerance::new(2.7e-7 * size, size)).unwrap().unwrap();
        let (nu, nv) = form.net.counts;
        let Off::Bounded(bound) = form.off else { panic!("{name}: {:?}", form.off) };
        let found = off(&surface, &form, size);
        assert!(found <= 1e-7 && found <= bound / size && bound <= 2.7e-7 * size, "{name}: {found:e} of the size, {bound:e}");
        assert!(nu <= 4 * other.0 && nv <= 4 * other.1, "{name}: {nu} × {nv}");
    }
}

fn through(points: &[DVec3]) -> Chain {
    let settings = Spline { start: Ends::Natural, end: Ends::Natural, closed: false };
    Chain::of_curve(&spline(points, &settings, Origin::NONE).unwrap())
}

/// As wings and hulls are drawn: sections that differ, each a spline of its own spans.
#[test]
fn a_skin_of_a_hundred_sections_has_few_points_along_them() {
    let at = |j: usize, k: usize| {
        let (x, y) = (k as f64 / 14.0, j as f64 / 99.0);
        let x = x + 0.02 * math::sin(7.0 * y + 3.0 * k as f64);
        DVec3::new(10.0 * x, 40.0 * y, (1.5 + y) * math::sin(2.5 * x + y) + 0.4 * math::sin(5.0 * x - 3.0 * y))
    };
    let sections: Vec<SkinSection> =
        (0..100).map(|j| SkinSection::Curve(through(&(0..15).map(|k| at(j, k)).collect::<Vec<_>>()))).collect();
    let tolerance = Tolerance::new(1e-7 * 42.0, 42.0);
    let settings =
        SkinSettings { across: Across::Cubic, closed: false, ends: (Leaving::Plain, Leaving::Plain), smooth: None, origin: Origin::NONE };
    let (surface, _) = skin(&sections, &settings, &tolerance).unwrap();
    let form = surface.to_net(&tolerance).unwrap().unwrap();
    let Off::Bounded(bound) = form.off else { panic!("{:?}", form.off) };
    let found = off(&surface, &form, 42.0);
    assert!(found * 42.0 <= bound && bound <= tolerance.point, "{found:e}, {bound:e}");
    // 1 304 in another kernel.
    assert!(form.net.counts.0 <= 100 && form.net.counts.1 == 102, "{:?}", form.net.counts);
}

/// Largest value of what is zero on a surface, over its exact net.
fn residual(surface: &Surface, of: &dyn Fn(DVec3) -> f64) -> f64 {
    let form = surface.to_net(&Tolerance::new(1e-6, 10.0)).unwrap().unwrap();
    assert_eq!(form.off, Off::Exact);
    let places: Vec<f64> = (0..=97).map(|k| f64::from(k) / 97.0).collect();
    let mut points = vec![DVec3::ZERO; places.len() * places.len()];
    form.net.grid(&places, &places, &mut points);
    points.into_iter().map(|p| of(p).abs()).fold(0.0, f64::max)
}

/// What is zero on a surface.
type Zero<'a> = &'a dyn Fn(DVec3) -> f64;

#[test]
fn what_is_rational_is_written_as_it_is() {
    let tolerance = Tolerance::new(1e-6, 10.0);
    let chain = |curve| Chain::of_curve(&curve);
    let axis = Axis { about: DVec3::ZERO, direction: DVec3::Z };
    let turned = |profile: &Chain| revolve(profile, &axis, std::f64::consts::TAU, Origin::NONE, &tolerance).unwrap();
    let ring = chain(circle(DVec3::ZERO, 2.0, DVec3::Z, Origin::NONE).unwrap());
    let length = |x: f64, y: f64| (x * x + y * y).sqrt();
    let around = |p: DVec3| length(p.x, p.y);

    let cylinder = extrude(&ring, DVec3::new(0.0, 0.0, 3.0), Origin::NONE, &tolerance).unwrap();
    let cone = turned(&chain(line(DVec3::new(3.0, 0.0, 0.0), DVec3::new(1.0, 0.0, 4.0), Origin::NONE).unwrap()));
    let half = arc_center(DVec3::ZERO, DVec3::new(0.0, 0.0, -2.0), std::f64::consts::PI, -DVec3::Y, Origin::NONE).unwrap();
    let sphere = turned(&chain(half));
    let tube = circle(DVec3::new(3.0, 0.0, 0.0), 1.0, DVec3::Y, Origin::NONE).unwrap();
    let torus = turned(&chain(tube));
    let section = through(&[DVec3::new(1.0, 0.0, 0.0), DVec3::new(2.0, 0.0, 1.0), DVec3::new(1.5, 0.0, 2.0)]);
    let guide = |curve| vec![chain(curve)];
    let straight = guide(line(DVec3::new(1.0, 0.0, 0.0), DVec3::new(1.0, 5.0, 1.0), Origin::NONE).unwrap());
    let round = guide(arc_center(DVec3::ZERO, DVec3::new(1.0, 0.0, 0.0), 2.0, DVec3::Z, Origin::NONE).unwrap());
    let swept = |guides: &[Chain], law: Law| {
        let input = Input { sections: std::slice::from_ref(&section), guides, law, method: NetMethod::Gordon, origin: Origin::NONE };
        sweep(&input, &tolerance).unwrap_or_else(|fault| panic!("{fault}")).0
    };
    let parallel = swept(&straight, Law::Parallel);
    let bow = arc_center(DVec3::new(1.0, 0.0, 5.0), DVec3::new(1.0, 0.0, 0.0), 1.0, DVec3::X, Origin::NONE).unwrap();
    let bent = swept(&guide(bow), Law::Parallel);
    let rotational = swept(&round, Law::Rotational(axis));
    // Distance from the section in its own plane.
    let on_section = |p: DVec3| section.closest(p).2;
    // How far the section was carried: along an arc about (1, 0, 5) from its foot.
    let by_arc = |p: DVec3| on_section(p - DVec3::new(0.0, p.y, 5.0 - (25.0 - p.y * p.y).sqrt())) / 5.0;
    let cases: [(&str, &Surface, Zero); 7] = [
        ("cylinder", &cylinder, &|p| (around(p) - 2.0) / 2.0),
        ("cone", &cone, &|p| (around(p) - 3.0 + 0.5 * p.z) / 3.0),
        ("sphere", &sphere, &|p| (p.length() - 2.0) / 2.0),
        ("torus", &torus, &|p| (length(around(p) - 3.0, p.z) - 1.0) / 4.0),
        ("parallel", &parallel, &|p| on_section(p - DVec3::new(0.0, 5.0, 1.0) * (p.y / 5.0)) / 5.0),
        ("parallel along an arc", &bent, &by_arc),
        ("rotational", &rotational, &|p| on_section(DVec3::new(around(p), 0.0, p.z)) / 2.0),
    ];
    for (name, surface, of) in cases {
        let off = residual(surface, of);
        assert!(off <= 2e-15, "{name}: {off:e} of the size");
    }
}

#[test]
fn profiles_on_bent_paths_keep_what_their_files_say() {
    let size = 40.0;
    let path = through(&[DVec3::ZERO, DVec3::new(0.0, 0.0, 10.0), DVec3::new(10.0, 0.0, 20.0), DVec3::new(20.0, 10.0, 20.0)]);
    let ring = Chain::of_curve(&circle(DVec3::ZERO, 2.0, DVec3::Z, Origin::NONE).unwrap());
    let wave = through(&[DVec3::new(-2.0, 0.0, 0.0), DVec3::new(0.0, 1.0, 0.0), DVec3::new(2.0, -1.0, 0.0)]);
    for point in [1e-4, 1e-7] {
        let tolerance = Tolerance::new(point * size, size);
        for (profile, twist) in [(&ring, 0.0), (&wave, 0.0), (&wave, 2.0)] {
            let settings = AlongSettings { twist, round: false, origin: Origin::NONE };
            let (surface, _) = along(profile, &path, &settings, &tolerance).unwrap_or_else(|fault| panic!("{fault}"));
            for form in [surface.to_net(&tolerance), surface.ground_net(&tolerance)] {
                let form = form.unwrap().unwrap();
                let Off::Bounded(bound) = form.off else { panic!("{:?}", form.off) };
                assert!(bound <= tolerance.point && form.net.counts.0 <= 200, "{bound:e}, {:?}", form.net.counts);
            }
            let form = surface.ground_net(&tolerance).unwrap().unwrap();
            assert!(off(&surface, &form, size) * size <= form.off.distance() + tolerance.rounding);
            // In the profile's own parameter: every point of the net is near the surface.
            let form = surface.to_net(&tolerance).unwrap().unwrap();
            let rows: Vec<f64> = (0..=20).map(|k| f64::from(k) / 20.0).collect();
            let mut points = vec![DVec3::ZERO; rows.len() * rows.len()];
            form.net.grid(&rows, &rows, &mut points);
            let nearest = lofting::surface::Nearest::new(&surface);
            let far = points.into_iter().map(|p| nearest.at(p).distance).fold(0.0, f64::max);
            assert!(far <= form.off.distance() + tolerance.rounding, "{far:e}");
        }
    }
}
