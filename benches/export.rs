//! Writing a mesh of a million triangles (501 501 nodes): `cargo bench --bench export`.
//!
//! `cargo bench --bench export -- --once DIR` writes each file once into DIR and prints CPU seconds, as the peers'
//! script `benches/peers/p7_export.py` does.

#![allow(clippy::print_stdout)]

use std::fs::File;
use std::io::{self, Write};
use std::path::Path;

use criterion::{Criterion, Throughput};
use glam::DVec3;
use lofting::io::formats::choice::format_for;
use lofting::io::mesh_files::deck::{Deck, Encoding, Options};
use lofting::io::mesh_files::format::Format;
use lofting::mesh::{FaceRange, Group, Mesh};

const CELLS: (u32, u32) = (1000, 500);

/// The wavy sheet of the peers' script, as one surface.
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
    for half in 0..2 {
        for (i, j) in (0..nx).flat_map(|i| (0..ny).map(move |j| (i, j))) {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            mesh.triangles.push(if half == 0 { [a, b, c] } else { [a, c, d] });
        }
    }
    let n = mesh.triangles.len() as u32;
    mesh.faces = vec![FaceRange { name: "sheet".into(), triangles: 0..n, quads: 0..0, lines: 0..0 }];
    mesh.groups = vec![Group {
        name: "sheet".into(),
        nodes: (0..mesh.nodes.len() as u32).collect(),
        triangles: (0..n).collect(),
        ..Group::default()
    }];
    mesh
}

const KINDS: &[(&str, Encoding)] = &[
    ("stl", Encoding::Binary),
    ("stl", Encoding::Text),
    ("obj", Encoding::Text),
    ("ply", Encoding::Binary),
    ("vtu", Encoding::Binary),
    ("vtu", Encoding::Text),
    ("msh", Encoding::Binary),
    ("msh", Encoding::Text),
    ("inp", Encoding::Text),
    ("bdf", Encoding::Text),
];

fn write(format: &Format, mesh: &Mesh, encoding: Encoding, out: &mut dyn Write) -> io::Result<()> {
    let options = Options { encoding: Some(encoding), ..Options::default() };
    (format.write)(&Deck { mesh, unit: "mm", options: &options }, out).map(|_| ())
}

fn format(name: &str) -> &'static Format {
    format_for(lofting::base::origin::Origin::NONE, &format!("x.{name}")).expect("the name is in the table above")
}

/// User and system seconds of this process.
fn cpu_seconds() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields: Vec<&str> = stat.rsplit(')').next().unwrap_or("").split_whitespace().collect();
    let ticks = |k: usize| fields.get(k).and_then(|field| field.parse::<f64>().ok()).unwrap_or(0.0);
    (ticks(11) + ticks(12)) / 100.0
}

fn once(mesh: &Mesh, folder: &Path) -> io::Result<()> {
    for (name, encoding) in KINDS {
        // The clock of the system ticks in hundredths: write several times.
        const ROUNDS: u32 = 10;
        let path = folder.join(format!("p7_loft.{name}"));
        let (start, clock) = (cpu_seconds(), std::time::Instant::now());
        for _ in 0..ROUNDS {
            write(format(name), mesh, *encoding, &mut File::create(&path)?)?;
        }
        let (cpu, wall) = ((cpu_seconds() - start) / f64::from(ROUNDS), clock.elapsed().as_secs_f64() / f64::from(ROUNDS));
        let size = std::fs::metadata(&path)?.len() as f64 / 1e6;
        std::fs::remove_file(&path)?;
        println!(
            "{{\"problem\": \"P7\", \"kind\": \"{name} {encoding:?}\", \"cpu\": {cpu:.3}, \"wall\": {wall:.3}, \"size_mb\": {size:.1}}}"
        );
    }
    Ok(())
}

fn main() -> io::Result<()> {
    let mesh = sheet();
    let arguments: Vec<String> = std::env::args().collect();
    if let Some(k) = arguments.iter().position(|argument| argument == "--once") {
        return once(&mesh, Path::new(arguments.get(k + 1).map_or(".", String::as_str)));
    }
    let mut criterion = Criterion::default().configure_from_args().sample_size(10);
    let mut group = criterion.benchmark_group("export 1M triangles");
    for (name, encoding) in KINDS {
        let mut size = Vec::new();
        write(format(name), &mesh, *encoding, &mut size)?;
        group.throughput(Throughput::Bytes(size.len() as u64));
        group.bench_function(format!("{name} {encoding:?}"), |bencher| {
            bencher.iter(|| write(format(name), &mesh, *encoding, &mut io::sink()))
        });
    }
    group.finish();
    criterion.final_summary();
    Ok(())
}
