//! What is broken is said with its line, costs itself and what stands on it, and never more than moments.

use std::time::Instant;

use super::file::{FRAME, can, file};
use super::{areas, read};

/// Faces that come in and the warnings of a file with one thing replaced.
fn broken(from: &str, to: &str) -> (usize, String) {
    let text = file(&can(".T."), "#21");
    assert!(text.contains(from), "{from}");
    let part = read(text.replacen(from, to, 1).as_bytes()).unwrap();
    let said: Vec<String> = part.warnings.iter().map(|w| format!("{}: {}", w.line, w.what)).collect();
    (areas(&part).len(), said.join("\n"))
}

#[test]
fn files_that_are_no_step_say_what_they_are() {
    let utf_16: Vec<u8> = "ISO-10303-21;\nDATA;".encode_utf16().flat_map(u16::to_le_bytes).collect();
    for (bytes, expected) in [
        (&b""[..], "line 1: the file is empty"),
        (&utf_16, "line 1: the file is written in UTF-16 or UTF-32; STEP files are plain text of one byte a letter: save it as UTF-8"),
        (b"solid cube\n facet", "line 1: the file does not begin with ISO-10303-21, as STEP files do"),
        (b"<?xml version='1.0'?>", "line 1: the file is XML; STEP files that can be read are clear text, which begins with ISO-10303-21"),
        (b"ISO-10303-21;\nHEADER;\nENDSEC;\n", "line 4: the file has no DATA section"),
        (b"ISO-10303-21;\nDATA;\nENDSEC;\n", "line 1: the file holds no entity that can be read"),
    ] {
        assert_eq!(read(bytes).err().as_deref(), Some(expected));
    }
}

#[test]
fn damage_costs_itself_and_what_stands_on_it() {
    for (from, to, faces, said) in [
        (
            "#16=PLANE('',#4);",
            "#16=PLANE('',#4444);",
            2,
            "'foot': skipped: its surface #16 PLANE: its parameter 2: there is no entity #4444",
        ),
        ("#16=PLANE('',#4);", "#16=PLANE('',4.);", 2, "its parameter 2: an entity is missing"),
        ("#16=PLANE('',#4);", "#16=PLANE('',#4", 2, "#16: a comma is missing between two values"),
        ("#16=PLANE('',#4);", "#16=PLANE('',#2);", 2, "#2 DIRECTION"),
        ("#16=PLANE('',#4);", "#16=CIRCLE('',#4,1.);", 2, "#16 CIRCLE is not a surface that can be read"),
        ("#16=PLANE('',#4);", "#16=PLANE('',#4);\n#16=PLANE('',#6);", 3, "#16 is defined again; the first definition is used"),
        ("#11=CIRCLE('',#4,2.)", "#11=CIRCLE('',#4,1.E308)", 1, "'foot': skipped"),
        ("#11=CIRCLE('',#4,2.)", "#11=CIRCLE('',#4,1.E999)", 1, "the number 1.E999 is too large"),
        ("#11=CIRCLE('',#4,2.)", "#11=CIRCLE('',#4,$)", 1, "a number is missing"),
        ("(#36,#43,#53)", "(#36,#43,#53,#99)", 3, "there is no entity #99"),
        ("ENDSEC;\nEND-ISO", "", 3, "the file ends before ENDSEC"),
        ("'side'", "'side", 2, "#36: a comma is missing between two values"),
    ] {
        let (found, warnings) = broken(from, to);
        let words = said.split(": ").all(|w| warnings.contains(w));
        assert!(found == faces && words, "{to}: {found} faces, {warnings}");
    }
}

#[test]
fn circles_of_references_and_doublings_end() {
    let start = Instant::now();
    let mut doubling = String::from(FRAME);
    doubling += "#100=CARTESIAN_POINT('',(1.,0.,0.));\n#101=POLYLINE('',(#1,#100));\n";
    for k in 0..25 {
        let (a, b) = (1000 + 10 * k, 1010 + 10 * k);
        let of = if k == 0 { 101 } else { a };
        doubling += &format!(
            "#{}=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#{of});\n#{}=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.F.,#{of});\n#{b}=COMPOSITE_CURVE('',(#{},#{}),.F.);\n",
            a + 1,
            a + 2,
            a + 1,
            a + 2
        );
    }
    doubling += "#2000=GEOMETRIC_SET('',(#1250));\n";
    let mut products =
        String::from(FRAME) + "#90=GEOMETRIC_SET('',(#91));\n#91=POLYLINE('',(#1,#92));\n#92=CARTESIAN_POINT('',(1.,0.,0.));\n";
    for k in 0..40 {
        let (inner, outer) = (1000 + 10 * k, 1010 + 10 * k);
        let item = if k == 0 { "#90".to_owned() } else { format!("#{},#{}", inner + 2, inner + 3) };
        products += &format!("#{inner}=SHAPE_REPRESENTATION('',({item}),#9002);\n#{}=REPRESENTATION_MAP(#4,#{inner});\n", inner + 1);
        products += &format!("#{}=MAPPED_ITEM('',#{},#4);\n#{}=MAPPED_ITEM('',#{},#4);\n", outer + 2, inner + 1, outer + 3, inner + 1);
    }
    let edges = can(".T.").replace("#40=ORIENTED_EDGE('',*,*,#13,.F.)", "#40=ORIENTED_EDGE('',*,*,#40,.F.)");
    let mut uses = String::new();
    let shells = can(".T.").replace("#60=ORIENTED_CLOSED_SHELL('',*,#20,.T.)", "#60=ORIENTED_CLOSED_SHELL('',*,#60,.T.)");
    let curve = format!(
        "{FRAME}#10=TRIMMED_CURVE('',#10,(PARAMETER_VALUE(0.)),(PARAMETER_VALUE(1.)),.T.,.PARAMETER.);\n#11=GEOMETRIC_SET('',(#10,#11));\n"
    );
    let product = can(".T.")
        + "#810=PRODUCT('a','a','',());\n#811=PRODUCT_DEFINITION_FORMATION('','',#810);\n#812=PRODUCT_DEFINITION('','',#811,$);\n\
           #813=NEXT_ASSEMBLY_USAGE_OCCURRENCE('','','',#812,#812,$);\n#814=PRODUCT_DEFINITION_SHAPE('','',#812);\n\
           #815=SHAPE_DEFINITION_REPRESENTATION(#814,#9000);\n";
    for (name, text) in [
        ("doubled curves", file(&doubling, "#2000")),
        ("doubled parts", file(&products, "#1402,#1403")),
        ("a circle of edges", file(&edges, "#21")),
        ("a circle of shells", file(&shells, "#60")),
        ("a curve of itself", file(&curve, "#11")),
        ("a product in itself", file(&product, "#21")),
    ] {
        let part = read(text.as_bytes()).unwrap();
        assert!(!part.warnings.is_empty() || part.surfaces.len() == 3, "{name}");
        for warning in &part.warnings {
            uses += &warning.what;
        }
    }
    assert!(uses.contains("more often than a file of this size may"), "{uses}");
    assert!(uses.contains("is made of itself") || uses.contains("are made of themselves"), "{uses}");
    assert!(start.elapsed().as_secs_f64() < if cfg!(debug_assertions) { 40.0 } else { 2.0 }, "{:?}", start.elapsed());
}

/// Time follows the size however the text is damaged.
#[test]
fn long_damaged_files_are_read_at_once() {
    let start = Instant::now();
    let n = 200_000;
    for (name, body) in [
        ("quotes", "#1=A('x);\n".repeat(n)),
        ("comments", "#1=A(;/*\n".repeat(n)),
        ("blank lines", "#1=A(\n\n\n\n".repeat(n)),
        ("brackets", "#1=A(((((((".repeat(n)),
        ("one number", "#1=A(1);".repeat(n)),
        ("one long list", format!("#1=A({});", "1.,".repeat(n))),
        ("no records", "x;".repeat(n)),
    ] {
        let text = format!("ISO-10303-21;\nDATA;\n{body}\nENDSEC;\n");
        let _ = read(text.as_bytes());
        assert!(start.elapsed().as_secs_f64() < if cfg!(debug_assertions) { 60.0 } else { 2.0 }, "{name}: {:?}", start.elapsed());
    }
}

#[test]
fn splines_that_cannot_be_say_why() {
    let points: Vec<String> = (0..30).map(|k| format!("#{}=CARTESIAN_POINT('',({k}.,0.,{}.));", 100 + k, k % 3)).collect();
    let names: Vec<String> = (0..27).map(|k| format!("#{}", 100 + k)).collect();
    let spline = |degree: usize, n: usize, mults: &str, knots: &str| {
        let curve = format!(
            "{FRAME}{}#10=B_SPLINE_CURVE_WITH_KNOTS('',{degree},({}),.UNSPECIFIED.,.F.,.F.,({mults}),({knots}),.UNSPECIFIED.);\n#11=GEOMETRIC_SET('',(#10));\n",
            points.concat(),
            names[..n].join(",")
        );
        let part = read(file(&curve, "#11").as_bytes()).unwrap();
        (part.curves.len(), part.warnings.into_iter().map(|w| w.what).collect::<String>())
    };
    assert_eq!(spline(3, 5, "4,1,4", "0.,1.,2.").0, 1);
    for (found, words) in [
        (spline(26, 27, "27,27", "0.,1."), "degree"),
        (spline(3, 5, "4,1,4", "0.,3.,2."), "knot 5 of this curve is 2, below the 3 before it"),
        (spline(3, 5, "4,1,3", "0.,1.,2."), "multiplicities give 8 knots, not 9"),
        (spline(3, 5, "4,9000000000,4", "0.,1.,2."), "multiplicities do not give 9 knots"),
        (spline(3, 3, "4,4", "0.,1."), "3 points and degree 3"),
    ] {
        assert!(found.0 == 0 && found.1.contains(words), "{found:?}");
    }
}
