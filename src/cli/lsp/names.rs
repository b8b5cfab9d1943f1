//! Which name means what: definitions, references, renaming, and what is known of a word.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::document::{Document, uri_of};
use crate::lang::diag::FileId;
use crate::lang::names::Names;
use crate::lang::scopes::{Binding, Occurrence, occurrences};
use crate::lang::settings::BLOCKS;
use crate::lang::std::{builtins, fields};
use crate::lang::syntax::ast::{DeclarationKind, Expr, Keyword, Script, Span, TextPart};
use crate::lang::syntax::{keywords, parse};
use crate::session::disk::read_limited;

/// Files beside the one at hand that are searched for uses of it.
const NEIGHBOURS: usize = 500;

/// A text with its tree.
pub struct Read {
    script: Script,
    names: Names,
    found: Vec<Occurrence>,
}

impl Read {
    pub fn new(text: &str) -> Self {
        let mut names = Names::default();
        let (script, _) = parse(text, FileId(0), &mut names);
        let found = occurrences(&script);
        Self { script, names, found }
    }

    /// The name at a byte.
    pub fn at(&self, byte: usize) -> Option<&Occurrence> {
        let byte = byte as u32;
        self.found.iter().filter(|o| o.span.start <= byte && byte <= o.span.end).max_by_key(|o| (o.of.is_some(), o.span.start))
    }

    /// Where a binding is made.
    fn place_of(&self, binding: Binding) -> Option<Span> {
        self.found.iter().find(|o| o.binds && o.binding == binding).map(|o| o.span)
    }

    pub fn text_of(&self, occurrence: &Occurrence) -> &str {
        self.names.text(occurrence.name)
    }

    /// The file that a `use` loads.
    fn module(&self, declaration: usize, from: &Path) -> Option<PathBuf> {
        let declaration = self.script.declarations.get(declaration).filter(|d| d.keyword == Keyword::Use)?;
        let DeclarationKind::Load { path, .. } = &declaration.kind else { return None };
        match &declaration.nodes.get(path.index())?.expr {
            Expr::Text(parts) => match parts.as_slice() {
                [TextPart::Literal(text)] => from.parent()?.join(&**text).canonicalize().ok(),
                _ => None,
            },
            _ => None,
        }
    }
}

fn neighbour(path: &Path) -> Option<Document> {
    let bytes = read_limited(path, crate::base::limits::SOURCE_BYTES).ok()?;
    Some(Document::new(&uri_of(path), String::from_utf8(bytes).ok()?, 0, false))
}

pub fn definition(document: &Document, position: &Value) -> Value {
    let read = Read::new(&document.text);
    let Some(found) = read.at(document.byte(position)) else { return Value::Null };
    if let Some(path) = found.of.zip(document.path.as_deref()).and_then(|(of, path)| read.module(of, path)) {
        let Some(module) = neighbour(&path) else { return Value::Null };
        let inside = Read::new(&module.text);
        let wanted = read.text_of(found);
        let place = inside.found.iter().find(|o| o.binds && matches!(o.binding, Binding::Declaration(_)) && inside.text_of(o) == wanted);
        let span = place.map_or(Span::default(), |o| o.span);
        return json!({ "uri": module.uri, "range": module.range(span) });
    }
    match read.place_of(found.binding) {
        Some(span) => json!({ "uri": document.uri, "range": document.range(span) }),
        None => Value::Null,
    }
}

/// Every place that means what the name at a place means, by file; other scripts of the folder that use this one too.
fn meanings(document: &Document, position: &Value) -> Option<Vec<(String, Vec<Value>)>> {
    let read = Read::new(&document.text);
    let found = *read.at(document.byte(position))?;
    if found.binding == Binding::Free {
        return None;
    }
    let same = read.found.iter().filter(|o| o.binding == found.binding);
    let mut out = vec![(document.uri.clone(), same.map(|o| document.range(o.span)).collect())];
    if let (Binding::Declaration(_), Some(path)) = (found.binding, document.path.as_deref()) {
        let wanted = read.text_of(&found);
        let own = path.canonicalize().ok()?;
        let entries = std::fs::read_dir(path.parent()?).ok()?.flatten().map(|e| e.path());
        let mut files: Vec<PathBuf> =
            entries.filter(|p| p.extension().is_some_and(|e| e == "loft") && *p != path).take(NEIGHBOURS).collect();
        files.sort();
        for file in files {
            let Some(other) = neighbour(&file) else { continue };
            let inside = Read::new(&other.text);
            let means = |o: &&Occurrence| {
                inside.text_of(o) == wanted && o.of.is_some_and(|of| inside.module(of, &file).as_deref() == Some(own.as_path()))
            };
            let ranges: Vec<Value> = inside.found.iter().filter(means).map(|o| other.range(o.span)).collect();
            if !ranges.is_empty() {
                out.push((other.uri.clone(), ranges));
            }
        }
    }
    Some(out)
}

pub fn references(document: &Document, position: &Value) -> Value {
    let all = meanings(document, position).unwrap_or_default();
    all.into_iter().flat_map(|(uri, ranges)| ranges.into_iter().map(move |range| json!({ "uri": uri, "range": range }))).collect()
}

/// The edits that give a name another text, or why there are none.
pub fn rename(document: &Document, position: &Value, name: &str) -> Result<Value, String> {
    let sound = crate::lang::syntax::outline::outline(&format!("let {name} = 0"));
    let is_name = sound.first().and_then(|o| o.name).is_some_and(|n| n.start == 4 && n.end as usize == 4 + name.len());
    if !is_name || sound.len() != 1 {
        return Err(format!("`{name}` is no name"));
    }
    let all = meanings(document, position).ok_or("this is no name of the script")?;
    let read = Read::new(&document.text);
    if read.found.iter().any(|o| read.text_of(o) == name) {
        return Err(format!("`{name}` stands in this script already"));
    }
    let edits = |ranges: Vec<Value>| ranges.into_iter().map(|range| json!({ "range": range, "newText": name })).collect::<Vec<Value>>();
    let changes: serde_json::Map<String, Value> = all.into_iter().map(|(uri, ranges)| (uri, Value::Array(edits(ranges)))).collect();
    Ok(json!({ "changes": changes }))
}

/// What is known of a word of the language: function, field, keyword or setting.
pub fn about_word(word: &str, behind_dot: bool, before_colon: bool) -> Option<String> {
    if before_colon {
        let settings = BLOCKS.iter().flat_map(|(_, settings)| settings.iter());
        if let Some(setting) = settings.clone().find(|s| s.key == word) {
            let default = if setting.default.is_empty() { String::new() } else { format!(" (default {})", setting.default) };
            return Some(format!("```text\n{}: {}\n```\n{}{default}", setting.key, setting.ty.signature(), setting.docs.trim()));
        }
    }
    let entry = |b: &&crate::lang::std::Builtin| b.name == word;
    let found = if behind_dot {
        fields().find(entry).or_else(|| builtins().find(entry))
    } else {
        builtins().find(entry).or_else(|| fields().find(entry))
    };
    match (found, keywords::find(word).filter(|_| !behind_dot)) {
        (_, Some(keyword)) if found.is_none() || keyword.keyword.is_some() => {
            Some(format!("```loft\n{}\n```\n{}", keyword.form, keyword.docs))
        }
        (Some(builtin), _) => Some(format!("```text\n{}\n```\n{}", builtin.signature(), builtin.docs.trim())),
        _ => None,
    }
}
