//! Statements of other languages: values, functions, outputs, loops and choices with their words and signs.

use crate::lang::syntax::foreign::makes::keyword_of;
use crate::lang::syntax::foreign::{FUNCTION_WORDS, Meant, Refusal, opens};
use crate::lang::syntax::is_declaration;
use crate::lang::syntax::token::Kind;

/// Words that declare a value in other languages.
const VALUE_WORDS: [&str; 14] =
    ["const", "var", "val", "auto", "double", "float", "int", "number", "string", "bool", "static", "final", "local", "define"];

/// What other languages call showing a value.
pub(crate) const PRINTS: [&str; 6] = ["print", "println", "printf", "echo", "puts", "show"];

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

impl Refusal<'_> {
    /// A sign after `units`, `tolerance` or `snap`: `units = mm`, `tolerance: 1mm`.
    pub(crate) fn needless_sign(&self) -> Option<Meant> {
        let head = matches!(self.tokens.kinds[self.base], Kind::Units | Kind::Tolerance | Kind::Snap);
        let sign = matches!(self.kind(self.base + 1)?, Kind::Equals | Kind::Colon);
        let typed = format!("{} {}", self.text(self.base, self.base + 1), self.text(self.base + 2, self.end).trim_matches('"'));
        if head && sign { self.replaced("there is no sign between them", typed) } else { None }
    }

    /// `const k = 3`, `double k = 3`.
    pub(crate) fn value_word(&self) -> Option<Meant> {
        if !VALUE_WORDS.contains(&self.text(self.base, self.base + 1)) || self.kind(self.base + 2) != Some(Kind::Equals) {
            return None;
        }
        self.replaced("a value is declared by `let`", format!("let {}", self.text(self.base + 1, self.end)))
    }

    /// `def rib(y): return line(…)`, `function rib(y) = …`, `let rib(y) = …`.
    pub(crate) fn function_word(&self) -> Option<Meant> {
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
    pub(crate) fn printed(&self) -> Option<Meant> {
        if !PRINTS.contains(&self.text(self.base, self.base + 1)) {
            return None;
        }
        let bracket = self.kind(self.base + 1) == Some(Kind::OpenRound) && self.closer(self.base + 1) == Some(self.end - 1);
        let what = if bracket { self.text(self.base + 2, self.end - 1) } else { self.text(self.base + 1, self.end) };
        self.replaced("a value is shown by `report`", format!("report {what}"))
    }

    /// `circle(…)` without a keyword and a name.
    pub(crate) fn nameless(&self) -> Option<Meant> {
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

    /// An import of a module of Python: `import math`.
    pub(crate) fn python_import(&self) -> Option<Meant> {
        let imports = self.tokens.kinds[self.base] == Kind::Import || self.text(self.base, self.base + 1) == "from";
        let modules =
            ["math", "numpy", "cadquery", "build123d", "gmsh", "FreeCAD", "Part", "Draft", "rhinoscriptsyntax", "Rhino", "pygmsh", "solid"];
        let known = imports && self.kind(self.base + 1) == Some(Kind::Name) && modules.contains(&self.text(self.base + 1, self.base + 2));
        // An example of functions and constants that need no import.
        known.then(|| Meant { why: "functions need no import, delete this line", typed: "sin(30deg) + pi".to_owned(), at: None })
    }

    /// `if n > 3: …`, `for i in range(4): …` in the place of a declaration.
    pub(crate) fn statement(&self) -> Option<Meant> {
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

    /// `export(fine, "x.stl")`, `export fine, "x.stl"`, `export "x.stl" of fine`, `export "x.stl" { mesh: fine }`, `export fine as "x.stl"`,
    /// `export fine to x.stl`.
    pub(crate) fn called_output(&self) -> Option<Meant> {
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
            self.in_braces(path + 1, end).unwrap_or_else(|| self.text(path + 1 + skip, end))
        } else {
            let as_word = path > first && self.tokens.kinds[path - 1] == Kind::As;
            self.text(first, path - usize::from(as_word)).trim_end().trim_end_matches(',').trim_end()
        };
        self.replaced("the file follows `to`", format!("{} {things} to {}", self.text(self.base, self.base + 1), self.text(path, path + 1)))
    }

    /// `fine` of `{ fine }` and of `{ mesh: fine }`, where these are the tokens from `first` to `end`.
    fn in_braces(&self, first: usize, end: usize) -> Option<&str> {
        let whole = self.kind(first) == Some(Kind::OpenCurly) && self.closer(first) == Some(end - 1);
        let start = if self.kind(first + 2) == Some(Kind::Colon) { first + 3 } else { first + 1 };
        (whole && start + 1 < end).then(|| self.text(start, end - 1))
    }

    /// Settings without braces, behind them, or behind a comma.
    pub(crate) fn settings_apart(&self) -> Option<Meant> {
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
    pub(crate) fn settings_elsewhere(&self) -> Option<Meant> {
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
    pub(crate) fn of_missing(&self) -> Option<Meant> {
        let collects = matches!(self.tokens.kinds[self.base], Kind::Mesh | Kind::Shell | Kind::Group);
        if !collects || !matches!(self.kind(self.base + 2)?, Kind::Equals | Kind::Colon | Kind::In) {
            return None;
        }
        self.replaced("what it is made of follows `of`", self.with(self.base + 2, self.base + 3, "of"))
    }

    /// `point A(0, 0, 0)`, `curve c(…)`.
    pub(crate) fn name_with_brackets(&self) -> Option<Meant> {
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
    pub(crate) fn bare_point(&self) -> Option<Meant> {
        if self.tokens.kinds[self.base] != Kind::Point || self.kind(self.at) != Some(Kind::Comma) || self.depth(self.at) != 0 {
            return None;
        }
        let value = self.find(self.base, Kind::Equals)? + 1;
        self.replaced("a point has brackets around it", format!("{} ({})", self.text(self.base, value), self.text(value, self.end)))
    }

    /// `1,5m`
    pub(crate) fn decimal_comma(&self) -> Option<Meant> {
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

    /// A loop after its value: `[i * 2 for i in range(4)]`.
    pub(crate) fn loop_after_value(&self) -> Option<Meant> {
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

    /// A condition after its value: `a if c else b`.
    pub(crate) fn condition_after_value(&self) -> Option<Meant> {
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
    pub(crate) fn colon_for_equals(&self) -> Option<Meant> {
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
