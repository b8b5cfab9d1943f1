//! A Coons roof between two arches, meshed with quads and written for a solver: `cargo run --example roof`.

#![allow(clippy::print_stdout, reason = "an example shows what it made")]

use lofting::{Curve, Elements, Error, MeshPlan, Model, Surface, Tolerance};

fn main() -> Result<(), Error> {
    let tolerance = Tolerance::new(1e-5, 60.0);
    let south = Curve::arc((-16.0, 0.0, 19.0), (16.0, 0.0, 19.0), (0.0, 0.0, 25.0))?.named("south");
    let north = south.moved((0.0, 50.0, 0.0))?.named("north");
    let west = Curve::line(south.start(), north.start())?.named("west");
    let east = Curve::line(south.end(), north.end())?.named("east");
    let roof = Surface::coons([&south, &east, &north, &west], &tolerance)?.named("roof");
    let model = Model::new([], [&roof], &tolerance)?.with_unit("m")?;
    let plan = MeshPlan::new("roof").elements(Elements::Quads).chord_error(0.02).count("west", 24).group("eaves", ["west", "east"]);
    let mesh = plan.mesh(&model)?;
    mesh.write(std::env::temp_dir().join("roof.inp"))?;
    println!(
        "{} nodes, {} quads, {} nodes on the eaves",
        mesh.nodes().len(),
        mesh.quads().len(),
        mesh.group("eaves").map_or(0, |g| g.nodes.len())
    );
    println!("area {:.3} m2 of {:.3} m2", mesh.quality().map_or(0.0, |quality| quality.area), roof.area());
    Ok(())
}
