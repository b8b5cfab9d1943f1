//! `grammar/loft.pest` as rules over tokens instead of characters.
//!
//! pest matches characters, about twenty steps for a token; the tree of a declaration follows from the kinds of its
//! tokens alone. So the rules that `build.rs` has `pest_meta` read from the file become rules over kinds: a text between
//! quotes is a token, blanks are none, and words, numbers and strings are what the scanner made of them. What matches gives the
//! tree; what does not goes to the parser that pest generates from the same file, whose error gives the message.
//! `fuzz.rs` checks that both accept the same. What the second matcher saves: [notes](../../../docs/notes/syntax.md).

use std::collections::BTreeMap;
use std::sync::LazyLock;

use crate::lang::syntax::Rule;
use crate::lang::syntax::scan::scan;
use crate::lang::syntax::token::Kind;

/// An expression of the grammar, as pest reads it.
enum GrammarExpr {
    Text(&'static str),
    Name(&'static str),
    Sequence(&'static [GrammarExpr]),
    Choice(&'static [GrammarExpr]),
    Repeat(&'static GrammarExpr),
    RepeatOnce(&'static GrammarExpr),
    Maybe(&'static GrammarExpr),
    NotAhead(&'static GrammarExpr),
    /// What stands only inside tokens, or nowhere.
    Other,
}

/// A rule of the grammar.
struct GrammarRule {
    name: &'static str,
    silent: bool,
    atomic: bool,
    expr: GrammarExpr,
}

/// The rules of `grammar/loft.pest`, in the order of the file.
static GRAMMAR: &[GrammarRule] = include!(concat!(env!("OUT_DIR"), "/grammar.rs"));

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
    /// Negative lookahead: consumes nothing and matches where this does not.
    NotAhead(Box<Op>),
    /// The next token does not begin a line.
    SameLine,
    Nothing,
    End,
}

/// A rule over tokens.
#[derive(Clone, Debug)]
pub(crate) struct TokenRule {
    /// The rule of the pair that a match produces; `None` when it produces none.
    pub pair: Option<Rule>,
    /// Rules inside it produce no pairs.
    pub atomic: bool,
    pub op: Op,
}

/// Rules of signs and ends, whose pairs no tree needs; words that start with `kw_` are left out as well.
const WITHOUT_PAIR: &[&str] = &["comma", "colon", "eq", "dot", "lpar", "rpar", "rbracket", "lbrace", "rbrace", "single", "EOI"];

/// All rules that a declaration may need, the first of them `single`; `None` when the file holds what is not known here.
pub(crate) static RULES: LazyLock<Option<Vec<TokenRule>>> = LazyLock::new(|| {
    let rules = GRAMMAR.iter().map(|rule| (rule.name, rule)).collect();
    let names = Rule::all_rules().iter().map(|rule| (format!("{rule:?}"), *rule)).collect();
    let mut compiler = Compiler { rules, names, numbers: BTreeMap::new(), out: Vec::new() };
    compiler.rule("single")?;
    Some(compiler.out)
});

/// The bit of a kind.
pub(crate) const fn bit(kind: Kind) -> u128 {
    1 << kind as u8
}

struct Compiler {
    /// The rules of the file by their names.
    rules: BTreeMap<&'static str, &'static GrammarRule>,
    /// The generated parser's rule of each name.
    names: BTreeMap<String, Rule>,
    /// Rules met so far, and their numbers in `out`.
    numbers: BTreeMap<String, usize>,
    out: Vec<TokenRule>,
}

impl Compiler {
    /// The number of a rule, which is compiled when it is met first.
    fn rule(&mut self, name: &str) -> Option<usize> {
        if let Some(number) = self.numbers.get(name) {
            return Some(*number);
        }
        let number = self.out.len();
        self.numbers.insert(name.to_owned(), number);
        let GrammarRule { silent, atomic, expr, .. } = self.rules.get(name)?;
        let silent = *silent || WITHOUT_PAIR.contains(&name) || name.starts_with("kw_");
        let pair = self.names.get(name).copied().filter(|_| !silent);
        self.out.push(TokenRule { pair, atomic: *atomic, op: Op::Nothing });
        self.out[number].op = match self.token(name) {
            Some(op) => op,
            None => self.op(expr)?,
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

    fn op(&mut self, expr: &GrammarExpr) -> Option<Op> {
        let mut all = |parts: &[GrammarExpr]| parts.iter().map(|part| self.op(part)).collect::<Option<Vec<Op>>>();
        Some(match expr {
            GrammarExpr::Text(text) => Op::Kinds(kinds_of(text)?),
            GrammarExpr::Name("_s" | "SOI") => Op::Nothing,
            GrammarExpr::Name("_h") => Op::SameLine,
            GrammarExpr::Name("EOI") => Op::End,
            GrammarExpr::Name(name) => Op::Rule(self.rule(name)?),
            GrammarExpr::Sequence(parts) => {
                let parts = all(parts)?.into_iter().filter(|op| !matches!(op, Op::Nothing));
                Op::Sequence(parts.collect())
            }
            GrammarExpr::Choice(parts) => {
                let parts = all(parts)?;
                let kinds = |op: &Op| if let Op::Kinds(kinds) = op { Some(*kinds) } else { None };
                match parts.iter().map(kinds).try_fold(0, |all, kinds| Some(all | kinds?)) {
                    Some(kinds) => Op::Kinds(kinds),
                    None => Op::Choice(parts.into()),
                }
            }
            GrammarExpr::Repeat(inner) => Op::Repeat(Box::new(self.op(inner)?)),
            GrammarExpr::RepeatOnce(inner) => {
                let inner = self.op(inner)?;
                Op::Sequence([inner.clone(), Op::Repeat(Box::new(inner))].into())
            }
            GrammarExpr::Maybe(inner) => Op::Maybe(Box::new(self.op(inner)?)),
            // The scanner has found where a word ends.
            GrammarExpr::NotAhead(GrammarExpr::Name("XID_CONTINUE")) => Op::Nothing,
            GrammarExpr::NotAhead(inner) => Op::NotAhead(Box::new(self.op(inner)?)),
            GrammarExpr::Other => return None,
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
