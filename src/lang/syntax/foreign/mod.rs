//! Forms of other languages, and their loft form typed out from the user's own words.
//!
//! Each rule looks at the tokens of a declaration that the grammar refuses and gives the text that was meant; a rewriting is
//! only offered when the grammar accepts it.

pub mod calls;
pub mod gmsh;
pub mod makes;
pub mod meshes;
pub mod shapes;
pub mod solids;

use std::cell::{OnceCell, RefCell};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use crate::lang::diag::diagnostic::Diagnostic;
use crate::lang::diag::span::Span;
pub(crate) use crate::lang::syntax::foreign::calls::Call;
use crate::lang::syntax::foreign::makes::keyword_of;
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

/// Names for what was made without one: `circle_1`, `circle_2`, none of which stands in the source.
#[derive(Default)]
pub(crate) struct FreshNames {
    numbers: RefCell<BTreeMap<&'static str, (BTreeSet<u64>, u64)>>,
    /// What the source declares as a function, in the words of this language or another; found once.
    functions: OnceCell<BTreeSet<String>>,
}

impl FreshNames {
    /// The next free name that begins with a word; the source is searched once for each word.
    fn next(&self, source: &str, word: &'static str) -> String {
        let mut all = self.numbers.borrow_mut();
        let (taken, last) = all.entry(word).or_insert_with(|| (numbers_behind(source, word), 0));
        *last = (*last + 1..).find(|n| !taken.contains(n)).unwrap_or(u64::MAX);
        format!("{word}_{last}")
    }

    /// Whether a source makes a function of this name.
    fn is_function(&self, source: &str, name: &str) -> bool {
        self.functions.get_or_init(|| functions_of(source)).contains(name)
    }
}

/// The names behind the words that declare a function.
fn functions_of(source: &str) -> BTreeSet<String> {
    looked(source.len());
    let name = |line: &str| {
        let (word, rest) = line.trim_start().split_once(' ')?;
        let (name, _) = rest.split_once('(').filter(|_| word == "fn" || FUNCTION_WORDS.contains(&word))?;
        Some(name.trim().to_owned())
    };
    source.lines().filter_map(name).collect()
}

/// The numbers `n` of all `word_n` in a text.
fn numbers_behind(source: &str, word: &str) -> BTreeSet<u64> {
    looked(source.len());
    let number = |at: usize| {
        let rest = source[at + word.len()..].strip_prefix('_')?;
        let digits = rest.bytes().take_while(u8::is_ascii_digit).count();
        rest[..digits].parse().ok()
    };
    source.match_indices(word).filter_map(|(at, _)| number(at)).collect()
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

/// Words that declare a value in other languages.
const VALUE_WORDS: [&str; 14] =
    ["const", "var", "val", "auto", "double", "float", "int", "number", "string", "bool", "static", "final", "local", "define"];
/// Words that declare a function in other languages.
const FUNCTION_WORDS: [&str; 6] = ["def", "function", "func", "fun", "module", "lambda"];
/// What other languages call showing a value.
pub(crate) const PRINTS: [&str; 6] = ["print", "println", "printf", "echo", "puts", "show"];

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
    pub fn new((source, tokens): (&'a str, &'a Tokens), whole: Range<usize>, at: usize, fresh: &'a FreshNames) -> Self {
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
            Self::head_sign,
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
            Self::loop_behind,
            Self::choice_behind,
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

    /// `units = mm`, `tolerance: 1mm`.
    fn head_sign(&self) -> Option<Meant> {
        let head = matches!(self.tokens.kinds[self.base], Kind::Units | Kind::Tolerance | Kind::Snap);
        let sign = matches!(self.kind(self.base + 1)?, Kind::Equals | Kind::Colon);
        let typed = format!("{} {}", self.text(self.base, self.base + 1), self.text(self.base + 2, self.end).trim_matches('"'));
        if head && sign { self.replaced("there is no sign between them", typed) } else { None }
    }

    /// `const k = 3`, `double k = 3`.
    fn value_word(&self) -> Option<Meant> {
        if !VALUE_WORDS.contains(&self.text(self.base, self.base + 1)) || self.kind(self.base + 2) != Some(Kind::Equals) {
            return None;
        }
        self.replaced("a value is declared by `let`", format!("let {}", self.text(self.base + 1, self.end)))
    }

    /// `def rib(y): return line(…)`, `function rib(y) = …`, `let rib(y) = …`.
    fn function_word(&self) -> Option<Meant> {
        let word = self.text(self.base, self.base + 1);
        let open = self.base + 2;
        let keyword = self.tokens.kinds[self.base];
        // A `fn` of ours whose body stands in braces, or behind a colon where a type may be.
        let block = || match self.closer(open).and_then(|close| self.kind(close + 1)) {
            Some(Kind::Colon) => self.find(self.base, Kind::Equals).is_none(),
            behind => behind == Some(Kind::OpenCurly),
        };
        let own = keyword == Kind::Let || keyword == Kind::Fn && self.kind(open) == Some(Kind::OpenRound) && block();
        if !(own || FUNCTION_WORDS.contains(&word)) || self.kind(open) != Some(Kind::OpenRound) {
            return None;
        }
        let body = self.closer(open)? + 1;
        let head = format!("fn {}", self.text(self.base + 1, body));
        let sign = matches!(self.kind(body), Some(Kind::Colon | Kind::Equals | Kind::OpenCurly));
        let mut first = body + usize::from(sign);
        first += usize::from(self.kind(first).is_some() && self.text(first, first + 1) == "return");
        let curly = self.kind(body) == Some(Kind::OpenCurly) && self.kind(self.end - 1) == Some(Kind::CloseCurly);
        let end = self.end - usize::from(curly);
        let last = if end > first && self.tokens.kinds[end - 1] == Kind::Strange { end - 1 } else { end };
        let typed = match self.made(first, last) {
            Some((made, _)) => format!("{head} = {}", made.expression()),
            None => format!("{head} = {}", self.text(first, end)),
        };
        let why = "a function is one expression";
        if is_declaration(&typed) {
            return Some(Meant { why, typed, at: self.whole() });
        }
        Some(Meant { why, typed: format!("{head} = …"), at: None })
    }

    /// `print(x)`
    fn printed(&self) -> Option<Meant> {
        if !PRINTS.contains(&self.text(self.base, self.base + 1)) {
            return None;
        }
        let bracket = self.kind(self.base + 1) == Some(Kind::OpenRound) && self.closer(self.base + 1) == Some(self.end - 1);
        let what = if bracket { self.text(self.base + 2, self.end - 1) } else { self.text(self.base + 1, self.end) };
        self.replaced("a value is shown by `report`", format!("report {what}"))
    }

    /// `circle(…)` without a keyword and a name.
    fn nameless(&self) -> Option<Meant> {
        let whole = self.kind(self.base + 1) == Some(Kind::OpenRound) && self.closer(self.base + 1) == Some(self.end - 1);
        let function = self.text(self.base, self.base + 1);
        if whole && self.fresh.is_function(self.source, function) {
            let name = self.fresh.next(self.source, "part");
            return self.replaced("what is made gets a name", format!("let {name} = {}", self.text(self.base, self.end)));
        }
        let (function, word) = keyword_of(function).filter(|_| whole)?;
        let word = if function == "plane" { "surface" } else { word };
        let name = self.fresh.next(self.source, function);
        self.replaced("what is made gets a name", format!("{word} {name} = {}", self.text(self.base, self.end)))
    }

    /// `import math`
    fn python_import(&self) -> Option<Meant> {
        let imports = self.tokens.kinds[self.base] == Kind::Import || self.text(self.base, self.base + 1) == "from";
        let modules =
            ["math", "numpy", "cadquery", "build123d", "gmsh", "FreeCAD", "Part", "Draft", "rhinoscriptsyntax", "Rhino", "pygmsh", "solid"];
        let known = imports && self.kind(self.base + 1) == Some(Kind::Name) && modules.contains(&self.text(self.base + 1, self.base + 2));
        known.then(|| Meant { why: "functions need no import, delete this line", typed: "sin(30deg) + pi".to_owned(), at: None })
    }

    /// `if n > 3: …`, `for i in range(4): …` in the place of a declaration.
    fn statement(&self) -> Option<Meant> {
        let first =
            if matches!(self.kind(self.at), Some(Kind::If | Kind::For)) && self.tokens.first[self.at] { self.at } else { self.base };
        let stated = self.kind(first).filter(|kind| matches!(kind, Kind::If | Kind::For))?;
        let ends =
            |t: &usize| matches!(self.tokens.kinds[*t], Kind::Colon | Kind::OpenCurly | Kind::Then) && self.depth(*t) == self.depth(first);
        let head_end = (first..self.end).find(ends).unwrap_or(self.end);
        match stated {
            Kind::If => {
                let condition = unbracketed(self.text(first + 1, head_end));
                let why = "a choice is a value";
                Some(Meant { why, typed: format!("let name = if {condition} then … else …"), at: None })
            }
            Kind::For if first == self.base || self.find(self.base, Kind::Equals).is_some_and(|t| t < first) => {
                let inside = ranges(&unbracketed(self.text(first + 1, head_end)));
                let why = "a loop makes a family";
                Some(Meant { why, typed: format!("curve name for {inside} = …"), at: None })
            }
            _ => None,
        }
    }

    /// `export(fine, "x.stl")`, `export fine, "x.stl"`, `export "x.stl" of fine`, `export fine as "x.stl"`, `export fine to x.stl`.
    fn called_output(&self) -> Option<Meant> {
        if !matches!(self.tokens.kinds[self.base], Kind::Export | Kind::Picture) {
            return None;
        }
        let called = self.kind(self.base + 1) == Some(Kind::OpenRound) && self.closer(self.base + 1) == Some(self.end - 1);
        let (first, end) = if called { (self.base + 2, self.end - 1) } else { (self.base + 1, self.end) };
        let Some(path) = (first..end).find(|&t| self.tokens.kinds[t] == Kind::Text) else {
            let path = self.find(first, Kind::To)? + 1;
            let typed = format!("{} \"{}\"", self.text(self.base, path), self.text(path, end));
            return self.replaced("the name of a file is in quotes", typed);
        };
        let things = if path == first {
            let skip = usize::from(matches!(self.kind(path + 1), Some(Kind::Comma | Kind::Of | Kind::In)));
            self.text(path + 1 + skip, end)
        } else {
            let as_word = path > first && self.tokens.kinds[path - 1] == Kind::As;
            self.text(first, path - usize::from(as_word)).trim_end().trim_end_matches(',').trim_end()
        };
        self.replaced("the file follows `to`", format!("{} {things} to {}", self.text(self.base, self.base + 1), self.text(path, path + 1)))
    }

    /// Settings without braces, behind them, or behind a comma.
    fn settings_apart(&self) -> Option<Meant> {
        if !matches!(self.tokens.kinds[self.base], Kind::Mesh | Kind::Shell | Kind::Export | Kind::Picture) {
            return None;
        }
        let signed = |t: usize| matches!(self.kind(t + 1), Some(Kind::Colon | Kind::Equals));
        let is_setting = |t: &usize| self.tokens.kinds[*t] == Kind::Name && signed(*t) && self.depth(*t) == 0;
        let first = (self.base + 2..self.end).find(is_setting)?;
        let before = |t: usize| self.kind(t.wrapping_sub(1));
        let mut head = first;
        while matches!(before(head), Some(Kind::Comma)) {
            head -= 1;
        }
        let (mut inner, mut head_text) = (String::new(), self.text(self.base, head));
        if before(head) == Some(Kind::CloseCurly) {
            let open = (self.base..head).find(|&t| self.tokens.kinds[t] == Kind::OpenCurly && self.closer(t) == Some(head - 1))?;
            inner = self.text(open + 1, head - 1).to_owned();
            head_text = self.text(self.base, open);
        }
        let rest = (first..self.end).filter(is_setting).fold(self.text(first, self.end).to_owned(), |rest, t| {
            let (key, value) = (self.text(t, t + 1), self.text(t, t + 3));
            rest.replacen(value, &format!("{key}: {}", self.text(t + 2, t + 3)), 1)
        });
        let rest = rest.trim_end_matches(['}', ' ', '\n']);
        let joined: Vec<&str> = [inner.trim(), rest].into_iter().filter(|t| !t.is_empty()).collect();
        let of = if self.tokens.kinds[self.base] == Kind::Mesh {
            "settings follow `mesh … of …` in braces"
        } else {
            "settings are in braces"
        };
        self.replaced(of, format!("{} {{ {} }}", head_text.trim_end(), joined.join("  ")))
    }

    /// `surface s = plane(rim) { size: 5mm }`
    fn settings_elsewhere(&self) -> Option<Meant> {
        let declares = matches!(self.tokens.kinds[self.base], Kind::Surface | Kind::Curve | Kind::Let);
        if !declares || self.kind(self.at) != Some(Kind::OpenCurly) || self.kind(self.at + 2) != Some(Kind::Colon) {
            return None;
        }
        let name = self.text(self.base + 1, self.base + 2);
        let typed = format!("{}\nmesh {name}_mesh of {name} {}", self.text(self.base, self.at), self.text(self.at, self.end));
        let whole = typed.split_once('\n').is_some_and(|(a, b)| is_declaration(a) && is_declaration(b));
        whole.then(|| Meant { why: "settings follow `mesh … of …` in braces", typed, at: self.whole() })
    }

    /// `mesh m = plate { … }`, `group g: plate`.
    fn of_missing(&self) -> Option<Meant> {
        let collects = matches!(self.tokens.kinds[self.base], Kind::Mesh | Kind::Shell | Kind::Group);
        if !collects || !matches!(self.kind(self.base + 2)?, Kind::Equals | Kind::Colon | Kind::In) {
            return None;
        }
        self.replaced("what it is made of follows `of`", self.with(self.base + 2, self.base + 3, "of"))
    }

    /// `point A(0, 0, 0)`, `curve c(…)`.
    fn name_with_brackets(&self) -> Option<Meant> {
        let declares = matches!(self.tokens.kinds[self.base], Kind::Point);
        if !declares || self.kind(self.base + 2) != Some(Kind::OpenRound) || self.closer(self.base + 2) != Some(self.end - 1) {
            return None;
        }
        self.replaced(
            "a name gets its value by `=`",
            format!("{} = {}", self.text(self.base, self.base + 2), self.text(self.base + 2, self.end)),
        )
    }

    /// `point A = 0, 0, 0`
    fn bare_point(&self) -> Option<Meant> {
        if self.tokens.kinds[self.base] != Kind::Point || self.kind(self.at) != Some(Kind::Comma) || self.depth(self.at) != 0 {
            return None;
        }
        let value = self.find(self.base, Kind::Equals)? + 1;
        self.replaced("a point has brackets around it", format!("{} ({})", self.text(self.base, value), self.text(value, self.end)))
    }

    /// `1,5m`
    fn decimal_comma(&self) -> Option<Meant> {
        let digits = |t: usize| self.kind(t) == Some(Kind::Number) && self.text(t, t + 1).bytes().all(|b| b.is_ascii_digit());
        let (before, behind) = (self.at.checked_sub(1)?, self.at + 1);
        let glued = self.tokens.ends[before] == *self.tokens.starts.get(self.at)?
            && Some(&self.tokens.ends[self.at]) == self.tokens.starts.get(behind);
        let number = matches!(self.kind(behind), Some(Kind::Number | Kind::Quantity));
        if self.kind(self.at) != Some(Kind::Comma) || !glued || !digits(before) || !number {
            return None;
        }
        let typed = format!("{}.{}", self.text(before, self.at), self.text(behind, behind + 1));
        let works = is_declaration(&self.with(before, behind + 1, &typed));
        works.then(|| Meant { why: "decimals follow a dot", typed, at: Some(self.tokens.stretch(before, behind)) })
    }

    /// `[i * 2 for i in range(4)]`
    fn loop_behind(&self) -> Option<Meant> {
        if self.kind(self.at) != Some(Kind::For) {
            return None;
        }
        let start = self.start_of_value(self.at);
        let end = self.end_of_value(self.at);
        let open = start.checked_sub(1)?;
        if self.kind(open) != Some(Kind::OpenSquare) || self.kind(end) != Some(Kind::CloseSquare) {
            return None;
        }
        let typed = format!("[{}: {}]", ranges(self.text(self.at, end)), self.text(start, self.at));
        let works = is_declaration(&self.with(open, end + 1, &typed));
        works.then(|| Meant { why: "the loop comes first", typed, at: Some(self.tokens.stretch(open, end)) })
    }

    /// `a if c else b`
    fn choice_behind(&self) -> Option<Meant> {
        if self.kind(self.at) != Some(Kind::If) || self.tokens.first[self.at] {
            return None;
        }
        let (start, end) = (self.start_of_value(self.at), self.end_of_value(self.at));
        let other = self.find(self.at + 1, Kind::Else).filter(|t| *t < end)?;
        let typed = format!("if {} then {} else {}", self.text(self.at + 1, other), self.text(start, self.at), self.text(other + 1, end));
        let works = is_declaration(&self.with(start, end, &typed));
        works.then(|| Meant { why: "the condition comes first", typed, at: Some(self.tokens.stretch(start, end - 1)) })
    }

    /// `param w: 4m`, `a[1:3]`
    fn colon_for_equals(&self) -> Option<Meant> {
        if self.kind(self.base + 2) == Some(Kind::Colon) && self.tokens.kinds[self.base].keyword().is_some() {
            return self.replaced("a name gets its value by `=`", self.with(self.base + 2, self.base + 3, " ="));
        }
        let inside = (self.base..self.at).rev().find(|&t| opens(self.tokens.kinds[t]) > 0)?;
        if self.kind(self.at) != Some(Kind::Colon) || self.kind(inside) != Some(Kind::OpenSquare) {
            return None;
        }
        let end = self.closer(inside)?;
        let typed = format!("[{}..{}]", self.text(inside + 1, self.at), self.text(self.at + 1, end));
        let works = is_declaration(&self.with(inside, end + 1, &typed));
        works.then(|| Meant { why: "a part of a list is written with `..`", typed, at: Some(self.tokens.stretch(inside, end)) })
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

/// Without the round brackets around the whole of it.
fn unbracketed(text: &str) -> String {
    let text = text.trim();
    let inner = text.strip_prefix('(').and_then(|t| t.strip_suffix(')')).filter(|t| !t.contains(['(', ')']));
    inner.unwrap_or(text).trim().to_owned()
}

/// `range(4)` as `0..4`, `range(1, 4)` as `1..4`.
fn ranges(text: &str) -> String {
    let Some((before, rest)) = text.split_once("range(") else { return text.to_owned() };
    let Some((inside, behind)) = rest.split_once(')') else { return text.to_owned() };
    match range(&inside.split(',').map(str::trim).collect::<Vec<_>>()) {
        Some(typed) => format!("{before}{typed}{behind}"),
        None => text.to_owned(),
    }
}

/// The range that `range(…)` of these arguments is.
pub(crate) fn range(arguments: &[&str]) -> Option<String> {
    let end = |text: &str| {
        if text.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_' || b == b'.') { text.to_owned() } else { format!("({text})") }
    };
    match arguments {
        [n] if !n.contains('(') => Some(format!("0..{}", end(n))),
        [a, b] if !a.contains('(') && !b.contains('(') => Some(format!("{}..{}", end(a), end(b))),
        _ => None,
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
