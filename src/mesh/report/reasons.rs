//! Who decided what, in words: clauses by what they say, so that the words do not depend on where they stand in a script.

use glam::DVec3;

use crate::base::text::real;
use crate::mesh::request::decider::{Decider, Tally, Why};
use crate::mesh::request::input::Input;
use crate::mesh::request::plan::{Place, Target};
use crate::mesh::size::border_spacing::BorderSpacing;
use crate::mesh::size::sizing::STEPS_OF_RING;
use crate::model::{Course, EdgePart};
use crate::network::Chain;

/// A place as far as the tolerance tells it, model units.
pub fn point(input: &Input, p: DVec3) -> String {
    let p = input.tolerance.rounded(p);
    format!("({}, {}, {})", real(p.x), real(p.y), real(p.z))
}

/// A clause by its number: rules first, then `near` and `in`.
pub fn clause(input: &Input, number: usize) -> String {
    match number.checked_sub(input.plan.rules.len()) {
        Some(refine) => refined(input, refine),
        None => {
            let rule = &input.plan.rules[number];
            let what = match (&rule.settings.count, &rule.settings.size) {
                (Some((count, _)), _) => format!("count {count}"),
                (None, Some((size, _))) => format!("size {}", real(*size)),
                _ => "settings".to_owned(),
            };
            format!("{what} on {}", target(input, &rule.target))
        }
    }
}

fn target(input: &Input, target: &Target) -> String {
    let surface = |id: crate::model::SurfaceId| input.model.surfaces[id.index()].name.clone();
    match target {
        Target::Chain(chain) => curve(input, chain),
        Target::Edge(courses) => edge(input, courses),
        Target::Surface(id) => surface(*id),
        Target::Patches(all) => {
            all.first().map_or_else(|| "no face".to_owned(), |p| format!("a face of {}", surface(input.model.patches[p.index()].surface)))
        }
        Target::Point(p) => point(input, *p),
    }
}

/// An edge by the surface whose border it is.
fn edge(input: &Input, courses: &[Course]) -> String {
    let part = courses.iter().flatten().next();
    let of = |part: &EdgePart| input.model.edges[part.edge.index()].users.first().copied();
    let surface = part.and_then(of).map(|(patch, _)| input.model.patches[patch.index()].surface);
    match (part, surface) {
        (Some(part), Some(surface)) => {
            let at = input.model.track(part.edge, input.network).point(0.5 * (part.s.0 + part.s.1));
            format!("an edge of {} at {}", input.model.surfaces[surface.index()].name, point(input, at))
        }
        _ => "an edge".to_owned(),
    }
}

fn curve(input: &Input, chain: &Chain) -> String {
    let links = input.network.links_of(chain, input.tolerance).unwrap_or_default();
    let name = links.first().map(|(link, _)| {
        let curve = input.network.links[link.index()].curve;
        input.network.curves[curve.index()].name.clone()
    });
    name.filter(|n| !n.is_empty()).unwrap_or_else(|| format!("a curve at {}", point(input, chain.point(0.5))))
}

fn refined(input: &Input, k: usize) -> String {
    let refine = &input.plan.refines[k];
    let place = match refine.at.as_slice() {
        [Place::Point(p)] => format!("near {}", point(input, *p)),
        [Place::Chain(chain)] => format!("near {}", curve(input, chain)),
        [Place::Box(b)] => format!("in the box {} to {}", point(input, b.min), point(input, b.max)),
        [Place::Box(b), ..] => format!("in boxes from {} on", point(input, b.min)),
        all => format!("near {} places", all.len()),
    };
    format!("size {} {place}", real(refine.size.0))
}

/// A cause in words that follow "by".
pub fn cause(input: &Input, why: Why) -> String {
    match why {
        Why::Size => "the size".to_owned(),
        Why::Refined(k) => refined(input, k),
        Why::Bends => match (input.plan.settings.chord_error, input.plan.settings.angle_error) {
            (Some(_), Some(_)) => "chord_error or angle_error".to_owned(),
            (None, Some(_)) => "angle_error".to_owned(),
            _ => "chord_error".to_owned(),
        },
        Why::Border => "growth from shorter edges".to_owned(),
        Why::Gap => "the border facing it".to_owned(),
        Why::Floor => "min_size".to_owned(),
    }
}

/// "; lengths of 0.05 to 0.9 asked for: 80 % by size 0.05 near (5, 3, 0), 20 % by the size" of a segment whose steps vary; a limit or a
/// written count may make the steps themselves shorter.
pub fn of_spacing(input: &Input, spacing: &BorderSpacing) -> String {
    let part = |(why, share): (Why, f64)| format!("{:.0} % by {}", 100.0 * share, cause(input, why));
    let parts: Vec<String> = spacing.shares().into_iter().map(part).collect();
    format!("; lengths of {:.3} to {:.3} asked for: {}", spacing.least(), spacing.most(), parts.join(", "))
}

/// "; raised from 14 to a multiple of 4, …" of a closed curve round or in a plane face of quads.
pub fn of_ring(demand: u32) -> String {
    format!("; raised from {demand} to a multiple of {STEPS_OF_RING}, with which the rows of a plane face of quads go round it")
}

/// "; 40 cells, 12 crossed by borders, marks 0 1 2 right at 30 of 31 corners" of a face between lines of constant u and v.
pub fn of_cells(tally: Tally) -> String {
    let cells = format!("; {} cells, {} crossed by borders", tally.whole + tally.crossed, tally.crossed);
    if tally.corners == 0 { cells } else { format!("{cells}, marks 0 1 2 right at {} of {} corners", tally.agree, tally.corners) }
}

/// "; inside 300 nodes: 40 by the size, 260 by size 0.05 near (5, 3, 0), one at (…)" of a free face.
pub fn of_face(input: &Input, deciders: &[Decider]) -> String {
    let total: usize = deciders.iter().map(|d| d.nodes).sum();
    let part = |d: &Decider| match d.why {
        Why::Size => format!("{} by the size", d.nodes),
        why => format!("{} by {}, one at {}", d.nodes, cause(input, why), point(input, d.at)),
    };
    let parts: Vec<String> = deciders.iter().filter(|d| d.nodes > 0).map(part).collect();
    if parts.is_empty() { String::new() } else { format!("; {total} nodes inside: {}", parts.join(", ")) }
}
