//! Parsing under random texts: it never panics, every span lies in the text, and a known shape changes nothing.

use proptest::prelude::*;
use proptest::test_runner::TestRunner;

use crate::lang::syntax::ast::{Declaration, DeclarationKind, ExprId};
use crate::lang::syntax::*;

const TOUR: &str = include_str!("../../../tests/data/tour.loft");

const WORDS: &[&str] = &[
    "units",
    "tolerance",
    "snap",
    "use",
    "import",
    "param",
    "let",
    "fn",
    "point",
    "curve",
    "modeling",
    "modeling curve",
    "surface",
    "shell",
    "group",
    "mesh",
    "check",
    "report",
    "export",
    "picture",
    "of",
    "for",
    "in",
    "if",
    "then",
    "else",
    "and",
    "or",
    "not",
    "true",
    "false",
    "none",
    "within",
    "to",
    "as",
    "on",
    "near",
    "a",
    "A",
    "south",
    "지붕",
    "m",
    "_",
    "x1",
    "1",
    "1.5",
    "2m",
    "7850kg/m3",
    "5%",
    "1e-3",
    "0..5",
    "3mmm",
    "1__0",
    "1e999",
    ".5",
    "5.",
    "\"text\"",
    "\"{",
    "}\"",
    "\"a{1}b\"",
    "\"\\n\"",
    "\"",
    "(",
    ")",
    "[",
    "]",
    "{",
    "}",
    ",",
    ":",
    "=",
    ".",
    "..",
    "+",
    "-",
    "*",
    "/",
    "^",
    "&",
    "==",
    "!=",
    "<",
    "<=",
    ">",
    ">=",
    ";",
    "!",
    "\\",
    "//c",
    "///d",
    "/*",
    "*/",
    "/* c */",
    "\n",
    "\n",
    "\n",
    "\n  ",
    "\r\n",
    "\t",
    "\u{feff}",
    "°",
    "𝒳",
];

fn soup() -> impl Strategy<Value = String> {
    prop::collection::vec((0..WORDS.len(), prop::bool::weighted(0.85)), 0..60)
        .prop_map(|words| words.into_iter().map(|(w, blank)| format!("{}{}", WORDS[w], if blank { " " } else { "" })).collect())
}

/// Declarations of the tour with some of their characters lost, doubled or replaced by a word.
fn mutated() -> impl Strategy<Value = String> {
    prop::collection::vec((0..TOUR.len(), 0..4u8, 0..WORDS.len()), 1..12).prop_map(|changes| {
        let mut text: Vec<char> = TOUR.chars().collect();
        for (at, what, word) in changes {
            let at = at % text.len();
            match what {
                0 => drop(text.remove(at)),
                1 => text.insert(at, text[at]),
                2 => drop(text.splice(at..at + 1, WORDS[word].chars())),
                _ => drop(text.splice(at..(at + 9).min(text.len()), [])),
            }
        }
        text.into_iter().collect()
    })
}

fn spans_lie_in(text: &str, script: &Script, found: &[Diagnostic]) {
    let lies = |span: Span| text.get(span.start as usize..span.end as usize).is_some();
    for declaration in script.declarations.iter() {
        assert!(lies(declaration.span) && lies(declaration.keyword_span));
        for node in &declaration.nodes {
            assert!(lies(node.span) && node.span.start < node.span.end, "{node:?}");
            assert!(node.span.start >= declaration.span.start && node.span.end <= declaration.span.end);
        }
    }
    assert!(script.broken.iter().all(|b| lies(b.span)));
    for label in found.iter().flat_map(|d| &d.labels) {
        assert!(lies(label.span), "{label:?}");
    }
    let sorted = found.windows(2).all(|w| w[0].place() <= w[1].place());
    let spans: Vec<Span> = (0..script.declarations.len()).map(|at| script.declarations.span(at)).collect();
    assert!(sorted && spans.windows(2).all(|w| w[0].end <= w[1].start));
}

/// A declaration with all its places moved.
fn debug_of(declaration: &Declaration, names: &Names) -> String {
    format!("{:?} {:?}", declaration.kind, declaration.nodes.iter().map(|n| (&n.expr, n.span)).collect::<Vec<_>>())
        + &declaration_names(declaration, names)
}

fn declaration_names(declaration: &Declaration, names: &Names) -> String {
    match &declaration.kind {
        DeclarationKind::Value { bound, .. } => names.text(bound.name).to_owned(),
        _ => String::new(),
    }
}

/// Each declaration means the same alone, put at the same place, as among the others.
fn shapes_change_nothing(text: &str, script: &Script, names: &mut Names) {
    for declaration in script.declarations.iter().take(40) {
        let (start, end) = (declaration.span.start as usize, declaration.span.end as usize);
        let alone = format!("{}{}", " ".repeat(start), &text[start..end]);
        let (single, found) = parse(&alone, FileId(0), names);
        assert!(found.iter().all(|d| d.severity() != crate::base::fault::Severity::Error), "{found:?}");
        assert_eq!(single.declarations.len(), 1);
        assert_eq!(debug_of(&single.declarations.whole(0), names), debug_of(&declaration, names));
    }
}

/// What the pieces read without an error, the grammar reads as a whole.
fn the_grammar_agrees(text: &str, script: &Script, found: &[Diagnostic]) {
    if !found.iter().all(|d| matches!(d.code.0, "W220" | "W229")) || text.starts_with('\u{feff}') {
        return;
    }
    let pairs = Grammar::parse(Rule::script, text).unwrap_or_else(|e| panic!("{text}\n{e}"));
    let count = pairs.flat_map(|p| p.into_inner()).filter(|p| p.as_rule() != Rule::EOI).count();
    assert_eq!(count, script.declarations.len(), "{text}");
}

/// Each declaration matches over tokens as pest matches its characters, rule by rule and place by place.
fn tokens_match_as_characters(text: &str, script: &Script) {
    for declaration in script.declarations.iter().take(40) {
        let alone = &text[declaration.span.start as usize..declaration.span.end as usize];
        let tokens = scan::scan(alone);
        let mut marks = Marks::default();
        let pair = marks.declaration(&tokens, 0, tokens.len()).unwrap_or_else(|| panic!("{alone}"));
        let mut found = Vec::new();
        collect(pair, &mut found);
        let token = |byte: usize| tokens.starts.partition_point(|&start| (start as usize) < byte);
        let produced: Vec<Rule> = token_rules::RULES.as_ref().unwrap().iter().filter_map(|rule| rule.pair).collect();
        let pairs = Grammar::parse(Rule::single, alone).unwrap_or_else(|e| panic!("{e}")).flatten();
        let pairs = pairs.filter(|p| produced.contains(&p.as_rule()));
        let expected: Vec<(Rule, usize, usize)> =
            pairs.map(|p| (p.as_rule(), token(p.as_span().start()), token(p.as_span().end()))).collect();
        assert_eq!(found, expected, "{alone}");
    }
}

fn collect(pair: matching::Pair<'_>, out: &mut Vec<(Rule, usize, usize)>) {
    let Span { start, end } = pair.extent();
    out.push((pair.as_rule(), start as usize, end as usize + 1));
    pair.into_inner().for_each(|inner| collect(inner, out));
}

/// The rules over tokens are all of those that a declaration needs.
#[test]
fn the_grammar_is_read() {
    let rules = token_rules::RULES.as_ref().expect("the grammar holds only what is read here");
    assert!(rules.len() > 40 && rules.iter().all(|rule| !matches!(rule.op, token_rules::Op::Nothing)), "{rules:?}");
}

fn check(text: &str) -> Result<(), TestCaseError> {
    let mut names = Names::default();
    let (script, found) = parse(text, FileId(0), &mut names);
    spans_lie_in(text, &script, &found);
    the_grammar_agrees(text, &script, &found);
    tokens_match_as_characters(text, &script);
    shapes_change_nothing(text, &script, &mut names);
    let mut sources = crate::lang::diag::diagnostic::Sources::default();
    sources.add("fuzz.loft", text);
    crate::lang::diag::render::render_all(&found, &sources, true);
    Ok(())
}

#[test]
fn random_words_never_panic() {
    TestRunner::deterministic().run(&soup(), |text| check(&text)).unwrap();
}

#[test]
fn damaged_scripts_never_panic() {
    TestRunner::deterministic().run(&mutated(), |text| check(&text)).unwrap();
}

#[test]
fn random_characters_never_panic() {
    TestRunner::deterministic().run(&".{0,80}", |text| check(&text)).unwrap();
}

/// Generated expressions, so that most texts are sound and the shapes are deep.
fn expression() -> impl Strategy<Value = String> {
    let leaf =
        prop::sample::select(vec!["1", "2.5mm", "a", "south", "\"t\"", "true", "none", "5m/t", "x.y", "c[1]"]).prop_map(str::to_owned);
    leaf.prop_recursive(6, 60, 4, |inner| {
        let op = prop::sample::select(vec!["+", "-", "*", "/", "^", "&", "..", "and", "or"]);
        prop_oneof![
            (inner.clone(), op, inner.clone()).prop_map(|(a, op, b)| format!("{a} {op} {b}")),
            prop::collection::vec(inner.clone(), 1..4).prop_map(|v| format!("({})", v.join(", "))),
            prop::collection::vec(inner.clone(), 0..4).prop_map(|v| format!("[{}]", v.join(", "))),
            (inner.clone(), inner.clone()).prop_map(|(a, b)| format!("f({a}, of: {b})")),
            (inner.clone(), inner.clone()).prop_map(|(a, b)| format!("c[{a} .. {b}].start")),
            (inner.clone(), inner.clone()).prop_map(|(a, b)| format!("(let y = {a} in {b})")),
            (inner.clone(), inner.clone()).prop_map(|(a, b)| format!("(if ({a}) == ({b}) within 1% then {a} else {b})")),
            (inner.clone(), inner.clone()).prop_map(|(a, b)| format!("[for i in ({a}) if ({b}): {a}]")),
            inner.clone().prop_map(|a| format!("-{a}")),
            inner.clone().prop_map(|a| format!("\"v {{ {a} }} w\"")),
            inner.prop_map(|a| format!("{{key: {a}}}")),
        ]
    })
}

#[test]
fn sound_expressions_parse_and_repeat() {
    TestRunner::deterministic()
        .run(&prop::collection::vec(expression(), 1..4), |texts| {
            let text: String = texts.iter().chain(&texts).enumerate().map(|(n, t)| format!("let v{n} = {t}\n")).collect();
            let (script, found) = parse(&text, FileId(0), &mut Names::default());
            prop_assert!(found.iter().all(|d| matches!(d.code.0, "W220" | "W229")), "{}\n{:?}", text, found);
            let half = script.declarations.len() / 2;
            for (a, b) in script.declarations.iter().zip(script.declarations.iter().skip(half)) {
                let tree = |d: &Declaration| d.nodes.iter().map(|n| format!("{:?}", std::mem::discriminant(&n.expr))).collect::<Vec<_>>();
                prop_assert_eq!(tree(&a), tree(&b));
            }
            check(&text)
        })
        .unwrap();
}

#[test]
fn children_come_before_parents() {
    let (script, _) = parse(TOUR, FileId(0), &mut Names::default());
    for declaration in script.declarations.iter() {
        for (index, node) in declaration.nodes.iter().enumerate() {
            let text = format!("{:?}", node.expr);
            let children = text.split("ExprId(").skip(1).filter_map(|rest| rest.split(')').next()?.parse().ok());
            assert!(children.map(|n: u32| ExprId(n)).all(|child| child.index() < index), "{text}");
        }
    }
}
