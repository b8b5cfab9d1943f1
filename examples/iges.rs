//! The faces of an IGES file in one skin, meshed anew at several sizes: `cargo run --example iges`.

#![allow(clippy::print_stdout, reason = "an example shows what it made")]

use lofting::{Error, MeshPlan, Script};

fn main() -> Result<(), Error> {
    let data = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/data");
    let script = "units mm\nimport \"fuselage.igs\" as part\nshell hull of part.surfaces";
    let model = Script::from_str(script).folder(data).run()?;
    for size in [16.0, 8.0, 4.0] {
        let mesh = MeshPlan::new("hull").of(["hull"]).size(size).mesh(&model)?;
        let area = mesh.quality().map_or(0.0, |quality| quality.area);
        let closed = if mesh.is_watertight() { "watertight" } else { "open" };
        println!("size {size} mm: {} triangles, {closed}, area {area:.1} mm2", mesh.triangles().len());
        mesh.write(std::env::temp_dir().join("fuselage.stl"))?;
    }
    Ok(())
}
