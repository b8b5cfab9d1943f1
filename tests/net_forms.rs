//! Nets of curves as B-splines: how near, how smooth, and with how many control points.
#![allow(clippy::unwrap_used, clippy::panic, missing_docs)]

#[path = "support/networks.rs"]
mod networks;

use lofting::base::tolerance::Tolerance;
use lofting::surface::{NetForm, Off, Surface};
use networks::{NETWORKS, as_given};

/// Largest distance of a net from its surface at equal (u, v), as a share of the size.
fn off(surface: &Surface, form: &NetForm, size: f64) -> f64 {
    let n = 400;
    let places: Vec<f64> = (0..=n).map(|k| f64::from(k) / f64::from(n)).collect();
    let mut found = vec![glam::DVec3::ZERO; places.len() * places.len()];
    let mut wanted = found.clone();
    form.net.grid(&places, &places, &mut found);
    surface.grid(&places, &places, &mut wanted);
    found.iter().zip(&wanted).map(|(p, q)| p.distance(*q)).fold(0.0, f64::max) / size
}

/// The control points of each direction are counted where nothing of the surface is missed by more than 1e-7 of the size.
#[test]
fn networks_become_nets_of_few_points() {
    // Control points of an independent builder that misses the same nets by 1e-4 to 9e-4 of the size.
    let others = [(22, 61), (54, 25), (16, 17), (76, 20), (81, 64), (87, 78)];
    for ((name, gap), other) in NETWORKS.into_iter().zip(others) {
        let (surface, size) = as_given(name, gap, 1.0);
        let form = surface.to_net(&Tolerance::new(3e-7 * size, size)).unwrap().unwrap();
        let (nu, nv) = form.net.counts;
        let Off::Bounded(bound) = form.off else { panic!("{name}: {:?}", form.off) };
        let found = off(&surface, &form, size);
        assert!(found <= 1e-7 && found <= bound / size && bound <= 3e-7 * size, "{name}: {found:e} of the size, {bound:e}");
        assert!(nu <= 4 * other.0 && nv <= 4 * other.1, "{name}: {nu} × {nv}");
    }
}
