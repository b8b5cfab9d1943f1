//! Things that a picture on the command line is asked for by paths such as `ribs[3]`.

use super::run::Wanted;
use crate::base::fault::Severity;
use crate::lang::diag::diagnostic::{Diagnostic, FileId};
use crate::lang::syntax::parse;
use crate::lang::words::names::Names;

/// What the hidden names begin with that paths have while the model is evaluated.
pub(super) const ASKED: &str = "asked_of_this_picture_";

/// Whether a name is all that is asked by.
pub(super) fn is_name(text: &str) -> bool {
    text.chars().all(|c| c.is_alphanumeric() || c == '_')
}

/// What is asked for by more than a name: `ribs[3]`, `roof.patches[0]`; with the hidden name of each.
fn paths(wanted: &Wanted) -> impl Iterator<Item = (String, &String)> {
    let all = wanted.names.iter().chain(&wanted.zoom).filter(|name| !is_name(name));
    all.enumerate().map(|(k, path)| (format!("{ASKED}{k}"), path))
}

/// The script with a declaration at its end for each path that is asked for: a path is an expression of the script.
///
/// Fails with E102 for what is no expression.
pub fn with_paths(text: &str, wanted: &Wanted) -> Result<String, Box<Diagnostic>> {
    let mut out = text.to_owned();
    for (name, path) in paths(wanted) {
        let declaration = format!("let {name} = {path}\n");
        let (script, said) = parse(&declaration, FileId(0), &mut Names::default());
        if script.declarations.len() != 1 || path.contains('\n') || said.iter().any(|d| d.severity() == Severity::Error) {
            let text = format!("`{path}` is neither a name nor a path in the script");
            return Err(Diagnostic::without_place("E102", text).help("for example `roof`, `ribs[3]` or `roof.patches[0]`").into());
        }
        if !out.is_empty() && !out.ends_with('\n') {
            out.push('\n');
        }
        out.push_str(&declaration);
    }
    Ok(out)
}

/// What is said about a path that was asked for, its declaration behind byte `end` of the script, as said about the path.
pub fn about_paths(said: &mut [Diagnostic], wanted: &Wanted, end: usize) -> bool {
    let mut any = false;
    for diagnostic in said {
        if diagnostic.labels.iter().any(|l| l.file == FileId(0) && l.span.start as usize >= end) {
            diagnostic.labels.clear();
            any = true;
        }
        for (name, path) in paths(wanted) {
            diagnostic.notes.iter_mut().filter(|n| n.contains(&name)).for_each(|n| *n = n.replace(&name, &format!("`{path}`")));
        }
    }
    any
}
