//! Better quads in plane nets, the worst ones first: the quads about a bad one are taken out and the cavity is filled with the best ones.

use glam::DVec2;

use crate::base::fault::Result;
use crate::base::job::Job;
use crate::base::tolerance::FLAT_CORNER;
use crate::base::work;
use crate::mesh::chart::halves::NONE;
use crate::mesh::quad::cavity::{Content, EditableNet};
use crate::mesh::quad::disk::DiskOfQuads;
use crate::mesh::quad::net::Net;
use crate::mesh::quad::plane::{least_sine, quality};
use crate::mesh::quad::polygon::{Filling, fillings};
use crate::mesh::quad::regular::RegularInput;
use crate::mesh::quad::settings::REMESH;

/// Fills cavities about quads below the wanted quality anew where that is better; gives the nodes round the new quads.
pub(super) fn remesh(net: &mut Net, input: &RegularInput, job: &Job) -> Result<Vec<u32>> {
    let mut bad: Vec<(f64, u32)> = Vec::new();
    for f in 0..net.face.len() {
        let quality = if net.face[f][3] == NONE { 1.0 } else { quality(net, f) };
        if quality < REMESH.min_quality {
            bad.push((quality, f as u32));
        }
    }
    if bad.is_empty() {
        return Ok(Vec::new());
    }
    bad.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let mut remesh = Remesh { of: EditableNet::new(net), input };
    let mut touched = Vec::new();
    for (_, f) in bad {
        job.go_on()?;
        if remesh.of.alive[f as usize] {
            let cavities = remesh.cavities(f);
            touched.extend(remesh.fill_best(cavities));
        }
    }
    Ok(remesh.finished(&touched))
}

struct Remesh<'a> {
    of: EditableNet<'a>,
    input: &'a RegularInput<'a>,
}

/// New quads of a cavity.
struct NewQuads {
    faces: Vec<[u32; 4]>,
    xy: Vec<DVec2>,
    score: f64,
}

impl Remesh<'_> {
    /// Takes out what is gone; gives the numbers of those nodes that are left.
    fn finished(self, nodes: &[u32]) -> Vec<u32> {
        let number = if nodes.is_empty() { Vec::new() } else { self.of.compact() };
        nodes.iter().filter_map(|n| number.get(*n as usize).copied()).filter(|n| *n != NONE).collect()
    }

    /// Fills the cavity that gains most; the nodes round the new quads.
    fn fill_best(&mut self, cavities: Vec<Vec<u32>>) -> Vec<u32> {
        let mut best: Option<(DiskOfQuads, NewQuads, f64)> = None;
        for faces in cavities {
            let Some(disk) = DiskOfQuads::new(&self.of, self.input, faces) else { continue };
            let before = score(disk.least, disk.irregular);
            let least = best.as_ref().map_or(REMESH.min_gain, |b| b.2);
            if let Some(new) = self.fill(&disk, before + least) {
                let gain = new.score - before;
                best = Some((disk, new, gain));
            }
        }
        let Some((disk, new, _)) = best else { return Vec::new() };
        let content = Content { faces: &disk.faces, inner: &disk.inner, ring: &disk.ring, new: &new.faces, xy: &new.xy[disk.ring.len()..] };
        let first = self.of.net.p.len() as u32;
        self.of.replace(&content, &self.input.plane, self.input.field);
        let mut touched = disk.ring;
        touched.extend(first..self.of.net.p.len() as u32);
        touched
    }

    /// Sets of faces about one, the smaller ones first.
    fn cavities(&self, f: u32) -> Vec<Vec<u32>> {
        let net = &*self.of.net;
        let c = net.face[f as usize];
        let beside = |k: usize| {
            let (a, b) = (c[k], c[(k + 1) % 4]);
            self.of.of[a as usize].iter().copied().find(|g| *g != f && self.of.of[b as usize].contains(g))
        };
        let sides: Vec<u32> = (0..4).filter_map(beside).collect();
        let mut all: Vec<Vec<u32>> = sides.iter().map(|g| vec![f, *g]).collect();
        all.push([&[f], &sides[..]].concat());
        let stars = c.map(|n| &self.of.of[n as usize][..]);
        all.extend(stars.iter().map(|star| [&[f], *star].concat()));
        for k in 0..4 {
            all.push([stars[k], stars[(k + 1) % 4]].concat());
        }
        for k in 0..2 {
            all.push([stars[k], stars[k + 2]].concat());
        }
        all.push(stars.concat());
        distinct(all)
    }

    /// The best quads of a cavity with more than a score.
    fn fill(&self, disk: &DiskOfQuads, least: f64) -> Option<NewQuads> {
        let net = &*self.of.net;
        let place = |n: &u32| net.xy[*n as usize];
        let ring: Vec<DVec2> = disk.ring.iter().map(place).collect();
        let n = ring.len();
        let middle = ring.iter().copied().sum::<DVec2>() / n as f64;
        let old: Vec<DVec2> = disk.inner.iter().map(place).collect();
        let mut trials: Vec<Vec<DVec2>> = vec![Vec::new(), vec![middle]];
        trials.extend(old.iter().map(|xy| vec![*xy]));
        if n <= REMESH.max_corners_of_two {
            for (k, a) in old.iter().enumerate() {
                trials.extend(old[..k].iter().map(|b| vec![*a, *b]));
            }
            if let [one] = old[..] {
                let far = ring.iter().map(|p| 0.5 * (*p - middle)).max_by(|a, b| a.length().total_cmp(&b.length()))?;
                trials.push(vec![one + 0.5 * far, one - 0.5 * far]);
            }
        }
        let mut best: Option<NewQuads> = None;
        for inside in trials {
            let xy: Vec<DVec2> = ring.iter().copied().chain(inside).collect();
            work::spend(REMESH.corner_work * xy.len() as u64);
            let mut found: Vec<Filling> = Vec::new();
            fillings(&xy, n, REMESH.max_cost, &mut found);
            found.sort_by(|a, b| a.cost.total_cmp(&b.cost));
            found.dedup_by(|a, b| a.cost == b.cost);
            for filling in found.into_iter().take(REMESH.max_optimized) {
                let new = self.optimized(disk, filling, xy.clone());
                if new.score > best.as_ref().map_or(least, |b| b.score) {
                    best = Some(new);
                }
            }
        }
        best
    }

    /// Moves the nodes inside to where their quads are best, and rates the quads.
    fn optimized(&self, disk: &DiskOfQuads, filling: Filling, mut xy: Vec<DVec2>) -> NewQuads {
        let (n, faces) = (disk.ring.len(), filling.faces);
        let step = self.input.always;
        let distortion = |xy: &[DVec2], node: u32| -> f64 {
            let round = faces.iter().filter(|f| f.contains(&node));
            round.map(|f| least_sine(f.map(|n| xy[n as usize]))).map(|q| 1.0 / q.max(FLAT_CORNER)).map(|x| x * x * x * x).sum()
        };
        if xy.len() > n {
            for reach in REMESH.steps {
                for _ in 0..REMESH.sweeps {
                    for node in n..xy.len() {
                        let (mut place, mut now) = (xy[node], distortion(&xy, node as u32));
                        for way in [DVec2::X, DVec2::NEG_X, DVec2::Y, DVec2::NEG_Y] {
                            xy[node] = place + way * (reach * step);
                            let there = distortion(&xy, node as u32);
                            if there < now {
                                (place, now) = (xy[node], there);
                            }
                        }
                        xy[node] = place;
                    }
                }
            }
        }
        let least = faces.iter().map(|f| least_sine(f.map(|n| xy[n as usize]))).fold(f64::INFINITY, f64::min);
        let is_given = |a: u32, b: u32| a < n as u32 && b == (a + 1) % n as u32;
        let fits = faces.iter().all(|f| {
            (0..4).all(|k| {
                let (a, b) = (f[k], f[(k + 1) % 4]);
                let side = xy[a as usize].distance(xy[b as usize]);
                is_given(a, b) || side >= disk.sides.0 && side <= disk.sides.1
            })
        });
        let valence = |k: usize| faces.iter().filter(|f| f.contains(&(k as u32))).count();
        let irregular = (0..xy.len()).filter(|k| match disk.ring.get(*k) {
            Some(node) => *node >= self.of.net.fixed && disk.outside[*k] + valence(*k) != 4,
            None => valence(*k) != 4,
        });
        let score = if fits { score(least, irregular.count()) } else { f64::NEG_INFINITY };
        NewQuads { faces, xy, score }
    }
}

/// What quads with a least quality and so many irregular nodes are worth.
fn score(least: f64, irregular: usize) -> f64 {
    least.min(REMESH.enough) - REMESH.irregular_cost * irregular as f64
}

/// Sets of more than one face without those that are there twice.
fn distinct(mut all: Vec<Vec<u32>>) -> Vec<Vec<u32>> {
    for faces in &mut all {
        faces.sort_unstable();
        faces.dedup();
    }
    let mut found: Vec<Vec<u32>> = Vec::new();
    for faces in all {
        if faces.len() > 1 && !found.contains(&faces) {
            found.push(faces);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::chart::parametric_surface::{Spot, UniformSize};
    use glam::DVec3;

    /// A strip between two borders of unit steps, whose nodes face each other while its quads run from each to the next but one.
    #[test]
    fn leaning_quads_of_a_strip_are_put_upright() {
        let n = 8;
        let mut net = Net::default();
        for k in 0..=n {
            net.xy.push(DVec2::new(f64::from(k), 0.0));
        }
        for k in 0..=n {
            net.xy.push(DVec2::new(f64::from(k), 1.0));
        }
        let (low, high) = (|k: u32| k, |k: u32| 9 + k);
        for k in 0..3 {
            net.face.push([low(k), low(k + 1), high(k + 1), high(k)]);
        }
        // A quad and the way back to upright ones.
        net.face.push([low(3), low(4), low(5), high(3)]);
        net.face.push([low(5), high(5), high(4), high(3)]);
        for k in 5..8 {
            net.face.push([low(k), low(k + 1), high(k + 1), high(k)]);
        }
        net.p = net.xy.iter().map(|xy| xy.extend(0.0)).collect();
        net.normal = vec![DVec3::Z; net.p.len()];
        net.size = vec![1.0; net.p.len()];
        net.fixed = net.p.len() as u32;
        let plane = Spot { p: DVec3::ZERO, dx: DVec3::X, dy: DVec3::Y };
        let lines = RegularInput { plane, field: &UniformSize(1.0), always: 1.5, has_lines: true };
        let before = net.face.clone();
        // Where lines may run through, sides between nodes of the border stay.
        assert!(remesh(&mut net, &lines, &Job::default()).unwrap().is_empty() && net.face == before);
        let input = RegularInput { has_lines: false, ..lines };
        assert!(!remesh(&mut net, &input, &Job::default()).unwrap().is_empty());
        let worst = (0..net.face.len()).map(|f| quality(&net, f)).fold(f64::INFINITY, f64::min);
        assert!(worst > 0.999 && net.face.len() == 8 && net.p.len() == 18, "{worst}");
    }
}
