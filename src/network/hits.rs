//! Contacts: where the curves of a network meet each other and themselves, kept pair by pair.
//!
//! Pairs are asked in the order of names, so that a contact is the same to the last bit whatever was declared first.

use std::collections::BTreeMap;

use glam::DVec3;

use super::graph::NetCurve;
use crate::base::bbox::Box3;
use crate::base::boxtree::BoxTree;
use crate::base::fault::Result;
use crate::base::job::Job;
use crate::base::par;
use crate::base::tolerance::Tolerance;
use crate::geometry::curves::curve::Shape;
use crate::geometry::query::intersect::{SearchBuffers, intersect_with};
use crate::geometry::{Curve, Hit, self_intersect};

/// One contact of two curves, or of a curve with itself.
#[derive(Clone, Debug, PartialEq)]
pub struct Contact {
    /// The curves, as indices; the first by name first.
    pub curves: [u32; 2],
    /// Arc length on each.
    pub s: [f64; 2],
    /// Where.
    pub at: DVec3,
    /// The other end of an overlap: arc lengths (the second one may be less than its start) and point.
    pub to: Option<Box<([f64; 2], DVec3)>>,
}

/// Work of two curves whose boxes touch, before they are looked at: at least so much is done with them.
const OF_A_PAIR: u64 = 32;
/// Tolerances that the far end of the shorter of two straight curves with a common end is off the other one where they meet nowhere else:
/// four times the distance within which the search looks for ends.
const CLEAR: f64 = 256.0;
/// Pairs of one curve from which on its pieces are kept from one to the next.
const MANY_PAIRS: u32 = 8;
/// Pairs handed to a thread at once.
const CHUNK: usize = 256;

/// All contacts of curves, in order of pairs.
pub fn all(curves: &[NetCurve], tolerance: &Tolerance, job: &Job) -> Result<Vec<Contact>> {
    of_pairs(curves, &near(curves, tolerance), tolerance, job)
}

/// Pairs whose boxes touch, then curves that may meet themselves.
fn near(curves: &[NetCurve], tolerance: &Tolerance) -> Vec<(u32, u32)> {
    let boxes: Vec<Box3> = curves.iter().map(|c| c.curve.bbox()).collect();
    let mut pairs = BoxTree::build(&boxes).pairs(tolerance.point, OF_A_PAIR);
    pairs.extend((0..curves.len() as u32).filter(|&k| may_meet_itself(&curves[k as usize].curve)).map(|k| (k, k)));
    pairs
}

/// The same, with the contacts of pairs that were there before: curves made once and copied, under the same names.
pub fn all_after(curves: &[NetCurve], before: (&[NetCurve], &[Contact]), tolerance: &Tolerance, job: &Job) -> Result<Vec<Contact>> {
    let (old, contacts) = before;
    let by_name: BTreeMap<&str, u32> = old.iter().zip(0..).map(|(c, k)| (c.name.as_str(), k)).collect();
    let same = |c: &NetCurve| by_name.get(c.name.as_str()).copied().filter(|k| old[*k as usize].curve.is(&c.curve));
    let was: Vec<Option<u32>> = curves.iter().map(same).collect();
    let unordered = |[a, b]: [u32; 2]| (a.min(b), a.max(b));
    let mut known: Vec<&Contact> = contacts.iter().collect();
    // Stable, so that the contacts of a pair keep their order.
    known.sort_by_key(|c| unordered(c.curves));
    let pairs = near(curves, tolerance);
    let is_new = |pair: &&(u32, u32)| was[pair.0 as usize].is_none() || was[pair.1 as usize].is_none();
    let new: Vec<(u32, u32)> = pairs.iter().filter(is_new).copied().collect();
    let mut found = of_pairs(curves, &new, tolerance, job)?.into_iter().peekable();
    let mut all = Vec::with_capacity(contacts.len());
    for pair in &pairs {
        if let (Some(a), Some(b)) = (was[pair.0 as usize], was[pair.1 as usize]) {
            let key = unordered([a, b]);
            let from = known.partition_point(|c| unordered(c.curves) < key);
            let own = known[from..].iter().take_while(|c| unordered(c.curves) == key);
            // The first by name is the same one as before.
            let now = |k: u32| if k == a { pair.0 } else { pair.1 };
            all.extend(own.map(|c| Contact { curves: c.curves.map(now), ..(**c).clone() }));
        } else {
            while let Some(contact) = found.next_if(|c| unordered(c.curves) == unordered([pair.0, pair.1])) {
                all.push(contact);
            }
        }
    }
    Ok(all)
}

/// Contacts of one curve with all others and itself.
pub fn of_one(curves: &[NetCurve], one: usize, tolerance: &Tolerance, job: &Job) -> Result<Vec<Contact>> {
    let own = curves[one].curve.bbox();
    let near =
        |k: &usize| if *k == one { may_meet_itself(&curves[one].curve) } else { curves[*k].curve.bbox().touches(&own, tolerance.point) };
    let pairs: Vec<(u32, u32)> = (0..curves.len()).filter(near).map(|k| (k.min(one) as u32, k.max(one) as u32)).collect();
    of_pairs(curves, &pairs, tolerance, job)
}

fn may_meet_itself(curve: &Curve) -> bool {
    !matches!(curve.shape(), Shape::Line(..) | Shape::Arc(_))
}

fn of_pairs(curves: &[NetCurve], pairs: &[(u32, u32)], tolerance: &Tolerance, job: &Job) -> Result<Vec<Contact>> {
    job.expect(pairs.len() as u64);
    keep_pieces(curves, pairs);
    let chunks = par::try_map(pairs.len().div_ceil(CHUNK), |k| {
        job.go_on()?;
        let chunk = &pairs[k * CHUNK..((k + 1) * CHUNK).min(pairs.len())];
        let (mut contacts, mut buffers) = (Vec::with_capacity(chunk.len()), SearchBuffers::default());
        for &(a, b) in chunk {
            let (a, b) = if curves[a as usize].name <= curves[b as usize].name { (a, b) } else { (b, a) };
            let (first, second) = (&curves[a as usize].curve, &curves[b as usize].curve);
            if let Some((s, at)) = corner(first, second, tolerance) {
                contacts.push(Contact { curves: [a, b], s, at, to: None });
                continue;
            }
            if a == b {
                buffers.hits = self_intersect(first, tolerance)?;
            } else {
                intersect_with(first, second, tolerance, &mut buffers)?;
            }
            contacts.extend(buffers.hits.iter().map(|hit| contact([a, b], [first, second], *hit)));
        }
        job.advance(chunk.len() as u64);
        Result::Ok(contacts)
    })?;
    Ok(chunks.into_iter().flatten().collect())
}

/// Has the pieces of curves that are in many pairs made once.
fn keep_pieces(curves: &[NetCurve], pairs: &[(u32, u32)]) {
    let mut of_each = vec![0_u32; curves.len()];
    for curve in pairs.iter().flat_map(|(a, b)| [*a, *b]) {
        of_each[curve as usize] += 1;
        if of_each[curve as usize] == MANY_PAIRS {
            curves[curve as usize].curve.pieces();
        }
    }
}

/// Place of each curve in the order of names.
pub fn ranks(curves: &[NetCurve]) -> Vec<u32> {
    let mut order: Vec<u32> = (0..curves.len() as u32).collect();
    order.sort_unstable_by(|&a, &b| curves[a as usize].name.cmp(&curves[b as usize].name).then(a.cmp(&b)));
    let mut rank = vec![0; curves.len()];
    for (place, &k) in order.iter().enumerate() {
        rank[k as usize] = place as u32;
    }
    rank
}

/// Two straight curves with a common end that part at a right angle or more, or far enough: they can meet nowhere else.
fn corner(a: &Curve, b: &Curve, tolerance: &Tolerance) -> Option<([f64; 2], DVec3)> {
    let (&Shape::Line(a0, a1), &Shape::Line(b0, b1)) = (a.shape(), b.shape()) else { return None };
    let ends = [(a0, a1, b0, b1), (a0, a1, b1, b0), (a1, a0, b0, b1), (a1, a0, b1, b0)];
    let (p, far_a, _, far_b) = ends.into_iter().find(|(p, _, q, _)| p == q)?;
    let s = |curve: &Curve, start: DVec3| if start == p { 0.0 } else { curve.length() };
    let (u, v) = (far_a - p, far_b - p);
    // The far end of the shorter one is |u × v| / max(|u|, |v|) off the line of the other.
    let clear = CLEAR * tolerance.point;
    let apart = || u.cross(v).length_squared() > clear * clear * u.length_squared().max(v.length_squared());
    (u.dot(v) <= 0.0 || apart()).then(|| ([s(a, a0), s(b, b0)], p))
}

fn contact(curves: [u32; 2], [a, b]: [&Curve; 2], hit: Hit) -> Contact {
    match hit {
        Hit::Point { ta, tb, at, .. } => Contact { curves, s: [a.length_at(ta), b.length_at(tb)], at, to: None },
        Hit::Overlap { a: (ta0, ta1), b: (tb0, tb1) } => Contact {
            curves,
            s: [a.length_at(ta0), b.length_at(tb0)],
            at: (a.point(ta0) + b.point(tb0)) * 0.5,
            to: Some(Box::new(([a.length_at(ta1), b.length_at(tb1)], (a.point(ta1) + b.point(tb1)) * 0.5))),
        },
    }
}
