//! How long sides inside a face may be: by its size, by what is refined, and by longer steps of the border.

use glam::DVec3;

use crate::base::par;
use crate::base::tolerance::WHOLE_NUMBER;
use crate::mesh::chart::outline::Outline;
use crate::mesh::request::sources::{Body, Source, Sources};
use crate::mesh::tri::triangulation::Triangulation;

/// Longest edge inside over the size (language reference, mesh settings).
pub(crate) const LONGEST: f64 = 1.05;

/// How long sides inside a face may be.
pub(crate) struct Longest<'a> {
    /// Between inner nodes where nothing is refined.
    pub(crate) inside: f64,
    /// At each border node: where the border itself has longer steps (a written count), sides there are as long.
    at_border: Vec<f64>,
    /// Places where they have to be shorter.
    rules: &'a Sources,
    /// Longer steps of the border, with their lengths below zero: what is allowed falls from them with the distance.
    steps: Sources,
}

impl<'a> Longest<'a> {
    pub(crate) fn new(size: f64, outline: &Outline, rules: &'a Sources) -> Self {
        let inside = LONGEST * size * (1.0 + WHOLE_NUMBER);
        let mut longest = Self { inside, at_border: Vec::new(), rules, steps: Sources::default() };
        longest.at_border = outline.p.iter().map(|p| longest.there(*p)).collect();
        // Where something is refined a border may step out of it: the shorter edge at a node counts.
        let (start, pick): (f64, fn(f64, f64) -> f64) = if rules.is_empty() { (0.0, f64::max) } else { (f64::INFINITY, f64::min) };
        let mut steps = vec![start; outline.p.len()];
        for edge in outline.edges() {
            let most = LONGEST * outline.length(edge);
            edge.iter().for_each(|n| steps[*n as usize] = pick(steps[*n as usize], most));
        }
        longest.at_border.iter_mut().zip(steps).filter(|(_, step)| step.is_finite()).for_each(|(most, step)| *most = most.max(step));
        longest
    }

    /// Sides inside may be longer near steps of the border that are longer than wanted there (a written count), less so by `slope`
    /// away from them: lengths cannot change at once from one row to the next.
    pub(crate) fn graded(mut self, outline: &Outline, slope: f64) -> Self {
        let step = |edge: [u32; 2]| {
            let [a, b] = edge.map(|n| outline.p[n as usize]);
            let most = LONGEST * outline.length(edge);
            let is_long = most > self.wanted(0.5 * (a + b));
            is_long.then_some(Source { body: Body::Segment(a, b), radius: 0.0, size: -most, steep: 1.0, tag: 0 })
        };
        self.steps = Sources::new(outline.edges().filter_map(step).collect(), slope);
        if !self.rules.is_empty() {
            let there: Vec<f64> = outline.p.iter().map(|p| self.there(*p)).collect();
            self.at_border.iter_mut().zip(there).for_each(|(most, there)| *most = most.max(there));
        }
        self
    }

    /// How long sides may be anywhere, model units; 0 where something is refined.
    pub(crate) fn always(&self) -> f64 {
        if self.rules.is_empty() { self.inside } else { 0.0 }
    }

    /// How long sides at a place may be by the wanted sizes.
    fn wanted(&self, p: DVec3) -> f64 {
        if self.rules.is_empty() {
            return self.inside;
        }
        let share = LONGEST * (1.0 + WHOLE_NUMBER);
        share * self.rules.plateau(p, self.inside / share)
    }

    fn there(&self, p: DVec3) -> f64 {
        -self.steps.at(p, -self.wanted(p))
    }

    /// How long sides at a node may be, given the points of all nodes.
    pub(crate) fn at(&self, p: &[DVec3], n: u32) -> f64 {
        self.at_border.get(n as usize).copied().unwrap_or_else(|| self.there(p[n as usize]))
    }

    /// Whether a side inside the face between two nodes may be as long as it is.
    pub(crate) fn allows(&self, triangulation: &Triangulation, a: u32, b: u32) -> bool {
        triangulation.p[a as usize].distance(triangulation.p[b as usize]) <= self.at(&triangulation.p, a).max(self.at(&triangulation.p, b))
    }

    /// Those of some triangles with a side inside the face that is too long; sides between two border nodes do not count.
    pub(crate) fn broken(&self, triangulation: &Triangulation, some: &[u32]) -> Vec<u32> {
        // For most of the triangles the length at each node is computed once.
        let all = if 2 * some.len() > triangulation.tri.len() { triangulation.p.len() } else { 0 };
        let known: Vec<f64> = par::map(all, |n| self.at(&triangulation.p, n as u32));
        let most = |n: usize| known.get(n).copied().unwrap_or_else(|| self.at(&triangulation.p, n as u32));
        let too_long = |t: &u32| {
            let c = triangulation.tri[*t as usize].map(|n| n as usize);
            (0..3).filter(|k| triangulation.locked[*t as usize] >> k & 1 == 0).any(|k| {
                let [a, b] = [c[(k + 1) % 3], c[(k + 2) % 3]];
                a.max(b) >= triangulation.fixed as usize && triangulation.p[a].distance(triangulation.p[b]) > most(a).max(most(b))
            })
        };
        some.iter().copied().filter(too_long).collect()
    }
}

impl Longest<'_> {
    /// The same, and those that break another limit; ascending.
    pub(crate) fn broken_or(&self, triangulation: &Triangulation, some: &[u32], breaks: impl Fn(u32) -> bool) -> Vec<u32> {
        let mut found = self.broken(triangulation, some);
        found.extend(some.iter().copied().filter(|t| breaks(*t)));
        found.sort_unstable();
        found.dedup();
        found
    }
}

/// The longest side of a triangle.
pub(crate) fn longest_side(triangulation: &Triangulation, t: u32) -> f64 {
    let [a, b, c] = triangulation.tri[t as usize].map(|n| triangulation.p[n as usize]);
    a.distance(b).max(b.distance(c)).max(c.distance(a))
}
