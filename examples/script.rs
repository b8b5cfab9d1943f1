//! A script run from memory, with the table that it imports and a param that is set: `cargo run --example script`.

#![allow(clippy::print_stdout, reason = "an example shows what it made")]

use lofting::{Error, Script};

const HALL: &str = r#"
units m
param height = 4m in 2m to 10m
import "frames.csv" (header: true) as frames

curve frame for f in frames = arc((-f.half, f.y, 0m), (f.half, f.y, 0m), through: (0m, f.y, height))
surface hall = skin(frame)
mesh net of hall { elements: quads, size: 1m }
check "within a per cent": net.area == hall.area within 1%
export net to "hall.msh"
export frame to "frames.svg"
"#;

const FRAMES: &str = "y [m],half [m]\n0,6\n8,7\n16,7\n24,5\n";

fn main() -> Result<(), Error> {
    let script = Script::from_str(HALL).named("hall.loft").file("frames.csv", FRAMES);
    for height in ["3m", "5m"] {
        let model = script.clone().set("height", height).run()?;
        println!("height {height}: area {:.3} m2", model.surface("hall").map_or(0.0, |hall| hall.area()));
        model.meshes().iter().for_each(|mesh| println!("  {}: {} quads", mesh.name(), mesh.quads().len()));
        model.checks().iter().for_each(|check| println!("  {}: {}", check.label, check.pass));
        model.outputs().iter().for_each(|output| println!("  {}: {} bytes", output.path(), output.size()));
    }
    // A mistake has a code and a place; nothing is made of such a script.
    let error = script.set("height", "12m").run().err();
    println!("{}", error.map_or_else(String::new, |error| error.to_string()));
    Ok(())
}
