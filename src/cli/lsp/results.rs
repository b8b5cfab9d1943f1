//! What the editor shows of an evaluated model: diagnostics, lenses, hovers and quick fixes.

use serde_json::{Value, json};

use super::document::Document;
use super::model::{Facts, Seen};
use crate::base::fault::Severity;
use crate::lang::assist::hover_text;
use crate::lang::diag::diagnostic::{Diagnostic, FileId, Sources};
use crate::lang::diag::span::Span;
use crate::lang::syntax::ast::Keyword;
use crate::lang::syntax::fixes::Change;
use crate::session::live::Depth;
use crate::session::report::MeshRow;

/// Lenses over one script.
const LENSES: usize = 500;

/// All that is said about a text.
pub fn diagnostics(facts: &Facts, document: &Document) -> Vec<Value> {
    let bug = facts.bug.iter().map(|words| {
        let start = document.range(Span::default());
        json!({ "range": start, "severity": 1, "code": "E999", "source": "loft", "message": words })
    });
    bug.chain(facts.diagnostics.iter().map(|d| row(d, document, &facts.sources))).collect()
}

/// A report as the editor takes it.
fn row(diagnostic: &Diagnostic, document: &Document, sources: &Sources) -> Value {
    let own = diagnostic.labels.iter().find(|l| l.file == FileId(0));
    let mut message = diagnostic.message.clone();
    if let Some(label) = own.filter(|l| !l.text.is_empty()) {
        message.push_str(&format!(": {}", label.text));
    }
    for (word, lines) in [("help", diagnostic.help.iter().collect::<Vec<_>>()), ("note", diagnostic.notes.iter().collect())] {
        lines.into_iter().for_each(|line| message.push_str(&format!("\n{word}: {line}")));
    }
    if diagnostic.more > 0 {
        message.push_str(&format!("\nand {} more like this one", diagnostic.more));
    }
    let related: Vec<Value> = diagnostic
        .labels
        .iter()
        .filter(|l| l.file == FileId(0) && Some(*l) != own)
        .map(|l| json!({ "location": { "uri": document.uri, "range": document.range(l.span) }, "message": l.text }))
        .collect();
    if own.is_none()
        && let Some(label) = diagnostic.labels.first()
    {
        let name = sources.get(label.file).map_or("", |f| &f.name);
        let line = sources.place(label.file, label.span.start).map_or(0, |p| p.line);
        message.push_str(&format!("\nin {name}, line {line}"));
    }
    let severity = match diagnostic.severity() {
        Severity::Error => 1,
        Severity::Warning => 2,
        Severity::Note => 3,
    };
    let span = own.map_or(Span::default(), |l| l.span);
    json!({
        "range": document.range(span), "severity": severity, "code": diagnostic.code.0, "source": "loft",
        "message": message, "relatedInformation": related,
    })
}

/// Lines over declarations: areas, qualities, and on top the checks.
pub fn lenses(facts: &Facts, document: &Document) -> Value {
    let mut titles: Vec<(Span, String)> = Vec::new();
    for (name, about) in &facts.names {
        match (about.keyword, facts.meshes.get(name)) {
            (Keyword::Surface | Keyword::Shell, _) => {
                titles.extend(about.line.split_once(": ").map(|(_, words)| (about.span, words.to_owned())));
            }
            (Keyword::Mesh, Some(row)) => titles.push((about.span, of_mesh(row))),
            _ => {}
        }
    }
    titles.sort_by_key(|(span, _)| *span);
    titles.truncate(LENSES);
    let (passed, all) = facts.checks;
    if all > 0 {
        let words = match (passed, all) {
            (1, 1) => "1 check passes".to_owned(),
            _ if passed == all => format!("{all} checks pass"),
            _ => format!("{passed} of {all} checks pass"),
        };
        titles.insert(0, (Span::default(), words));
    }
    let lens = |(span, title): (Span, String)| json!({ "range": document.range(span), "command": { "title": title, "command": "" } });
    titles.into_iter().map(lens).collect()
}

/// What a mesh has and how good it is: `441 nodes, 800 triangles, quality 0.93 (least 0.71), angles 38.1° to 92.4°`.
fn of_mesh(row: &MeshRow) -> String {
    let mut parts = Vec::new();
    for (n, one, many) in [(row.nodes, "node", "nodes"), (row.triangles, "triangle", "triangles"), (row.quads, "quad", "quads")] {
        match n {
            0 => {}
            1 => parts.push(format!("1 {one}")),
            n => parts.push(format!("{n} {many}")),
        }
    }
    if let (Some(mean), Some(least)) = (row.mean_quality, row.min_quality) {
        parts.push(format!("quality {mean:.2} (least {least:.2})"));
    }
    if let (Some(least), Some(most)) = (row.min_angle, row.max_angle) {
        parts.push(format!("angles {least:.1}° to {most:.1}°"));
    }
    parts.join(", ")
}

/// A declared name: its value where one is known, marked when that is of an earlier text, else how it is declared.
pub fn hover(facts: &Facts, document: &Document, name: &str, line: &str, docs: &str) -> String {
    let current = facts.revision == document.revision && facts.depth.is_some();
    let (line, note) = match facts.seen.get(name) {
        Some(seen) if seen.revision == document.revision => (seen.line.as_str(), ""),
        Some(seen) => (seen.line.as_str(), "*Stale: from before the last change of the text.*"),
        None if current && facts.is_mesh(name) && facts.depth != Some(Depth::Report) => (line, "*Not meshed yet.*"),
        None if current => (line, ""),
        None => (line, "*Not evaluated yet.*"),
    };
    hover_text(line, &format!("{docs}\n\n{note}"))
}

/// Puts the facts of a run over those of earlier runs.
pub fn remember(facts: &mut Facts, before: Facts) {
    let mut seen = before.seen;
    if facts.knows_all() {
        seen.retain(|name, _| facts.names.contains_key(name));
    }
    for (name, about) in &facts.names {
        let line = match (about.keyword, facts.meshes.get(name)) {
            (_, Some(row)) => format!("mesh {name}: {}", of_mesh(row)),
            (Keyword::Mesh, None) => continue,
            _ => about.line.clone(),
        };
        seen.insert(name.clone(), Seen { line, revision: facts.revision });
    }
    facts.seen = seen;
}

/// Quick fixes of reports in a stretch.
pub fn actions(facts: &Facts, document: &Document, range: &Value) -> Value {
    let (start, end) = (document.byte(&range["start"]), document.byte(&range["end"]));
    let near = |span: &Span| span.start as usize <= end && start <= span.end as usize;
    let mut out = Vec::new();
    for diagnostic in &facts.diagnostics {
        let own = || diagnostic.labels.iter().filter(|l| l.file == FileId(0));
        if !own().any(|l| near(&l.span)) {
            continue;
        }
        let changes: Vec<Change> =
            diagnostic.fixes.iter().filter(|f| f.file == FileId(0)).filter_map(|f| f.change(&document.text)).collect();
        for change in &changes {
            let edit = json!({ "range": document.range(change.span), "newText": change.text });
            out.push(json!({
                "title": change.title, "kind": "quickfix", "isPreferred": changes.len() == 1,
                "diagnostics": [row(diagnostic, document, &facts.sources)],
                "edit": { "changes": { document.uri.clone(): [edit] } },
            }));
        }
    }
    Value::Array(out)
}
