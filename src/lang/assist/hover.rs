//! What a word means where it stands.

use crate::lang::assist::function::{Function, Parameter};
use crate::lang::assist::place::{CompletionPlace, stand};
use crate::lang::assist::scripts::Scripts;
use crate::lang::assist::shape::KnownType;
use crate::lang::eval::std::{builtins, fields};
use crate::lang::syntax::ast::Keyword;
use crate::lang::syntax::keywords;
use crate::lang::syntax::keywords::written;
use crate::lang::syntax::scan;
use crate::lang::values::settings::{Setting, range};
use crate::lang::values::types::Ty;

/// What is known of a word.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum About {
    /// Something of the language, a local name, or of another script: all there is to say.
    Words(String),
    /// A name of the script: its value is known where the script was run.
    Declared {
        /// The name.
        name: String,
        /// How it is declared, in a line.
        line: String,
        /// Its doc comment, its type and what is allowed.
        docs: String,
    },
}

/// A line as it would be written, and what it means.
pub fn hover_text(line: &str, docs: &str) -> String {
    format!("```text\n{line}\n```\n{}", docs.trim()).trim_end().to_owned()
}

/// What the word at a byte means.
pub(crate) fn about(scripts: &Scripts<'_>, at: usize) -> Option<About> {
    let home = scripts.unit(0);
    let text = home.text.as_str();
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let start = text[..at].char_indices().rev().take_while(|(_, c)| is_word(*c)).last().map_or(at, |(k, _)| k);
    let end = text[at..].find(|c: char| !is_word(c)).map_or(text.len(), |n| at + n);
    // Words of comments and strings are no words of the script.
    if start == end || !scan(text).starts.iter().any(|token| *token as usize == start) {
        return None;
    }
    let word = &text[start..end];
    let behind = text[end..].trim_start();
    let (names, calls) = (behind.starts_with(':'), text[end..].starts_with('('));
    let here = stand(scripts, start);
    let found = match &here.place {
        CompletionPlace::Member(shape) => return of_member(scripts, shape, word, calls).map(About::Words),
        CompletionPlace::Key(table, ..) if names => table.iter().find(|s| s.key == word).map(of_setting),
        CompletionPlace::Value(wanted) => match (&wanted.call, wanted.ty.and_then(Ty::choices)) {
            (Some((function, _)), _) if names => function.params.iter().find(|p| p.name == word).map(|p| of_parameter(function, p)),
            (_, Some(words)) if words.contains(&word) => {
                let of_call = || here.call.as_ref().and_then(|(f, at)| Some(of_parameter(f, f.params.get((*at)?)?)));
                here.setting.map(of_setting).or_else(of_call)
            }
            _ => None,
        },
        _ => None,
    };
    if let Some(found) = found {
        return Some(About::Words(found));
    }
    if let Some((_, shape)) = here.locals.iter().rev().find(|(name, _)| name == word && !calls) {
        let shown = shape.signature();
        return Some(About::Words(hover_text(&format!("{word}{}{shown}", if shown.is_empty() { "" } else { ": " }), "")));
    }
    of_name(scripts, word, calls).or_else(|| of_language(word, calls).map(About::Words))
}

/// A name that the script declares.
fn of_name(scripts: &Scripts<'_>, word: &str, calls: bool) -> Option<About> {
    let home = scripts.unit(0);
    let entry = home.declared.get(word)?;
    if entry.keyword == Keyword::Fn {
        let function = Function::of_script(scripts, 0, word)?;
        return Some(About::Words(hover_text(&format!("fn {}", function.signature), &function.docs)));
    }
    if calls && builtins().any(|b| b.name == word) {
        return None;
    }
    let (line, docs) = of_declared(scripts, 0, word)?;
    Some(About::Declared { name: word.to_owned(), line, docs })
}

/// What a declaration says of its name: a line, and more.
fn of_declared(scripts: &Scripts<'_>, unit: usize, name: &str) -> Option<(String, String)> {
    let home = scripts.unit(unit);
    let entry = home.declared.get(name)?;
    let mut docs = home.declaration(name).and_then(|(_, d)| d.doc.clone()).unwrap_or_default().to_string();
    let ty = scripts.shape_of_name(unit, name, &Vec::new()).signature();
    let word = written(entry.keyword);
    let mut line = format!("{word} {name}");
    let mut say = |what: &str, text: &str| docs.push_str(&format!("{}{what}: {text}.", if docs.is_empty() { "" } else { "\n\n" }));
    if !ty.is_empty() && !word.ends_with(&ty) {
        line.push_str(&format!(": {ty}"));
        say("Type", &ty);
    }
    if let Some(param) = Function::param_of_script(scripts, unit, name) {
        param.default.iter().for_each(|default| line.push_str(&format!(" = {default}")));
        param.range.iter().for_each(|range| say("Range", range));
    }
    Some((line, docs))
}

fn of_member(scripts: &Scripts<'_>, shape: &KnownType, word: &str, calls: bool) -> Option<String> {
    match shape {
        KnownType::Module(module) => {
            return match Function::of_script(scripts, *module, word) {
                Some(function) => Some(hover_text(&format!("fn {}", function.signature), &function.docs)),
                None => of_declared(scripts, *module, word).map(|(line, docs)| hover_text(&line, &docs)),
            };
        }
        KnownType::Record(keys) => {
            if let Some((_, of)) = keys.iter().find(|(key, _)| key == word) {
                return Some(hover_text(&format!("{word}: {}", of.signature()), ""));
            }
        }
        _ => {}
    }
    let field = fields().find(|f| f.name == word && f.params.first().is_some_and(|p| shape.has_fields_of(p.ty)));
    match (field, Function::of_script(scripts, 0, word)) {
        (Some(field), _) if !calls || builtins().all(|b| b.name != word) => Some(hover_text(&field.signature(), field.docs)),
        (_, Some(function)) => Some(hover_text(&format!("fn {}", function.signature), &function.docs)),
        _ => of_language(word, true),
    }
}

/// A function, keyword or field of the language.
fn of_language(word: &str, calls: bool) -> Option<String> {
    if let Some(keyword) = keywords::find(word).filter(|_| !calls) {
        return Some(format!("```loft\n{}\n```\n{}", keyword.form, keyword.docs));
    }
    let found = builtins().find(|b| b.name == word).or_else(|| fields().find(|b| b.name == word))?;
    Some(hover_text(&found.signature(), found.docs))
}

fn of_setting(setting: &Setting) -> String {
    let range = range(setting);
    let range = if range.is_empty() { String::new() } else { format!("\n\nRange: {range}.") };
    let default = if setting.default.is_empty() { String::new() } else { format!("\n\nDefault: {}.", setting.default) };
    hover_text(&format!("{}: {}", setting.key, setting.ty.signature()), &format!("{}{range}{default}", setting.docs.trim()))
}

fn of_parameter(function: &Function, parameter: &Parameter) -> String {
    let range = parameter.range.as_ref().map_or_else(String::new, |range| format!("\n\nRange: {range}."));
    let of = match function.name.as_str() {
        "use" => "A param of the module.".to_owned(),
        name => format!("An argument of `{name}`."),
    };
    hover_text(&parameter.signature(), &format!("{}\n\n{of}{range}", parameter.docs.trim()))
}
