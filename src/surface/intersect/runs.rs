//! The runs of a curve that lie on surfaces, as curves.

use crate::base::fault::Result;
use crate::base::tolerance::Tolerance;
use crate::network::Chain;
use crate::surface::core::surface::Surface;
use crate::surface::intersect::with_curve::with_curve;

/// A part of a curve, from one fraction of its length to another.
type Stretch = (f64, f64);

/// The runs of a curve that lie on a surface; one that is a point within the tolerance is none. Fails as [`with_curve`] does.
pub fn runs_on(chain: &Chain, surface: &Surface, tolerance: &Tolerance) -> Result<Vec<Chain>> {
    sliced(chain, stretches(chain, std::slice::from_ref(surface), tolerance)?, tolerance)
}

/// The runs of a curve that lie inside faces, their borders included, in order along it; where faces join they go on, and so does a closed
/// curve past its start. One that is a point within the tolerance is none. Fails as [`with_curve`] does.
pub fn inside(chain: &Chain, faces: &[Surface], tolerance: &Tolerance) -> Result<Vec<Chain>> {
    let near = tolerance.point / chain.length();
    let mut runs = stretches(chain, faces, tolerance)?;
    if let [first, .., last] = runs[..]
        && chain.is_closed(tolerance)
        && first.0 <= near
        && last.1 >= 1.0 - near
    {
        runs.pop();
        runs[0] = (last.0, first.1);
    }
    sliced(chain, runs, tolerance)
}

/// Where a curve lies on surfaces, longer than a point, ascending.
fn stretches(chain: &Chain, surfaces: &[Surface], tolerance: &Tolerance) -> Result<Vec<Stretch>> {
    let runs = with_curve(chain, surfaces, tolerance)?.into_iter().filter_map(|run| Some((run.f, run.overlap_end?)));
    Ok(runs.filter(|(from, to)| to - from > tolerance.point / chain.length()).collect())
}

fn sliced(chain: &Chain, runs: Vec<Stretch>, tolerance: &Tolerance) -> Result<Vec<Chain>> {
    let near = tolerance.point / chain.length();
    let whole = |(from, to): Stretch| from <= near && to >= 1.0 - near;
    runs.into_iter().map(|run| if whole(run) { Ok(chain.clone()) } else { chain.slice(run.0, run.1, tolerance) }).collect()
}
