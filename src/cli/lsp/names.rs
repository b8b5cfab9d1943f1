//! Which name means what: definitions, references and renaming.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::answers::Others;
use super::document::{Document, uri_of};
use crate::lang::diag::diagnostic::FileId;
use crate::lang::diag::span::Span;
use crate::lang::syntax::ast::{DeclarationKind, Expr, Keyword, Script, TextPart};
use crate::lang::syntax::parse;
use crate::lang::syntax::scopes::{Binding, Occurrence, occurrences};
use crate::lang::words::names::Names;
use crate::session::disk::read_limited;

/// Files beside the one at hand, and in each folder above it, that are searched for uses of it.
const NEIGHBOURS: usize = 500;
/// Folders above the one at hand that are searched.
const FOLDERS_ABOVE: usize = 4;

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

    /// Where a name of the whole script is declared.
    fn declared(&self, name: &str) -> Option<&Occurrence> {
        self.found.iter().find(|o| o.binds && matches!(o.binding, Binding::Declaration(_)) && self.text_of(o) == name)
    }

    /// The file whose name an occurrence is, when that is another one.
    fn home(&self, occurrence: &Occurrence, from: &Path, others: &Others<'_>) -> Option<PathBuf> {
        let module = self.module(occurrence.of?, from)?;
        let Some(through) = occurrence.through else { return Some(module) };
        let inside = Self::new(&others.find(&module)?.text);
        let declared = inside.declared(self.names.text(through))?.binding;
        let Binding::Declaration(declared) = declared else { return None };
        inside.module(declared, &module)
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

/// A file as it is on the disk.
pub fn on_disk(path: &Path) -> Option<Document> {
    let bytes = read_limited(path, crate::base::limits::SOURCE_BYTES).ok()?;
    Some(Document::new(&uri_of(path), String::from_utf8(bytes).ok()?, 0, false))
}

pub fn definition(document: &Document, position: &Value, others: &Others<'_>) -> Value {
    let read = Read::new(&document.text);
    let Some(found) = read.at(document.byte(position)) else { return Value::Null };
    if let Some(path) = document.path.as_deref().and_then(|path| read.home(found, path, others)) {
        let Some(module) = others.find(&path) else { return Value::Null };
        let span = Read::new(&module.text).declared(read.text_of(found)).map_or(Span::default(), |o| o.span);
        return json!({ "uri": module.uri, "range": module.range(span) });
    }
    match read.place_of(found.binding) {
        Some(span) => json!({ "uri": document.uri, "range": document.range(span) }),
        None => Value::Null,
    }
}

/// Places by file.
type Places = Vec<(String, Vec<Value>)>;

/// Every place that means what the name at a place means, by file, scripts that use it too; and the script that declares it.
fn meanings(document: &Document, position: &Value, others: &Others<'_>) -> Option<(Places, Read)> {
    let read = Read::new(&document.text);
    let found = *read.at(document.byte(position))?;
    if let Some(path) = document.path.as_deref().and_then(|path| read.home(&found, path, others)) {
        let module = others.find(&path)?;
        let inside = Read::new(&module.text);
        let declared = *inside.declared(read.text_of(&found))?;
        return Some((meanings_of(&module, &inside, &declared, others), inside));
    }
    (found.binding != Binding::Free).then(|| (meanings_of(document, &read, &found, others), read))
}

fn meanings_of(document: &Document, read: &Read, found: &Occurrence, others: &Others<'_>) -> Places {
    let same = read.found.iter().filter(|o| o.binding == found.binding);
    let mut out = vec![(document.uri.clone(), same.map(|o| document.range(o.span)).collect())];
    let own = document.path.as_deref().and_then(|path| path.canonicalize().ok());
    if let (Binding::Declaration(_), Some(own)) = (found.binding, own) {
        let wanted = read.text_of(found);
        for file in around(&own, others) {
            let Some(other) = others.find(&file) else { continue };
            let inside = Read::new(&other.text);
            let means = |o: &&Occurrence| inside.text_of(o) == wanted && inside.home(o, &file, others).as_deref() == Some(own.as_path());
            let ranges: Vec<Value> = inside.found.iter().filter(means).map(|o| other.range(o.span)).collect();
            if !ranges.is_empty() {
                out.push((other.uri.clone(), ranges));
            }
        }
    }
    out
}

/// Scripts that may use one: those of its folder and of folders above it, since modules stay below what uses them, and
/// those that are open.
fn around(own: &Path, others: &Others<'_>) -> BTreeSet<PathBuf> {
    let mut found = BTreeSet::new();
    for folder in own.ancestors().skip(1).take(1 + FOLDERS_ABOVE) {
        let beside = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|e| e.path());
        let scripts = beside.filter(|p| p.extension().is_some_and(|e| e == "loft")).take(NEIGHBOURS);
        found.extend(scripts.filter_map(|p| p.canonicalize().ok()));
    }
    found.extend(others.paths().map(Path::to_owned));
    found.remove(own);
    found
}

pub fn references(document: &Document, position: &Value, others: &Others<'_>) -> Value {
    let all = meanings(document, position, others).map_or(Places::new(), |found| found.0);
    all.into_iter().flat_map(|(uri, ranges)| ranges.into_iter().map(move |range| json!({ "uri": uri, "range": range }))).collect()
}

/// The edits that give a name another text, or why there are none.
pub fn rename(document: &Document, position: &Value, name: &str, others: &Others<'_>) -> Result<Value, String> {
    let sound = crate::lang::syntax::outline::outline(&format!("let {name} = 0"));
    let is_name = sound.first().and_then(|o| o.name).is_some_and(|n| n.start == 4 && n.end as usize == 4 + name.len());
    if !is_name || sound.len() != 1 {
        return Err(format!("`{name}` is not a valid name"));
    }
    let (all, read) = meanings(document, position, others).ok_or("this is not a name of the script")?;
    if read.found.iter().any(|o| read.text_of(o) == name) {
        return Err(format!("`{name}` is already in the script"));
    }
    let edits = |ranges: Vec<Value>| ranges.into_iter().map(|range| json!({ "range": range, "newText": name })).collect::<Vec<Value>>();
    let changes: serde_json::Map<String, Value> = all.into_iter().map(|(uri, ranges)| (uri, Value::Array(edits(ranges)))).collect();
    Ok(json!({ "changes": changes }))
}
