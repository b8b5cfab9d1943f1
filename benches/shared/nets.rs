//! Networks of known counts, the same numbers as `benches/peers/network.py` makes.

use glam::DVec3;
use lofting::base::origin::Origin;
use lofting::geometry::Curve;
use lofting::geometry::construct::build;
use lofting::network::Input;

/// A generator of numbers in 0…1.
struct Lcg(u64);

impl Lcg {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Lines, arcs and cubics across the square 0…100; 300 of them cross 33 864 times.
pub fn planar(n: usize) -> Vec<Input> {
    let mut random = Lcg(7);
    let curves = (0..n).map(|k| {
        let (a, b) = (100.0 * random.next(), 100.0 * random.next());
        let (c, d) = (16.0 * random.next() - 8.0, 16.0 * random.next() - 8.0);
        let at = |s: f64, t: f64| if (k / 3) % 2 == 0 { DVec3::new(s, t, 0.0) } else { DVec3::new(t, s, 0.0) };
        match k % 3 {
            0 => build::line(at(0.0, a), at(100.0, b), Origin::NONE),
            1 => {
                let middle = (a + b) / 2.0 + c + if c >= 0.0 { 1.0 } else { -1.0 };
                build::arc_through(at(0.0, a), at(100.0, b), at(50.0, middle), Origin::NONE)
            }
            _ => {
                let poles = [at(0.0, a), at(33.0, a + (b - a) / 3.0 + 2.0 * c), at(66.0, b - (b - a) / 3.0 + 2.0 * d), at(100.0, b)];
                build::bezier(&poles, None, Origin::NONE)
            }
        }
    });
    inputs(curves.map(|c| c.expect("the generator makes valid curves")))
}

/// `m` lines each way and `m` parabolas on the ruled surface z = xy/50.
pub fn ruled(m: usize) -> Vec<Input> {
    let at = |x: f64, y: f64| DVec3::new(x, y, x * y / 50.0);
    let step = |i: usize, share: f64| 100.0 * (i as f64 + share) / m as f64;
    let mut curves = Vec::new();
    curves.extend((0..m).map(|i| build::line(at(step(i, 0.5), 0.0), at(step(i, 0.5), 100.0), Origin::NONE)));
    curves.extend((0..m).map(|i| build::line(at(0.0, step(i, 0.5)), at(100.0, step(i, 0.5)), Origin::NONE)));
    curves.extend((0..m).map(|i| {
        let c = step(i, 0.37) - 50.0;
        let (x0, x1) = ((-c).max(0.0), (100.0 - c).min(100.0));
        let middle = (x0 + x1) / 2.0;
        let poles = [at(x0, x0 + c), DVec3::new(middle, middle + c, (x0 * x1 + c * middle) / 50.0), at(x1, x1 + c)];
        build::bezier(&poles, None, Origin::NONE)
    }));
    inputs(curves.into_iter().map(|c| c.expect("the generator makes valid curves")))
}

/// Lines end to end along a wave.
pub fn row(n: usize) -> Vec<Input> {
    let at = |k: usize| {
        let x = k as f64;
        DVec3::new(x, 10.0 * lofting::base::math::sin(0.01 * x), 0.0)
    };
    inputs((0..n).map(|k| build::line(at(k), at(k + 1), Origin::NONE).expect("neighbours differ")))
}

/// Short lines all over the square 0…1000; few of them cross.
pub fn scattered(n: usize) -> Vec<Input> {
    let mut random = Lcg(3);
    inputs((0..n).map(|_| {
        let a = DVec3::new(1000.0 * random.next(), 1000.0 * random.next(), 0.0);
        let by = DVec3::new(40.0 * random.next() - 20.0, 40.0 * random.next() - 20.0, 0.0);
        build::line(a, a + by, Origin::NONE).expect("the generator makes valid lines")
    }))
}

fn inputs(curves: impl Iterator<Item = Curve>) -> Vec<Input> {
    curves.enumerate().map(|(k, curve)| Input { name: format!("c{k}"), curve, cuts: Vec::new() }).collect()
}
