//! The reserved words: what each is, how it is written, and what it means. Scanner, messages and reference read this table.
//!
//! The code that does what a word asks for:
//!
//! | word | code |
//! |---|---|
//! | `curve`, `modeling curve`, `point` | [`Network::build_after`](crate::network::Network::build_after) |
//! | `snap` | [`network::snap::snap`](crate::network::snap::snap) |
//! | `surface` | [`Model::build`](crate::model::Model::build) |
//! | `shell` | [`Model::shell`](crate::model::Model::shell) |
//! | `mesh`, `group` | [`mesh::MeshLayouts::build`](crate::mesh::MeshLayouts::build) |
//! | `on` | [`segment_rules`](crate::mesh::size::segment_rules) for borders, [`face_settings`](crate::mesh::size::face_settings) for faces |
//! | `near`, `in` (of a mesh) | [`SizeRequests::new`](crate::mesh::request::size_requests::SizeRequests::new), [`sources`](crate::mesh::request::sources) |
//! | `export` | [`endings::ending_for`](crate::io::formats::endings::ending_for), [`choice::format_for`](crate::io::formats::choice::format_for); written by `session/export.rs` |
//! | `check`, `report` | `lang/declare/outputs.rs`; a failed check writes nothing: `session/run.rs` |
//! | `import`, `param`, `use` | `lang/declare/imports.rs`, `lang/declare/params.rs`, `lang/eval/load.rs` |
//! | `picture` | [`draw::Picture::new`](crate::draw::Picture::new) |
//! | `tolerance` | [`Tolerance::new`](crate::base::tolerance::Tolerance::new) |

use crate::lang::syntax::ast::Keyword;
use crate::lang::syntax::token::Kind;

/// A reserved word.
#[derive(Debug)]
pub struct KeywordDoc {
    /// As written; `modeling` opens the two words `modeling curve`.
    pub word: &'static str,
    pub(crate) kind: Kind,
    /// The declaration that it opens, when it opens one.
    pub keyword: Option<Keyword>,
    /// How it is used, a line each.
    pub form: &'static str,
    /// What it means.
    pub docs: &'static str,
}

const fn opens(word: &'static str, kind: Kind, keyword: Keyword, form: &'static str, docs: &'static str) -> KeywordDoc {
    KeywordDoc { word, kind, keyword: Some(keyword), form, docs }
}

const fn inside(word: &'static str, kind: Kind, form: &'static str, docs: &'static str) -> KeywordDoc {
    KeywordDoc { word, kind, keyword: None, form, docs }
}

/// All reserved words, sorted.
pub static WORDS: [KeywordDoc; 36] = [
    inside("and", Kind::AndWord, "a and b", "True when both are; the right side is evaluated only when the left is true."),
    inside("as", Kind::As, "use \"ribs.loft\" as ribs", "The name of what is loaded."),
    opens(
        "check",
        Kind::Check,
        Keyword::Check,
        "check condition\ncheck \"label\": condition\ncheck ribs[i].length > 1m for i in 0..5",
        "A condition that must hold; otherwise the run fails and writes nothing. Both sides, their difference and the tolerance are reported.",
    ),
    opens(
        "curve",
        Kind::Curve,
        Keyword::Curve,
        "curve name = value\ncurve name for i in list = value",
        "A curve of the model's network, which gets a node where it ends or meets another. With `for` a family: `name[i]`.",
    ),
    inside("else", Kind::Else, "if condition then a else b", "The value when the condition is false."),
    opens(
        "export",
        Kind::Export,
        Keyword::Export,
        "export things to \"file.ending\"\nexport things to \"file.ending\" { settings }\nexport plates[i] for i in 0..3 to \"plate_{i}.stl\"",
        "A file, in the format of its ending. All files of a run are put in place together, when every check has passed.",
    ),
    inside("false", Kind::False, "false", "A condition that does not hold."),
    opens(
        "fn",
        Kind::Fn,
        Keyword::Fn,
        "fn name(a, b: type, c: type = default) = value\nfn name(a): type = value",
        "A function: its value depends on its arguments and the script's names alone. Types are optional; it may call itself.",
    ),
    inside(
        "for",
        Kind::For,
        "[for i in list if condition: value]\ncurve name for i in list = value",
        "Takes the members of a list or range in turn; more `for`s nest.",
    ),
    opens(
        "group",
        Kind::Group,
        Keyword::Group,
        "group name of things",
        "Things under one name: a node or element set in every file that has sets.",
    ),
    inside("if", Kind::If, "if condition then a else b", "One of two values; in a comprehension, keeps the members for which it holds."),
    opens(
        "import",
        Kind::Import,
        Keyword::Import,
        "import \"file.csv\" as name\nimport \"file.csv\" (header: true  unit: m) as name",
        "Data: csv, dat, txt, json, OBJ, STL, IGES or STEP (`part.curves[0]`, `part[\"deck\"]`). Curves of it join the network when a `curve` binds them.",
    ),
    inside(
        "in",
        Kind::In,
        "for i in list\nlet x = a in value\nparam p = a in a to b",
        "The list of a loop, the value in which a local name is valid, or the allowed range.",
    ),
    opens(
        "let",
        Kind::Let,
        Keyword::Let,
        "let name = value\nlet name for i in list = value\nlet name = a in value",
        "A name for any value. Curves and surfaces of a `let` are construction geometry: not meshed, drawn or exported unless asked.",
    ),
    opens(
        "mesh",
        Kind::Mesh,
        Keyword::Mesh,
        "mesh name of things { settings  on things { settings } }",
        "A mesh of surfaces, shells, curves or points, conforming over all their faces.",
    ),
    opens(
        "modeling",
        Kind::Modeling,
        Keyword::ModelingCurve,
        "modeling curve name = chain\nmodeling curve name for i in list = chain",
        "A chain of links of the network, from which surfaces are built: `south[A .. ribs[2]] + ribs[2][south .. B]`.",
    ),
    inside(
        "near",
        Kind::Near,
        "near points { size: 5mm  radius: 20mm }",
        "A clause of a mesh: smaller elements near points and curves, growing from there.",
    ),
    inside("none", Kind::None, "none", "No value; an empty cell of a table."),
    inside("not", Kind::Not, "not a", "True when the condition is false."),
    inside("of", Kind::Of, "mesh name of things", "What a shell, group or mesh contains; nested lists are flattened."),
    inside(
        "on",
        Kind::On,
        "on things { count: 20  bias: 2 }",
        "A clause of a mesh: settings for the links, curves, edges or faces named. The later of two equal rules applies.",
    ),
    inside("or", Kind::OrWord, "a or b", "True when either is; the right side is evaluated only when the left is false."),
    opens(
        "param",
        Kind::Param,
        Keyword::Param,
        "param name = default\nparam name: type = default\nparam name = default in a to b\nparam name = word in [word, other]",
        "A value that may be set from outside by a literal: `--set name=value`, a column of a design table, or `use`. A range includes \
         both ends.",
    ),
    opens("picture", Kind::Picture, Keyword::Picture, "picture things to \"file.png\" { settings }", "A picture of things."),
    opens(
        "point",
        Kind::Point,
        Keyword::Point,
        "point name = (x, y, z)\npoint name for i in list = value",
        "A point of the model; of a pair z is 0. A node that curves make within the tolerance of it is this point.",
    ),
    opens(
        "report",
        Kind::Report,
        Keyword::Report,
        "report value\nreport \"title\": value\nreport value for i in list",
        "A table in the summary and the JSON report: of records, lists, or the members of an entity. One entity shows its members \
         (those of its kind in the reference) a row each, with units; a family, a group or several things a row for each thing. A list \
         among the members is shown by its length.",
    ),
    opens(
        "shell",
        Kind::Shell,
        Keyword::Shell,
        "shell name of surfaces",
        "Surfaces joined to one: a composite surface, or the boundary of a solid when it is closed.",
    ),
    opens(
        "snap",
        Kind::Snap,
        Keyword::Snap,
        "snap length",
        "For measured data: curve ends closer than this are moved together before anything is built; what is made from them follows. Every move is reported.",
    ),
    opens(
        "surface",
        Kind::Surface,
        Keyword::Surface,
        "surface name = value\nsurface name for i in list = value",
        "A surface of the model, with patches, edges and vertices. `-s` reverses its normal.",
    ),
    inside("then", Kind::Then, "if condition then a else b", "The value when the condition is true."),
    inside("to", Kind::To, "export things to \"file.stl\"\nparam p = 3 in 1 to 5", "Where a file goes, or the last value allowed."),
    opens(
        "tolerance",
        Kind::Tolerance,
        Keyword::Tolerance,
        "tolerance length\ntolerance length, angle",
        "When two points are one, and how sharp a turn is a kink. Default 1e-6 of the model's diagonal, rounded down to a power of ten, and \
         0.1deg.",
    ),
    inside("true", Kind::True, "true", "A condition that holds."),
    opens("units", Kind::Units, Keyword::Units, "units m", "The model unit: of bare lengths, reports and files. Default mm."),
    opens(
        "use",
        Kind::Use,
        Keyword::Use,
        "use \"ribs.loft\" as ribs\nuse \"ribs.loft\" (height: 3m) as ribs",
        "Another script as a module, with its own units, network and checks; its params may be given.",
    ),
    inside(
        "within",
        Kind::Within,
        "a == b within 0.1mm\na == b within 0.1%",
        "How far two quantities may differ and be equal: absolute, or of the right side.",
    ),
];

/// Where the words of each letter begin among all.
static BY_LETTER: [u8; 27] = by_letter();

const fn by_letter() -> [u8; 27] {
    let mut from = [WORDS.len() as u8; 27];
    let mut word = WORDS.len();
    while word > 0 {
        word -= 1;
        from[(WORDS[word].word.as_bytes()[0] - b'a') as usize] = word as u8;
    }
    // A letter without words ends where the next one begins.
    let mut letter = 26;
    while letter > 0 {
        letter -= 1;
        if from[letter] as usize == WORDS.len() {
            from[letter] = from[letter + 1];
        }
    }
    from
}

/// The entry of a word.
pub fn find(word: &str) -> Option<&'static KeywordDoc> {
    let letter = usize::from(word.as_bytes().first()?.checked_sub(b'a')?);
    let (from, to) = (*BY_LETTER.get(letter)?, *BY_LETTER.get(letter + 1)?);
    WORDS[usize::from(from)..usize::from(to)].iter().find(|w| w.word == word)
}

/// Words that open a declaration, in the order of [`Keyword`].
pub fn openers() -> Vec<&'static KeywordDoc> {
    let mut found: Vec<&KeywordDoc> = WORDS.iter().filter(|w| w.keyword.is_some()).collect();
    found.sort_by_key(|w| w.keyword);
    found
}

impl KeywordDoc {
    /// As the user writes it: `modeling curve` has two words.
    pub fn written(&self) -> &'static str {
        if self.keyword == Some(Keyword::ModelingCurve) { "modeling curve" } else { self.word }
    }
}

/// The words of a declaration keyword.
pub fn written(keyword: Keyword) -> &'static str {
    WORDS.iter().find(|w| w.keyword == Some(keyword)).map_or("", KeywordDoc::written)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lang::syntax::token::kind_of_word;

    #[test]
    fn words_are_sorted_and_found_and_told() {
        assert!(WORDS.windows(2).all(|w| w[0].word < w[1].word));
        for word in &WORDS {
            assert!(kind_of_word(word.word) == word.kind && word.kind.is_reserved() && word.kind.keyword() == word.keyword);
            assert!(word.docs.ends_with('.') && word.form.lines().all(|line| line.contains(word.word)), "{}", word.word);
        }
        assert_eq!(openers().len(), 19);
        assert_eq!(kind_of_word("letter"), Kind::Name);
        assert_eq!(kind_of_word("m"), Kind::Name);
    }

    /// The grammar must name its words itself; these are the same.
    #[test]
    fn the_grammar_reserves_these_words() {
        let grammar = include_str!("../../../grammar/loft.pest");
        let rule = grammar.split("reserved = @{").nth(1).and_then(|rest| rest.split('}').next()).unwrap_or("");
        let mut reserved: Vec<&str> = rule.split('"').skip(1).step_by(2).collect();
        reserved.sort_unstable();
        assert!(reserved.iter().eq(WORDS.iter().map(|w| &w.word)));
    }
}
