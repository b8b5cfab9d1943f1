//! Forms of other languages, and their loft form typed out from the user's own words.
//!
//! Each rule looks at the tokens of a declaration that the grammar refuses and gives the text that was meant; a rewriting is
//! only offered when the grammar accepts it.

pub mod calls;
pub mod fresh_names;
pub mod gmsh;
pub mod makes;
pub mod meshes;
pub mod shapes;
pub mod solids;
pub mod statements;

use std::ops::Range;

use crate::lang::diag::diagnostic::Diagnostic;
use crate::lang::diag::span::Span;
pub(crate) use crate::lang::syntax::foreign::calls::Call;
use crate::lang::syntax::foreign::fresh_names::FreshNames;
pub(crate) use crate::lang::syntax::foreign::shapes::{Made, shape};
use crate::lang::syntax::is_declaration;
use crate::lang::syntax::scan::Tokens;
use crate::lang::syntax::token::Kind;

/// A declaration that the grammar refuses, with the token at which it did.
pub(crate) struct Refusal<'a> {
    source: &'a str,
    tokens: &'a Tokens,
    fresh: &'a FreshNames,
    /// First token of the declaration.
    base: usize,
    /// Token after its last one.
    end: usize,
    /// The refused token; `end` when the declaration ended too early.
    at: usize,
    brackets: Brackets,
}

/// How the brackets of a declaration lie, from its first token on.
struct Brackets {
    /// Brackets open before each token, less those closed.
    depths: Vec<i32>,
    /// The token that closes the bracket opened by a token.
    closers: Vec<Option<u32>>,
}

impl Brackets {
    /// One pass over the kinds of a declaration.
    fn of(kinds: &[Kind]) -> Self {
        let (mut depths, mut closers) = (Vec::with_capacity(kinds.len()), vec![None; kinds.len()]);
        let (mut open, mut depth): (Vec<usize>, i32) = (Vec::new(), 0);
        looked(kinds.len());
        for (at, kind) in kinds.iter().enumerate() {
            depths.push(depth);
            let step = opens(*kind);
            depth += step;
            if step > 0 {
                open.push(at);
            } else if step < 0
                && let Some(opener) = open.pop()
            {
                closers[opener] = Some(at as u32);
            }
        }
        Self { depths, closers }
    }
}

/// Counts what is looked at, tokens or bytes: the tests see that it grows as the text does.
#[cfg(not(test))]
fn looked(_: usize) {}

#[cfg(test)]
fn looked(n: usize) {
    LOOKED.with(|all| all.set(all.get() + n));
}

#[cfg(test)]
thread_local! {
    static LOOKED: std::cell::Cell<usize> = const { std::cell::Cell::new(0) };
}

/// What was meant.
pub(crate) struct Meant {
    /// What stands before the typed form.
    pub why: &'static str,
    /// The typed form.
    pub typed: String,
    /// Where it stands; `None`: something in it is still to be filled in.
    pub at: Option<Span>,
}

/// Words that declare a function in other languages.
const FUNCTION_WORDS: [&str; 6] = ["def", "function", "func", "fun", "module", "lambda"];

/// A report with what was meant as its help.
pub(crate) fn say(mut report: Diagnostic, meant: Option<Meant>) -> Diagnostic {
    let Some(Meant { why, typed, at }) = meant else { return report };
    report.fixes.clear();
    if let Some(label) = report.labels.first_mut().filter(|l| l.text.starts_with("did you mean")) {
        label.text = "no declaration starts with this".to_owned();
    }
    let lines = typed.contains('\n');
    let report = report.help(if lines { format!("{why}:\n{typed}") } else { format!("{why}: `{typed}`") });
    match at {
        Some(at) => report.put(at, typed),
        None => report,
    }
}

impl<'a> Refusal<'a> {
    /// The tokens `whole` of a source are refused at one of them.
    pub fn new(source: &'a str, tokens: &'a Tokens, whole: Range<usize>, at: usize, fresh: &'a FreshNames) -> Self {
        let (base, mut end) = (whole.start, whole.end);
        while end > base + 1 && tokens.kinds[end - 1] == Kind::Strange {
            end -= 1;
        }
        Self { source, tokens, fresh, base, end, at, brackets: Brackets::of(&tokens.kinds[base..end]) }
    }
}

impl Refusal<'_> {
    /// The loft form of what stands there.
    pub fn meant(&self) -> Option<Meant> {
        let rules: [fn(&Self) -> Option<Meant>; 26] = [
            Self::needless_sign,
            Self::value_word,
            Self::function_word,
            Self::printed,
            Self::gmsh_statement,
            Self::gmsh_call,
            Self::gmsh_meshing,
            Self::mesh_called,
            Self::boolean,
            Self::shape_statement,
            Self::shape_value,
            Self::block_of_python,
            Self::nameless,
            Self::python_import,
            Self::statement,
            Self::called_output,
            Self::settings_apart,
            Self::settings_elsewhere,
            Self::equals_for_colons,
            Self::of_missing,
            Self::name_with_brackets,
            Self::bare_point,
            Self::decimal_comma,
            Self::loop_after_value,
            Self::condition_after_value,
            Self::colon_for_equals,
        ];
        rules.iter().find_map(|rule| rule(self))
    }

    fn kind(&self, at: usize) -> Option<Kind> {
        (self.base..self.end).contains(&at).then(|| self.tokens.kinds[at])
    }

    /// The text from a token to before another, as far as the declaration goes.
    fn text(&self, from: usize, to: usize) -> &str {
        let to = to.min(self.end);
        if from >= to {
            return "";
        }
        let span = self.tokens.stretch(from, to - 1);
        looked(to - from);
        &self.source[span.start as usize..span.end as usize]
    }

    fn whole(&self) -> Option<Span> {
        Some(self.tokens.stretch(self.base, self.end - 1))
    }

    /// Brackets open before a token, from the start of the declaration.
    fn depth(&self, at: usize) -> i32 {
        looked(1);
        self.brackets.depths.get(at - self.base).copied().unwrap_or(0)
    }

    /// The first token of a kind from `from` on, outside brackets opened after it.
    fn find(&self, from: usize, wanted: Kind) -> Option<usize> {
        (from..self.end).find(|&t| self.tokens.kinds[t] == wanted && self.depth(t) == self.depth(from))
    }

    /// The bracket that closes the one at a token.
    fn closer(&self, open: usize) -> Option<usize> {
        looked(1);
        self.brackets.closers.get(open - self.base).copied().flatten().map(|at| self.base + at as usize)
    }

    /// The first token of the expression that a token stands in: behind `=`, `:`, `,` or an opening bracket.
    fn start_of_value(&self, at: usize) -> usize {
        let mut depth = 0;
        let stop = (self.base..at).rev().find(|&t| {
            let kind = self.tokens.kinds[t];
            let stops = depth == 0 && (opens(kind) > 0 || matches!(kind, Kind::Equals | Kind::Comma | Kind::Colon | Kind::In));
            depth -= opens(kind);
            stops
        });
        stop.map_or(self.base + 1, |t| t + 1)
    }

    /// Where the expression that a token stands in ends.
    fn end_of_value(&self, at: usize) -> usize {
        let mut depth = 0;
        let stop = (at..self.end).find(|&t| {
            let kind = self.tokens.kinds[t];
            let stops = depth == 0 && (opens(kind) < 0 || kind == Kind::Comma);
            depth += opens(kind);
            stops
        });
        stop.unwrap_or(self.end)
    }

    /// The declaration with a stretch of tokens replaced.
    fn with(&self, from: usize, to: usize, put: &str) -> String {
        let (whole, start) = (self.tokens.stretch(self.base, self.end - 1), self.tokens.starts[from]);
        let end = if to > from { self.tokens.ends[to - 1] } else { start };
        format!("{}{put}{}", &self.source[whole.start as usize..start as usize], &self.source[end as usize..whole.end as usize])
    }

    fn replaced(&self, why: &'static str, typed: String) -> Option<Meant> {
        is_declaration(&typed).then(|| Meant { why, typed, at: self.whole() })
    }
}

/// 1 for what opens a bracket, -1 for what closes one.
fn opens(kind: Kind) -> i32 {
    match kind {
        Kind::OpenRound | Kind::LineRound | Kind::OpenSquare | Kind::LineSquare | Kind::OpenCurly | Kind::TextHead => 1,
        Kind::CloseRound | Kind::CloseSquare | Kind::CloseCurly | Kind::TextTail => -1,
        _ => 0,
    }
}

#[cfg(test)]
mod tests {
    use super::LOOKED;
    use crate::lang::diag::diagnostic::FileId;
    use crate::lang::syntax::parse;
    use crate::lang::words::names::Names;

    /// What is looked at for the help on a text.
    fn work(text: &str) -> usize {
        LOOKED.with(|all| all.set(0));
        let (_, said) = parse(text, FileId(0), &mut Names::default());
        assert!(!said.is_empty(), "{text:.60}");
        LOOKED.with(std::cell::Cell::get)
    }

    #[test]
    fn help_on_refused_text_looks_at_it_a_few_times() {
        let list = |item: &str, n: usize| vec![item; n].join(", ");
        let texts: [&dyn Fn(usize) -> String; 7] = [
            &|n| format!("let rows = [{}] of 3", list("{x: 1, y: 2}", n)),
            &|n| format!("mesh m of {} size: 3", list("{x: 1}", n)),
            &|n| format!("mesh m of a {{ {} }} size: 3", "on b { size: 3 } ".repeat(n)),
            &|n| format!("let rows = [{} if x]", list("(1)", n)),
            &|n| "circle(center: (0, 0, 0), radius: 1)\n".repeat(n),
            &|n| (0..n).map(|k| format!("circle(center: (0, 0, 0), radius: circle_{k})\n")).collect(),
            &|n| format!("let rows = {}{} of 3", "{x: ".repeat(n.min(200)), "1}".repeat(n.min(200))),
        ];
        for text in texts {
            let (small, large) = (work(&text(500)), work(&text(2000)));
            assert!(small > 0 && large < 5 * small, "{small} → {large}: {:.60}", text(2));
        }
    }

    #[test]
    fn names_for_what_has_none_are_free_and_differ() {
        let text = "let circle_2 = 1\ncircle(center: (0, 0, 0), radius: 1)\ncircle(center: (0, 0, 0), radius: 2)\n";
        let (_, said) = parse(text, FileId(0), &mut Names::default());
        let names: Vec<bool> =
            said.iter().zip(["circle_1 =", "circle_3 ="]).map(|(d, name)| d.help.iter().any(|h| h.contains(name))).collect();
        assert_eq!(names, [true, true], "{said:?}");
    }
}
