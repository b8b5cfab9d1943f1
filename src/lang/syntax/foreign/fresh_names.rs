//! Names for what other languages make without one, and the functions that a source declares.

use std::cell::{OnceCell, RefCell};
use std::collections::{BTreeMap, BTreeSet};

use crate::lang::syntax::foreign::{FUNCTION_WORDS, looked};

/// Names for what was made without one: `circle_1`, `circle_2`, none of which stands in the source.
#[derive(Default)]
pub(crate) struct FreshNames {
    numbers: RefCell<BTreeMap<&'static str, (BTreeSet<u64>, u64)>>,
    /// What the source declares as a function, in the words of this language or another; found once.
    functions: OnceCell<BTreeSet<String>>,
}

impl FreshNames {
    /// The next free name that begins with a word; the source is searched once for each word.
    pub(crate) fn next(&self, source: &str, word: &'static str) -> String {
        let mut all = self.numbers.borrow_mut();
        let (taken, last) = all.entry(word).or_insert_with(|| (numbers_behind(source, word), 0));
        *last = (*last + 1..).find(|n| !taken.contains(n)).unwrap_or(u64::MAX);
        format!("{word}_{last}")
    }

    /// Whether a source makes a function of this name.
    pub(crate) fn is_function(&self, source: &str, name: &str) -> bool {
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
