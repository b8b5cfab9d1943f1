//! Repairs that failed: tried again only where something changed.

/// Triangles that could not be repaired, and nodes that changed since.
#[derive(Clone, Debug, Default)]
pub struct FailedRepairs {
    /// Triangles given up so far.
    now: u32,
    /// When each node, or a triangle at it, changed last.
    changed: Vec<u32>,
    /// When each triangle was given up; 0 where it was not.
    given_up: Vec<u32>,
}

impl FailedRepairs {
    /// A node moved, or a triangle at it is another one.
    pub fn change(&mut self, node: u32) {
        let n = node as usize;
        if n >= self.changed.len() {
            self.changed.resize(n + 1, 0);
        }
        self.changed[n] = self.now;
    }

    /// No change repairs a triangle now.
    pub fn give_up(&mut self, t: u32) {
        let t = t as usize;
        if t >= self.given_up.len() {
            self.given_up.resize(t + 1, 0);
        }
        self.now += 1;
        self.given_up[t] = self.now;
    }

    /// Since when a triangle has been given up; 0 where it was not.
    pub fn since(&self, t: u32) -> u32 {
        self.given_up.get(t as usize).copied().unwrap_or(0)
    }

    /// Whether one of some nodes changed since then.
    pub fn is_new(&self, mut nodes: impl Iterator<Item = u32>, since: u32) -> bool {
        since == 0 || nodes.any(|n| self.changed.get(n as usize).is_some_and(|at| *at >= since))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_changed_is_tried_again() {
        let mut failed_repairs = FailedRepairs::default();
        failed_repairs.change(3);
        assert!(failed_repairs.is_new([1].into_iter(), failed_repairs.since(7)), "never failed_repairs");
        failed_repairs.give_up(7);
        let since = failed_repairs.since(7);
        assert!(!failed_repairs.is_new([1, 3].into_iter(), since));
        failed_repairs.change(1);
        assert!(failed_repairs.is_new([3, 1].into_iter(), since));
        assert!(!failed_repairs.is_new([3].into_iter(), since));
    }
}
