//! How a section gives way between its anchors: the displacement that bends least and is what it has to be at them.
//!
//! Over the parameter in which a section is as smooth as its pieces make it, the displacement is the cubic spline through the anchors with
//! the least ∫ δ″², natural at open ends and periodic on closed sections. Straight members stay straight unless an anchor divides them: over one δ is linear,
//! and it goes on smoothly where the section does. Two members that meet at an angle turn against each other like parts of a rod with a hinge.
//! Beyond the outer anchors δ is constant. Where anchors that lie together move apart, a slope is no larger than what lets δ swing beyond its
//! values at the anchors by about half of their difference.

use std::collections::BTreeMap;
use std::ops::Range;

use glam::{DVec3, DVec4};

use crate::base::solve;
use crate::geometry::Nurbs;
use crate::geometry::shapes::nurbs::{projected, weighted};
use crate::surface::swept::course::{Course, end_slopes};
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
    /// Beyond the outer anchors, where δ is constant.
    beyond: bool,
    span: f64,
    values: [Form; 2],
    slopes: [Form; 2],
}

/// Displacements of a section as sums of those of its anchors.
#[derive(Clone, Debug)]
pub(super) struct Displacement {
    members: Vec<Solved>,
    /// Derivative after the start of a closed section over that before it; none of an open one.
    ring: Option<f64>,
    /// Whether the tangent goes on from each member to the next.
    smooth: Vec<bool>,
}

/// A member with shares of the anchors in what δ is at its ends.
#[derive(Clone, Debug)]
struct Solved {
    pieces: Range<usize>,
    straight: bool,
    span: f64,
    spans: Vec<f64>,
    values: [Vec<f64>; 2],
    slopes: [Vec<f64>; 2],
}

/// A displacement of a section: of each member δ and its derivative at both ends.
pub(super) struct Field<'a> {
    along: &'a Displacement,
    ends: Vec<([DVec3; 2], [DVec3; 2])>,
}

impl Displacement {
    /// Of a section with anchors where pieces begin or end, by the numbers of these joints. On a closed one the first anchor is at joint 0.
    /// `None` where anchors do not decide it.
    pub fn new(section: &Pieces, course: &Course, anchors: &[usize], closed: bool) -> Option<Self> {
        let n = section.len();
        let stiff = course.stiff(anchors, closed);
        let runs = course.members(anchors, &stiff);
        let (first, last) = (*anchors.iter().min()?, *anchors.iter().max()?);
        // Unknowns: values where members meet at no anchor, and slopes of bent members.
        let most = 3 * runs.len() + 1;
        let mut taken = 0;
        let mut unknown = || {
            taken += 1;
            Form::from([(taken - 1, 1.0)])
        };
        let at_anchor = |joint: usize| anchors.iter().position(|a| *a == joint).map(|k| Form::from([(most + k, 1.0)]));
        let mut values: Vec<Form> = Vec::with_capacity(runs.len() + 1);
        for joint in runs.iter().map(|run| run.start).chain([n]) {
            // Beyond the outer anchors it is constant.
            let held = if closed { joint } else { joint.clamp(first, last) };
            let back = (joint == n && closed).then(|| values[0].clone());
            values.push(at_anchor(held).or(back).unwrap_or_else(&mut unknown));
        }
        let mut members: Vec<Member> = Vec::with_capacity(runs.len());
        for (m, run) in runs.into_iter().enumerate() {
            let span: f64 = course.spans[run.clone()].iter().sum();
            let beyond = !closed && (run.end <= first || run.start >= last);
            let (straight, ends) = (stiff[run.start], [values[m].clone(), values[m + 1].clone()]);
            let slopes = if beyond {
                [Form::new(), Form::new()]
            } else if straight {
                let rise = sum([(1.0, &ends[1]), (-1.0, &ends[0])]);
                line_rates(section, course, &run).map(|rate| sum([(rate, &rise)]))
            } else {
                [unknown(), unknown()]
            };
            members.push(Member { pieces: run, straight, beyond, span, values: ends, slopes });
        }
        let squares = joined(&mut members, course, closed);
        let solved = least(&squares, most, anchors.len())?;
        let known = |form: &Form| -> Vec<f64> {
            (0..anchors.len())
                .map(|a| {
                    form.iter().map(|(k, c)| if *k < most { c * solved[a][*k] } else { c * f64::from(u8::from(*k == most + a)) }).sum()
                })
                .collect()
        };
        let smooth = members.iter().map(|member| course.smooth[member.pieces.end % n]).collect();
        let solve = |member: Member| Solved {
            spans: course.spans[member.pieces.clone()].to_vec(),
            values: member.values.map(|form| known(&form)),
            slopes: member.slopes.map(|form| known(&form)),
            pieces: member.pieces,
            straight: member.straight,
            span: member.span,
        };
        let members = members.into_iter().map(solve).collect();
        Some(Self { members, ring: closed.then_some(course.return_ratio), smooth })
    }

    /// The displacement for those of the anchors.
    pub fn field(&self, given: &[DVec3]) -> Field<'_> {
        let of = |shares: &Vec<f64>| shares.iter().zip(given).map(|(share, by)| *by * *share).sum::<DVec3>();
        let ends = |m: &Solved| ([of(&m.values[0]), of(&m.values[1])], [of(&m.slopes[0]), of(&m.slopes[1])]);
        let mut field = Field { along: self, ends: self.members.iter().map(ends).collect() };
        field.held_back();
        field
    }
}

impl Field<'_> {
    /// Slopes at the joints of bent members no larger than lets them swing.
    fn held_back(&mut self) {
        /// A slope m at one end of a span h moves a cubic by 4/27 m h at most.
        const MOST: f64 = 4.0;
        let members = &self.along.members;
        let count = members.len();
        let mut less = vec![[false; 2]; count];
        for m in 0..count {
            let next = (m + 1) % count;
            let ratio = if next > m { Some(1.0) } else { self.along.ring };
            let Some(ratio) = ratio.filter(|_| self.along.smooth[m] && !members[m].straight && !members[next].straight) else { continue };
            let rise = |m: usize| self.ends[m].0[0].distance(self.ends[m].0[1]);
            let limit = MOST * rise(m).max(rise(next)) / members[m].span.max(members[next].span);
            let slope = self.ends[m].1[1];
            if slope.length() > limit {
                let held = slope * (limit / slope.length());
                (self.ends[m].1[1], self.ends[next].1[0]) = (held, held * ratio);
                (less[m][1], less[next][0]) = (true, true);
            }
        }
        // At a free end there is no second derivative.
        let open = self.along.ring.is_none();
        for (m, end) in [(0, 0), (count - 1, 1)] {
            if open && !members[m].straight && less[m][1 - end] && !less[m][end] && members[m].slopes[end].iter().any(|c| *c != 0.0) {
                let ([v0, v1], slopes) = self.ends[m];
                self.ends[m].1[end] = ((v1 - v0) * (3.0 / members[m].span) - slopes[1 - end]) * 0.5;
            }
        }
    }

    /// Displaces the pieces of a section; `made` are these carried to where they are, `at_rest` as they were.
    pub fn apply(&self, made: &mut Pieces, at_rest: &Pieces) {
        for (member, ends) in self.along.members.iter().zip(&self.ends) {
            let at = |k: usize, i: usize| projected(at_rest[k][i]);
            let (from, to) = (at(member.pieces.start, 0), at(member.pieces.end - 1, at_rest[member.pieces.end - 1].len() - 1));
            let mut x = 0.0;
            for (k, span) in member.pieces.clone().zip(&member.spans) {
                let (start, end) = (x, if k + 1 == member.pieces.end { member.span } else { x + span });
                x = end;
                let by = if member.straight {
                    along_line(&at_rest[k], (from, to), ends.0)
                } else {
                    bent(&at_rest[k], member.span, (start, end), ends)
                };
                made[k].iter_mut().zip(by).for_each(|(q, by)| *q = weighted(projected(*q) + by, q.w));
            }
        }
    }
}

/// By how much the poles of a piece of a straight member move.
fn along_line(piece: &[DVec4], (from, to): (DVec3, DVec3), [start, end]: [DVec3; 2]) -> Vec<DVec3> {
    let way = to - from;
    let share = |p: DVec3| if way == DVec3::ZERO { 0.0 } else { (p - from).dot(way) / way.length_squared() };
    piece.iter().map(|q| start.lerp(end, share(projected(*q)))).collect()
}

/// By how much the poles of a piece between two places of a bent member move.
fn bent(piece: &[DVec4], h: f64, (from, to): (f64, f64), ends: &([DVec3; 2], [DVec3; 2])) -> Vec<DVec3> {
    let ([v0, v1], [m0, m1]) = *ends;
    let at = |x: f64| {
        let y = x / h;
        let z = 1.0 - y;
        let value = v0 * (z * z * (1.0 + 2.0 * y)) + v1 * (y * y * (3.0 - 2.0 * y)) + (m0 * z - m1 * y) * (h * y * z);
        let slope = (v1 - v0) * (6.0 * y * z / h) + m0 * (z * (1.0 - 3.0 * y)) + m1 * (y * (3.0 * y - 2.0));
        (value, slope * (to - from))
    };
    let ((start, out), (end, inward)) = (at(from), at(to));
    let degree = piece.len() - 1;
    let (first, last) = (piece[0].w / piece[1].w, piece[degree].w / piece[degree - 1].w);
    let cubic = [start, start + out * (first / 3.0), end - inward * (last / 3.0), end];
    let poles = cubic.iter().map(|p| p.extend(1.0)).collect();
    Nurbs::bezier(0.0, 1.0, poles).elevated(degree - 3).poles.iter().map(|q| projected(*q)).collect()
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
            _ if members[m].beyond && members[next].beyond => {}
            (false, _) if smooth && members[next].beyond => members[m].slopes[1] = Form::new(),
            (_, false) if smooth => members[next].slopes[0] = sum([(ratio, &before)]),
            (false, true) if smooth => members[m].slopes[1] = sum([(1.0 / ratio, &after)]),
            _ if members[m].beyond || members[next].beyond => {}
            _ => {
                let stiff = (0.5 * (members[m].span + members[next].span)).sqrt().recip();
                squares.push(sum([(stiff, &after), (-stiff, &before)]));
            }
        }
    }
    // ∫ δ″² = h/3 (a² + ab + b²) for δ″ from a to b.
    for member in members.iter().filter(|member| !member.straight && !member.beyond) {
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
        let along = Displacement::new(section, &course, anchors, false).expect("a displacement");
        let mut moved = section.clone();
        along.field(given).apply(&mut moved, section);
        moved
    }

    #[test]
    fn a_displacement_that_is_linear_at_the_anchors_is_linear_between_them() {
        let (section, breaks) = parabola(6);
        let by = DVec3::new(0.3, -0.2, 0.5);
        let given = [0, 3, 4, 6].map(|k| by * breaks[k]);
        for (k, piece) in displaced(&section, &breaks, &[0, 3, 4, 6], &given).iter().enumerate() {
            for (i, (q, p)) in piece.iter().zip(&section[k]).enumerate() {
                let t = breaks[k] + (breaks[k + 1] - breaks[k]) * i as f64 / 3.0;
                assert!((projected(*q) - projected(*p)).distance(by * t) < 1e-12, "{k} {i}");
            }
        }
    }

    #[test]
    fn beyond_the_outer_anchors_it_is_constant_and_smooth_at_them() {
        let (section, breaks) = parabola(6);
        let moved = displaced(&section, &breaks, &[2, 4], &[DVec3::Z, DVec3::Y]);
        for k in [0, 1, 4, 5] {
            let by = if k < 2 { DVec3::Z } else { DVec3::Y };
            moved[k].iter().zip(&section[k]).for_each(|(q, p)| assert!((projected(*q) - projected(*p)).distance(by) < 1e-12, "{k}"));
        }
        for k in [2, 4] {
            assert!(end_slopes(&moved[k - 1]).1.angle_between(end_slopes(&moved[k]).0) < 1e-12, "{k}");
        }
    }

    #[test]
    fn anchors_that_lie_together_and_move_apart_swing_it_little() {
        let (section, breaks) = parabola(64);
        for near in [33, 34, 36, 40] {
            let moved = displaced(&section, &breaks, &[0, 32, near, 64], &[DVec3::ZERO, DVec3::Z, -DVec3::Z, DVec3::ZERO]);
            let most = moved.iter().flatten().map(|q| projected(*q).z.abs()).fold(0.0, f64::max);
            assert!(most < 2.5, "{near}: {most}");
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
        let off = |p: &DVec3| (*p - points[0]).cross(points[3] - points[0]).length();
        assert!(points.iter().all(|p| off(p) < 1e-12), "{points:?}");
        let (before, after) = (end_slopes(&moved[0]).1, end_slopes(&moved[1]).0);
        assert!(before.angle_between(after) < 1e-12);
        assert!(projected(moved[1][3]).distance(projected(section[1][3]) + DVec3::Z) < 1e-12);
    }
}
