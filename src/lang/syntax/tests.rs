use crate::lang::syntax::ast::{Declaration, DeclarationKind, Expr, ExprId, Keyword, TextPart};
use crate::lang::syntax::*;

fn parsed(source: &str) -> (Script, Vec<Diagnostic>, Names) {
    let mut names = Names::default();
    let (script, found) = parse(source, FileId(0), &mut names);
    (script, found, names)
}

/// The tree of an expression with all brackets written.
fn shown(declaration: &Declaration, id: ExprId, names: &Names) -> String {
    let show = |id: ExprId| shown(declaration, id, names);
    let all = |ids: &[ExprId]| ids.iter().map(|&i| show(i)).collect::<Vec<_>>().join(" ");
    let args = |args: &[crate::lang::syntax::ast::Arg]| {
        args.iter()
            .map(|a| a.name.map_or(String::new(), |(n, _)| format!("{}:", names.text(n))) + &show(a.value))
            .collect::<Vec<_>>()
            .join(" ")
    };
    match &declaration.nodes[id.index()].expr {
        Expr::Number(x) => format!("{x:?}").trim_end_matches(".0").to_owned(),
        Expr::Quantity(x, unit) => format!("{x:?}").trim_end_matches(".0").to_owned() + unit,
        Expr::Text(parts) => {
            let part = |p: &TextPart| match p {
                TextPart::Literal(text) => format!("{text:?}"),
                TextPart::Value(id) => show(*id),
            };
            format!("<{}>", parts.iter().map(part).collect::<Vec<_>>().join(" "))
        }
        Expr::Bool(b) => b.to_string(),
        Expr::None => "none".into(),
        Expr::Name(name) => names.text(*name).into(),
        Expr::Call { name, of, args: list, .. } => match of {
            Some(of) => format!("{}.{}({})", show(*of), names.text(*name), args(list)),
            None => format!("{}({})", names.text(*name), args(list)),
        },
        Expr::Field { of, name, .. } => format!("{}.{}", show(*of), names.text(*name)),
        Expr::Index { of, index } => format!("{}[{}]", show(*of), show(*index)),
        Expr::Slice { from, to } => format!("{}..{}", from.map_or(String::new(), show), to.map_or(String::new(), show)),
        Expr::Tuple(items) => format!("(, {})", all(items)),
        Expr::List(items) => format!("[{}]", all(items)),
        Expr::Comprehension { clauses, body } => {
            let clause = |c: &crate::lang::syntax::ast::Clause| match c {
                crate::lang::syntax::ast::Clause::For(f) => format!("for {} in {}", names.text(f.name), show(f.list)),
                crate::lang::syntax::ast::Clause::If(c) => format!("if {}", show(*c)),
            };
            format!("[{}: {}]", clauses.iter().map(clause).collect::<Vec<_>>().join(" "), show(*body))
        }
        Expr::Record(pairs) => {
            format!("{{{}}}", pairs.iter().map(|(n, v)| format!("{}:{}", names.text(*n), show(*v))).collect::<Vec<_>>().join(" "))
        }
        Expr::Unary(op, x) => format!("({op:?} {})", show(*x)),
        Expr::Binary { op, a, b, .. } => format!("({op:?} {} {})", show(*a), show(*b)),
        Expr::Within { of, tolerance } => format!("(within {} {})", show(*of), show(*tolerance)),
        Expr::If { condition, then, otherwise } => format!("(if {} {} {})", show(*condition), show(*then), show(*otherwise)),
        Expr::Let { name, value, body, .. } => format!("(let {} {} {})", names.text(*name), show(*value), show(*body)),
    }
}

/// Parses `let x = <text>` and compares its tree.
fn check(text: &str, tree: &str) {
    let (script, found, names) = parsed(&format!("let x = {text}\n"));
    assert!(found.is_empty(), "{text}: {found:?}");
    let DeclarationKind::Value { value, .. } = script.declarations.whole(0).kind else { panic!("no value") };
    assert_eq!(shown(&script.declarations.whole(0), value, &names), tree, "{text}");
}

#[test]
fn operators_bind_as_the_language_says() {
    check("-2^2", "(Minus (Power 2 2))");
    check("2^-2", "(Power 2 (Minus 2))");
    check("2^3^4", "(Power 2 (Power 3 4))");
    check("a - b - c", "(Minus (Minus a b) c)");
    check("a & b + (0, 0, 1m)", "(Plus (Meet a b) (, 0 0 1m))");
    check("-c[A..B]", "(Minus c[A..B])");
    check("-a & b * c", "(Times (Meet (Minus a) b) c)");
    check("1 + 2 * 3 / 4", "(Plus 1 (Divide (Times 2 3) 4))");
    check("0 < x and x < 5 or not y == z", "(Or (And (Less 0 x) (Less x 5)) (Not (Equal y z)))");
    check("a + 1 .. b * 2", "(Run (Plus a 1) (Times b 2))");
    check("a == b within 0.1%", "(within (Equal a b) 0.1%)");
    check("if a then b else c + 1", "(if a b (Plus c 1))");
    check("1 + let y = 3 in y * 2", "(Plus 1 (let y 3 (Times y 2)))");
    check("a + not b == c", "(Plus a (Not (Equal b c)))");
    check("- -x", "(Minus (Minus x))");
}

#[test]
fn postfixes_chain() {
    check("-a.b(1)[2]^2", "(Minus (Power a.b(1)[2] 2))");
    check("f(a, key: 1)\n  .start\n  .x", "f(a key:1).start.x");
    check("c[..B] + c[A..] + c[1] + c[-1]", "(Plus (Plus (Plus c[..B] c[A..]) c[1]) c[(Minus 1)])");
    check("south[A .. ribs[2]]", "south[A..ribs[2]]");
    check("c[(0..3)]", "c[(Run 0 3)]");
    check("f(near: A, of: B).mesh", "f(near:A of:B).mesh");
    check("p.at(30%)", "p.at(30%)");
}

#[test]
fn literals() {
    check("1_000 + 1.5e-3", "(Plus 1000 0.0015)");
    check("0..5", "(Run 0 5)");
    check("7850kg/m3 * 2m2 / 3in", "(Divide (Times 7850kg/m3 2m2) 3in)");
    check("5m/t", "5m/t");
    check("5m/total + 5m/t.x", "(Plus (Divide 5m total) (Divide 5m t.x))");
    check(r#""a{b + 1}c{"x{y}"}\n\u{41}""#, r#"<"a" (Plus b 1) "c" <"x" y> "\nA">"#);
    check(r#""{a}""#, "<a>");
    check(r#""""#, "<>");
    check(r#""{ {a: 1}.a }""#, "<{a:1}.a>");
    check("[for i in 0..5 if i != 2 for j in 0..i: (i, j)]", "[for i in (Run 0 5) if (NotEqual i 2) for j in (Run 0 i): (, i j)]");
    check("{a: 1, of: [true, none,]}", "{a:1 of:[true none]}");
    check("if true then let a = 1 in\n let b = 2 in a + b else [let c = 1 in c]", "(if true (let a 1 (let b 2 (Plus a b))) [(let c 1 c)])");
}

const TOUR: &str = include_str!("../../../tests/data/tour.loft");

#[test]
fn every_declaration_of_the_language_parses() {
    let (script, found, names) = parsed(TOUR);
    assert!(found.is_empty(), "{found:#?}");
    let mut keywords: Vec<Keyword> = script.declarations.keywords().collect();
    keywords.sort_unstable();
    keywords.dedup();
    assert_eq!(keywords.len(), 19);
    for declaration in script.declarations.iter() {
        let text = &TOUR[declaration.span.start as usize..declaration.span.end as usize];
        let keyword = &TOUR[declaration.keyword_span.start as usize..declaration.keyword_span.end as usize];
        let (first, last) = (keyword.split(' ').next().unwrap(), keyword.split(' ').next_back().unwrap());
        let listed = Some(keywords::written(declaration.keyword)).is_some_and(|word| word.starts_with(first) && word.ends_with(last));
        assert!(text.starts_with(keyword) && listed, "{text}");
        assert!(declaration.nodes.iter().all(|n| n.span.start >= declaration.span.start && n.span.end <= declaration.span.end));
    }
    let documented = script.declarations.iter().find(|d| d.doc.is_some()).unwrap();
    assert_eq!(documented.doc.as_deref(), Some("Span of the hall.\nBetween the outer faces."));
    let DeclarationKind::Param { bound, .. } = documented.kind else { panic!("not a param") };
    assert_eq!(names.text(bound.name), "span");
}

#[test]
fn the_whole_grammar_reads_what_the_pieces_read() {
    let pairs = Grammar::parse(Rule::script, TOUR).unwrap();
    let whole = pairs.flat_map(|p| p.into_inner()).filter(|p| p.as_rule() != Rule::EOI).count();
    assert_eq!(whole, parsed(TOUR).0.declarations.len());
}

#[test]
fn the_square_of_a_length_is_no_area() {
    let (_, found, _) = parsed("let a = 2m^2\nlet b = 2m2 ^ 2\nlet c = (2m)^2\nlet d = 3mm^3 + 4mm^n\n");
    let said: Vec<(&str, u32)> = found.iter().map(|d| (d.message.as_str(), d.labels[0].span.start)).collect();
    assert_eq!(said, [("`2m^2` is the square of 2m", 8), ("`3mm^3` is the cube of 3mm", 52)]);
}

/// Texts that parse alone parse the same behind another declaration of their shape.
#[test]
fn a_known_shape_gives_the_same_tree() {
    let (first, _, _) = parsed(TOUR);
    let (second, found, _) = parsed(&format!("{TOUR}\n{TOUR}"));
    assert!(found.is_empty());
    let all: Vec<_> = second.declarations.iter().collect();
    let (early, late) = all.split_at(first.declarations.len());
    assert_eq!(early, first.declarations.iter().collect::<Vec<_>>());
    let shift = TOUR.len() as u32 + 1;
    for (a, b) in early.iter().zip(late) {
        assert_eq!((a.span.start + shift, a.span.end + shift, &a.doc, a.nodes.len()), (b.span.start, b.span.end, &b.doc, b.nodes.len()));
        for (x, y) in a.nodes.iter().zip(&b.nodes) {
            assert_eq!((x.span.start + shift, x.span.end + shift), (y.span.start, y.span.end));
        }
    }
}

/// What is told of a declaration without its tree is what its tree tells.
#[test]
fn declarations_are_the_same_with_and_without_their_trees() {
    let long = format!("let long = \"{}\" + \"{{long}}\" + short\n", "x".repeat(300));
    let text = format!("{TOUR}\n{long}{}{TOUR}", long.replace("long =", "longer ="));
    let (script, found, _) = parsed(&text);
    assert!(found.is_empty());
    let all = &script.declarations;
    for (at, whole) in all.iter().enumerate() {
        assert_eq!((all.keyword(at), all.span(at), all.keyword_span(at)), (whole.keyword, whole.span, whole.keyword_span));
        assert_eq!(all.bound(at), scopes::bound(&whole));
        let (mut names, mut from) = (Vec::new(), 0);
        while let Some((behind, name)) = all.find_use(at, from, Some) {
            names.push(name);
            from = behind;
        }
        let used = whole.nodes.iter().filter_map(|node| match node.expr {
            Expr::Name(name) | Expr::Call { name, .. } => Some(name),
            _ => None,
        });
        assert_eq!(names, used.collect::<Vec<_>>());
        let family = match &whole.kind {
            DeclarationKind::Value { family, .. } | DeclarationKind::Collection { family, .. } => family.len(),
            _ => 0,
        };
        assert_eq!(all.family_size(at), family);
    }
    let last = |name: &str| text.rfind(name).unwrap() as u32;
    let longer = (0..all.len()).find(|at| all.bound(*at).is_some_and(|b| b.span.start == last("longer"))).unwrap();
    let texts = all.whole(longer).nodes.iter().filter(|node| matches!(node.expr, Expr::Text(_))).count();
    assert_eq!((all.span(longer).end, texts), (last(" + short") + 8, 2));
}
