//! What changed between two models, two goldens, or a model and a golden: the same lines, the same words as `loft test`.

use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;

use super::compare::{Allowance, compare};
use super::describe::{self, DiffLine};
use super::details::{self, Details};
use super::file::{Golden, TOLERANCE};
use super::geometry::{self, Shape};
use super::line::Line;
use super::section;
use super::values::Value;
use crate::base::job::Job;
use crate::base::limits;
use crate::mesh::Mesh;
use crate::session::disk::{Disk, Outputs, read_limited};
use crate::session::guard::{Bug, guarded};
use crate::session::run::{self, Task};

/// One of the two things compared.
#[derive(Debug, Default)]
struct Side {
    cases: Vec<ComparedCase>,
    tolerance: f64,
}

/// A case with its lines.
#[derive(Debug, Default)]
struct ComparedCase {
    name: Option<String>,
    lines: Vec<Line>,
    /// Names that the script uses; none of a golden.
    names: BTreeSet<String>,
    /// Diagonal of the model's box, model units.
    size: f64,
    units: String,
    meshes: Vec<(String, Arc<Mesh>)>,
}

/// What differs in one case.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// The case; `None` for models as written.
    pub case: Option<String>,
    /// What differs.
    pub lines: Vec<DiffLine>,
}

/// Why nothing was compared.
#[derive(Clone, Debug, PartialEq)]
pub enum NoDiff {
    /// A file cannot be read, or its run was ended for its work; a sentence.
    Unreadable(String),
    /// A bug in loft.
    Bug(Bug),
    /// Stopped from outside.
    Interrupted,
}

/// What differs between two files, `.loft` or `.golden` each; empty when nothing does.
///
/// The tolerance is that of the first golden, else 1e-9.
pub fn diff(old: &Path, new: &Path, clock: &(dyn Fn() -> f64 + Sync), job: &Job) -> Result<Vec<Difference>, NoDiff> {
    let (a, b) = (side(old, clock, job)?, side(new, clock, job)?);
    let tolerance = if a.tolerance > 0.0 || old.extension().is_some_and(|e| e == "golden") { a.tolerance } else { b.tolerance };
    let mut found = Vec::new();
    let words = |text: &str| vec![DiffLine::Words(text.to_owned())];
    for case in &a.cases {
        let lines = match b.cases.iter().find(|other| other.name == case.name) {
            Some(other) => between(case, other, tolerance),
            None => words("this case is gone"),
        };
        found.push(Difference { case: case.name.clone(), lines });
    }
    for case in b.cases.iter().filter(|case| !a.cases.iter().any(|other| other.name == case.name)) {
        found.push(Difference { case: case.name.clone(), lines: words("this case is new") });
    }
    found.retain(|difference| !difference.lines.is_empty());
    Ok(found)
}

fn between(old: &ComparedCase, new: &ComparedCase, tolerance: f64) -> Vec<DiffLine> {
    let size = if new.size > 0.0 { new.size } else { old.size };
    let allowance = Allowance { tolerance, size };
    let mut lines = describe::changes(&compare(&old.lines, &new.lines, &new.names, allowance), allowance);
    if old.units == new.units {
        for (name, mesh) in &new.meshes {
            let Some((_, before)) = old.meshes.iter().find(|(other, _)| other == name) else { continue };
            let moved = geometry::differs(&Shape::from_mesh(before), &Shape::from_mesh(mesh), tolerance * size, &new.units);
            lines.extend(moved.map(|text| DiffLine::Words(format!("mesh {}: {text}", super::quotes::label(name)))));
        }
    }
    lines
}

fn side(path: &Path, clock: &(dyn Fn() -> f64 + Sync), job: &Job) -> Result<Side, NoDiff> {
    let unreadable = |what: String| NoDiff::Unreadable(format!("{}: {what}", path.display()));
    let bytes = read_limited(path, limits::SOURCE_BYTES + 1).map_err(|error| unreadable(super::run::why_unreadable(&error)))?;
    match path.extension().and_then(|e| e.to_str()) {
        Some("golden") => golden(&bytes).map_err(|text| NoDiff::Unreadable(format!("{}:{text}", path.display()))),
        Some("loft") => model(path, &bytes, clock, job),
        _ => Err(unreadable("it is neither a script (.loft) nor a golden file".to_owned())),
    }
}

/// The sections of a golden; the error is a line number and a sentence.
fn golden(bytes: &[u8]) -> Result<Side, String> {
    let (golden, flaws) = Golden::parse(bytes).unwrap_or_else(|flaws| (Golden::default(), flaws));
    if let Some(flaw) = flaws.first() {
        return Err(format!("{}: {}", flaw.line, flaw.what));
    }
    let tolerance = golden.head.tolerance();
    let case = |section: super::file::Section| {
        let lines: Vec<Line> = section.entries.into_iter().map(|entry| entry.line).collect();
        ComparedCase { name: section.case, size: size_of(&lines), lines, ..ComparedCase::default() }
    };
    let mut cases: Vec<ComparedCase> = golden.sections.into_iter().map(case).collect();
    if cases.is_empty() {
        cases.push(ComparedCase::default());
    }
    Ok(Side { cases, tolerance })
}

/// The diagonal of all boxes that stand in a golden; without any, its longest curve.
pub(super) fn size_of(lines: &[Line]) -> f64 {
    let boxes = lines.iter().filter_map(|line| match line.get("box") {
        Some(Value::Corners(corners, _)) => Some(corners.map(glam::DVec3::from)),
        _ => None,
    });
    let bounds = crate::base::bbox::Box3::of(boxes.flatten());
    let length = |line: &Line| match line.get("length") {
        Some(Value::Real(length, _)) => Some(*length),
        _ => None,
    };
    if bounds.is_empty() { lines.iter().filter_map(length).fold(0.0, f64::max) } else { bounds.diagonal() }
}

fn model(path: &Path, text: &[u8], clock: &(dyn Fn() -> f64 + Sync), job: &Job) -> Result<Side, NoDiff> {
    let disk = Disk::new(Some(path), None, &[], Outputs::Counted);
    let disk = disk.map_err(|error| NoDiff::Unreadable(format!("{}: {error}", path.display())))?.seen_from_home();
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let task = Task { full: true, ..Task::new(&name, text, &[], clock) };
    let mut details = Details::default();
    let outcome = guarded(|| run::run_seen(&task, &disk, job, &mut |cx| details = details::of(cx))).map_err(NoDiff::Bug)?;
    if outcome.interrupted {
        return Err(NoDiff::Interrupted);
    }
    if let Some(over) = outcome.over {
        return Err(NoDiff::Unreadable(format!("{}: {over}", path.display())));
    }
    let found = section::of(&outcome, details, "");
    let case = ComparedCase {
        name: None,
        lines: found.lines,
        names: found.names,
        size: found.size,
        units: outcome.report.units,
        meshes: outcome.meshes,
    };
    Ok(Side { cases: vec![case], tolerance: TOLERANCE })
}
