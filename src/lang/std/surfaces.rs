//! Surfaces: constructors, places on them, patches, edges and vertices.

use crate::base::fault::ValueFault;
use crate::lang::cx::Stop;
use crate::surface::{Domain, Surface};

/// Checks that (u, v) lies in the surface's domain; each with the name of its argument.
pub(super) fn checked_uv(surface: &Surface, u: (f64, &'static str), v: (f64, &'static str)) -> Result<(f64, f64), Stop> {
    for (value, argument) in [u, v] {
        if !(0.0..=1.0).contains(&value) {
            let (found, range) = (value.to_string(), "between 0 and 1".to_owned());
            return Err(ValueFault::OutsideRange { argument, found, range }.into());
        }
    }
    if surface.domain() == Domain::Triangle && u.0 + v.0 > 1.0 {
        let (found, range) = (v.0.to_string(), "at most 1 less u on a surface of three sides".to_owned());
        return Err(ValueFault::OutsideRange { argument: v.1, found, range }.into());
    }
    Ok((u.0, v.0))
}
