//! How a section gives way between its anchors: the displacement that bends least and is what it has to be at them.
//!
//! Over the parameter in which a section is as smooth as its pieces make it, the displacement is the cubic spline through the anchors with
//! the least ∫ δ″², natural at open ends and periodic on closed sections. Straight members stay straight unless an anchor divides them: over one δ is linear,
//! and it goes on smoothly where the section does. Two members that meet at an angle turn against each other like parts of a rod with a hinge.

use std::collections::BTreeMap;
use std::ops::Range;

use glam::{DVec3, DVec4};

use crate::base::solve;
use crate::geometry::Nurbs;
use crate::geometry::shapes::nurbs::{projected, weighted};
use crate::surface::swept::course::{Course, end_slopes, straight_shares};
use crate::surface::swept::deform::Pieces;

/// A sum of unknowns and of displacements of anchors, by their numbers; anchors come after the unknowns.
type Form = BTreeMap<usize, f64>;

fn sum<'a>(parts: impl IntoIterator<Item = (f64, &'a Form)>) -> Form {
    let mut all = Form::new();
    for (by, form) in parts {
        form.iter().for_each(|(k, c)| *all.entry(*k).or_default() += by * c);
    }
    all
}

/// A member with what δ is at its ends.
struct Member {
    pieces: Range<usize>,
    straight: bool,
    span: f64,
    values: [Form; 2],
    slopes: [Form; 2],
}

/// Displacements of a section as sums of those of its anchors.
#[derive(Clone, Debug)]
pub(super) struct Displacement {
    /// Of each piece the shares of the anchors in value and derivative at its start, then at its end, by its own parameter.
    pieces: Vec<[Vec<f64>; 4]>,
    /// Whether each piece stays straight.
    stiff: Vec<bool>,
    anchors: usize,
}

impl Displacement {
    /// Of a section with anchors where pieces begin or end, by the numbers of these joints. On a closed one the first anchor is at joint 0.
    pub fn new(section: &Pieces, course: &Course, anchors: &[usize], closed: bool) -> Self {
        let n = section.len();
        let constant = || {
            let one = vec![1.0 / anchors.len() as f64; anchors.len()];
            let none = vec![0.0; anchors.len()];
            Self { pieces: vec![[one.clone(), none.clone(), one, none]; n], stiff: vec![false; n], anchors: anchors.len() }
        };
        if anchors.len() < 2 {
            return constant();
        }
        let stiff = course.stiff(anchors);
        let runs = course.members(anchors, &stiff);
        // Unknowns: values where members meet at no anchor, and slopes of bent members.
        let most = 3 * runs.len() + 1;
        let mut taken = 0;
        let mut unknown = || {
            taken += 1;
            Form::from([(taken - 1, 1.0)])
        };
        let mut values: Vec<Form> = Vec::with_capacity(runs.len() + 1);
        for joint in runs.iter().map(|run| run.start).chain([n]) {
            let own = anchors.iter().position(|a| *a == joint).map(|k| Form::from([(most + k, 1.0)]));
            let back = (joint == n && closed).then(|| values[0].clone());
            values.push(own.or(back).unwrap_or_else(&mut unknown));
        }
        let mut members: Vec<Member> = Vec::with_capacity(runs.len());
        for (m, run) in runs.into_iter().enumerate() {
            let span: f64 = course.spans[run.clone()].iter().sum();
            let (straight, ends) = (stiff[run.start], [values[m].clone(), values[m + 1].clone()]);
            let slopes = if straight {
                let rise = sum([(1.0, &ends[1]), (-1.0, &ends[0])]);
                let rates = line_rates(section, course, &run);
                rates.map(|rate| sum([(rate, &rise)]))
            } else {
                [unknown(), unknown()]
            };
            members.push(Member { pieces: run, straight, span, values: ends, slopes });
        }
        let squares = joined(&mut members, course, closed);
        let Some(solved) = least(&squares, most, anchors.len()) else { return constant() };
        let known = |form: &Form| -> Vec<f64> {
            (0..anchors.len())
                .map(|a| {
                    form.iter().map(|(k, c)| if *k < most { c * solved[a][*k] } else { c * f64::from(u8::from(*k == most + a)) }).sum()
                })
                .collect()
        };
        let pieces = members.iter().flat_map(|member| member.shares(section, course, &known)).collect();
        Self { pieces, stiff, anchors: anchors.len() }
    }

    /// Displaces piece `k` by displacements of the anchors.
    pub fn apply(&self, k: usize, piece: &mut [DVec4], given: &[DVec3], at_rest: &[DVec4]) {
        debug_assert_eq!(given.len(), self.anchors);
        let of = |shares: &Vec<f64>| shares.iter().zip(given).map(|(share, by)| *by * *share).sum::<DVec3>();
        let [start, out, end, inward] = &self.pieces[k];
        let (start, end) = (of(start), of(end));
        let degree = piece.len() - 1;
        let rest: Vec<DVec3> = at_rest.iter().map(|q| projected(*q)).collect();
        let by: Vec<DVec3> = match straight_shares(&rest).filter(|_| self.stiff[k]) {
            Some(shares) => shares.iter().map(|share| start.lerp(end, *share)).collect(),
            None => {
                let (first, last) = (at_rest[0].w / at_rest[1].w, at_rest[degree].w / at_rest[degree - 1].w);
                let cubic = [start, start + of(out) * (first / 3.0), end - of(inward) * (last / 3.0), end];
                let poles = cubic.iter().map(|p| p.extend(1.0)).collect();
                Nurbs::bezier(0.0, 1.0, poles).elevated(degree - 3).poles.iter().map(|q| projected(*q)).collect()
            }
        };
        piece.iter_mut().zip(by).for_each(|(q, by)| *q = weighted(projected(*q) + by, q.w));
    }
}

/// How fast a straight member is run over at its ends, as shares of the whole of it by the parameter.
fn line_rates(section: &Pieces, course: &Course, run: &Range<usize>) -> [f64; 2] {
    let (first, last) = (&section[run.start], &section[run.end - 1]);
    let way = projected(last[last.len() - 1]) - projected(first[0]);
    let rate = |slope: DVec3, span: f64| if way == DVec3::ZERO { 0.0 } else { slope.dot(way) / (way.length_squared() * span) };
    [rate(end_slopes(first).0, course.spans[run.start]), rate(end_slopes(last).1, course.spans[run.end - 1])]
}

/// Joins members to each other: slopes that go on become one. Returns what is to be least, as the sum of the squares of forms.
fn joined(members: &mut [Member], course: &Course, closed: bool) -> Vec<Form> {
    let count = members.len();
    let mut squares = Vec::new();
    for m in 0..count {
        let next = (m + 1) % count;
        if next == 0 && !closed {
            break;
        }
        let joint = members[next].pieces.start;
        let ratio = if next == 0 { course.return_ratio } else { 1.0 };
        let (before, after) = (members[m].slopes[1].clone(), members[next].slopes[0].clone());
        let smooth = course.smooth[joint];
        match (members[m].straight, members[next].straight) {
            (_, false) if smooth => members[next].slopes[0] = sum([(ratio, &before)]),
            (false, true) if smooth => members[m].slopes[1] = sum([(1.0 / ratio, &after)]),
            _ => {
                let stiff = (0.5 * (members[m].span + members[next].span)).sqrt().recip();
                squares.push(sum([(stiff, &after), (-stiff, &before)]));
            }
        }
    }
    // ∫ δ″² = h/3 (a² + ab + b²) for δ″ from a to b.
    for member in members.iter().filter(|member| !member.straight) {
        let h = member.span;
        let rise = sum([(1.0, &member.values[1]), (-1.0, &member.values[0])]);
        let [m0, m1] = &member.slopes;
        let bend = |by: f64, near: &Form, far: &Form| sum([(by * 6.0 / (h * h), &rise), (-by * 4.0 / h, near), (-by * 2.0 / h, far)]);
        let (a, b) = (bend(1.0, m0, m1), bend(-1.0, m1, m0));
        // The second derivative at the end is −6 rise / h² + 2 m₀ / h + 4 m₁ / h.
        squares.push(sum([((h / 3.0).sqrt(), &a), (0.5 * (h / 3.0).sqrt(), &b)]));
        squares.push(sum([((h / 4.0).sqrt(), &b)]));
    }
    squares
}

/// Values of the unknowns, of the first `most` numbers, that make the sum of squares least, for a displacement of 1 of each anchor.
fn least(squares: &[Form], most: usize, anchors: usize) -> Option<Vec<Vec<f64>>> {
    let used: BTreeMap<usize, usize> = {
        let mut all: Vec<usize> = squares.iter().flat_map(|form| form.keys().copied()).filter(|k| *k < most).collect();
        all.sort_unstable();
        all.dedup();
        all.into_iter().enumerate().map(|(place, k)| (k, place)).collect()
    };
    let n = used.len();
    let (mut matrix, mut right) = (vec![0.0; n * n], vec![vec![0.0; n]; anchors]);
    for form in squares {
        for (row, by) in form.iter().filter_map(|(k, c)| Some((*used.get(k)?, c))) {
            for (k, c) in form {
                match used.get(k) {
                    Some(column) => matrix[row * n + column] += by * c,
                    None => right[k - most][row] -= by * c,
                }
            }
        }
    }
    let mut solved = Vec::with_capacity(anchors);
    for mut column in right {
        if !solve::dense(&mut matrix.clone(), &mut column) {
            return None;
        }
        let mut whole = vec![0.0; most];
        used.iter().for_each(|(k, place)| whole[*k] = column[*place]);
        solved.push(whole);
    }
    Some(solved)
}

impl Member {
    /// Shares of the anchors in values and slopes at the ends of each piece.
    fn shares(&self, section: &Pieces, course: &Course, known: &impl Fn(&Form) -> Vec<f64>) -> Vec<[Vec<f64>; 4]> {
        let [v0, v1] = [0, 1].map(|k| known(&self.values[k]));
        let [m0, m1] = [0, 1].map(|k| known(&self.slopes[k]));
        let ends = |k: usize| (projected(section[k][0]), projected(section[k][section[k].len() - 1]));
        let (first, last) = (ends(self.pieces.start).0, ends(self.pieces.end - 1).1);
        let way = last - first;
        let h = self.span;
        let at = |x: f64, p: DVec3, a: usize| {
            if self.straight {
                let share = if way == DVec3::ZERO { x / h } else { (p - first).dot(way) / way.length_squared() };
                return (v0[a] + (v1[a] - v0[a]) * share, 0.0);
            }
            let y = x / h;
            let z = 1.0 - y;
            let value = v0[a] * z * z * (1.0 + 2.0 * y) + v1[a] * y * y * (3.0 - 2.0 * y) + h * y * z * (m0[a] * z - m1[a] * y);
            let slope = 6.0 * y * z * (v1[a] - v0[a]) / h + m0[a] * z * (1.0 - 3.0 * y) + m1[a] * y * (3.0 * y - 2.0);
            (value, slope)
        };
        let mut x = 0.0;
        let piece = |k: usize| {
            let span = course.spans[k];
            let (from, to) = (x, if k + 1 == self.pieces.end { h } else { x + span });
            x = to;
            let of = |x: f64, p: DVec3| -> (Vec<f64>, Vec<f64>) {
                let both = (0..v0.len()).map(|a| at(x, p, a));
                both.map(|(value, slope)| (value, slope * span)).unzip()
            };
            let ((start, out), (end, inward)) = (of(from, ends(k).0), of(to, ends(k).1));
            [start, out, end, inward]
        };
        self.pieces.clone().map(piece).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::tolerance::Tolerance;

    /// Cubics through points on a parabola, with breaks at its own parameter.
    fn parabola(n: usize) -> (Pieces, Vec<f64>) {
        let breaks: Vec<f64> = (0..=n).map(|k| k as f64 / n as f64).collect();
        let point = |t: f64| DVec3::new(t, t * t, 0.0);
        let slope = |t: f64| DVec3::new(1.0, 2.0 * t, 0.0);
        let piece = |w: &[f64]| {
            let h = (w[1] - w[0]) / 3.0;
            let poles = [point(w[0]), point(w[0]) + slope(w[0]) * h, point(w[1]) - slope(w[1]) * h, point(w[1])];
            poles.iter().map(|p| p.extend(1.0)).collect()
        };
        (breaks.windows(2).map(piece).collect(), breaks)
    }

    fn displaced(section: &Pieces, breaks: &[f64], anchors: &[usize], given: &[DVec3]) -> Pieces {
        let course = Course::new(section, breaks, false, &Tolerance::new(1e-6, 1.0));
        let field = Displacement::new(section, &course, anchors, false);
        let mut moved = section.clone();
        moved.iter_mut().enumerate().for_each(|(k, piece)| field.apply(k, piece, given, &section[k]));
        moved
    }

    #[test]
    fn a_displacement_that_is_linear_at_the_anchors_is_linear_everywhere() {
        let (section, breaks) = parabola(6);
        let by = DVec3::new(0.3, -0.2, 0.5);
        let given = [1, 3, 4].map(|k| by * breaks[k]);
        for (k, piece) in displaced(&section, &breaks, &[1, 3, 4], &given).iter().enumerate() {
            for (i, (q, p)) in piece.iter().zip(&section[k]).enumerate() {
                let t = breaks[k] + (breaks[k + 1] - breaks[k]) * i as f64 / 3.0;
                assert!((projected(*q) - projected(*p)).distance(by * t) < 1e-12, "{k} {i}");
            }
        }
    }

    #[test]
    fn between_three_anchors_it_is_the_natural_cubic_spline() {
        let (section, breaks) = parabola(4);
        let moved = displaced(&section, &breaks, &[0, 2, 4], &[DVec3::ZERO, DVec3::Z, DVec3::ZERO]);
        // Through (0, 0), (1/2, 1), (1, 0): 3 t − 4 t³ up to the middle.
        for (k, wanted) in [(0, 0.0), (1, 0.6875), (2, 1.0), (3, 0.6875)] {
            assert!((moved[k][0].z - wanted).abs() < 1e-12, "{k}: {}", moved[k][0].z);
        }
    }

    #[test]
    fn a_line_that_an_anchor_divides_bends_smoothly() {
        let line = |k: usize| (0..4).map(|i| DVec3::new(k as f64 + i as f64 / 3.0, 0.0, 0.0).extend(1.0)).collect();
        let section: Pieces = (0..2).map(line).collect();
        let moved = displaced(&section, &[0.0, 0.5, 1.0], &[0, 1, 2], &[DVec3::ZERO, DVec3::Z, DVec3::ZERO]);
        let (before, after) = (end_slopes(&moved[0]).1, end_slopes(&moved[1]).0);
        assert!(before.angle_between(after) < 1e-12, "{before} {after}");
    }

    #[test]
    fn straight_members_stay_straight_and_bent_ones_leave_them_smoothly() {
        let (mut section, _) = parabola(2);
        let line = |k: usize| DVec3::new(-2.0 + 2.0 * k as f64 / 3.0, 0.0, 0.0).extend(1.0);
        section.insert(0, (0..4).map(line).collect());
        let moved = displaced(&section, &[0.0, 0.6, 0.75, 1.0], &[0, 2, 3], &[DVec3::ZERO, DVec3::Z, DVec3::Y]);
        let points: Vec<DVec3> = moved[0].iter().map(|q| projected(*q)).collect();
        assert!(straight_shares(&points).is_some(), "{points:?}");
        let (before, after) = (end_slopes(&moved[0]).1, end_slopes(&moved[1]).0);
        assert!(before.angle_between(after) < 1e-12);
        assert!(projected(moved[1][3]).distance(projected(section[1][3]) + DVec3::Z) < 1e-12);
    }
}
