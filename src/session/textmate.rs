//! The grammar of editors that colour by patterns (TextMate), made from the tables that the interpreter uses.

use serde_json::{Value, json};

use crate::lang::eval::std::builtins;
use crate::lang::syntax::keywords::WORDS;
use crate::lang::syntax::number::{ANGLES, LENGTHS, MASSES};
use crate::lang::values::settings::BLOCKS;

/// A letter of a name.
const LETTER: &str = r"[\p{L}\p{Nl}\p{Mn}\p{Mc}\p{Nd}\p{Pc}]";
/// A name.
const NAME: &str = r"[\p{L}\p{Nl}_][\p{L}\p{Nl}\p{Mn}\p{Mc}\p{Nd}\p{Pc}]*";
/// No field: a single dot stands before those, two before the end of a range.
const NO_FIELD: &str = r"(?:(?<=\.\.)|(?<!\.))";
/// Before a colon every word is a name.
const NO_LABEL: &str = r"(?!\s*:)";

/// The grammar as a JSON file.
pub fn grammar() -> String {
    let words = |opens: bool| -> Vec<&'static str> {
        let all = WORDS.iter().filter(|w| w.keyword.is_some() == opens).map(|w| w.word);
        all.filter(|w| !CONSTANTS.contains(w) && !SIGNS.contains(w)).collect()
    };
    let binders = r"(?:modeling\s+)?curve|point|surface|let|param|shell|group|mesh|as";
    let functions: Vec<&str> = builtins().map(|b| b.name).collect();
    let settings: Vec<&str> = BLOCKS.iter().flat_map(|(_, table)| table.iter()).map(|s| s.key).collect();
    let sign = json!({ "name": "punctuation.loft" });
    let value = json!({
        "$schema": "https://raw.githubusercontent.com/martinring/tmlanguage/master/tmlanguage.json",
        "name": "Loft",
        "scopeName": "source.loft",
        "fileTypes": ["loft"],
        "patterns": [{ "include": "#value" }],
        "repository": {
            "value": { "patterns": [
                { "include": "#comment" }, { "include": "#text" }, { "include": "#number" },
                {
                    "match": format!(r"{NO_FIELD}{}\s+({NAME})", word(&format!("({binders})"))),
                    "captures": { "1": { "name": "keyword.declaration.loft" }, "2": { "patterns": [
                        { "match": format!("^(?:{})$", WORDS.iter().map(|w| w.word).collect::<Vec<_>>().join("|")), "name": "keyword.declaration.loft" },
                        { "match": ".+", "name": "variable.other.declaration.loft" },
                    ] } },
                },
                coloured(&words(true), "keyword.declaration.loft"),
                coloured(&words(false), "keyword.control.loft"),
                coloured(&SIGNS, "keyword.operator.word.loft"),
                // These are no names of fields: before a colon they are values too.
                { "match": format!("{NO_FIELD}{}", word(&one_of(CONSTANTS.to_vec()))), "name": "constant.language.loft" },
                { "match": format!(r"{}(?=\s*\()", word(&one_of(functions))), "name": "support.function.loft" },
                { "match": format!(r"{NAME}(?=\s*\()"), "name": "entity.name.function.loft" },
                { "match": format!(r"{}(?=\s*:)", word(&one_of(settings))), "name": "support.type.property-name.loft" },
                { "match": format!(r"{NAME}(?=\s*:)|(?<=\.)(?<!\.\.)\s*{NAME}"), "name": "variable.other.property.loft" },
                { "match": NAME, "name": "variable.other.loft" },
                { "match": r"==|!=|<=|>=|\.\.|[-+*/^&<>=]", "name": "keyword.operator.loft" },
                { "match": r"[,.:()\[\]{}]", "name": "punctuation.loft" },
            ] },
            "comment": { "patterns": [
                { "match": r"^\s*///(?!/).*$", "name": "comment.line.documentation.loft" },
                { "match": r"//.*$", "name": "comment.line.double-slash.loft" },
                { "include": "#block" },
            ] },
            "block": {
                "name": "comment.block.loft", "begin": r"/\*", "end": r"\*/", "patterns": [{ "include": "#block" }],
            },
            "text": {
                "name": "string.quoted.double.loft", "begin": "\"", "end": "\"|$",
                "patterns": [
                    { "match": r#"\\(?:["\\n{]|u\{[0-9A-Fa-f]{1,6}\})"#, "name": "constant.character.escape.loft" },
                    { "match": r"\\.", "name": "invalid.illegal.escape.loft" },
                    {
                        "name": "meta.interpolation.loft meta.embedded.line.loft", "begin": r"\{", "end": r"\}|(?=$)",
                        "beginCaptures": { "0": { "name": "punctuation.section.interpolation.begin.loft" } },
                        "endCaptures": { "0": { "name": "punctuation.section.interpolation.end.loft" } },
                        "patterns": [{ "include": "#curly" }, { "include": "#value" }],
                    },
                ],
            },
            "curly": {
                "begin": r"\{", "end": r"\}|(?=$)", "beginCaptures": { "0": sign }, "endCaptures": { "0": sign }, "patterns": [{ "include": "#curly" }, { "include": "#value" }],
            },
            "number": {
                "match": format!(r"\d(?:_?\d)*(?:\.\d(?:_?\d)*)?(?:[eE][-+]?\d(?:_?\d)*)?({})?", unit()),
                "name": "constant.numeric.loft",
                "captures": { "1": { "name": "keyword.other.unit.loft" } },
            },
        },
    });
    written(&value)
}

/// Words that are values.
const CONSTANTS: [&str; 3] = ["false", "none", "true"];
/// Words that stand between values as signs do.
const SIGNS: [&str; 4] = ["and", "not", "or", "within"];

/// The words in one pattern, the longer ones first.
fn one_of(mut words: Vec<&str>) -> String {
    words.sort_unstable_by_key(|w| (std::cmp::Reverse(w.len()), *w));
    words.dedup();
    format!("(?:{})", words.join("|"))
}

/// The pattern where whole words match it.
fn word(pattern: &str) -> String {
    format!("(?<!{LETTER}){pattern}(?!{LETTER})")
}

/// A rule for reserved words: names where they stand as fields or before a colon.
fn coloured(words: &[&str], scope: &str) -> Value {
    json!({ "match": format!("{NO_FIELD}{}{NO_LABEL}", word(&one_of(words.to_vec()))), "name": scope })
}

/// A unit behind its number.
fn unit() -> String {
    let plain = format!("(?:{}[23]?|{})", one_of(LENGTHS.to_vec()), one_of([ANGLES, MASSES].concat()));
    // `2m/t.x` and `2m/t(…)` divide by a name.
    format!(r"%|{plain}(?!{LETTER})(?:/{plain}(?!{LETTER})(?![(\[]|\.(?!\.)))?")
}

fn written(value: &Value) -> String {
    // A value of our own making can be written.
    serde_json::to_string_pretty(value).unwrap_or_default() + "\n"
}
