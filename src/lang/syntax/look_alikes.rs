//! Names whose letters come from two scripts, where one can be taken for a letter of the other, and names that look like another one of the
//! script [Unicode Technical Standard 39].
//!
//! What people write on purpose stays: Japanese, Chinese and Korean beside Latin, and the small Greek letters of formulas (`Δx`, `αmax`); the
//! parts of a name between `_` and digits are words of their own (`длина_x`).

use std::collections::BTreeSet;

use unicode_script::{Script, UnicodeScript};
use unicode_security::{MixedScript, is_potential_mixed_script_confusable_char, skeleton};

use crate::lang::diag::diagnostic::{Diagnostic, FileId};
use crate::lang::diag::span::Span;

/// Letters that a message names.
const SHOWN: usize = 4;

/// A word with letters of two scripts.
struct Mixed {
    /// The letters of the script that it has fewer of, each once.
    odd: Vec<char>,
    /// Their script, and that of the others.
    scripts: (Script, Script),
}

/// W229 for names of two scripts, and for those that look like another one.
pub fn found(source: &str, names: impl Iterator<Item = Span> + Clone, file: FileId) -> Vec<Diagnostic> {
    let text = |at: Span| &source[at.start as usize..at.end as usize];
    let latin: BTreeSet<&str> = names.clone().map(text).filter(|name| name.is_ascii()).collect();
    let others = names.filter(|at| !text(*at).is_ascii());
    others.filter_map(|at| mixed(text(at), file, at).or_else(|| twin(text(at), &latin, file, at))).collect()
}

/// W229 for a name that looks like one in Latin letters.
fn twin(name: &str, latin: &BTreeSet<&str>, file: FileId, at: Span) -> Option<Diagnostic> {
    if !name.chars().all(|c| c.is_ascii() || looks_latin(c)) {
        return None;
    }
    let plain = plain(name).filter(|plain| latin.contains(plain.as_str()))?;
    let odd = name.chars().find(|c| !c.is_ascii())?;
    let (script, code) = (odd.script().full_name(), u32::from(odd));
    let message = format!("`{name}` and `{plain}` look alike and are two names: `{odd}` (U+{code:04X}) is {script}");
    Some(
        Diagnostic::new("W229", message, file, at, format!("in {script} letters"))
            .help(format!("`{plain}`, or a name that looks different")),
    )
}

/// W229 for a name of two scripts.
fn mixed(name: &str, file: FileId, at: Span) -> Option<Diagnostic> {
    let found = name.split(|c: char| c == '_' || c.is_numeric()).find_map(word)?;
    let (one, other) = (found.scripts.0.full_name(), found.scripts.1.full_name());
    let letters: Vec<String> = found.odd.iter().take(SHOWN).map(|c| format!("`{c}` (U+{:04X})", u32::from(*c))).collect();
    let are = if letters.len() == 1 { "is" } else { "are" };
    let message = format!("`{name}` mixes letters of two scripts: {} {are} {one}, others are {other}", letters.join(", "));
    let report = Diagnostic::new("W229", message, file, at, format!("{one} and {other} in one word"));
    Some(report.help(match plain(name) {
        Some(plain) => format!("`{plain}` in Latin letters alone"),
        None => "write it in letters of one script, or put `_` between the two".to_owned(),
    }))
}

/// The letters of the rarer script of a word, where they can be taken for those of the other; `None` for a word of one script.
fn word(word: &str) -> Option<Mixed> {
    if word.is_ascii() || word.is_single_script() {
        return None;
    }
    let own = |c: char| !matches!(c.script(), Script::Common | Script::Inherited | Script::Unknown);
    let letters: Vec<char> = word.chars().filter(|c| own(*c)).collect();
    let deceiving = letters.iter().find(|c| deceives(**c, &letters))?.script();
    let (a, b): (Vec<char>, Vec<char>) = letters.iter().partition(|c| c.script() == deceiving);
    let other = b.first()?.script();
    let (odd, scripts) = if a.len() <= b.len() { (a, (deceiving, other)) } else { (b, (other, deceiving)) };
    let mut each: Vec<char> = Vec::new();
    odd.into_iter().filter(|c| c.script() == scripts.0).for_each(|c| {
        if !each.contains(&c) {
            each.push(c);
        }
    });
    Some(Mixed { odd: each, scripts })
}

/// Whether a letter can be taken for one of another script that stands in the same word.
fn deceives(c: char, letters: &[char]) -> bool {
    match c.script() {
        // The letter of the other script tells.
        Script::Latin => false,
        Script::Han | Script::Hiragana | Script::Katakana | Script::Hangul | Script::Bopomofo => false,
        // So many look alike that no word has both on purpose.
        Script::Cyrillic => letters.iter().any(|other| matches!(other.script(), Script::Latin | Script::Greek)),
        _ => looks_latin(c),
    }
}

/// Whether a letter of another script looks like a Latin one. The small Greek letters of formulas do not, but `ο`.
fn looks_latin(c: char) -> bool {
    is_potential_mixed_script_confusable_char(c) && !(matches!(c, 'α'..='ω') && c != 'ο')
}

/// The name with Latin letters in place of those that look like them, where all do.
fn plain(name: &str) -> Option<String> {
    let mut out = String::with_capacity(name.len());
    for c in name.chars() {
        if c.is_ascii() {
            out.push(c);
            continue;
        }
        let whole = c.to_string();
        let mut alike = skeleton(&whole);
        match (alike.next(), alike.next()) {
            (Some(one), None) if one.is_ascii_alphabetic() => out.push(one),
            _ => return None,
        }
    }
    Some(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(name: &str) -> String {
        mixed(name, FileId(0), Span { start: 0, end: 1 }).map_or_else(String::new, |report| report.message)
    }

    #[test]
    fn what_people_write_is_left_alone() {
        for name in [
            "area",
            "größe",
            "Δx",
            "αmax",
            "νxy",
            "ρ_air",
            "µm",
            "\u{3bc}m",
            "γ",
            "地球x",
            "3Dモデル",
            "x좌표",
            "длина_x",
            "длина2x",
            "الطول",
            "Ω0",
            "ÅngströmΔ",
            "hauteurΣ",
            "x\u{301}",
        ] {
            assert_eq!(message(name), "");
        }
    }

    #[test]
    fn names_that_look_like_another_are_told() {
        let told = |source: &str| {
            let names = source.split(' ').scan(0, |at, word| {
                let start = *at;
                *at += word.len() as u32 + 1;
                Some(Span { start, end: start + word.len() as u32 })
            });
            let spans: Vec<Span> = names.collect();
            found(source, spans.into_iter(), FileId(0)).into_iter().map(|report| report.message).collect::<Vec<_>>()
        };
        assert_eq!(told("a \u{430}"), ["`а` and `a` look alike and are two names: `а` (U+0430) is Cyrillic"]);
        assert_eq!(told("T1 \u{3a4}1 \u{3a4}2"), ["`Τ1` and `T1` look alike and are two names: `Τ` (U+03A4) is Greek"]);
        assert_eq!(told("p ρ v ν a α γ y \u{430}\u{431} ö o"), [""; 0]);
    }

    #[test]
    fn look_alikes_are_told() {
        let told = |name: &str| message(name).split_once(": ").map(|(_, told)| told.to_owned()).unwrap_or_default();
        assert_eq!(told("p\u{430}rt"), "`а` (U+0430) is Cyrillic, others are Latin");
        assert_eq!(told("длин\u{61}"), "`a` (U+0061) is Latin, others are Cyrillic");
        assert_eq!(told("flo\u{3bf}r"), "`ο` (U+03BF) is Greek, others are Latin");
        assert_eq!(told("\u{391}rea"), "`Α` (U+0391) is Greek, others are Latin");
        assert_eq!(told("\u{455}\u{441}\u{430}le"), "`l` (U+006C), `e` (U+0065) are Latin, others are Cyrillic");
        assert_eq!(plain("p\u{430}rt_1").as_deref(), Some("part_1"));
        assert_eq!(plain("длин\u{61}"), None);
    }
}
