//! Free-format parameters: values between separators, texts counted in advance (`5Hround`).

use crate::io::cad::defect::{Defect, defect};

/// Where the values of a list of parameters stand in its text.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ParameterSpan {
    /// Nothing between two separators: the default is meant.
    Empty,
    /// A number or a bare word.
    Bare(usize, usize),
    /// The characters of a counted text.
    Text(usize, usize),
}

/// The two characters that part values and end the list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Separators {
    /// Between values.
    pub value: u8,
    /// After the last one.
    pub record: u8,
}

impl Default for Separators {
    fn default() -> Self {
        Self { value: b',', record: b';' }
    }
}

/// The values of one list.
#[derive(Debug, Default)]
pub struct Tokens {
    /// In order.
    pub tokens: Vec<ParameterSpan>,
    /// The separator of records was reached.
    pub ended: bool,
    /// Counted texts whose count was wrong: index of the value.
    pub miscounted: Vec<usize>,
}

/// Takes a text apart, from its start to the separator of records or the end.
pub fn tokens(text: &[u8], separators: Separators) -> Tokens {
    let mut found = Tokens::default();
    let is_end = |c: u8| c == separators.value || c == separators.record;
    let mut at = 0;
    loop {
        while text.get(at).is_some_and(u8::is_ascii_whitespace) {
            at += 1;
        }
        let token;
        (token, at) = match counted(text, at) {
            Some((from, to)) => {
                let (to, next, wrong) = settled(text, from, to, separators);
                if wrong {
                    found.miscounted.push(found.tokens.len());
                }
                (ParameterSpan::Text(from, to), next)
            }
            None => {
                let end = text[at.min(text.len())..].iter().position(|c| is_end(*c)).map_or(text.len(), |n| at + n);
                let to = at + text[at.min(end)..end].trim_ascii_end().len();
                (if to == at { ParameterSpan::Empty } else { ParameterSpan::Bare(at, to) }, end)
            }
        };
        let separator = text.get(at).copied();
        // Blanks after the last separator of a list that just stops are no value.
        if separator.is_some() || token != ParameterSpan::Empty {
            found.tokens.push(token);
        }
        match separator {
            Some(c) if c == separators.record => {
                found.ended = true;
                return found;
            }
            None => return found,
            Some(_) => at += 1,
        }
    }
}

/// The text after `5H` at a place, as a range.
fn counted(text: &[u8], at: usize) -> Option<(usize, usize)> {
    let digits = text[at.min(text.len())..].iter().take(9).take_while(|c| c.is_ascii_digit()).count();
    if digits == 0 || !matches!(text.get(at + digits), Some(b'H' | b'h')) {
        return None;
    }
    let count: usize = std::str::from_utf8(&text[at..at + digits]).ok()?.parse().ok()?;
    let from = at + digits + 1;
    Some((from, from.saturating_add(count).min(text.len())))
}

/// Checks that a separator follows a counted text; where none does the count is wrong and the text ends at a separator.
///
/// Returns the end of the text, where to go on, and whether the count was wrong.
fn settled(text: &[u8], from: usize, to: usize, separators: Separators) -> (usize, usize, bool) {
    let is_end = |c: &u8| *c == separators.value || *c == separators.record;
    let next = text[to..].iter().position(|c| !c.is_ascii_whitespace()).map_or(text.len(), |n| to + n);
    if next == text.len() || is_end(&text[next]) {
        return (to, next, false);
    }
    // Counted too far: its own last separator has only blanks behind it.
    let inside = text[from..to].trim_ascii_end();
    if let Some(last) = inside.last()
        && is_end(last)
    {
        let end = from + inside.len() - 1;
        return (end, end, true);
    }
    let end = text[to..].iter().position(is_end).map_or(text.len(), |n| to + n);
    (end, end, true)
}

/// Reads the values of one entity in order.
#[derive(Debug)]
pub struct ParameterReader<'a> {
    text: &'a [u8],
    tokens: &'a [ParameterSpan],
    at: usize,
    ended: bool,
    /// Values follow that are no lists of groups and properties.
    uncounted: bool,
}

impl<'a> ParameterReader<'a> {
    /// Over the values of a list; of one that was ended properly values may be left out at the end.
    pub fn new(text: &'a [u8], list: &'a Tokens) -> Self {
        Self { text, tokens: &list.tokens, at: 0, ended: list.ended, uncounted: false }
    }

    /// Values not read yet.
    pub fn left(&self) -> usize {
        self.tokens.len() - self.at
    }

    fn next(&mut self) -> ParameterSpan {
        let token = self.tokens.get(self.at).copied().unwrap_or(ParameterSpan::Empty);
        self.at = (self.at + 1).min(self.tokens.len());
        token
    }

    /// A real number; one left out is 0.
    pub fn real(&mut self, what: &str) -> Result<f64, Defect> {
        let value = self.at + 1;
        if self.left() == 0 {
            if self.ended {
                return Ok(0.0);
            }
            return Err(defect(format!("the values stop before the {what} (value {value})")));
        }
        match self.next() {
            ParameterSpan::Empty => Ok(0.0),
            ParameterSpan::Bare(from, to) => match real(&self.text[from..to]) {
                Some(x) => Ok(x),
                None => Err(defect(format!("`{}` is not a number ({what}, value {value})", shown(&self.text[from..to])))),
            },
            ParameterSpan::Text(..) => Err(defect(format!("a text is given where the {what} is expected (value {value})"))),
        }
    }

    /// A real number that may be missing at the end of the list.
    pub fn real_or(&mut self, default: f64) -> f64 {
        match self.next() {
            ParameterSpan::Bare(from, to) => real(&self.text[from..to]).unwrap_or(default),
            _ => default,
        }
    }

    /// Three real numbers.
    pub fn point(&mut self, what: &str) -> Result<glam::DVec3, Defect> {
        Ok(glam::DVec3::new(self.real(what)?, self.real(what)?, self.real(what)?))
    }

    /// As many real numbers, checked against what is left before anything is allocated.
    pub fn reals(&mut self, n: usize, what: &str) -> Result<Vec<f64>, Defect> {
        self.needs(n, 1, what)?;
        (0..n).map(|_| self.real(what)).collect()
    }

    /// As many points.
    pub fn points(&mut self, n: usize, what: &str) -> Result<Vec<glam::DVec3>, Defect> {
        self.needs(n, 3, what)?;
        (0..n).map(|_| self.point(what)).collect()
    }

    /// Fails unless `n` groups of `each` values are left.
    pub fn needs(&self, n: usize, each: usize, what: &str) -> Result<(), Defect> {
        let needed = n.saturating_mul(each);
        if needed <= self.left() {
            return Ok(());
        }
        Err(defect(format!("{n} of {what} are announced, which takes {needed} values, but {} are left", self.left())))
    }

    /// A whole number; one left out is 0.
    pub fn int(&mut self, what: &str) -> Result<i64, Defect> {
        let value = self.at + 1;
        let x = self.real(what)?;
        if x.fract() == 0.0 && x.abs() <= f64::from(i32::MAX) {
            return Ok(x as i64);
        }
        Err(defect(format!("{what} must be a whole number, got {x} (value {value})")))
    }

    /// A count or an index: a whole number from 0.
    pub fn count(&mut self, what: &str) -> Result<usize, Defect> {
        let x = self.int(what)?;
        usize::try_from(x).map_err(|_| defect(format!("{what} must not be negative, got {x}")))
    }

    /// A pointer to a directory entry, 0 for none.
    pub fn pointer(&mut self, what: &str) -> Result<u32, Defect> {
        Ok(self.int(what)?.unsigned_abs() as u32)
    }

    /// As many pointers.
    pub fn pointers(&mut self, n: usize, what: &str) -> Result<Vec<u32>, Defect> {
        self.needs(n, 1, what)?;
        (0..n).map(|_| self.pointer(what)).collect()
    }

    /// A text, counted or bare.
    pub fn text(&mut self) -> String {
        match self.next() {
            ParameterSpan::Text(from, to) | ParameterSpan::Bare(from, to) => shown(&self.text[from..to]),
            ParameterSpan::Empty => String::new(),
        }
    }

    /// Whether what follows the values is no lists of groups and properties, once those were read: more values than counts say.
    pub fn is_uncounted(&self) -> bool {
        self.uncounted || self.tokens[self.at..].iter().any(|token| *token != ParameterSpan::Empty)
    }

    /// The groups and properties that may follow the values of any entity: two counted lists of pointers.
    pub fn attached(&mut self) -> (Vec<u32>, Vec<u32>) {
        let mut list = || {
            let n = if self.left() > 0 { self.count("count of pointers").unwrap_or(usize::MAX) } else { 0 };
            self.uncounted |= n > self.left();
            self.pointers(n, "pointers").unwrap_or_default()
        };
        (list(), list())
    }
}

/// A finite number with an exponent letter E or D.
pub fn real(text: &[u8]) -> Option<f64> {
    const LONGEST: usize = 64;
    let text = text.trim_ascii();
    if text.is_empty() || text.len() > LONGEST {
        return None;
    }
    let mut copy = [0_u8; LONGEST];
    for (to, from) in copy.iter_mut().zip(text) {
        *to = if matches!(from, b'D' | b'd') { b'E' } else { *from };
    }
    let text = std::str::from_utf8(&copy[..text.len()]).ok()?;
    crate::base::text::parse_real(text).filter(|x| x.is_finite())
}

/// Bytes as text for names and messages, at most 200 characters, without what a terminal would act on.
pub fn shown(text: &[u8]) -> String {
    const LONGEST: usize = 200;
    let text: String = String::from_utf8_lossy(&text[..text.len().min(LONGEST)]).chars().filter(|c| !c.is_control()).collect();
    text.trim().to_owned()
}
