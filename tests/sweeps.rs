//! Properties of sweeps: what they contain, what changes nothing, what moves with them.

use std::slice::from_ref;

use glam::DVec3;
use lofting::base::origin::Origin;
use lofting::base::tolerance::Tolerance;
use lofting::geometry::Motion;
use lofting::geometry::construct::build::{arc_center, line};
use lofting::geometry::construct::spline::{Ends, Spline, spline};
use lofting::network::Chain;
use lofting::surface::swept::along::{AlongSettings, along};
use lofting::surface::swept::laws::Law;
use lofting::surface::swept::revolve;
use lofting::surface::swept::sweep::sweep;
use lofting::surface::swept::sweep_input::{Input, NetMethod};
use lofting::surface::{Surface, extrude};

use crate::support::surfaces;

const SIZE: f64 = 400.0;

/// Numbers between −1 and 1 that are the same in every run.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((self.0 >> 11) as f64 / (1u64 << 53) as f64) * 2.0 - 1.0
    }
}

fn tolerance() -> Tolerance {
    Tolerance::new(1e-6, SIZE)
}

fn through(points: &[DVec3]) -> Chain {
    let settings = Spline { start: Ends::Natural, end: Ends::Natural, closed: false };
    Chain::of_curve(&spline(points, &settings, Origin::NONE).expect("a spline"))
}

/// Sections in planes x = 0, 100, … and guides through them.
fn net(seed: u64) -> (Vec<Chain>, Vec<Chain>) {
    let mut numbers = Numbers(seed);
    let (sections, guides) = (1 + seed as usize % 3, 1 + seed as usize / 3 % 3);
    let at: Vec<Vec<DVec3>> = (0..guides)
        .map(|j| {
            let place = |k: usize, n: &mut Numbers| DVec3::new(100.0 * k as f64, 80.0 * j as f64 + 8.0 * n.next(), 10.0 * n.next());
            (0..4).map(|k| place(k, &mut numbers)).collect()
        })
        .collect();
    let used = [0usize, 3, 1];
    let section = |k: usize, numbers: &mut Numbers| {
        let mut points = vec![at[0][k] + DVec3::new(0.0, -30.0, 12.0 * numbers.next())];
        for row in &at {
            points.push(row[k]);
            points.push(row[k] + DVec3::new(0.0, 40.0, 30.0 + 10.0 * numbers.next()));
        }
        through(&points)
    };
    let sections = used[..sections].iter().map(|&k| section(k, &mut numbers)).collect();
    (sections, at.iter().map(|row| through(row)).collect())
}

fn made(sections: &[Chain], guides: &[Chain], law: Law) -> Surface {
    let input = Input { sections, guides, law, method: NetMethod::Gordon, origin: Origin::NONE };
    sweep(&input, &tolerance()).unwrap_or_else(|fault| panic!("{fault}")).0
}

/// The largest distance of two surfaces over a grid of parameters, the second one perhaps run backwards.
fn apart(a: &Surface, b: &Surface) -> f64 {
    surfaces::apart(a, b, 12)
}

/// How far a curve of the net lies off the line of constant u or v on which it is.
fn off(surface: &Surface, curve: &Chain) -> f64 {
    (0..=6)
        .map(|k| {
            let p = curve.point(f64::from(k) / 6.0);
            lofting::surface::closest(surface, p).distance
        })
        .fold(0.0, f64::max)
}

#[test]
fn sections_and_guides_lie_on_the_surface() {
    for seed in 1..13 {
        let (sections, guides) = net(seed);
        let surface = made(&sections, &guides, Law::Parallel);
        for curve in sections.iter().chain(&guides) {
            assert!(off(&surface, curve) < 1e-9 * SIZE, "{seed}: {}", off(&surface, curve));
        }
        assert!(surface.patch_angle().to_degrees() < 1e-3, "{seed}: {}", surface.patch_angle().to_degrees());
    }
}

#[test]
fn order_and_direction_change_nothing() {
    for seed in [2, 5, 7, 8] {
        let (mut sections, mut guides) = net(seed);
        let surface = made(&sections, &guides, Law::Parallel);
        sections.reverse();
        sections = sections.iter().enumerate().map(|(k, c)| if k % 2 == 0 { c.reversed() } else { c.clone() }).collect();
        // The first guide stays the main one.
        guides[1..].reverse();
        guides = guides.iter().enumerate().map(|(k, c)| if k % 2 == 1 { c.reversed() } else { c.clone() }).collect();
        let again = made(&sections, &guides, Law::Parallel);
        assert!(apart(&surface, &again) < 1e-9 * SIZE, "{seed}: {}", apart(&surface, &again));
    }
}

#[test]
fn motions_and_scales_move_the_surface() {
    let motion = Motion::rotation(DVec3::new(3.0, 1.0, 2.0), DVec3::new(0.6, 0.0, 0.8), 0.7).then(&Motion::scaling(DVec3::X, 3.0));
    for (seed, law) in [(2, Law::Parallel), (5, Law::Parallel), (8, Law::Parallel), (5, Law::Synchronized), (8, Law::Synchronized)] {
        let (sections, guides) = net(seed);
        let surface = made(&sections, &guides, law).moved(&motion);
        let moved = |list: &[Chain]| list.iter().map(|c| c.moved(&motion)).collect::<Vec<_>>();
        let again = made(&moved(&sections), &moved(&guides), law);
        assert!(apart(&surface, &again) < 1e-9 * 3.0 * SIZE, "{seed}: {}", apart(&surface, &again));
    }
}

#[test]
fn one_section_on_a_line_is_extruded_and_on_an_arc_revolved() {
    let section = through(&[DVec3::new(50.0, 0.0, 0.0), DVec3::new(60.0, 0.0, 30.0), DVec3::new(40.0, 0.0, 70.0)]);
    let by = DVec3::new(0.0, 120.0, 0.0);
    let way = Chain::of_curve(&line(section.start(), section.start() + by, Origin::NONE).expect("a line"));
    let wanted = extrude(&section, by, Origin::NONE, &tolerance()).expect("a surface");
    let settings = AlongSettings { twist: 0.0, round: false, origin: Origin::NONE };
    let carried = along(&section, &way, &settings, &tolerance()).expect("a surface").0;
    for found in
        [&carried, &made(from_ref(&section), from_ref(&way), Law::Parallel), &made(from_ref(&section), from_ref(&way), Law::Normal)]
    {
        assert!(apart(&wanted, found) < 1e-12 * SIZE, "{}", apart(&wanted, found));
    }
    let angle = 1.9;
    let round = Chain::of_curve(&arc_center(DVec3::ZERO, section.start(), angle, DVec3::Z, Origin::NONE).expect("an arc"));
    let axis = revolve::Axis { about: DVec3::ZERO, direction: DVec3::Z };
    let wanted = lofting::surface::revolve(&section, &axis, angle, Origin::NONE, &tolerance()).expect("a surface");
    let carried = along(&section, &round, &settings, &tolerance()).expect("a surface").0;
    for found in [
        &carried,
        &made(from_ref(&section), from_ref(&round), Law::Rotational(axis)),
        &made(from_ref(&section), from_ref(&round), Law::Normal),
    ] {
        assert!(apart(&wanted, found) < 1e-12 * SIZE, "{}", apart(&wanted, found));
    }
}

#[test]
fn two_guides_and_two_sections_of_several_runs_make_four_by_four_patches() {
    // Sections of three and two runs, guides of three and two: no inner breaks fall together.
    let chain = |points: &[(f64, f64, f64)]| {
        let points: Vec<DVec3> = points.iter().map(|p| DVec3::from(*p)).collect();
        Chain::of_curve(&lofting::geometry::construct::build::polyline(&points, false, Origin::NONE).expect("a polyline"))
    };
    let a = chain(&[(0.0, 0.0, 0.0), (0.0, 30.0, 20.0), (0.0, 70.0, 20.0), (0.0, 100.0, 0.0)]);
    let b = chain(&[(200.0, 0.0, 0.0), (200.0, 50.0, 40.0), (200.0, 100.0, 0.0)]);
    let c = chain(&[(0.0, 0.0, 0.0), (60.0, -5.0, 0.0), (130.0, -5.0, 0.0), (200.0, 0.0, 0.0)]);
    let d = chain(&[(0.0, 100.0, 0.0), (100.0, 110.0, 0.0), (200.0, 100.0, 0.0)]);
    let surface = made(&[a, b], &[c, d], Law::Parallel);
    let stations = surface.stations();
    assert_eq!(stations.len(), 5);
    let curve = stations[2].to_curve().expect("a curve");
    assert_eq!(curve.to_nurbs(&tolerance()).expect("a curve").poles.len(), 13);
}
