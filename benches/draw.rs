//! A picture of a million triangles: `cargo bench --bench draw`.
//!
//! `cargo bench --bench draw -- --once` draws it once as PNG and once as SVG and prints the seconds.

#![allow(clippy::print_stdout, clippy::unwrap_used)]

use std::collections::BTreeSet;
use std::time::Instant;

use criterion::{Criterion, Throughput};
use glam::DVec3;
use lofting::draw::lines::Folds;
use lofting::draw::meshes::{self, Measure};
use lofting::draw::{Format, Picture, Scene, Settings, View};
use lofting::mesh::{FaceRange, Mesh};

const CELLS: (u32, u32) = (1000, 500);

/// A wavy sheet as one surface.
fn sheet() -> Mesh {
    let (nx, ny) = CELLS;
    let mut mesh = Mesh { name: "sheet".into(), order: 1, ..Mesh::default() };
    for i in 0..=nx {
        for j in 0..=ny {
            let (x, y) = (f64::from(i) * 0.2, f64::from(j) * 0.2);
            mesh.nodes.push(DVec3::new(x, y, 5.0 * lofting::base::math::sin(x / 9.0) * lofting::base::math::cos(y / 7.0)));
        }
    }
    let at = |i: u32, j: u32| i * (ny + 1) + j;
    for (i, j) in (0..nx).flat_map(|i| (0..ny).map(move |j| (i, j))) {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        mesh.triangles.extend([[a, b, c], [a, c, d]]);
    }
    let n = mesh.triangles.len() as u32;
    mesh.faces = vec![FaceRange { name: "sheet".into(), triangles: 0..n, quads: 0..0, lines: 0..0 }];
    mesh
}

/// From the mesh to the bytes of the file.
fn picture(mesh: &Mesh, format: Format) -> usize {
    let scene = Scene {
        sheets: vec![meshes::whole(mesh, Measure::Light)],
        lines: meshes::lines(mesh, &Folds::default(), &BTreeSet::new()),
        ..Scene::default()
    };
    let settings = Settings {
        view: View::named("isometric").unwrap(),
        width: 1200,
        height: 800,
        title: "a million triangles".into(),
        unit: "m".into(),
        edges: true,
        axes: true,
        ruler: true,
        legend: true,
    };
    let mut out = Vec::new();
    Picture::new(&scene, &settings, format).write(format, &mut out).unwrap();
    out.len()
}

fn main() {
    let mesh = sheet();
    if std::env::args().any(|a| a == "--once") {
        for (name, format) in [("png", Format::Png), ("svg", Format::Svg)] {
            let start = Instant::now();
            let bytes = picture(&mesh, format);
            println!("{name}: {:.3} s, {bytes} bytes", start.elapsed().as_secs_f64());
        }
        return;
    }
    let mut criterion = Criterion::default().configure_from_args().sample_size(10);
    let mut group = criterion.benchmark_group("draw");
    group.throughput(Throughput::Elements(mesh.triangles.len() as u64));
    group.bench_function("png_of_a_million_triangles", |b| b.iter(|| picture(&mesh, Format::Png)));
    group.finish();
    criterion.final_summary();
}
