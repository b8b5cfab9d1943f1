//! Nodes that wait for something, each once.

/// A set of nodes that is filled one by one and emptied as a whole.
#[derive(Clone, Debug, Default)]
pub struct Pending {
    waits: Vec<bool>,
    list: Vec<u32>,
}

impl Pending {
    /// The first `n` nodes.
    pub fn all(n: usize) -> Self {
        Self { waits: vec![true; n], list: (0..n as u32).collect() }
    }

    /// One more.
    pub fn add(&mut self, node: u32) {
        let n = node as usize;
        if n >= self.waits.len() {
            self.waits.resize(n + 1, false);
        }
        if !std::mem::replace(&mut self.waits[n], true) {
            self.list.push(node);
        }
    }

    /// All of them, ascending; none waits any more.
    pub fn take(&mut self) -> Vec<u32> {
        let mut list = std::mem::take(&mut self.list);
        list.sort_unstable();
        list.iter().for_each(|n| self.waits[*n as usize] = false);
        list
    }

    /// None waits any more.
    pub fn clear(&mut self) {
        self.list.drain(..).for_each(|n| self.waits[n as usize] = false);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_is_taken_once() {
        let mut pending = Pending::all(2);
        [5, 1, 5, 3].into_iter().for_each(|n| pending.add(n));
        assert_eq!(pending.take(), [0, 1, 3, 5]);
        assert!(pending.take().is_empty());
        pending.add(3);
        pending.clear();
        pending.add(2);
        assert_eq!(pending.take(), [2]);
    }
}
