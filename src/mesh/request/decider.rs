//! What decides sizes inside a face, and what is counted of its cells.

use glam::DVec3;

/// What decides sizes inside a free face.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Why {
    /// The size of the mesh or of a rule on the face.
    Size,
    /// A `near` or `in` clause, by its place in the plan.
    Refined(usize),
    /// Chord error or angle.
    Bends,
    /// Short edges of the border, from which lengths grow.
    Border,
    /// A border that faces this one, or that its steps would cross.
    Gap,
    /// The floor of all sizes.
    Floor,
}

/// A decider with what it decided.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decider {
    /// Which.
    pub why: Why,
    /// Inner nodes whose distance it decided.
    pub nodes: usize,
    /// One of them.
    pub at: DVec3,
}

/// What decided the sizes of a face: each decider with what it decided, and the decider of each node.
#[derive(Clone, Debug, Default)]
pub struct Decided {
    /// Deciders, in order of [`Why`].
    pub deciders: Vec<Decider>,
    /// Decider of each node, by its place among the deciders.
    pub of: Vec<u32>,
    /// Asked length of the edges at each node, model units; not a number where no length was asked.
    pub lengths: Vec<f32>,
}

impl PartialEq for Decided {
    fn eq(&self, other: &Self) -> bool {
        let bits = |own: &Self| own.lengths.iter().map(|length| length.to_bits()).collect::<Vec<_>>();
        self.deciders == other.deciders && self.of == other.of && bits(self) == bits(other)
    }
}

impl Decided {
    /// Adds the next node: what decided, the asked length of its edges, its point, and whether it lies inside the face.
    pub fn push(&mut self, why: Why, length: f64, p: DVec3, inside: bool) {
        let inner = usize::from(inside);
        let place = self.deciders.iter().position(|d| d.why == why).unwrap_or_else(|| {
            self.deciders.push(Decider { why, nodes: 0, at: p });
            self.deciders.len() - 1
        });
        let decider = &mut self.deciders[place];
        if decider.nodes == 0 {
            decider.at = p;
        }
        decider.nodes += inner;
        self.of.push(place as u32);
        self.lengths.push(length as f32);
    }

    /// Other nodes, all by one decider without asked lengths; those before have decided something that is no longer to be seen.
    pub fn other_nodes(&self, points: &[DVec3], fixed: usize, why: Why) -> Self {
        let deciders = self.deciders.iter().map(|d| Decider { nodes: 0, ..*d }).collect();
        let mut other = Self { deciders, ..Self::default() };
        points.iter().enumerate().for_each(|(n, p)| other.push(why, f64::NAN, *p, n >= fixed));
        other.sorted()
    }

    /// Puts the deciders in order.
    pub fn sorted(mut self) -> Self {
        let mut order: Vec<usize> = (0..self.deciders.len()).collect();
        order.sort_by_key(|k| self.deciders[*k].why);
        let mut place = vec![0; order.len()];
        order.iter().zip(0..).for_each(|(k, now)| place[*k] = now);
        self.of.iter_mut().for_each(|k| *k = place[*k as usize]);
        self.deciders.sort_by_key(|d| d.why);
        self
    }

    /// Whether it is of so many nodes, each with a decider that is there.
    pub fn is_sound(&self, nodes: usize) -> bool {
        let deciders = self.deciders.len();
        self.of.len() == nodes && self.lengths.len() == nodes && self.of.iter().all(|k| (*k as usize) < deciders)
    }

    /// The same without the first `border` nodes.
    pub fn without(mut self, border: usize) -> Self {
        self.of.drain(..border.min(self.of.len()));
        self.lengths.drain(..border.min(self.lengths.len()));
        self
    }
}

/// The cells of a face between lines of constant u and v.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Cells inside.
    pub whole: usize,
    /// Cells that a border crosses.
    pub crossed: usize,
    /// Corners of cells that a loop crosses, those on borders left out.
    pub corners: usize,
    /// Those at which the marks 0, 1 and 2 say what the winding does.
    pub agree: usize,
}
