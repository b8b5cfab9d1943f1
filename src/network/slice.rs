//! Taking chains apart and putting them together: slices, sums, kinks, nearest points.

use glam::DVec3;

use super::chain::{Chain, Run, same_curve};
use super::snap::may_snap;
use crate::base::fault::Result;
use crate::base::origin::Origin;
use crate::base::tolerance::{SLIVER, Tolerance};
use crate::geometry::Curve;
use crate::geometry::query::closest::closest as closest_on_curve;
use crate::network::fault::{ChainFault, CurveEnd};

/// [`Chain::slice`].
pub fn slice(chain: &Chain, (f0, f1): (f64, f64), tolerance: &Tolerance) -> Result<Chain> {
    let (f0, f1) = (f0.clamp(0.0, 1.0), f1.clamp(0.0, 1.0));
    let least = tolerance.point / chain.length();
    if chain.is_closed(tolerance) {
        // Forward always; the start of the chain is also its end.
        let (f0, f1) = (if f0 >= 1.0 - least { 0.0 } else { f0 }, if f1 <= least { 1.0 } else { f1 });
        if f1 - f0 > least {
            return Ok(Chain::of_runs(runs_between(chain, f0, f1), chain.origin()));
        }
        let mut runs = runs_between(chain, f0, 1.0);
        if f0.min(f1) > 0.0 {
            runs.extend(runs_between(chain, 0.0, if (f1 - f0).abs() <= least { f0 } else { f1 }));
        }
        return Ok(Chain::of_runs(merged(runs, true), chain.origin()));
    }
    if (f1 - f0).abs() <= least {
        let length = (f1 - f0).abs() * chain.length();
        return Err(ChainFault::NoLength { of: chain.origin(), at: chain.point(f0), length, tolerance: tolerance.point }.into());
    }
    let part = Chain::of_runs(runs_between(chain, f0.min(f1), f0.max(f1)), chain.origin());
    Ok(if f1 < f0 { part.reversed() } else { part })
}

/// The runs between two ascending fractions, `f0 < f1`, without those that rounding left beside a joint.
fn runs_between(chain: &Chain, f0: f64, f1: f64) -> Vec<Run> {
    let joints = chain.joints();
    let mut runs = Vec::new();
    for (k, run) in chain.runs().iter().enumerate() {
        let (from, to) = (joints[k].max(f0), joints[k + 1].min(f1));
        if to - from > SLIVER {
            let s0 = if from == joints[k] { run.s0 } else { chain.locate(from).1 };
            let s1 = if to == joints[k + 1] { run.s1 } else { chain.locate(to).1 };
            runs.push(normal(Run { curve: run.curve.clone(), s0, s1 }));
        }
    }
    runs
}

/// A run that lies wholly past the start of its closed curve, one turn earlier.
fn normal(run: Run) -> Run {
    let length = run.curve.length();
    if run.s0.min(run.s1) >= length { Run { s0: run.s0 - length, s1: run.s1 - length, ..run } } else { run }
}

/// Neighbouring runs that go on along the same curve as one; past the start of a closed curve when `wrap`.
fn merged(runs: Vec<Run>, wrap: bool) -> Vec<Run> {
    let mut out: Vec<Run> = Vec::with_capacity(runs.len());
    for run in runs {
        if let Some(last) = out.last_mut()
            && same_curve(&last.curve, &run.curve)
            && last.is_backward() == run.is_backward()
        {
            let length = run.curve.length();
            if last.s1 == run.s0 {
                last.s1 = run.s1;
                continue;
            }
            if wrap && !run.is_backward() && last.s1 == length && run.s0 == 0.0 && run.s1 <= last.s0 {
                last.s1 = length + run.s1;
                continue;
            }
            if wrap && run.is_backward() && last.s1 == 0.0 && run.s0 == length && run.s1 >= last.s0 {
                last.s0 += length;
                last.s1 = run.s1;
                continue;
            }
        }
        out.push(run);
    }
    out
}

/// [`Chain::join`].
pub fn join(parts: &[Chain], origin: Origin, tolerance: &Tolerance) -> Result<Chain> {
    for pair in parts.windows(2) {
        let (end, start) = (pair[0].end(), pair[1].start());
        if !tolerance.same_point(end, start) {
            let shorter = pair.iter().map(Chain::length).fold(f64::INFINITY, f64::min);
            return Err(ChainFault::Broken {
                a: CurveEnd { of: pair[0].origin(), last: true, at: end },
                b: CurveEnd { of: pair[1].origin(), last: false, at: start },
                reversed_fits: tolerance.same_point(end, pair[1].end()),
                snaps: may_snap(end.distance(start), shorter),
                tolerance: tolerance.point,
            }
            .into());
        }
    }
    let owned: Vec<(Origin, &Run)> = parts.iter().flat_map(|part| part.runs().iter().map(|run| (part.origin(), run))).collect();
    for (k, (a, first)) in owned.iter().enumerate() {
        for (b, second) in &owned[k + 1..] {
            if let Some((s0, s1)) = shared_stretch(first, second, tolerance) {
                let stretch = (first.point_at(s0), first.point_at(s1));
                return Err(ChainFault::Repeats { a: *a, b: *b, stretch }.into());
            }
        }
    }
    Ok(Chain::of_runs(merged(owned.into_iter().map(|(_, run)| run.clone()).collect(), false), origin))
}

/// The arc lengths of the first run that the second one runs over again, when they are more than a point.
fn shared_stretch(a: &Run, b: &Run, tolerance: &Tolerance) -> Option<(f64, f64)> {
    if !same_curve(&a.curve, &b.curve) {
        return None;
    }
    let length = a.curve.length();
    let span = |run: &Run, turn: f64| (run.s0.min(run.s1) + turn, run.s0.max(run.s1) + turn);
    let (lo, hi) = span(a, 0.0);
    [-length, 0.0, length].into_iter().find_map(|turn| {
        let (from, to) = span(b, turn);
        let shared = (lo.max(from), hi.min(to));
        (shared.1 - shared.0 > tolerance.point).then_some(shared)
    })
}

/// [`Chain::kinks`].
pub fn kinks(chain: &Chain, tolerance: &Tolerance) -> Vec<f64> {
    let near = tolerance.point / chain.length();
    let closed = chain.is_closed(tolerance);
    let mut found = Vec::new();
    for (k, run) in chain.runs().iter().enumerate() {
        let (lo, hi) = (run.s0.min(run.s1), run.s0.max(run.s1));
        for t in run.curve.kinks(tolerance) {
            let s = run.curve.length_at(t);
            for s in [s, s + run.curve.length()] {
                if lo < s && s < hi {
                    found.push(chain.fraction(k, s));
                }
            }
        }
    }
    let joints = chain.joints();
    for &f in &joints[1..joints.len() - 1] {
        if tolerance.is_kink(chain.jet_before(f).d1, chain.jet(f).d1) {
            found.push(f);
        }
    }
    if closed && tolerance.is_kink(chain.jet_before(1.0).d1, chain.jet(0.0).d1) {
        found.push(0.0);
    }
    found.sort_by(f64::total_cmp);
    // A kink a hair beside a joint is the joint's; beside an open end it is none.
    let snap = |f: f64| joints.iter().copied().find(|joint| (joint - f).abs() <= near).unwrap_or(f);
    let mut kinks: Vec<f64> = found.into_iter().map(snap).map(|f| if f == 1.0 { 0.0 } else { f }).filter(|&f| closed || f > 0.0).collect();
    kinks.sort_by(f64::total_cmp);
    kinks.dedup_by(|b, a| *b - *a <= near);
    kinks
}

/// The exact curves of a run in its direction: one, or two where it passes the start of a closed curve.
pub fn pieces(run: &Run) -> Vec<Curve> {
    let length = run.curve.length();
    let (lo, hi) = (run.s0.min(run.s1), run.s0.max(run.s1));
    let part = |a: f64, b: f64| {
        if a <= 0.0 && b >= length { run.curve.clone() } else { run.curve.part(run.curve.param_at_length(a), run.curve.param_at_length(b)) }
    };
    // What rounding left of a piece at the start of the curve is none.
    let room = SLIVER * length;
    let mut pieces = match (length - lo > room, hi - length > room) {
        (true, true) => vec![part(lo, length), part(0.0, hi - length)],
        (false, true) => vec![part((lo - length).max(0.0), hi - length)],
        _ => vec![part(lo, hi.min(length))],
    };
    if run.is_backward() {
        pieces.reverse();
        pieces = pieces.iter().map(Curve::reversed).collect();
    }
    pieces
}

/// [`Chain::closest`].
pub fn closest(chain: &Chain, p: DVec3) -> (f64, DVec3, f64) {
    let mut best = (0.0, chain.start(), chain.start().distance(p));
    let mut offer = |f: f64, point: DVec3| {
        let distance = point.distance(p);
        if distance < best.2 {
            best = (f, point, distance);
        }
    };
    for (k, run) in chain.runs().iter().enumerate() {
        let length = run.curve.length();
        let (lo, hi) = (run.s0.min(run.s1), run.s0.max(run.s1));
        if lo <= 0.0 && hi >= length {
            let found = closest_on_curve(&run.curve, p);
            offer(chain.fraction(k, run.curve.length_at(found.t)), found.point);
            continue;
        }
        let mut from = run.s0;
        for piece in pieces(run) {
            let found = closest_on_curve(&piece, p);
            let along = piece.length_at(found.t);
            let step = if run.is_backward() { -1.0 } else { 1.0 };
            offer(chain.fraction(k, from + step * along), found.point);
            from += step * piece.length();
        }
    }
    offer(1.0, chain.end());
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::construct::build;

    fn line(a: (f64, f64), b: (f64, f64)) -> Chain {
        let point = |(x, y): (f64, f64)| DVec3::new(x, y, 0.0);
        Chain::of_curve(&build::line(point(a), point(b), Origin::NONE).unwrap())
    }

    fn tolerance() -> Tolerance {
        Tolerance::new(1e-6, 10.0)
    }

    #[test]
    fn a_chain_of_three_walks_by_length() {
        let chain = Chain::join(
            &[line((0., 0.), (3., 0.)), line((3., 4.), (3., 0.)).reversed(), line((3., 4.), (0., 4.))],
            Origin::NONE,
            &tolerance(),
        )
        .unwrap();
        assert_eq!(chain.joints(), [0.0, 0.3, 0.7, 1.0]);
        assert_eq!(chain.length(), 10.0);
        for (f, x, y) in [(0.0, 0., 0.), (0.15, 1.5, 0.), (0.3, 3., 0.), (0.5, 3., 2.), (0.7, 3., 4.), (1.0, 0., 4.)] {
            assert!(chain.point(f).distance(DVec3::new(x, y, 0.0)) < 1e-14, "{f}: {}", chain.point(f));
            assert!((chain.jet(f).d1.length() - 10.0).abs() < 1e-13);
        }
        assert_eq!(chain.kinks(&tolerance()), [0.3, 0.7]);
        assert_eq!(chain.jet_before(0.3).d1, DVec3::new(10.0, 0.0, 0.0));
        assert_eq!(chain.jet(0.3).d1, DVec3::new(0.0, 10.0, 0.0));
        let fs = [0.0, 0.1, 0.3, 0.9, 1.0];
        let mut out = [DVec3::ZERO; 5];
        chain.points(&fs, &mut out);
        for (&f, p) in fs.iter().zip(out) {
            assert_eq!(p, chain.point(f));
        }
    }

    #[test]
    fn a_closed_slice_walks_forward_past_the_start() {
        let square = Chain::join(
            &[line((0., 0.), (1., 0.)), line((1., 0.), (1., 1.)), line((1., 1.), (0., 1.)), line((0., 1.), (0., 0.))],
            Origin::NONE,
            &tolerance(),
        )
        .unwrap();
        assert_eq!(square.kinks(&tolerance()), [0.0, 0.25, 0.5, 0.75]);
        let part = square.slice(0.625, 0.125, &tolerance()).unwrap();
        assert_eq!((part.length(), part.start(), part.end()), (2.0, DVec3::new(0.5, 1.0, 0.0), DVec3::new(0.5, 0.0, 0.0)));
        let once = square.slice(0.125, 0.125, &tolerance()).unwrap();
        assert_eq!((once.length(), once.start()), (4.0, DVec3::new(0.5, 0.0, 0.0)));
        assert_eq!(once.runs().len(), 5);
    }

    #[test]
    fn an_open_slice_runs_either_way_and_never_ends_as_a_point() {
        let c = line((0., 0.), (10., 0.));
        let back = c.slice(0.75, 0.25, &tolerance()).unwrap();
        assert_eq!((back.start().x, back.end().x, back.length()), (7.5, 2.5, 5.0));
        assert_eq!(c.slice(0.5, 0.5, &tolerance()).unwrap_err().code().0, "E401");
        let twice = back.reversed().slice(0.5, 1.0, &tolerance()).unwrap();
        assert_eq!((twice.start().x, twice.end().x), (5.0, 7.5));
    }

    #[test]
    fn parts_of_one_curve_join_to_one_run_and_never_overlap() {
        let c = line((0., 0.), (10., 0.));
        let (a, b) = (c.slice(0.0, 0.5, &tolerance()).unwrap(), c.slice(0.5, 1.0, &tolerance()).unwrap());
        let whole = Chain::join(&[a.clone(), b], Origin::NONE, &tolerance()).unwrap();
        assert!(whole.whole_curve().is_some());
        assert_eq!(Chain::join(&[a.clone(), a.reversed()], Origin::NONE, &tolerance()).unwrap_err().code().0, "E504");
        let fault = Chain::join(&[a, line((6., 0.), (5., 0.))], Origin::NONE, &tolerance()).unwrap_err();
        assert_eq!(fault.code().0, "E503");
    }
}
