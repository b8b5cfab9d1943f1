//! Which length of edges was asked at each node of a mesh, and which setting decided that.

/// Words for nodes of which it is not known.
const UNKNOWN: &str = "not known";

/// Asked lengths and deciders by corner node. They ride along for those who look at a mesh and never decide whether two meshes are equal.
#[derive(Clone, Debug)]
pub struct NodeSizes {
    /// Deciders in words; the first stands for nodes without one.
    pub words: Vec<String>,
    /// Decider of each node, by its place in the words.
    pub of: Vec<u32>,
    /// Asked length of the edges at each node, model units; not a number where none was asked.
    pub lengths: Vec<f32>,
}

impl Default for NodeSizes {
    fn default() -> Self {
        Self { words: vec![UNKNOWN.to_owned()], of: Vec::new(), lengths: Vec::new() }
    }
}

impl PartialEq for NodeSizes {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl NodeSizes {
    /// Of so many nodes, of which nothing is known yet.
    pub fn unknown(nodes: usize) -> Self {
        Self { of: vec![0; nodes], lengths: vec![f32::NAN; nodes], ..Self::default() }
    }

    /// Whether it is of so many nodes, or of none, each with a word that is there.
    pub fn is_sound(&self, nodes: usize) -> bool {
        let words = self.words.len();
        self.of.len() == self.lengths.len()
            && (self.of.is_empty() || self.of.len() == nodes)
            && self.of.iter().all(|k| (*k as usize) < words)
    }

    /// The place of a decider among the words.
    pub fn word(&mut self, text: &str) -> u32 {
        let place = self.words.iter().position(|word| word == text).unwrap_or_else(|| {
            self.words.push(text.to_owned());
            self.words.len() - 1
        });
        place as u32
    }

    /// Sets what is known of a node, unless a shorter length was asked there before.
    pub fn lower(&mut self, node: usize, word: u32, length: f32) {
        let known = self.lengths[node];
        if known.is_nan() || length < known {
            (self.of[node], self.lengths[node]) = (word, length);
        }
    }

    /// Adds those of the nodes of another mesh, `more`, after those of the `nodes` here; nodes without an entry are not known.
    pub fn append(&mut self, nodes: usize, other: &Self, more: usize) {
        let place_of: Vec<u32> = other.words.iter().map(|word| self.word(word)).collect();
        self.of.resize(nodes, 0);
        self.lengths.resize(nodes, f32::NAN);
        self.of.extend(other.of.iter().map(|k| place_of[*k as usize]));
        self.lengths.extend(&other.lengths);
        self.of.resize(nodes + more, 0);
        self.lengths.resize(nodes + more, f32::NAN);
    }

    /// Multiplies all lengths.
    pub fn scale(&mut self, by: f64) {
        self.lengths.iter_mut().for_each(|length| *length *= by as f32);
    }
}
