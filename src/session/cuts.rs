//! Curves of a mesh that follow a line of constant u or v of one of its faces: the face is cut there, so that the curve
//! lies on mesh lines.

use crate::base::fault::Fault;
use crate::base::job::Job;
use crate::base::tolerance::Tolerance;
use crate::lang::eval::scene::Scene;
use crate::mesh::Plan;
use crate::mesh::request::plan::Target;
use crate::model::carry::Stage;
use crate::model::{Lines, Model, PatchId, SurfaceId};
use crate::network::Chain;
use crate::surface::{Domain, IsoLine, Nearest, Surface, chain_breaks};

/// Samples of a curve between its breaks.
const EACH: usize = 24;

/// The scene with its faces cut along the curves of a plan that follow their lines; the rules of the plan speak of the pieces.
pub fn along_curves(scene: Scene, plan: &mut Plan, tolerance: &Tolerance, job: &Job) -> Result<Scene, Fault> {
    let mut cuts: Vec<(SurfaceId, Lines)> = Vec::new();
    for (id, _) in &plan.surfaces {
        let surface = &scene.model.surfaces[id.index()].surface;
        if surface.domain() != Domain::Square || cuts.iter().any(|c| c.0 == *id) {
            continue;
        }
        let mut lines = Lines::default();
        for (_, chain) in &plan.curves {
            match followed(surface, chain, tolerance) {
                Some(IsoLine::U(u)) => lines.u.push(u),
                Some(IsoLine::V(v)) => lines.v.push(v),
                None => {}
            }
        }
        if !(lines.u.is_empty() && lines.v.is_empty()) {
            cuts.push((*id, lines));
        }
    }
    if cuts.is_empty() {
        return Ok(scene);
    }
    let model = Model::build_cut(scene.model.surfaces.clone(), &cuts, &scene.network, tolerance, job)?;
    let cut = Scene { model: model.into(), network: scene.network.clone() };
    let rules = plan.rules.iter_mut().map(|rule| &mut rule.target);
    for target in rules.chain(plan.groups.iter_mut().flat_map(|group| &mut group.members)) {
        match target {
            Target::Patches(patches) => *patches = patches.iter().flat_map(|p| pieces(&scene.model, &cut.model, *p)).collect(),
            Target::Edge(courses) => {
                let stage = Stage { model: &cut.model, network: &cut.network };
                *courses = scene.model.carried(&scene.network, courses, stage, &Some);
            }
            Target::Chain(_) | Target::Surface(_) | Target::Point(_) => {}
        }
    }
    Ok(cut)
}

/// The line of a surface that a curve follows, inside it: the curve lies on the surface and one parameter stays.
fn followed(surface: &Surface, chain: &Chain, tolerance: &Tolerance) -> Option<IsoLine> {
    if !chain.bbox().touches(&surface.hull(), tolerance.point) {
        return None;
    }
    let nearest = Nearest::new(surface);
    let stops = [vec![0.0], chain_breaks(chain), vec![1.0]].concat();
    let cell = |w: &[f64]| -> Vec<f64> { (0..EACH).map(|k| w[0] + (w[1] - w[0]) * k as f64 / EACH as f64).collect() };
    // The middle comes first: most curves lie elsewhere.
    let fractions = [0.5, 1.0].into_iter().chain(stops.windows(2).flat_map(cell));
    let mut points = Vec::new();
    for f in fractions {
        let p = chain.point(f);
        let foot = nearest.at(p);
        if foot.distance > tolerance.point {
            return None;
        }
        points.push((p, foot.uv));
    }
    let mid = points[0].1;
    let stays = |line: IsoLine| {
        let on = |(p, uv): &(glam::DVec3, (f64, f64))| {
            let (u, v) = if matches!(line, IsoLine::U(_)) { line.at(uv.1) } else { line.at(uv.0) };
            surface.point(u, v).distance(*p) <= tolerance.point
        };
        points.iter().all(on)
    };
    let inside = |x: f64| x > tolerance.parameter && x < 1.0 - tolerance.parameter;
    [(IsoLine::U(mid.0), mid.0), (IsoLine::V(mid.1), mid.1)].into_iter().find(|(line, x)| inside(*x) && stays(*line)).map(|l| l.0)
}

/// The patches that a patch became.
fn pieces(old: &Model, new: &Model, patch: PatchId) -> Vec<PatchId> {
    let whole = &old.patches[patch.index()];
    let inside = |x: (f64, f64), range: (f64, f64)| range.0 <= 0.5 * (x.0 + x.1) && 0.5 * (x.0 + x.1) <= range.1;
    let of_surface = new.patches_of(whole.surface);
    of_surface.filter(|p| inside(new.patches[p.index()].u, whole.u) && inside(new.patches[p.index()].v, whole.v)).collect()
}
