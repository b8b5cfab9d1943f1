//! E217 where the lengths wanted inside a free face come to more elements than a mesh may have, before its border is divided.

use crate::base::fault::Result;
use crate::base::job::Job;
use crate::mesh::border::layout::Layout;
use crate::mesh::border::nodes::Nodes;
use crate::mesh::chart::face_input::FaceInput;
use crate::mesh::request::input::Input;
use crate::mesh::request::work::too_many;
use crate::mesh::size::sizing::Sizing;
use crate::mesh::size::too_large::of_size;
use crate::mesh::tri::triangle_fit::elements_ahead;

/// E217 where the wanted lengths demand more elements inside a free face than a mesh may have. The estimate adds up the lengths over a
/// triangulation of the coarsely divided border, before the border itself is divided.
pub fn refuse_large(input: &Input, layout: &Layout, sizing: &Sizing, job: &Job) -> Result<()> {
    for face in layout.faces.iter().filter(|face| face.free) {
        let surface = &input.model.surfaces[face.surface.index()].surface;
        let least = face.size.0.min(sizing.wanted.sources.least()).max(sizing.wanted.written);
        let across = surface.hull().diagonal() / least;
        let most = input.plan.most_elements as f64;
        if across * across < SMALL_FACE_SHARE * most {
            continue;
        }
        for coarse in COARSE_STEPS {
            job.go_on()?;
            let counts: Vec<u32> = sizing.decisions.iter().map(|d| d.count.map_or(d.demand, |c| c.0).min(coarse)).collect();
            let nodes = Nodes::new(layout, &counts, |segment, count| sizing.fractions(segment, count));
            let points = nodes.points(layout, &input.plan.points);
            let face_input = FaceInput { input, layout, nodes: &nodes, points: &points, wanted: &sizing.wanted, sliding: &[] };
            let Some([elements, by_size]) = elements_ahead(&face_input, face) else { continue };
            if elements > most {
                let refines = input.plan.refines.iter().map(|r| r.size).min_by(|a, b| a.0.total_cmp(&b.0));
                let refined = refines.filter(|_| by_size <= most).map(|size| size.1);
                return Err(too_many(input.plan, refined.unwrap_or_else(|| of_size(input, face.size.1)), Some(elements as u64)));
            }
            break;
        }
    }
    Ok(())
}

/// Largest number of steps of each segment for the estimate: the next one where borders so coarse cross.
const COARSE_STEPS: [u32; 3] = [32, 512, 8192];

/// Share of the largest mesh up to which the estimate by the box of a face suffices.
const SMALL_FACE_SHARE: f64 = 0.1;
