//! Hermite blended Coons patches from curves: their borders, how smooth nets of them are, poles, and twists.

use glam::DVec3;
use lofting::base::fault::Fault;
use lofting::base::math;
use lofting::base::origin::Origin;
use lofting::base::tolerance::Tolerance;
use lofting::geometry::construct::build::{arc_center, ellipse, line, spline};
use lofting::geometry::{Ends, Spline};
use lofting::network::{Chain, ChainFlow, of_chains};
use lofting::surface::blended::coons::Grid;
use lofting::surface::blended::hermite::{build, default_pole};
use lofting::surface::blended::twists::Twist;
use lofting::surface::{Off, OneSided, Surface};

const ALL: [Twist; 3] = [Twist::Zero, Twist::Adini, Twist::Similar];

fn tolerance() -> Tolerance {
    Tolerance::new(1e-6, 10.0)
}

fn p(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

fn straight(a: DVec3, b: DVec3) -> Chain {
    Chain::of_curve(&line(a, b, Origin::NONE).unwrap())
}

fn through(points: &[DVec3]) -> Chain {
    let settings = Spline { start: Ends::Natural, end: Ends::Natural, closed: false };
    Chain::of_curve(&spline(points, &settings, Origin::NONE).unwrap())
}

fn quarter(from: DVec3, normal: DVec3) -> Chain {
    Chain::of_curve(&arc_center(DVec3::ZERO, from, std::f64::consts::FRAC_PI_2, normal, Origin::NONE).unwrap())
}

fn tried(chains: &[Chain], options: &ChainFlow, twist: Twist) -> Result<Surface, Fault> {
    let t = tolerance();
    let (flow, nodes) = of_chains(chains, options, &t)?;
    let poles = (flow.poles.0.map(|n| nodes[n]), flow.poles.1.map(|n| nodes[n]));
    build(&Grid { chains, flow: &flow, poles }, twist, Origin::NONE, &t).map(|made| made.0)
}

fn patch(chains: &[Chain], options: &ChainFlow, twist: Twist) -> Surface {
    tried(chains, options, twist).unwrap()
}

/// Lines of an uneven net over a bumpy floor, those along x first.
fn floor() -> Vec<Chain> {
    let at = |x: f64, y: f64| p(x, y, 0.4 * math::sin(x * 1.3) * math::cos(y * 0.9) + 0.1 * x * y);
    let steps = [0.0, 0.4, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0];
    let along_x = [0.0, 0.4, 2.5, 3.0].map(|y| through(&steps.map(|x| at(x, y))));
    let along_y = [0.0, 1.0, 1.5, 3.0].map(|x| through(&steps.map(|y| at(x, y))));
    along_x.into_iter().chain(along_y).collect()
}

/// Meridians from the pole (0, 0, 1) and a quarter of the equator.
fn octant() -> [Chain; 3] {
    [quarter(DVec3::Z, DVec3::Y), quarter(DVec3::Z, -DVec3::X), quarter(DVec3::X, DVec3::Z)]
}

fn places(n: u32) -> impl Iterator<Item = f64> + Clone {
    (0..=n).map(move |k| f64::from(k) / f64::from(n))
}

#[test]
fn uneven_nets_contain_their_curves_and_are_c1() {
    for twist in ALL {
        let surface = patch(&floor(), &ChainFlow::default(), twist);
        let check = surface.net_check(&tolerance()).unwrap();
        assert!(check.residual <= 2e-15 * 5.0 + check.gap && check.turn <= 1e-7, "{twist:?}: {check:?}");
        let (us, vs) = surface.cells();
        assert_eq!((us.len(), vs.len()), (2, 2));
        for x in places(40).map(|x| 0.001 + 0.998 * x) {
            for &u in &us {
                let side = |side| surface.jet_one_sided(u, x, (side, OneSided::After));
                let (a, b) = (side(OneSided::Before), side(OneSided::After));
                assert!(a.p.distance(b.p) < 1e-14 && a.du.distance(b.du) < 1e-12 && a.dv.distance(b.dv) < 1e-12, "{twist:?} {u} {x}");
            }
            for &v in &vs {
                let side = |side| surface.jet_one_sided(x, v, (OneSided::After, side));
                let (a, b) = (side(OneSided::Before), side(OneSided::After));
                assert!(a.p.distance(b.p) < 1e-14 && a.du.distance(b.du) < 1e-12 && a.dv.distance(b.dv) < 1e-12, "{twist:?} {x} {v}");
            }
        }
    }
}

/// Distance of two surfaces at equal places, u and v exchanged and turned round as it suits best.
fn apart(a: &Surface, b: &Surface) -> f64 {
    let one = |x: f64, turned: bool| if turned { 1.0 - x } else { x };
    let off = |way: u8| {
        let (swapped, first, second) = (way & 1 > 0, way & 2 > 0, way & 4 > 0);
        let at = |u: f64, v: f64| {
            let (u, v) = if swapped { (v, u) } else { (u, v) };
            b.point(one(u, first), one(v, second))
        };
        places(7).flat_map(|u| places(7).map(move |v| (u, v))).map(|(u, v)| a.point(u, v).distance(at(u, v))).fold(0.0, f64::max)
    };
    (0..8).map(off).fold(f64::INFINITY, f64::min)
}

#[test]
fn order_and_direction_change_nothing() {
    for (chains, options) in [
        (floor(), ChainFlow::default()),
        (octant().to_vec(), ChainFlow { pole: Some(DVec3::Z), ..ChainFlow::default() }),
        (vec![floor()[0].clone(), floor()[3].clone(), floor()[4].clone(), floor()[7].clone()], ChainFlow::default()),
    ] {
        for twist in ALL {
            let first = patch(&chains, &options, twist);
            for round in 1..chains.len() {
                let mut other = chains.clone();
                other.rotate_left(round);
                other.swap(0, chains.len() - 1);
                let other: Vec<Chain> =
                    other.iter().enumerate().map(|(k, c)| if (k + round) % 2 == 0 { c.reversed() } else { c.clone() }).collect();
                let off = apart(&first, &patch(&other, &options, twist));
                assert!(off < 1e-12, "{twist:?}, round {round}: {off:e}");
            }
        }
    }
}

#[test]
fn octants_of_a_sphere_are_round_by_similar_twists() {
    let options = ChainFlow { pole: Some(DVec3::Z), ..ChainFlow::default() };
    let off = |twist: Twist| {
        let surface = patch(&octant(), &options, twist);
        assert!(surface.point(0.3, 0.0).distance(DVec3::Z) < 1e-15);
        for u in places(8) {
            assert!(surface.normal(u, 0.0).cross(DVec3::Z).length() < 1e-12, "{twist:?}");
            // The tangents at the pole lie in one plane.
            assert!(surface.jet(u, 0.0).dv.z.abs() < 1e-12, "{twist:?}");
        }
        places(100)
            .flat_map(|u| places(100).map(move |v| (u, v)))
            .map(|(u, v)| (surface.point(u, v).length() - 1.0).abs())
            .fold(0.0, f64::max)
    };
    // In arc length; 4.193 % in the parameters of Bézier curves that are nearly circles.
    let [zero, adini, similar] = ALL.map(off);
    assert!((zero - 0.04196).abs() < 1e-5 && (adini - 0.0492).abs() < 1e-4 && (similar - 0.00440).abs() < 1e-5, "{zero} {adini} {similar}");
}

/// Borders have the derivatives across them that the crossing curves and the twists say: cubics along each side.
#[test]
fn boundary_derivatives_are_met() {
    for twist in ALL {
        let surface = patch(&floor(), &ChainFlow::default(), twist);
        let (us, _) = surface.cells();
        for (x0, x1) in [(0.0, us[0]), (us[0], us[1]), (us[1], 1.0)] {
            let at = |x: f64| surface.jet_one_sided(x, 0.0, (if x == x1 { OneSided::Before } else { OneSided::After }, OneSided::After));
            let (a, b, h) = (at(x0), at(x1), x1 - x0);
            for t in places(10) {
                let jet = at(x0 + h * t);
                let s = 1.0 - t;
                let cubic = a.dv * (s * s * (1.0 + 2.0 * t)) + b.dv * (t * t * (3.0 - 2.0 * t)) + (a.duv * s - b.duv * t) * (h * s * t);
                assert!(jet.dv.distance(cubic) < 1e-12, "{twist:?} {x0} {t}");
            }
        }
    }
}

#[test]
fn nets_of_hermite_surfaces_are_near() {
    let options = ChainFlow { pole: Some(DVec3::Z), ..ChainFlow::default() };
    for (chains, options) in [(floor(), ChainFlow::default()), (octant().to_vec(), options)] {
        for twist in ALL {
            let surface = patch(&chains, &options, twist);
            let form = surface.to_net(&tolerance()).unwrap().unwrap();
            let Off::Bounded(bound) = form.off else { panic!("{twist:?}: {:?}", form.off) };
            let at: Vec<f64> = places(60).collect();
            let (mut found, mut wanted) = (vec![DVec3::ZERO; at.len() * at.len()], vec![DVec3::ZERO; at.len() * at.len()]);
            form.net.grid(&at, &at, &mut found);
            surface.grid(&at, &at, &mut wanted);
            let off = found.iter().zip(&wanted).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
            assert!(off <= bound && bound <= 1e-6, "{twist:?}: {off:e}, {bound:e}");
        }
    }
}

#[test]
fn the_pole_is_the_corner_of_the_sides_nearest_in_length() {
    let (a, b, c) = (p(0.0, 0.0, 0.0), p(5.0, 0.0, 0.0), p(4.0, 1.0, 1.0));
    let sides = [straight(a, b), straight(c, b), straight(a, c)];
    for turn in 0..3 {
        let mut chains = sides.to_vec();
        chains.rotate_left(turn);
        let (flow, _) = of_chains(&chains, &ChainFlow::default(), &tolerance()).unwrap();
        assert_eq!(default_pole(&chains, &flow, &tolerance()), Some(a), "{turn}");
    }
}

#[test]
fn parallel_tangents_are_told_with_their_corner() {
    let code = |found: Result<Surface, Fault>| {
        found.err().map(|fault| (fault.code().0, fault.describe(&lofting::base::fault::PlainWords).message))
    };
    // The second curve goes on as the first one ends.
    let (a, b, c, d) = (p(0.0, 0.0, 0.0), p(1.0, 0.0, 0.0), p(2.0, 0.0, 0.0), p(1.0, 2.0, 0.0));
    let (found, message) =
        code(tried(&[straight(a, b), straight(b, c), straight(c, d), straight(d, a)], &ChainFlow::default(), Twist::Zero)).unwrap();
    assert!(found == "E653" && message.contains("(1.000000, 0.000000, 0.000000)") && message.contains("0.0000°"), "{message}");
    let pole = ChainFlow { pole: Some(b), ..ChainFlow::default() };
    let (found, message) = code(tried(&[straight(a, b), straight(b, c), through(&[c, d, a])], &pole, Twist::Zero)).unwrap();
    assert!(found == "E652" && message.contains("(1.000000, 0.000000, 0.000000)"), "{message}");
}

/// An eighth of an ellipsoid keeps its mirror planes: beside two of its sides it leaves them at right angles everywhere.
#[test]
fn triangles_are_smooth_across_mirror_planes() {
    let quarter =
        |a: DVec3, b: DVec3| Chain::of_curve(&ellipse(DVec3::ZERO, a, b, 0.0, std::f64::consts::FRAC_PI_2, Origin::NONE).unwrap());
    let (x, y, z) = (DVec3::X * 6.0, DVec3::Y * 3.0, DVec3::Z * 4.0);
    let options = ChainFlow { pole: Some(x), ..ChainFlow::default() };
    let mut off = [0.0_f64; 2];
    for (k, twist) in [Twist::Zero, Twist::Similar].into_iter().enumerate() {
        let surface = patch(&[quarter(x, y), quarter(x, z), quarter(y, z)], &options, twist);
        for (u, v) in places(20).flat_map(|u| places(20).map(move |v| (u, v))) {
            let p = surface.point(u, v);
            off[k] = off[k].max((DVec3::new(p.x / 6.0, p.y / 3.0, p.z / 4.0).length() - 1.0).abs());
            if v > 0.0 && (u == 0.0 || u == 1.0) {
                let mirror = if p.z.abs() < p.y.abs() { DVec3::Z } else { DVec3::Y };
                assert!(surface.normal(u, v).dot(mirror).abs() < 1e-9, "{twist:?} {u} {v}");
            }
        }
    }
    assert!(off[0] > 0.06 && off[1] < 0.0065, "{off:?}");
}
