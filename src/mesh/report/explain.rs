//! How a mesh came about, for `-v` and `explain`.

use crate::base::origin::Origin;
use crate::mesh::border::layout::Layout;
use crate::mesh::data::face_geometry::FaceNodes;
use crate::mesh::data::face_mesh::FaceMesh;
use crate::mesh::report::reasons;
use crate::mesh::request::input::Input;
use crate::mesh::request::methods::Method;
use crate::mesh::size::sizing::Sizing;
use crate::model::SurfaceId;

/// What was chosen for a face.
#[derive(Clone, Debug, PartialEq)]
pub struct FaceNote {
    /// The surface.
    pub surface: SurfaceId,
    /// Patch of the surface, from 0.
    pub patch: usize,
    /// Method.
    pub method: &'static str,
    /// Kind of elements.
    pub elements: &'static str,
    /// Steps along the sides (a side with several segments: their sum; a pole: 0).
    pub sides: Vec<u32>,
}

/// Who decided a count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Because {
    /// A written count.
    Count(Origin),
    /// The size of a rule, or of a `near` or `in` clause.
    RuleSize(Origin),
    /// A spacing: sizes that vary along it.
    Varies,
    /// The size of the mesh.
    Size,
    /// Chord error or angle, or the shape of a face.
    Limit,
    /// Other segments of the strip, or the faces beside it.
    Neighbours,
}

/// The count of one segment of a border or curve.
#[derive(Clone, Debug, PartialEq)]
pub struct StretchNote {
    /// Stretches with the same number form one strip.
    pub strip: usize,
    /// Steps.
    pub count: u32,
    /// Arc length, model units.
    pub length: f64,
    /// First and last point.
    pub ends: [glam::DVec3; 2],
    /// Last step over first step.
    pub bias: f64,
    /// Who decided.
    pub because: Because,
}

/// How a mesh came about.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Explanation {
    /// One a face.
    pub faces: Vec<FaceNote>,
    /// One a segment.
    pub segments: Vec<StretchNote>,
    /// The same in words, one line a face and one a strip.
    pub lines: Vec<String>,
}

impl Explanation {
    /// Adds another part's notes.
    pub fn append(&mut self, other: &mut Self) {
        let strips = self.segments.iter().map(|s| s.strip + 1).max().unwrap_or(0);
        other.segments.iter_mut().for_each(|s| s.strip += strips);
        self.faces.append(&mut other.faces);
        self.segments.append(&mut other.segments);
        self.lines.append(&mut other.lines);
    }

    /// Of one set of faces with their counts.
    pub fn new(input: &Input, layout: &Layout, sizing: &Sizing, prepared: &[FaceMesh], counts: &[u32], strip: &[usize]) -> Self {
        let mut notes = Self::default();
        for (face, ready) in layout.faces.iter().zip(prepared) {
            let first = input.model.patches_of(face.surface).next().map_or(0, |p| p.index());
            let sides = match &ready.geometry.nodes {
                FaceNodes::Grid(_, frame) => {
                    let steps = |k: usize| if frame.poles[k] { 0 } else { frame.sides[k].len() as u32 - 1 };
                    (0..4).map(steps).collect()
                }
                _ => face.sides.iter().map(|s| s.uses.iter().map(|u| counts[u.segment]).sum()).collect(),
            };
            notes.faces.push(FaceNote {
                surface: face.surface,
                patch: face.patch.index() - first,
                method: match &ready.geometry.nodes {
                    FaceNodes::Free(..) if face.method == Method::Quadtree => "quadtree",
                    FaceNodes::Free(..) if face.method == Method::Display => "display",
                    FaceNodes::Free(..) if face.method == Method::Isoline => "isoline",
                    FaceNodes::Free(..) => "delaunay",
                    _ => "mapped",
                },
                elements: ready.elements.word(),
                sides,
            });
        }
        let first = input.plan.rules.len();
        let rule = |r: usize| input.plan.rules.get(r).map_or_else(|| input.plan.refines[r - first].origin, |rule| rule.origin);
        for (k, d) in sizing.decisions.iter().enumerate() {
            let because = match (d.count, d.size.1) {
                (Some((_, r)), _) => Because::Count(rule(r)),
                _ if d.demand != counts[k] => Because::Neighbours,
                _ if sizing.spacings[k].is_some() => Because::Varies,
                _ if d.unrounded == d.least && d.unrounded > 1 => Because::Limit,
                (None, Some(r)) => Because::RuleSize(rule(r)),
                _ => Because::Size,
            };
            let ends = layout.pieces.segments[k].ends;
            notes.segments.push(StretchNote {
                strip: strip[k],
                count: counts[k],
                length: layout.length(k),
                ends: [layout.pieces.junctions[ends.0], layout.pieces.junctions[ends.1]],
                bias: d.bias,
                because,
            });
        }
        notes.lines = notes.words(input, layout, sizing, prepared);
        notes
    }

    /// Who decided the count of a segment, in words that follow "by".
    pub fn reason(&self, input: &Input, sizing: &Sizing, segment: usize) -> String {
        let decision = &sizing.decisions[segment];
        match (self.segments[segment].because, decision.count, decision.size.1) {
            (Because::Count(_), Some((_, clause)), _) | (Because::RuleSize(_), _, Some(clause)) => reasons::clause(input, clause),
            (Because::Count(_) | Because::RuleSize(_), ..) => "a rule".to_owned(),
            (Because::Varies, ..) => "sizes along it".to_owned(),
            (Because::Limit, ..) => "chord_error, angle_error or the shape".to_owned(),
            (Because::Size, ..) => "the size".to_owned(),
            (Because::Neighbours, ..) => "the rows or faces beside it".to_owned(),
        }
    }

    fn words(&self, input: &Input, layout: &Layout, sizing: &Sizing, prepared: &[FaceMesh]) -> Vec<String> {
        let face = |(k, f): (usize, &FaceNote)| {
            let sides: Vec<String> = f.sides.iter().map(|n| if *n == 0 { "pole".to_owned() } else { n.to_string() }).collect();
            let name = &input.model.surfaces[f.surface.index()].name;
            let face = &layout.faces[k];
            let foreseen = face.foreseen.filter(|_| face.method == Method::Auto);
            let told = foreseen.map_or_else(String::new, |angle| format!(" (angles of {}° foreseen)", angle.to_degrees().round()));
            let why = face.why.as_ref().map_or(told, |why| format!(" (a face {why})"));
            let size = face.size.1.map_or_else(String::new, |clause| format!("; by {}", reasons::clause(input, clause)));
            let inside = prepared[k].inside.as_ref().map_or_else(String::new, |inside| {
                reasons::of_face(input, &inside.decided.deciders) + &inside.tally.map_or_else(String::new, reasons::of_cells)
            });
            format!("face {} of {name}: {}{why}, {}, sides {}{size}{inside}", f.patch, f.method, f.elements, sides.join(" "))
        };
        let mut lines: Vec<String> = self.faces.iter().enumerate().map(face).collect();
        let mut order: Vec<usize> = (0..self.segments.len()).collect();
        order.sort_by_key(|k| (self.segments[*k].strip, *k));
        for strip in order.chunk_by(|a, b| self.segments[*a].strip == self.segments[*b].strip) {
            let mut names: Vec<String> = strip.iter().map(|k| layout.name_of(input, *k)).collect();
            names.dedup();
            let ranked = |k: &&usize| match self.segments[**k].because {
                Because::Count(_) => 0,
                Because::RuleSize(_) => 1,
                Because::Varies => 2,
                Because::Limit => 3,
                Because::Size => 4,
                Because::Neighbours => 5,
            };
            let Some(first) = strip.iter().min_by_key(ranked) else { continue };
            let decision = &sizing.decisions[*first];
            let why = self.reason(input, sizing, *first);
            let spacing = sizing.spacings[*first].as_ref().map_or_else(String::new, |spacing| reasons::of_spacing(input, spacing));
            let raised = decision.count.is_none() && decision.unrounded < decision.demand && decision.demand == self.segments[*first].count;
            let ring = if raised { reasons::of_ring(decision.unrounded) } else { String::new() };
            lines.push(format!(
                "strip of {}: {} steps, by {why} (on {}){ring}{spacing}",
                names.join(", "),
                self.segments[*first].count,
                layout.name_of(input, *first)
            ));
        }
        lines
    }
}
