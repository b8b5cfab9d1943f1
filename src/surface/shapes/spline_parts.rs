//! Splines that are less than C2 at some nodes: parts that run by themselves, or leave a node with the slope of the part beside them.

use crate::surface::shapes::cardinal::{End, ended, slopes};

/// How the parts of a spline on both sides of an inner node go together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Joins {
    /// Each has the slope that it has by itself.
    Corner,
    /// The slope is that of the part before the node.
    Before,
    /// The slope is that of the part after the node.
    After,
}

crate::content_of_word!(Joins);

/// [`slopes`] of splines that are less than C2 at some inner nodes, `joints`, by ascending places: one row a node and part, so these nodes
/// have two, that of the part before them first. The first node is among them where a closed direction is less than C2 at its seam.
///
/// Two parts that both take their slope from each other both have their own.
pub fn slopes_between(nodes: &[f64], joints: &[(usize, Joins)], periodic: bool) -> Vec<Vec<f64>> {
    let (Some(&(first, _)), n) = (joints.first(), nodes.len() - 1) else { return slopes(nodes, periodic) };
    let turn = nodes[n] - nodes[0];
    // Places and joints of all parts; a closed direction has one that runs over the seam, from the last joint to the first.
    let mut parts: Vec<Part> = joints.windows(2).map(|w| Part::new((w[0].0..=w[1].0).collect(), [Some(w[0].1), Some(w[1].1)])).collect();
    let (last, how) = joints[joints.len() - 1];
    let at_seam = first == 0;
    match periodic {
        _ if at_seam => parts.push(Part::new((last..=n).collect(), [Some(how), Some(joints[0].1)])),
        true => parts.push(Part::new((last..n).chain(0..=first).collect(), [Some(how), Some(joints[0].1)])),
        false => {
            parts.insert(0, Part::new((0..=first).collect(), [None, Some(joints[0].1)]));
            parts.push(Part::new((last..=n).collect(), [Some(how), None]));
        }
    }
    let mut done: Vec<Option<Vec<Vec<f64>>>> = vec![None; parts.len()];
    for _ in 0..parts.len() {
        for k in 0..parts.len() {
            let beside = [(k + parts.len() - 1) % parts.len(), (k + 1) % parts.len()];
            let given = [0, 1].map(|side| done[beside[side]].as_ref().map(|rows| &rows[if side == 0 { rows.len() - 1 } else { 0 }]));
            if done[k].is_none() && (0..2).all(|side| !parts[k].takes(side) || given[side].is_some()) {
                done[k] = Some(parts[k].rows(nodes, turn, given));
            }
        }
    }
    let mut rows = done.into_iter().zip(&parts).map(|(rows, part)| rows.unwrap_or_else(|| part.alone(nodes, turn)));
    if at_seam || !periodic {
        return rows.flatten().collect();
    }
    let inner: Vec<Vec<f64>> = rows.by_ref().take(parts.len() - 1).flatten().collect();
    let over: Vec<Vec<f64>> = rows.flatten().collect();
    over[n - last..].iter().cloned().chain(inner).chain(over[..=n - last].iter().cloned()).collect()
}

/// A spline between two joints.
struct Part {
    places: Vec<usize>,
    /// How it goes together with the part before and after it; none at an open end.
    joins: [Option<Joins>; 2],
}

impl Part {
    fn new(places: Vec<usize>, joins: [Option<Joins>; 2]) -> Self {
        Self { places, joins }
    }

    /// Whether its slope at its start (0) or end (1) is that of its neighbour.
    fn takes(&self, side: usize) -> bool {
        self.joins[side] == Some([Joins::Before, Joins::After][side])
    }

    /// Its slopes as sums of values at all nodes.
    fn alone(&self, nodes: &[f64], turn: f64) -> Vec<Vec<f64>> {
        Self { places: self.places.clone(), joins: [None, None] }.rows(nodes, turn, [None, None])
    }

    /// Its slopes as sums of values at all nodes, with the neighbours' slopes at its ends where it takes them.
    fn rows(&self, nodes: &[f64], turn: f64, given: [Option<&Vec<f64>>; 2]) -> Vec<Vec<f64>> {
        let start = nodes[self.places[0]];
        let x: Vec<f64> = self.places.iter().map(|k| if nodes[*k] < start { nodes[*k] + turn } else { nodes[*k] }).collect();
        let ends = [0, 1].map(|side| if self.takes(side) { End::Slope } else { End::Plain });
        let own = if ends == [End::Plain; 2] { slopes(&x, false) } else { ended(&x, (ends[0], ends[1])) };
        let wide = |row: &Vec<f64>| {
            let mut whole = vec![0.0; nodes.len()];
            self.places.iter().zip(row).for_each(|(k, by)| whole[*k] += by);
            for (given, by) in given.iter().zip(&row[x.len()..]) {
                given.iter().for_each(|given| whole.iter_mut().zip(*given).for_each(|(sum, own)| *sum += by * own));
            }
            whole
        };
        own.iter().map(wide).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_of_a_spline_are_splines_by_themselves() {
        let nodes = [0.0, 0.15, 0.4, 0.55, 0.6, 0.83, 1.0];
        // A parabola, a corner at 0.4, a line until 0.6, and a parabola that leaves it smoothly.
        let value = |x: f64| match x {
            x if x <= 0.4 => (x - 0.4) * (x + 2.0),
            x if x <= 0.6 => 3.0 * (x - 0.4),
            x => 0.6 + 3.0 * (x - 0.6) - 5.0 * (x - 0.6) * (x - 0.6),
        };
        let values: Vec<f64> = nodes.iter().map(|x| value(*x)).collect();
        let found = |rows: &[Vec<f64>]| -> Vec<f64> { rows.iter().map(|row| row.iter().zip(&values).map(|(d, y)| d * y).sum()).collect() };
        let rows = slopes_between(&nodes, &[(2, Joins::Corner), (4, Joins::Before)], false);
        let wanted = [1.6, 1.9, 2.4, 3.0, 3.0, 3.0, 3.0, 3.0 - 10.0 * 0.23, 3.0 - 10.0 * 0.4];
        assert!(found(&rows).iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-12), "{:?}", found(&rows));
        // Around a seam the part from the last joint to the first is one.
        let ring = [0.0, 0.1, 0.3, 0.5, 0.8, 1.0];
        let over = slopes_between(&ring, &[(2, Joins::Corner), (4, Joins::Corner)], true);
        let straight = slopes(&[-0.2, 0.0, 0.1, 0.3], false);
        assert_eq!(over.len(), 8);
        for (row, places) in [(0, 1), (1, 2), (2, 3), (6, 0), (7, 1)] {
            let wide = [4, 0, 1, 2].into_iter().zip(&straight[places]);
            wide.for_each(|(k, by)| assert!((over[row][k] - by).abs() < 1e-12, "{row} {k}"));
        }
    }
}
