//! What searches for few spans share: where the next knots go, and whether a fit swings out between its data.

use glam::DVec3;

/// Spans up to which knots come one at a time.
const SINGLE: usize = 32;
/// Of many spans those are parted whose error is at least this share of the largest.
const BAD: f64 = 0.5;

/// Breaks with knots more, what helps most first: where there are many spans one in each bad one, then one in a single span, the worst
/// first; none where no span has data left to part. They follow from the data alone, so that a smaller tolerance goes on from where a
/// larger one ends.
pub fn finer<'a>(breaks: &'a [f64], parameters: &[f64], off: &[f64]) -> impl Iterator<Item = Vec<f64>> + 'a {
    let spans = breaks.windows(2).filter_map(|ends| {
        // The data at the ends of an open row are met whatever the knots: they settle nothing.
        let low = parameters.partition_point(|t| *t <= ends[0]);
        let high = parameters.partition_point(|t| *t < ends[1]).max(low);
        let worst = off[low..high].iter().copied().fold(0.0, f64::max);
        let at = if high - low >= 2 { middle(&parameters[low..high], &off[low..high]) } else { ends[0] };
        (worst > 0.0 && !breaks.contains(&at)).then_some((worst, at))
    });
    let mut spans: Vec<(f64, f64)> = spans.collect();
    spans.sort_by(|a, b| b.0.total_cmp(&a.0));
    let with = move |more: &[(f64, f64)]| {
        let mut all: Vec<f64> = breaks.iter().copied().chain(more.iter().map(|span| span.1)).collect();
        all.sort_by(f64::total_cmp);
        all
    };
    let bad = spans.partition_point(|span| span.0 >= BAD * spans[0].0);
    let many = (breaks.len() > SINGLE && bad > 1).then(|| with(&spans[..bad]));
    many.into_iter().chain(spans.into_iter().map(move |span| with(&[span])))
}

/// The parameter with half of the squared error of some data to either side.
fn middle(parameters: &[f64], off: &[f64]) -> f64 {
    let total: f64 = off.iter().map(|x| x * x).sum();
    let mut sum = 0.0;
    let passed = |x: &&f64| {
        sum += **x * **x;
        sum < 0.5 * total
    };
    let k = off.iter().take_while(passed).count().clamp(1, parameters.len() - 1);
    0.5 * (parameters[k - 1] + parameters[k])
}

/// How much a row of points turns at each of them, and at the points beside it: the largest second difference, model units. A closed
/// row has its first point at its end once more.
pub fn turns(points: &[DVec3], closed: bool) -> Vec<f64> {
    let n = points.len();
    let around = |i: usize| {
        let inner = i > 0 && i + 1 < n;
        let beside = if inner {
            Some((points[i - 1], points[i + 1]))
        } else if closed && n > 2 {
            Some((points[n - 2], points[1]))
        } else {
            None
        };
        beside.map_or(0.0, |(a, b)| (a + b - points[i] * 2.0).length())
    };
    let own: Vec<f64> = (0..n).map(around).collect();
    let near = |i: usize| own[i.saturating_sub(1)..(i + 2).min(n)].iter().copied().fold(0.0, f64::max);
    (0..n).map(near).collect()
}

/// Whether a point between data is farther from the middle of them than what they turn there and what the fit may be off, twice.
pub fn swings(at: DVec3, beside: DVec3, turn: f64, within: f64) -> bool {
    at.distance(beside) > turn + 2.0 * within
}
