//! Messages for values that do not fit the type that is wanted.

use crate::lang::eval::coerce::{Misfit, axis_of_word, is_coordinates, zero_dim};
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::machine::Code;
use crate::lang::syntax::ast::{Expr, ExprId};
use crate::lang::values::settings::DECK_ELEMENTS;
use crate::lang::values::types::Ty;
use crate::lang::values::units;
use crate::lang::values::value::{Dim, Value};

impl Cx<'_> {
    #[cold]
    pub(crate) fn misfit(&mut self, code: Code<'_>, id: ExprId, value: &Value, ty: Ty, subject: &str, misfit: &Misfit) -> Halt {
        let wanted = ty.words();
        if let Misfit::Member(i, item, inner) = misfit {
            // A list written out is blamed at its member.
            let of = ty.member();
            if let Expr::List(items) = code.expr(id)
                && let Some(place) = items.get(*i)
            {
                let nested = of.is_thing() && matches!(**inner, Misfit::Member(..));
                let ty = if nested { ty } else { of };
                return self.misfit(code, *place, item, ty, &format!("member {i} of {subject}"), inner);
            }
            if let Misfit::Member(..) = &**inner {
                return self.misfit(code, id, item, if of.is_thing() { ty } else { of }, &format!("member {i} of {subject}"), inner);
            }
            let found = self.kind(item);
            let text = format!("{subject} is {wanted}, got {found} at place {i}");
            return self.error(code, "E211", text, code.span(id), format!("[{i}] is {found}")).stop();
        }
        let span = code.span(id);
        match misfit {
            Misfit::NotWhole => {
                let found = self.show_inside(value);
                let wanted = if ty.words().contains("count") { "a whole number, 0 or more" } else { "a whole number" };
                self.error(code, "E306", format!("{subject} is {wanted}, got {found}"), span, "not one").came_from(code).stop()
            }
            Misfit::Choice => {
                let (word, words) = (self.show(value), ty.choices().unwrap_or(&[]));
                self.no_choice(code, id, &word, words, subject)
            }
            Misfit::Bare => {
                let source = self.source(code, id);
                let draft = self.error(code, "E211", format!("{subject} is {wanted}, got a bare number"), span, "the unit is missing");
                let bare = if let Value::Number(q) = value { q.value } else { 0.0 };
                let meant = units::meant_units(bare, zero_dim(ty).unwrap_or(Dim::ANGLE), draft.unit());
                let typed: Vec<String> = match code.expr(id) {
                    Expr::Number(_) => meant.iter().map(|unit| format!("{source}{unit}")).collect(),
                    _ => meant.iter().map(|unit| format!("({source}) * 1{unit}")).collect(),
                };
                let help: Vec<String> = typed.iter().map(|t| format!("`{t}`")).collect();
                let draft = draft.help(help.join(" or "));
                typed.into_iter().fold(draft, |draft, text| draft.put(span, text)).stop()
            }
            _ => {
                let found = self.kind(value);
                let label = found.strip_prefix("a ").or_else(|| found.strip_prefix("an ")).unwrap_or(&found).to_owned();
                let text = format!("{subject} is {wanted}, got {found}");
                let help = match (ty, value) {
                    (Ty::Choice(_), Value::Text(t)) => Some((format!("a word is written without quotes: `{t}`"), Some(t.to_string()))),
                    (Ty::Curve | Ty::Surface, Value::List(_)) => match self.as_many(code, id) {
                        Some((place, short, typed)) => {
                            let draft = self.error(code, "E211", text, span, label);
                            return draft.help(format!("`{short}` declares several")).put(place, typed).stop();
                        }
                        None => Some((format!("take one member, for example `{}[0]`", self.source(code, id)), None)),
                    },
                    _ => None,
                };
                let ways = self.as_vectors(code, id, value, ty, subject);
                let draft = self.error(code, "E211", text, span, label);
                if !ways.is_empty() {
                    return draft.ways(span, &ways).stop();
                }
                match help {
                    Some((help, Some(word))) => draft.help(help).put(span, word).stop(),
                    Some((help, None)) => draft.help(help).stop(),
                    None => draft.stop(),
                }
            }
        }
    }

    /// What may have been meant where a point or direction is wanted: `[0, 0, 0]` is a list, `"Z"` and `2m` are none either.
    fn as_vectors(&self, code: Code<'_>, id: ExprId, value: &Value, ty: Ty, subject: &str) -> Vec<String> {
        let axis = matches!(ty, Ty::Direction | Ty::Axis | Ty::Vector);
        if !axis && !matches!(ty, Ty::Point | Ty::Node) {
            return Vec::new();
        }
        let source = self.source(code, id);
        let n = value.len().unwrap_or(0);
        match value {
            Value::Text(word) | Value::Word(word) if axis => axis_of_word(word).into_iter().map(str::to_owned).collect(),
            Value::List(_) | Value::Record(_) if is_coordinates(value, Ty::Point) => match code.expr(id) {
                Expr::List(items) => {
                    let items: Vec<String> = items.iter().map(|i| self.source(code, *i)).collect();
                    vec![format!("({})", items.join(", "))]
                }
                Expr::Name(_) | Expr::Field { .. } | Expr::Index { .. } => {
                    let items: Vec<String> = (0..n).map(|k| format!("{source}[{k}]")).collect();
                    vec![format!("({})", items.join(", "))]
                }
                _ => Vec::new(),
            },
            // A way to go, as `extrude` and `move` take it.
            Value::Number(q) if (q.dim == Dim::LENGTH || q.dim.is_none()) && subject.starts_with("`by`") => {
                vec![format!("(0, 0, {source})"), format!("({source}, 0, 0)"), format!("(0, {source}, 0)")]
            }
            _ => Vec::new(),
        }
    }

    /// E213: a word that is none of those allowed.
    #[cold]
    pub(crate) fn no_choice(&mut self, code: Code<'_>, id: ExprId, word: &str, words: &[&str], subject: &str) -> Halt {
        // Of the element names of all decks those that this export may say.
        let at_hand = if words == DECK_ELEMENTS { self.element_words(code) } else { None };
        let shown = at_hand.as_deref().unwrap_or(words);
        let near = crate::lang::words::elsewhere::meant(word, shown.iter().copied()).map(str::to_owned);
        let list = shown.join(", ");
        let draft = self.error(code, "E213", format!("{subject} is one of {list}, got `{word}`"), code.span(id), "no such choice");
        match near {
            Some(near) => draft.help(format!("`{near}`")).put(code.span(id), near).stop(),
            None => draft.stop(),
        }
    }
}
