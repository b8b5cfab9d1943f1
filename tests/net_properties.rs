//! Properties of surfaces through random nets: what they contain, what changes nothing, what moves with them, and what they are in
//! simple cases.
//!
//! 40 random nets, 1000 in a long run; `PROPTEST_CASES` says how many.

use std::slice::from_ref;

use glam::DVec3;
use lofting::base::math::{cos, sin};
use lofting::base::origin::Origin;
use lofting::base::tolerance::Tolerance;
use lofting::geometry::Motion;
use lofting::geometry::construct::build::{arc_center, circle_start, line};
use lofting::geometry::construct::spline::{Ends, Spline, spline};
use lofting::network::Chain;
use lofting::surface::blended::skin::{Across, SkinSettings, skin};
use lofting::surface::blended::skin_align::SkinSection;
use lofting::surface::blended::skin_ends::Leaving;
use lofting::surface::swept::laws::Law;
use lofting::surface::swept::revolve;
use lofting::surface::swept::sweep::sweep;
use lofting::surface::swept::sweep_input::{Input, NetMethod};
use lofting::surface::{Closest, Nearest, Surface, extrude};

use crate::support::networks;
use crate::support::random;
use crate::support::surfaces;

const SIZE: f64 = 400.0;

fn cases() -> u64 {
    random::cases(40) as u64
}

/// Numbers between −1 and 1 that are the same in every run.
struct Numbers(u64);

impl Numbers {
    fn of(seed: u64) -> Self {
        let mut numbers = Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15));
        numbers.next();
        numbers
    }

    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((self.0 >> 11) as f64 / (1u64 << 53) as f64) * 2.0 - 1.0
    }

    fn below(&mut self, n: u64) -> usize {
        self.next();
        ((self.0 >> 33) % n) as usize
    }

    fn motion(&mut self) -> (Motion, f64) {
        let axis = DVec3::new(self.next(), self.next(), 1.5).normalize();
        let about = DVec3::new(self.next(), self.next(), self.next()) * SIZE;
        let scale = [1.0, 1e-2, 50.0][self.below(3)];
        // About the origin, so that small models do not lie far from it for their size.
        (Motion::rotation(about, axis, 3.0 * self.next()).then(&Motion::scaling(DVec3::ZERO, scale)), scale)
    }
}

fn tolerance(scale: f64) -> Tolerance {
    Tolerance::new(1e-6 * scale, SIZE * scale)
}

fn through(points: &[DVec3]) -> Chain {
    let settings = Spline { start: Ends::Natural, end: Ends::Natural, closed: false };
    Chain::of_curve(&spline(points, &settings, Origin::NONE).unwrap())
}

/// The largest distance of two surfaces over a grid of parameters, the second one perhaps run backwards.
fn apart(a: &Surface, b: &Surface) -> f64 {
    surfaces::apart(a, b, 9)
}

/// How far curves lie off a surface at most.
fn off(surface: &Surface, curves: &[Chain]) -> f64 {
    let nearest = Nearest::new(surface);
    let one = |curve: &Chain| {
        let each = (0..=5).map(|k| {
            let foot: Closest = nearest.at(curve.point(f64::from(k) / 5.0));
            foot.distance
        });
        each.fold(0.0, f64::max)
    };
    curves.iter().map(one).fold(0.0, f64::max)
}

/// Sections in planes of constant x, in any order and direction, and guides through them.
fn swept_net(numbers: &mut Numbers) -> (Vec<Chain>, Vec<Chain>) {
    let (sections, guides) = (1 + numbers.below(3), 1 + numbers.below(3));
    let place = |j: usize, k: usize, n: &mut Numbers| DVec3::new(100.0 * k as f64, 80.0 * j as f64 + 8.0 * n.next(), 10.0 * n.next());
    let at: Vec<Vec<DVec3>> = (0..guides).map(|j| (0..4).map(|k| place(j, k, numbers)).collect()).collect();
    let section = |k: usize, numbers: &mut Numbers| {
        let mut points = vec![at[0][k] + DVec3::new(0.0, -30.0, 12.0 * numbers.next())];
        for row in &at {
            points.push(row[k]);
            points.push(row[k] + DVec3::new(0.0, 40.0, 30.0 + 10.0 * numbers.next()));
        }
        through(&points)
    };
    let sections = [0usize, 3, 1][..sections].iter().map(|&k| section(k, numbers)).collect();
    (sections, at.iter().map(|row| through(row)).collect())
}

fn swept(sections: &[Chain], guides: &[Chain], law: Law, scale: f64) -> Surface {
    let input = Input { sections, guides, law, method: NetMethod::Gordon, origin: Origin::NONE };
    sweep(&input, &tolerance(scale)).unwrap_or_else(|fault| panic!("{fault}")).0
}

/// Each curve as it is or backwards, in another order.
fn shuffled(curves: &[Chain], fixed: usize, numbers: &mut Numbers) -> Vec<Chain> {
    let mut all: Vec<Chain> = curves.iter().map(|c| if numbers.below(2) == 0 { c.reversed() } else { c.clone() }).collect();
    for k in (fixed + 1..all.len()).rev() {
        all.swap(k, fixed + numbers.below((k - fixed + 1) as u64));
    }
    all
}

fn moved(curves: &[Chain], motion: &Motion) -> Vec<Chain> {
    curves.iter().map(|c| c.moved(motion)).collect()
}

#[test]
fn sweeps_hold_their_curves_in_any_order_and_move_with_them() {
    for seed in 0..cases() {
        let mut numbers = Numbers::of(seed);
        let (sections, guides) = swept_net(&mut numbers);
        let law = if seed % 2 == 0 { Law::Parallel } else { Law::Synchronized };
        let surface = swept(&sections, &guides, law, 1.0);
        let far = off(&surface, &sections).max(off(&surface, &guides));
        assert!(far <= 1e-9 * SIZE, "{seed} {law:?}: {far:e}");
        // The first guide stays the main one.
        let again = swept(&shuffled(&sections, 0, &mut numbers), &shuffled(&guides, 1, &mut numbers), law, 1.0);
        assert!(apart(&surface, &again) <= 1e-9 * SIZE, "{seed} {law:?}: {:e} in another order", apart(&surface, &again));
        let (motion, scale) = numbers.motion();
        let there = swept(&moved(&sections, &motion), &moved(&guides, &motion), law, scale);
        let far = apart(&surface.moved(&motion), &there);
        assert!(far <= 1e-9 * SIZE * scale, "{seed} {law:?}: {:e} when moved", far / scale);
    }
}

/// Points of a bent sheet over a grid, and splines through its rows and columns.
fn gordon_net(numbers: &mut Numbers) -> [Vec<Chain>; 2] {
    let (n, m) = (2 + numbers.below(4), 2 + numbers.below(4));
    let point = |i: usize, j: usize, by: &mut Numbers| {
        DVec3::new(90.0 * i as f64 + 12.0 * by.next(), 70.0 * j as f64 + 12.0 * by.next(), 25.0 * by.next())
    };
    let rows: Vec<Vec<DVec3>> = (0..m).map(|j| (0..n).map(|i| point(i, j, numbers)).collect()).collect();
    let column = |i: usize| rows.iter().map(|row| row[i]).collect::<Vec<_>>();
    [rows.iter().map(|row| through(row)).collect(), (0..n).map(|i| through(&column(i))).collect()]
}

#[test]
fn gordon_surfaces_hold_their_curves_in_any_order_and_move_with_them() {
    for seed in 0..cases() {
        let mut numbers = Numbers::of(seed + 10_000);
        let net = gordon_net(&mut numbers);
        let (surface, size) = networks::surface(net.clone(), 1e-6);
        let far = off(&surface, &net.concat());
        assert!(far <= 1e-9 * size, "{seed}: {:e}", far / size);
        let again = networks::surface([shuffled(&net[0], 0, &mut numbers), shuffled(&net[1], 0, &mut numbers)], 1e-6).0;
        assert!(apart(&surface, &again) <= 1e-9 * size, "{seed}: {:e} in another order", apart(&surface, &again) / size);
        let (motion, scale) = numbers.motion();
        let there = networks::surface([moved(&net[0], &motion), moved(&net[1], &motion)], 1e-6).0;
        let far = apart(&surface.moved(&motion), &there) / scale;
        assert!(far <= 1e-9 * size, "{seed}: {:e} when moved", far / size);
    }
}

/// Open sections one above the other, or rings, perhaps with a point at an end.
fn sections(numbers: &mut Numbers) -> Vec<SkinSection> {
    let (n, round) = (2 + numbers.below(4), numbers.below(2) == 0);
    let mut all: Vec<SkinSection> = Vec::new();
    for k in 0..n {
        let z = 60.0 * k as f64 + 10.0 * numbers.next();
        all.push(SkinSection::Curve(if round {
            let (center, r) = (DVec3::new(10.0 * numbers.next(), 10.0 * numbers.next(), z), 70.0 + 20.0 * numbers.next());
            let normal = DVec3::new(0.2 * numbers.next(), 0.2 * numbers.next(), 1.0).normalize();
            let start = center + normal.cross(DVec3::Y).normalize() * r;
            Chain::of_curve(&circle_start(center, start, normal, Origin::NONE).unwrap())
        } else {
            through(&[0.0, 1.0, 2.0, 3.0].map(|x| DVec3::new(60.0 * x + 8.0 * numbers.next(), 20.0 * numbers.next(), z)))
        }));
    }
    if numbers.below(3) == 0 {
        all.push(SkinSection::Point(DVec3::new(60.0 * f64::from(!round), 0.0, 60.0 * n as f64 + 20.0)));
    }
    all
}

fn skinned(sections: &[SkinSection], ends: (Leaving, Leaving), scale: f64) -> Surface {
    let settings = SkinSettings { across: Across::Cubic, closed: false, ends, smooth: None, origin: Origin::NONE };
    skin(sections, &settings, &tolerance(scale)).unwrap_or_else(|fault| panic!("{fault}")).0
}

#[test]
fn skins_hold_their_sections_in_any_direction_and_move_with_them() {
    for seed in 0..cases() {
        let mut numbers = Numbers::of(seed + 20_000);
        let given = sections(&mut numbers);
        let mut end = || match numbers.below(3) {
            0 => Leaving::Plain,
            1 => Leaving::Natural,
            _ => Leaving::Along(DVec3::new(0.3 * numbers.next(), 0.3 * numbers.next(), 1.0).normalize()),
        };
        let ends = (end(), end());
        let surface = skinned(&given, ends, 1.0);
        let chains: Vec<Chain> = given.iter().filter_map(|s| if let SkinSection::Curve(c) = s { Some(c.clone()) } else { None }).collect();
        // The line of constant v at each section runs along it, all of it.
        let lines: Vec<f64> = surface.net_curves().iter().map(|c| c.at).collect();
        for (chain, v) in chains.iter().zip(&lines) {
            let places = (0..=12).map(|k| chain.closest(surface.point(f64::from(k) / 12.0, *v)));
            let mut found: Vec<f64> = places.map(|(f, _, far)| if far <= 1e-9 * SIZE { f } else { f64::NAN }).collect();
            found.sort_by(f64::total_cmp);
            assert!(found.windows(2).all(|w| w[1] - w[0] < 0.1), "{seed} {ends:?}: {found:?} of a section");
        }
        let back = |s: &SkinSection, turn: bool| {
            if let (SkinSection::Curve(c), true) = (s, turn) { SkinSection::Curve(c.reversed()) } else { s.clone() }
        };
        let turned: Vec<SkinSection> = given.iter().enumerate().map(|(k, s)| back(s, k > 0 && numbers.below(2) == 0)).collect();
        let far = apart(&surface, &skinned(&turned, ends, 1.0));
        assert!(far <= 1e-9 * SIZE, "{seed} {ends:?}: {far:e} when sections are turned");
        // From the last section to the first one it is the same.
        let along = |leaving: Leaving| if let Leaving::Along(d) = leaving { Leaving::Along(-d) } else { leaving };
        let upside: Vec<SkinSection> = given.iter().rev().cloned().collect();
        let other = skinned(&upside, (along(ends.1), along(ends.0)), 1.0);
        if !chains[0].is_closed(&tolerance(1.0)) {
            assert!(apart(&surface, &other) <= 1e-9 * SIZE, "{seed} {ends:?}: {:e} upside down", apart(&surface, &other));
        }
        let (motion, scale) = numbers.motion();
        let carried = |s: &SkinSection| match s {
            SkinSection::Curve(c) => SkinSection::Curve(c.moved(&motion)),
            SkinSection::Point(p) => SkinSection::Point(motion.point(*p)),
        };
        let way = |leaving: Leaving| match leaving {
            Leaving::Along(d) => Leaving::Along(motion.vector(d).normalize()),
            other => other,
        };
        let there = skinned(&given.iter().map(carried).collect::<Vec<_>>(), (way(ends.0), way(ends.1)), scale);
        let far = apart(&surface.moved(&motion), &there) / scale;
        assert!(far <= 1e-9 * SIZE, "{seed} {ends:?}: {far:e} when moved");
    }
}

#[test]
fn equal_sections_on_a_straight_guide_are_extruded() {
    for seed in 0..cases() {
        let mut numbers = Numbers::of(seed + 30_000);
        let points: Vec<DVec3> =
            (0..3 + numbers.below(3)).map(|k| DVec3::new(0.0, 40.0 * k as f64 + 10.0 * numbers.next(), 40.0 * numbers.next())).collect();
        let section = through(&points);
        let by = DVec3::new(100.0 + 50.0 * numbers.next(), 30.0 * numbers.next(), 30.0 * numbers.next());
        let way = Chain::of_curve(&line(points[0], points[0] + by, Origin::NONE).unwrap());
        let wanted = extrude(&section, by, Origin::NONE, &tolerance(1.0)).unwrap();
        let last = section.moved(&Motion::translation(by));
        for law in [Law::Parallel, Law::Synchronized] {
            for sections in [vec![section.clone()], vec![section.clone(), last.clone()], vec![last.clone()]] {
                let far = apart(&wanted, &swept(&sections, from_ref(&way), law, 1.0));
                assert!(far <= 1e-12 * SIZE, "{seed} {law:?} with {} sections: {far:e}", sections.len());
            }
        }
    }
}

#[test]
fn one_section_round_an_axis_is_revolved() {
    for seed in 0..cases() {
        let mut numbers = Numbers::of(seed + 40_000);
        let points: Vec<DVec3> = (0..3 + numbers.below(3))
            .map(|k| DVec3::new(80.0 + 30.0 * numbers.next(), 0.0, 40.0 * k as f64 + 10.0 * numbers.next()))
            .collect();
        let section = through(&points);
        let angle = if numbers.below(4) == 0 { std::f64::consts::TAU } else { 3.0 + 2.9 * numbers.next() };
        let foot = DVec3::new(0.0, 0.0, points[0].z);
        let way = Chain::of_curve(&arc_center(foot, points[0], angle, DVec3::Z, Origin::NONE).unwrap());
        let axis = revolve::Axis { about: DVec3::ZERO, direction: DVec3::Z };
        let wanted = lofting::surface::revolve(&section, &axis, angle, Origin::NONE, &tolerance(1.0)).unwrap();
        let far = apart(&wanted, &swept(from_ref(&section), from_ref(&way), Law::Rotational(axis), 1.0));
        assert!(far <= 1e-12 * SIZE, "{seed}: {far:e}");
    }
}

/// Nodes and slopes across nearly cancel in a spline through many sections: what bounds each by itself is hundreds of times too large.
#[test]
fn bounds_of_skins_of_many_sections_come_near() {
    let point = |i: f64, k: f64| {
        let wave = 12.0 * sin((25.0 * i + 7.0 * k).to_radians()) + 4.0 * cos((11.0 * k).to_radians());
        DVec3::new(10.0 * i, 5.0 * k, wave)
    };
    let section = |k: u32| SkinSection::Curve(through(&(0..15_u32).map(|i| point(f64::from(i), f64::from(k))).collect::<Vec<_>>()));
    let surface = skinned(&(0..99).map(section).collect::<Vec<_>>(), (Leaving::Plain, Leaving::Plain), 500.0);
    // Cells along u and v in the whole, and how far the bounds may be from the largest values found.
    for (cells, most) in [((28, 98), [2.5, 4.0, 6.0]), ((112, 392), [1.5, 1.5, 2.0])] {
        let (u, v) = ((0.31, 0.31 + 1.0 / f64::from(cells.0)), (0.3, 0.3 + 1.0 / f64::from(cells.1)));
        let bound = surface.second_derivative_bound(u, v);
        let mut found = [0.0_f64; 3];
        for (i, j) in (0..=20).flat_map(|i| (0..=20).map(move |j| (f64::from(i) / 20.0, f64::from(j) / 20.0))) {
            let jet = surface.jet(u.0 + (u.1 - u.0) * i, v.0 + (v.1 - v.0) * j);
            let own = [jet.duu, jet.duv, jet.dvv].map(DVec3::length);
            (0..3).for_each(|k| found[k] = found[k].max(own[k]));
        }
        let ratios = [0, 1, 2].map(|k| bound[k] / found[k]);
        assert!((0..3).all(|k| (1.0..most[k]).contains(&ratios[k])), "{cells:?}: {ratios:?}");
    }
}
