//! The default of a param, written into the text of its script.

use crate::lang::diag::diagnostic::FileId;
use crate::lang::diag::span::Span;
use crate::lang::syntax::ast::{DeclarationKind, Expr, ExprId, Keyword, Node, TextPart, Unary};
use crate::lang::syntax::parse;
use crate::lang::words::names::Names;

/// A literal as scripts write it: a unit follows its number directly.
pub fn joined(text: &str) -> String {
    let text = text.trim();
    match text.split_once(' ') {
        Some((number, unit)) if number.parse::<f64>().is_ok() => format!("{number}{}", unit.trim_start()),
        _ => text.to_owned(),
    }
}

/// The script with another default of a param; nothing else of it changes.
///
/// Fails with a sentence where the text is no literal (a number with its unit, a word, a quoted text, `true` or `false`), and where the
/// script has no such param or not exactly one.
pub fn with_default(script: &str, name: &str, text: &str) -> Result<String, String> {
    let text = &*joined(text);
    if !is_literal(text) {
        return Err(format!("`{text}` is no literal: write a number with its unit, a word, true or false"));
    }
    let places = defaults_of(script, name);
    let [span] = places[..] else {
        return Err(if places.is_empty() {
            format!("there is no param `{name}`")
        } else {
            format!("there are {} params `{name}`", places.len())
        });
    };
    let (start, end) = (span.start as usize, span.end as usize);
    let (Some(before), Some(after)) = (script.get(..start), script.get(end..)) else { return Err("the script has changed".to_owned()) };
    Ok(format!("{before}{text}{after}"))
}

/// Where the defaults of the params of this name stand: one place, unless the script is wrong.
pub fn defaults_of(script: &str, name: &str) -> Vec<Span> {
    let mut names = Names::default();
    let (parsed, _) = parse(script, FileId(0), &mut names);
    let place = |index| {
        let declaration = parsed.declarations.whole(index);
        match &declaration.kind {
            DeclarationKind::Param { bound, value, .. } if names.text(bound.name) == name => {
                Some(declaration.nodes.get(value.index())?.span)
            }
            _ => None,
        }
    };
    parsed.declarations.with_keyword(Keyword::Param).filter_map(place).collect()
}

/// Whether a text is one literal and nothing more.
fn is_literal(text: &str) -> bool {
    let (parsed, mistakes) = parse(&format!("let x = {text}"), FileId(0), &mut Names::default());
    if !mistakes.is_empty() || parsed.declarations.len() != 1 || text.contains(['\n', '\r']) {
        return false;
    }
    let only = parsed.declarations.whole(0);
    match &only.kind {
        DeclarationKind::Value { value, family, .. } => {
            // A comment behind it would take the rest of the line with it.
            let whole = only.nodes[value.index()].span.end as usize == "let x = ".len() + text.len();
            family.is_empty() && whole && literal(&only.nodes, *value)
        }
        _ => false,
    }
}

fn literal(nodes: &[Node], id: ExprId) -> bool {
    match &nodes[id.index()].expr {
        Expr::Number(_) | Expr::Quantity(..) | Expr::Bool(_) | Expr::Name(_) => true,
        Expr::Unary(Unary::Minus, of) => matches!(nodes[of.index()].expr, Expr::Number(_) | Expr::Quantity(..)),
        Expr::Text(parts) => parts.iter().all(|part| matches!(part, TextPart::Literal(_))),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCRIPT: &str =
        "units m\n// width = 3\nparam width: length = 3m in 1m to 5m // 3m\nparam kind = flat in [flat, bent]\nlet b = width\n";

    #[test]
    fn only_the_default_changes() {
        let wider = with_default(SCRIPT, "width", "4.5 m").unwrap();
        assert_eq!(wider, SCRIPT.replace("length = 3m", "length = 4.5m"));
        assert_eq!(with_default(SCRIPT, "kind", "bent").unwrap(), SCRIPT.replace("= flat in", "= bent in"));
        assert!(with_default(SCRIPT, "b", "3").unwrap_err().contains("no param"));
        for text in ["3m\nlet c = 1", "width * 2", "", "3m // wide", "[1]", "3m in 1m to 2m", "f(3)", "(1, 2, 3)"] {
            assert!(with_default(SCRIPT, "width", text).is_err(), "{text:?}");
        }
    }
}
