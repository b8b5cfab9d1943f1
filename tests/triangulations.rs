//! Random changes of triangulations: flips, patches made anew, nodes put in and taken out, changes taken back and made again.
//! After each the triangulation states its conditions, covers what it covered and has the border that it had.
//!
//! Runs are longer in a long run; `PROPTEST_CASES` says how many cases.

use std::collections::BTreeSet;

use glam::{DVec2, DVec3};
use lofting::base::job::Job;
use lofting::base::triangulate::polygon;
use lofting::base::triangulate_points::NO_TRIANGLE;
use lofting::mesh::chart::outline::{Outline, is_left};
use lofting::mesh::chart::parametric_surface::{ParametricSurface, UniformSize};
use lofting::mesh::tri::build::{NodePlacement, Task, initial_triangulation};
use lofting::mesh::tri::shape::Star;
use lofting::mesh::tri::triangulation::undo::Before;
use lofting::mesh::tri::triangulation::{Patch, Ring, Triangulation};

use crate::support::outlines::{CARE, Waves, add_loop, star};
use crate::support::random::{Random, cases};

/// Changes of each triangulation.
const CHANGES: usize = 500;
/// Changes after which none of those before is taken back any more.
const DEEP: usize = 24;

/// One change, by the numbers of the triangles that it is made in.
#[derive(Clone, Debug)]
enum Change {
    /// The side opposite a corner becomes the other diagonal.
    Flip(u32, usize),
    /// The star of a node inside that stays, or of a new one.
    Star(Vec<u32>, Option<u32>, Star),
    /// The fan of a node of the rim.
    Fan(Vec<u32>, usize),
    /// Triangles over the rim.
    Fill(Vec<u32>, Vec<[usize; 3]>),
}

impl Change {
    /// The triangles that it is made in.
    fn within(&self, triangulation: &Triangulation) -> Vec<u32> {
        match self {
            Self::Flip(t, k) => vec![*t, triangulation.across[*t as usize][*k]],
            Self::Star(some, ..) | Self::Fan(some, _) | Self::Fill(some, _) => some.clone(),
        }
    }

    fn make(&self, triangulation: &mut Triangulation) {
        let mut patch = Patch::default();
        if !matches!(self, Self::Flip(..)) {
            triangulation.patch(&self.within(triangulation), &mut patch).expect("a patch that was one is one again");
        }
        match self {
            Self::Flip(t, k) => triangulation.flip(*t, *k),
            Self::Star(_, node, star) => _ = triangulation.restar(&patch, *node, star, 0.5),
            Self::Fan(_, k) => triangulation.refan(&patch, *k),
            Self::Fill(_, triangles) => triangulation.refill(&patch, triangles),
        }
    }
}

/// A triangle with its number, neighbours and locked sides.
type Triangle = (usize, [u32; 3], [u32; 3], u8);
/// A node with its number, triangle, point, place and size.
type Node = (usize, u32, DVec3, DVec2, f64);

/// All that counts of a triangulation.
#[derive(Clone, Debug, PartialEq)]
struct State {
    triangles: Vec<Triangle>,
    nodes: Vec<Node>,
    /// Numbers of triangles and nodes, free ones among them.
    len: (usize, usize),
}

fn live(t: &Triangulation) -> Vec<u32> {
    (0..t.tri.len() as u32).filter(|k| t.alive(*k)).collect()
}

fn state(t: &Triangulation) -> State {
    let used = (0..t.p.len()).filter(|n| t.at[*n] != NO_TRIANGLE);
    State {
        triangles: live(t).into_iter().map(|k| k as usize).map(|k| (k, t.tri[k], t.across[k], t.locked[k])).collect(),
        nodes: used.map(|n| (n, t.at[n], t.p[n], t.xy[n], t.size[n])).collect(),
        len: (t.tri.len(), t.p.len()),
    }
}

/// What no change may alter: border nodes, locked sides as they run, the area in the chart, and how triangles count against nodes.
struct Cover {
    border: Vec<(DVec3, DVec2)>,
    locked: BTreeSet<(u32, u32)>,
    area: f64,
    surplus: i64,
}

impl Cover {
    fn of(t: &Triangulation) -> Self {
        let all = live(t);
        let sides = all.iter().flat_map(|n| (0..3).map(move |k| (*n as usize, k))).filter(|(n, k)| t.locked[*n] >> k & 1 == 1);
        let inner = (t.fixed as usize..t.p.len()).filter(|n| t.at[*n] != NO_TRIANGLE).count();
        Self {
            border: (0..t.fixed as usize).map(|n| (t.p[n], t.xy[n])).collect(),
            locked: sides.map(|(n, k)| (t.tri[n][(k + 1) % 3], t.tri[n][(k + 2) % 3])).collect(),
            area: all.iter().map(|n| t.chart_area(*n)).sum(),
            surplus: all.len() as i64 - 2 * inner as i64,
        }
    }

    fn hold(&self, t: &Triangulation) {
        t.check().unwrap();
        let now = Self::of(t);
        assert!(now.border == self.border && now.locked == self.locked, "the border changed");
        assert!((now.area - self.area).abs() <= 1e-9 * self.area, "{} is covered, and was {}", now.area, self.area);
        assert_eq!(now.surplus, self.surplus, "triangles against inner nodes");
    }
}

/// A star-shaped plate with holes and a line inside, grown as faces are but not improved.
fn plate(surface: &dyn ParametricSurface, random: &mut Random) -> Triangulation {
    let mut outline = Outline::default();
    let radii: Vec<f64> = (0..7 + random.below(6)).map(|_| 3.0 + 1.5 * random.share()).collect();
    add_loop(&mut outline, surface, &star(DVec2::ZERO, &radii, 0.0), 0.7);
    for k in 0..random.below(4) {
        let center = star(DVec2::ZERO, &[1.5; 4], 0.4)[k];
        let radii: Vec<f64> = (0..3 + random.below(5)).map(|_| 0.2 + 0.4 * random.share()).collect();
        add_loop(&mut outline, surface, &star(center, &radii, random.share()), 0.5);
    }
    let first = outline.xy.len() as u32;
    for k in 0..3 {
        let xy = DVec2::new(0.3 * f64::from(k) - 0.3, 0.05 * f64::from(k));
        outline.xy.push(xy);
        outline.p.push(surface.point(xy));
    }
    outline.lines.extend([[first, first + 1], [first + 1, first + 2]]);
    let field = UniformSize(0.7);
    let task = Task {
        interpolated: None,
        chart_surface: surface,
        field: &field,
        outline: &outline,
        lattice: NodePlacement::Triangles,
        settings: CARE,
        most: 10_000,
        limit_check: None,
        sliding: None,
    };
    initial_triangulation(&task, &Job::new()).unwrap().unwrap()
}

/// Some triangles that hang together, across sides that may go.
fn some(t: &Triangulation, random: &mut Random, most: usize) -> Vec<u32> {
    let all = live(t);
    let mut some = vec![all[random.below(all.len())]];
    for _ in 0..random.below(3 * most) {
        let (from, k) = (some[random.below(some.len())] as usize, random.below(3));
        let next = t.across[from][k];
        if some.len() < most && next != NO_TRIANGLE && t.locked[from] >> k & 1 == 0 && !some.contains(&next) {
            some.push(next);
        }
    }
    some
}

/// A change that leaves all triangles upright, if the first try is one.
fn change(t: &mut Triangulation, surface: &dyn ParametricSurface, random: &mut Random) -> Option<Change> {
    let kind = random.below(5);
    if kind == 0 {
        let all = live(t);
        let (n, k) = (all[random.below(all.len())], random.below(3));
        let other = t.across[n as usize][k];
        if t.locked[n as usize] >> k & 1 == 1 {
            return None;
        }
        let c = t.tri[n as usize];
        let tip = t.tri[other as usize].into_iter().find(|m| !c.contains(m))?;
        let [a, b, d, tip] = [c[k], c[(k + 1) % 3], c[(k + 2) % 3], tip].map(|m| t.xy[m as usize]);
        return (is_left(a, b, tip) && is_left(a, tip, d)).then_some(Change::Flip(n, k));
    }
    let (mut patch, mut ring) = (Patch::default(), Ring::default());
    let within = if kind == 1 && t.p.len() > t.fixed as usize {
        // A node taken out: all triangles at it.
        let node = t.fixed + random.below(t.p.len() - t.fixed as usize) as u32;
        t.ring(node, &mut ring);
        ring.tri
    } else {
        some(t, random, 9)
    };
    if within.is_empty() {
        return None;
    }
    t.patch(&within, &mut patch)?;
    let rim: Vec<DVec2> = patch.rim.iter().map(|n| t.xy[*n as usize]).collect();
    let n = rim.len();
    let upright = |triangles: &[[usize; 3]]| triangles.iter().all(|[a, b, c]| is_left(rim[*a], rim[*b], rim[*c]));
    match kind {
        1 | 2 => {
            let k = random.below(n);
            let fan: Vec<[usize; 3]> = (1..n - 1).map(|i| [k, (k + i) % n, (k + i + 1) % n]).collect();
            upright(&fan).then_some(Change::Fan(within, k))
        }
        3 => {
            let flat: Vec<DVec3> = rim.iter().map(|q| q.extend(0.0)).collect();
            let triangles = polygon(&flat).ok()?;
            (triangles.len() == n - 2 && upright(&triangles)).then_some(Change::Fill(within, triangles))
        }
        _ => {
            let shares: Vec<f64> = (0..n).map(|_| 0.1 + random.share()).collect();
            let xy = rim.iter().zip(&shares).map(|(q, share)| *q * *share).sum::<DVec2>() / shares.iter().sum::<f64>();
            let sees = (0..n).all(|k| is_left(xy, rim[k], rim[(k + 1) % n]));
            let node = patch.inner.first().copied().filter(|_| random.below(2) == 0);
            sees.then(|| Change::Star(within, node, Star { xy, p: surface.point(xy), worst: 1.0 }))
        }
    }
}

#[test]
fn random_changes_leave_a_sound_triangulation_and_are_taken_back() {
    let (mut made, mut back, mut again) = ([0; 4], 0, 0);
    for case in 0..cases(8) {
        let mut random = Random(case as u64);
        let surface = Waves(if case % 2 == 0 { 0.0 } else { 0.6 });
        let mut t = plate(&surface, &mut random);
        let cover = Cover::of(&t);
        cover.hold(&t);
        let mut done: Vec<(Change, Before, State)> = Vec::new();
        for _ in 0..CHANGES {
            match random.below(20) {
                // Some of the last changes taken back, the first of them made again now and then: it is the same one.
                0 | 1 if !done.is_empty() => {
                    let mut after = state(&t);
                    for _ in 0..=random.below(done.len()) {
                        let Some((change, before, was)) = done.pop() else { break };
                        t.put_back(&before);
                        assert_eq!(state(&t), was, "case {case}: {change:?} taken back");
                        cover.hold(&t);
                        back += 1;
                        if random.below(4) == 0 {
                            change.make(&mut t);
                            assert_eq!(state(&t), after, "case {case}: {change:?} made again");
                            cover.hold(&t);
                            t.put_back(&before);
                            again += 1;
                        }
                        after = was;
                    }
                }
                2 if random.below(10) == 0 => {
                    t.compact();
                    cover.hold(&t);
                    assert_eq!(live(&t).len(), t.tri.len(), "no free place is left");
                    done.clear();
                }
                _ => {
                    let Some(change) = change(&mut t, &surface, &mut random) else { continue };
                    let (before, was) = (t.before(&change.within(&t)), state(&t));
                    change.make(&mut t);
                    cover.hold(&t);
                    made[match change {
                        Change::Flip(..) => 0,
                        Change::Star(..) => 1,
                        Change::Fan(..) => 2,
                        Change::Fill(..) => 3,
                    }] += 1;
                    done.push((change, before, was));
                    if done.len() > DEEP {
                        done.remove(0);
                    }
                }
            }
        }
    }
    assert!(made.iter().all(|n| *n > 200) && back > 300 && again > 60, "{made:?} made, {back} taken back, {again} made again");
}
