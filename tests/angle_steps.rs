//! Steps that `angle_error` takes on mapped faces, against the least that keep it: random curves and faces with a fixed seed.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use lofting::base::job::Job;
use lofting::mesh::Mesh;
use lofting::mesh::data::face_geometry::{FaceGeometry, FaceNodes};
use lofting::mesh::mapped::grid::Grid;
use lofting::session::live::{Depth, Live};

/// Limits that each shape is made with, degrees, falling.
const LIMITS: [f64; 5] = [60.0, 34.0, 23.0, 15.0, 10.0];
/// Steps over the least that keep the limit.
const FACTOR: f64 = 1.5;
/// The same of the one face in a hundred that may be above: where both directions turn alike each is raised, though few steps may be
/// enough in one where the other has many.
const FACTOR_OF_ANY: f64 = 1.55;
/// Room of a limit for places that samples miss.
const ROOM: f64 = 1.01;

struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn of(&mut self, least: f64, most: f64) -> f64 {
        least + (most - least) * self.next()
    }
}

/// The meshes of a script.
fn meshes(text: &str) -> Vec<Arc<Mesh>> {
    let mut live = Live::new("angles.loft", None, &[], Arc::new(|| 0.0));
    let outcome = live.run(text, &[], Depth::Report, &Job::new(), &mut |_| {}).unwrap();
    assert!(outcome.report.ok, "{text}{}", outcome.drawn(false, false));
    outcome.meshes.iter().map(|m| m.1.clone()).collect()
}

/// The meshes of a shape `s` under each limit, in quads.
fn under_limits(shape: &str) -> Vec<Arc<Mesh>> {
    let mesh =
        |(k, limit): (usize, f64)| format!("mesh m{k} of s {{ size: 100m  angle_error: {limit}deg  method: mapped  elements: quads }}\n");
    meshes(&format!("units m\n{shape}{}", LIMITS.into_iter().enumerate().map(mesh).collect::<String>()))
}

/// Cells along u and along v.
fn cells(geometry: &FaceGeometry) -> [usize; 2] {
    let FaceNodes::Grid(grid, _) = &geometry.nodes else { panic!("not mapped") };
    let (nu, nv) = grid.size();
    [nu, nv]
}

/// A curve that bends one way and the other: through points, or by poles of one piece or of several.
fn curve(kind: usize, random: &mut Random) -> String {
    let n = 4 + (random.next() * 5.0) as usize;
    let point = |k: usize, random: &mut Random| format!("({:.4}, {:.4}, 0)", k as f64 * 0.5 + random.of(-0.1, 0.1), random.of(-0.7, 0.7));
    let points = |random: &mut Random| (0..n).map(|k| point(k, random)).collect::<Vec<String>>().join(", ");
    match kind {
        0 => format!("curve p = spline([{}])\n", points(random)),
        1 => format!("curve p = bezier([{}])\n", points(random)),
        _ => format!("curve p = bspline([{}])\n", points(random)),
    }
}

/// The least even steps along the profile of an extruded face over which its normal keeps a limit, radians.
fn least_along(profile: &[(f64, DVec3)], limit: f64) -> usize {
    let whole = profile[profile.len() - 1].0;
    let place = |s: f64| profile.partition_point(|p| p.0 < s - 1e-9 * whole).min(profile.len() - 1);
    let keeps = |n: usize| {
        (0..n).all(|k| {
            let own = &profile[place(whole * k as f64 / n as f64)..=place(whole * (k + 1) as f64 / n as f64)];
            let far = |from: DVec3| own.iter().map(|p| p.1).min_by(|a, b| from.dot(*a).total_cmp(&from.dot(*b))).unwrap();
            let a = far(own[0].1);
            a.dot(far(a)).clamp(-1.0, 1.0).acos() <= limit
        })
    };
    (1..profile.len()).find(|n| keeps(*n)).unwrap()
}

#[test]
fn curves_take_few_more_steps_than_their_angle_needs() {
    let mut random = Random(17);
    let (mut worst, mut cases) = ((0.0, String::new()), 0);
    for case in 0..12 {
        let profile = curve(case % 3, &mut random);
        let shape = format!("{profile}surface s = extrude(p, by: (0, 0, 20))\n");
        let mut before = 0;
        for (mesh, limit) in under_limits(&shape).iter().zip(LIMITS) {
            let geometry = &mesh.geometries.0[0];
            let steps = cells(geometry)[1].max(cells(geometry)[0]);
            let along_v = cells(geometry)[1] == steps;
            let at = |k: u32| f64::from(k) / 600.0;
            let place = |t: f64| if along_v { (0.5, t) } else { (t, 0.5) };
            let mut sampled: Vec<(f64, DVec3)> = Vec::new();
            let mut last = None;
            for k in 0..=600 {
                let (u, v) = place(at(k));
                let p = geometry.surface.point(u, v);
                let s = sampled.last().map_or(0.0, |l| l.0) + last.map_or(0.0, |l: DVec3| l.distance(p));
                last = Some(p);
                sampled.push((s, geometry.surface.normal(u, v)));
            }
            let best = least_along(&sampled, limit.to_radians());
            // Uneven rows are fewer than the fewest even ones.
            assert!(steps >= before || steps < best, "{shape}{limit}°: {steps} after {before}, where {best} even ones do");
            before = steps;
            let over = (steps as f64 - 1.0) / best as f64;
            if over > worst.0 {
                worst = (over, format!("{shape}{limit}°: {steps} where {best} do"));
            }
            cases += 1;
        }
    }
    println!("{cases} cases, {} {}", worst.0, worst.1);
    assert!(cases >= 60 && worst.0 <= FACTOR, "{} {}", worst.0, worst.1);
}

/// Normals of a face, and lengths along its four sides, at even places of u and v.
struct Normals {
    all: Vec<DVec3>,
    /// Of the sides v = 0, u = 1, v = 1, u = 0: shares of their lengths.
    sides: [Vec<f64>; 4],
}

/// Places along each direction less one.
const FINE: usize = 96;
/// Places along each side of a cell less one.
const INSIDE: usize = 4;

impl Normals {
    fn new(geometry: &FaceGeometry) -> Self {
        let at = |k: usize| k as f64 / FINE as f64;
        let all = (0..(FINE + 1) * (FINE + 1)).map(|n| geometry.surface.normal(at(n % (FINE + 1)), at(n / (FINE + 1)))).collect();
        let sides = [0, 1, 2, 3].map(|side| {
            let point = |k: usize| match side {
                0 => geometry.surface.point(at(k), 0.0),
                1 => geometry.surface.point(1.0, at(k)),
                2 => geometry.surface.point(at(k), 1.0),
                _ => geometry.surface.point(0.0, at(k)),
            };
            let mut run = vec![0.0];
            (0..FINE).for_each(|k| run.push(run[k] + point(k).distance(point(k + 1))));
            run.iter().map(|s| s / run[FINE]).collect()
        });
        Self { all, sides }
    }

    /// The normal at a place, between those round it.
    fn at(&self, (u, v): (f64, f64)) -> DVec3 {
        let cell = |x: f64| ((x * FINE as f64) as usize).min(FINE - 1);
        let (i, j) = (cell(u), cell(v));
        let (x, y) = (u * FINE as f64 - i as f64, v * FINE as f64 - j as f64);
        let [a, b, c, d] = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(p, q)| self.all[i + p + (j + q) * (FINE + 1)]);
        a.lerp(b, x).lerp(c.lerp(d, x), y).normalize()
    }

    /// Whether a grid of so many cells, with even steps along its sides, keeps a limit, radians.
    fn keep(&self, [nu, nv]: [usize; 2], limit: f64) -> bool {
        let even = |side: usize, n: usize| -> Vec<f64> {
            let own = &self.sides[side];
            let place = |s: f64| {
                let k = own.partition_point(|o| *o <= s).clamp(1, FINE);
                (k as f64 - 1.0 + ((s - own[k - 1]) / (own[k] - own[k - 1])).min(1.0)) / FINE as f64
            };
            (0..=n).map(|k| place(k as f64 / n as f64)).collect()
        };
        let sides = [even(0, nu), even(1, nv), even(2, nu), even(3, nv)];
        let grid = Grid { u: (0.0, 1.0), v: (0.0, 1.0), sides, straight: (false, false) };
        let least = limit.cos();
        (0..nu * nv).all(|k| {
            let (i, j) = (k % nu, k / nu);
            let [a, b, c, d] = [(i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1)].map(|(i, j)| DVec2::from(grid.uv(i, j)));
            let place = |n: usize| {
                let (x, y) = ((n % (INSIDE + 1)) as f64 / INSIDE as f64, (n / (INSIDE + 1)) as f64 / INSIDE as f64);
                let at = a.lerp(b, x).lerp(c.lerp(d, x), y);
                self.at((at.x, at.y))
            };
            let own: Vec<DVec3> = (0..(INSIDE + 1) * (INSIDE + 1)).map(place).collect();
            own.iter().enumerate().all(|(k, p)| own[..k].iter().all(|q| p.dot(*q) >= least))
        })
    }

    /// Fewest cells that keep a limit, of no more than a grid that does.
    fn fewest(&self, [nu, nv]: [usize; 2], limit: f64) -> [usize; 2] {
        let mut best = [nu, nv];
        for a in 1..=2 * nu {
            let cap = (best[0] * best[1] - 1) / a;
            // Counts that cannot be enough are passed over.
            let first = (nv / 4).max(1);
            if let Some(b) = (first..=cap).find(|b| self.keep([a, *b], limit)) {
                best = [a, b];
            }
        }
        best
    }
}

#[test]
fn faces_take_few_more_steps_than_their_angle_needs() {
    let mut random = Random(29);
    let (mut worst, mut cases, mut above) = ((0.0, String::new()), 0, 0);
    for case in 0..56 {
        let height = random.of(0.2, 1.0);
        let row = |j: usize, random: &mut Random| {
            let one: Vec<String> = (0..4).map(|i| format!("({i}, {j}, {:.3})", random.next() * height)).collect();
            format!("[{}]", one.join(", "))
        };
        let rows: Vec<String> = (0..4).map(|j| row(j, &mut random)).collect();
        let shape = format!("surface s = {}([{}])\n", if case % 2 == 0 { "bezier_surface" } else { "grid" }, rows.join(", "));
        let made = under_limits(&shape);
        let normals = Normals::new(&made[0].geometries.0[0]);
        let mut before = 0;
        for (mesh, limit) in made.iter().zip(LIMITS) {
            let [nu, nv] = cells(&mesh.geometries.0[0]);
            assert!(nu * nv >= before, "{shape}{limit}°: {nu} by {nv} after {before}");
            before = nu * nv;
            if nu.max(nv) > FINE / 6 {
                continue;
            }
            assert!(normals.keep([nu, nv], limit.to_radians() * ROOM), "{shape}{limit}°: {nu} by {nv}");
            let [a, b] = normals.fewest([nu, nv], limit.to_radians());
            // One step more than the least is none too many.
            let over = (((nu - 1) * (nv - 1)) as f64 / (a * b) as f64).sqrt();
            if over > worst.0 {
                worst = (over, format!("{shape}{limit}°: {nu} by {nv} where {a} by {b} do"));
            }
            cases += 1;
            above += usize::from(over > FACTOR);
        }
    }
    println!("{cases} cases, {above} above {FACTOR}: {} {}", worst.0, worst.1);
    assert!(
        cases >= 200 && above * 100 <= cases && worst.0 <= FACTOR_OF_ANY,
        "{cases} cases, {above} above {FACTOR}: {} {}",
        worst.0,
        worst.1
    );
}
