//! Curves sorted into loops.

use super::chain::Chain;
use crate::base::tolerance::Tolerance;

/// The loops that curves close: a closed curve is one, others are walked from end to end, each loop closed as soon as it can
/// be; where several curves go on the first written does, so that curves written together stay together even where loops
/// touch. What closes with nothing comes last, all of it as one loop: whoever takes it says what is open.
pub fn rings(chains: &[Chain], tolerance: &Tolerance) -> Vec<Vec<Chain>> {
    let mut left: Vec<&Chain> = chains.iter().collect();
    let (mut rings, mut open): (Vec<Vec<Chain>>, Vec<Chain>) = (Vec::new(), Vec::new());
    while !left.is_empty() {
        let first = left.remove(0);
        let (start, mut end, mut places) = (first.start(), first.end(), Vec::new());
        while !tolerance.same_point(start, end) {
            let goes_on = |k: &usize| {
                !places.contains(k) && (tolerance.same_point(left[*k].start(), end) || tolerance.same_point(left[*k].end(), end))
            };
            let Some(next) = (0..left.len()).find(goes_on) else { break };
            end = if tolerance.same_point(left[next].start(), end) { left[next].end() } else { left[next].start() };
            places.push(next);
        }
        if !tolerance.same_point(start, end) {
            open.push(first.clone());
            continue;
        }
        places.sort_unstable();
        let mut ring = vec![first.clone()];
        ring.extend(places.iter().map(|&k| left[k].clone()));
        let mut place = 0..;
        left.retain(|_| place.next().is_none_or(|k| !places.contains(&k)));
        rings.push(ring);
    }
    if !open.is_empty() {
        rings.push(open);
    }
    rings
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::base::origin::Origin;
    use crate::geometry::construct::build;

    type Place = (f64, f64);

    fn line(a: Place, b: Place) -> Chain {
        let p = |(x, y)| DVec3::new(x, y, 0.0);
        Chain::of_curve(&build::line(p(a), p(b), Origin::NONE).unwrap())
    }

    fn check(lines: &[(Place, Place)], expected: &[usize]) {
        let chains: Vec<Chain> = lines.iter().map(|&(a, b)| line(a, b)).collect();
        let sizes: Vec<usize> = rings(&chains, &Tolerance::new(1e-5, 10.0)).iter().map(Vec::len).collect();
        assert_eq!(sizes, expected);
    }

    #[test]
    fn curves_close_where_they_can() {
        let (a, b, c, d) = ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (5.0, 5.0));
        let (e, f) = ((6.0, 5.0), (5.0, 6.0));
        // Two triangles whose sides are mixed and run either way.
        check(&[(a, b), (d, e), (c, b), (f, d), (a, c), (e, f)], &[3, 3]);
        // Two that touch in `a`, each written together.
        let (g, h) = ((-1.0, 0.0), (0.0, -1.0));
        check(&[(a, b), (a, c), (c, b), (a, g), (g, h), (h, a)], &[3, 3]);
        // What is open stays together and comes last.
        check(&[(a, b), (d, e), (c, b), (e, f), (d, f)], &[3, 2]);
        check(&[], &[]);
    }
}
