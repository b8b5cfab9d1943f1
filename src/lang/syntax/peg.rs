//! `grammar/loft.pest` once more, read for tokens instead of characters.
//!
//! pest matches characters and tells well what it expected, but takes twenty steps for a token. The tree of a declaration
//! follows from the kinds of its tokens alone, so the rules of the same file are read here as rules over kinds: a text
//! between quotes is a token, blanks are none, and words, numbers and strings are what the scanner made of them. What
//! matches gives the tree; what does not is given to pest, which says why. `fuzz.rs` holds that both accept the same.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use crate::lang::syntax::Rule;
use crate::lang::syntax::scan::scan;
use crate::lang::syntax::token::Kind;

/// The file that pest reads too.
const GRAMMAR: &str = include_str!("../../../grammar/loft.pest");

/// One step of matching.
#[derive(Clone, Debug)]
pub(crate) enum Op {
    /// A token of one of these kinds, a bit each.
    Kinds(u128),
    /// A string, which is one token or several with values between them; the number is that of `expr`.
    Text(usize),
    /// Another rule, by its number.
    Rule(usize),
    Sequence(Box<[Op]>),
    Choice(Box<[Op]>),
    /// Any number of times.
    Repeat(Box<Op>),
    Maybe(Box<Op>),
    /// Takes nothing and matches where this does not.
    Not(Box<Op>),
    /// Takes nothing and matches where this does.
    Look(Box<Op>),
    /// No line begins here.
    SameLine,
    Nothing,
    End,
}

/// A rule over tokens.
#[derive(Clone, Debug)]
pub(crate) struct TokenRule {
    /// What is told of it; `None` when nothing is.
    pub told: Option<Rule>,
    /// What matches inside it is not told.
    pub atomic: bool,
    pub op: Op,
}

/// Signs and words that no tree is made of.
const UNTOLD: &[&str] = &["comma", "colon", "eq", "dot", "lpar", "rpar", "rbracket", "lbrace", "rbrace", "single", "EOI"];

/// All rules that a declaration may need, the first of them `single`; `None` when the file holds what is not known here.
pub(crate) static RULES: LazyLock<Option<Vec<TokenRule>>> = LazyLock::new(|| {
    let rules = Reader { rest: GRAMMAR }.rules()?;
    let told = Rule::all_rules().iter().map(|rule| (format!("{rule:?}"), *rule)).collect();
    let mut compiler = Compiler { rules, told, numbers: BTreeMap::new(), out: Vec::new() };
    compiler.rule("single")?;
    Some(compiler.out)
});

/// The bit of a kind.
pub(crate) const fn bit(kind: Kind) -> u128 {
    1 << kind as u8
}

// ---- the file

/// An expression as it is written.
#[derive(Clone, Debug)]
enum Written {
    Text(String),
    Name(String),
    Sequence(Vec<Written>),
    Choice(Vec<Written>),
    Repeat(Box<Written>),
    Some(Box<Written>),
    Maybe(Box<Written>),
    Not(Box<Written>),
    Look(Box<Written>),
}

struct WrittenRule {
    modifier: char,
    body: Written,
}

struct Reader<'a> {
    rest: &'a str,
}

impl<'a> Reader<'a> {
    fn blanks(&mut self) {
        loop {
            self.rest = self.rest.trim_start();
            if !self.rest.starts_with("//") {
                return;
            }
            self.rest = self.rest.split_once('\n').map_or("", |(_, rest)| rest);
        }
    }

    fn takes(&mut self, sign: char) -> bool {
        self.blanks();
        let rest = self.rest.strip_prefix(sign);
        self.rest = rest.unwrap_or(self.rest);
        rest.is_some()
    }

    fn word(&mut self) -> Option<&'a str> {
        self.blanks();
        let end = self.rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(self.rest.len());
        let (word, rest) = self.rest.split_at(end);
        self.rest = rest;
        (!word.is_empty()).then_some(word)
    }

    fn rules(mut self) -> Option<BTreeMap<String, WrittenRule>> {
        let mut rules = BTreeMap::new();
        loop {
            self.blanks();
            if self.rest.is_empty() {
                return Some(rules);
            }
            let name = self.word()?.to_owned();
            let equals = self.takes('=');
            let modifier = ['_', '@', '$'].into_iter().find(|m| self.takes(*m)).unwrap_or(' ');
            if !equals || !self.takes('{') {
                return None;
            }
            let body = self.choice()?;
            if !self.takes('}') {
                return None;
            }
            rules.insert(name, WrittenRule { modifier, body });
        }
    }

    fn choice(&mut self) -> Option<Written> {
        let mut all = vec![self.sequence()?];
        while self.takes('|') {
            all.push(self.sequence()?);
        }
        if all.len() == 1 { all.pop() } else { Some(Written::Choice(all)) }
    }

    fn sequence(&mut self) -> Option<Written> {
        let mut all = vec![self.one()?];
        while self.takes('~') {
            all.push(self.one()?);
        }
        if all.len() == 1 { all.pop() } else { Some(Written::Sequence(all)) }
    }

    fn one(&mut self) -> Option<Written> {
        if self.takes('!') {
            return Some(Written::Not(Box::new(self.one()?)));
        }
        if self.takes('&') {
            return Some(Written::Look(Box::new(self.one()?)));
        }
        let mut found = if self.takes('(') {
            let inner = self.choice()?;
            self.takes(')').then_some(inner)?
        } else if self.takes('"') {
            Written::Text(self.text()?)
        } else {
            Written::Name(self.word()?.to_owned())
        };
        loop {
            found = if self.takes('*') {
                Written::Repeat(Box::new(found))
            } else if self.takes('+') {
                Written::Some(Box::new(found))
            } else if self.takes('?') {
                Written::Maybe(Box::new(found))
            } else if self.takes('{') {
                // So many times: only inside tokens.
                self.rest = self.rest.split_once('}')?.1;
                Written::Some(Box::new(found))
            } else {
                return Some(found);
            };
        }
    }

    /// The rest of a text between quotes.
    fn text(&mut self) -> Option<String> {
        let (mut text, mut chars) = (String::new(), self.rest.char_indices());
        loop {
            match chars.next()? {
                (at, '"') => {
                    self.rest = &self.rest[at + 1..];
                    return Some(text);
                }
                (_, '\\') => text.push(match chars.next()?.1 {
                    'n' => '\n',
                    't' => '\t',
                    'r' => '\r',
                    other => other,
                }),
                (_, other) => text.push(other),
            }
        }
    }
}

// ---- rules over tokens

struct Compiler {
    rules: BTreeMap<String, WrittenRule>,
    told: BTreeMap<String, Rule>,
    /// Rules met so far, and their numbers in `out`.
    numbers: BTreeMap<String, usize>,
    out: Vec<TokenRule>,
}

impl Compiler {
    /// The number of a rule, which is made when it is met first.
    fn rule(&mut self, name: &str) -> Option<usize> {
        if let Some(number) = self.numbers.get(name) {
            return Some(*number);
        }
        let number = self.out.len();
        self.numbers.insert(name.to_owned(), number);
        let modifier = self.rules.get(name)?.modifier;
        let told = self.told.get(name).copied().filter(|_| modifier != '_' && !UNTOLD.contains(&name) && !name.starts_with("kw_"));
        self.out.push(TokenRule { told, atomic: modifier == '@', op: Op::Nothing });
        self.out[number].op = match self.token(name) {
            Some(op) => op,
            None => {
                let body = self.rules.get(name)?.body.clone();
                self.op(&body)?
            }
        };
        Some(number)
    }

    /// Rules that are tokens, or less.
    fn token(&mut self, name: &str) -> Option<Op> {
        let words = |kind: u8| 1_u128.checked_shl(u32::from(kind)).unwrap_or(0);
        Some(match name {
            "name" => Op::Kinds(bit(Kind::Name)),
            "word" => Op::Kinds((Kind::Units as u8..=Kind::Near as u8).map(words).fold(bit(Kind::Name), |all, bit| all | bit)),
            "number" => Op::Kinds(bit(Kind::Number)),
            "quantity" => Op::Kinds(bit(Kind::Quantity)),
            "string" => Op::Text(self.rule("expr")?),
            _ => return None,
        })
    }

    fn op(&mut self, written: &Written) -> Option<Op> {
        let mut all = |parts: &[Written]| parts.iter().map(|part| self.op(part)).collect::<Option<Vec<Op>>>();
        Some(match written {
            Written::Text(text) => Op::Kinds(kinds_of(text)?),
            Written::Name(name) => match name.as_str() {
                "_s" | "SOI" => Op::Nothing,
                "_h" => Op::SameLine,
                "EOI" => Op::End,
                name => Op::Rule(self.rule(name)?),
            },
            Written::Sequence(parts) => {
                let parts = all(parts)?.into_iter().filter(|op| !matches!(op, Op::Nothing));
                Op::Sequence(parts.collect())
            }
            Written::Choice(parts) => {
                let parts = all(parts)?;
                let kinds = |op: &Op| if let Op::Kinds(kinds) = op { Some(*kinds) } else { None };
                match parts.iter().map(kinds).try_fold(0, |all, kinds| Some(all | kinds?)) {
                    Some(kinds) => Op::Kinds(kinds),
                    None => Op::Choice(parts.into()),
                }
            }
            Written::Repeat(inner) => Op::Repeat(Box::new(self.op(inner)?)),
            Written::Some(inner) => {
                let inner = self.op(inner)?;
                Op::Sequence([inner.clone(), Op::Repeat(Box::new(inner))].into())
            }
            Written::Maybe(inner) => Op::Maybe(Box::new(self.op(inner)?)),
            // Where a word ends is known already.
            Written::Not(inner) if matches!(&**inner, Written::Name(name) if name == "XID_CONTINUE") => Op::Nothing,
            Written::Not(inner) => Op::Not(Box::new(self.op(inner)?)),
            Written::Look(inner) => Op::Look(Box::new(self.op(inner)?)),
        })
    }
}

/// The kinds of the one token that is written so.
fn kinds_of(text: &str) -> Option<u128> {
    let one = |text: &str| match scan(text).kinds[..] {
        [kind] => Some(bit(kind)),
        _ => None,
    };
    // What opens a bracket is of another kind where it begins its line.
    if matches!(text, "(" | "[") {
        Some(one(text)? | scan(&format!("a{text}")).kinds.get(1).map_or(0, |kind| bit(*kind)))
    } else {
        one(text)
    }
}
