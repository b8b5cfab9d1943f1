//! One thing where a list is wanted: every parameter that takes a list of things takes one, a list, a nested list and a
//! family alike, and so do the clauses of collections.

use std::path::Path;

use lofting::lang::eval::std::{Builtin, Param, builtins, fields};
use lofting::lang::values::types::Ty;
use lofting::lang::values::value::Dim;
use lofting::session::disk::{Disk, Outputs};

use crate::support::script;

/// What is said about a script: codes and messages, and the tables of its reports.
fn said(text: &str) -> Vec<String> {
    let disk = Disk::new(Some(Path::new("lists.loft")), None, &[], Outputs::Counted).unwrap();
    let outcome = script::outcome("lists.loft", text.as_bytes(), &[], &disk);
    let mut all: Vec<String> = outcome.diagnostics.iter().map(|d| format!("{} {}", d.code.0, d.message)).collect();
    all.extend(outcome.report.reports.iter().map(|r| format!("{:?}", r.rows)));
    all
}

/// A declaration of `thing`, one of this type, and of a family of one such.
fn thing(ty: Ty) -> &'static str {
    match ty {
        Ty::OneOf(of) => thing(of[0]),
        Ty::Curve => "curve thing = circle(center: (0, 0, 0), radius: 1m)\nlet things for i in 0..1 = thing\n",
        Ty::Surface => {
            "curve foot = line((0, 0, 0), (4m, 0, 0))\nsurface thing = extrude(foot, by: (0, 0, 1m))\nlet things for i in 0..1 = thing\n"
        }
        Ty::Point => "point thing = (1m, 0, 0)\nlet things for i in 0..1 = thing\n",
        Ty::Bool => "let thing = true\nlet things for i in 0..1 = thing\n",
        Ty::Number | Ty::Count => "let thing = 3\nlet things for i in 0..1 = thing\n",
        Ty::Text => "let thing = \"a\"\nlet things for i in 0..1 = thing\n",
        Ty::Record => "let thing = {a: 1}\nlet things for i in 0..1 = thing\n",
        Ty::Direction => "let thing = (1, 0, 0)\nlet things for i in 0..1 = thing\n",
        Ty::Quantity(dim) if dim == Dim::ANGLE => "let thing = 3deg\nlet things for i in 0..1 = thing\n",
        Ty::Quantity(_) | Ty::Measure => "let thing = 3mm\nlet things for i in 0..1 = thing\n",
        other => panic!("no thing of this type: {}", other.words()),
    }
}

/// The type of the members where a parameter takes a list of things.
fn things(ty: Ty) -> Option<Ty> {
    match ty {
        Ty::List(of) | Ty::Rest(of) => of.is_thing().then_some(*of),
        Ty::Optional(of) => things(*of),
        // Rows of nets stay rows.
        Ty::OneOf(of) if of.iter().any(|t| matches!(t, Ty::List(Ty::List(_)))) => None,
        Ty::OneOf(of) => of.iter().find_map(|t| things(*t)),
        _ => None,
    }
}

fn check(builtin: &Builtin, param: &Param, of: Ty, wrong: &mut Vec<String>) {
    let call = |value: &str| {
        let others = match builtin.name {
            "trim" => "s: plane(circle(center: (0, 0, 0), radius: 3m)), ",
            "deviation" if param.name == "points" => "from: extrude(line((0, 0, 0), (4m, 0, 0)), by: (0, 2m, 0)), ",
            "nearest" => "to: (0, 0, 0), ",
            _ => "",
        };
        said(&format!("{}let result = {}({others}{}: {value})\nreport [result]\n", thing(of), builtin.name, param.name))
    };
    let one = call("thing");
    for form in ["[thing]", "[[thing]]", "[[[thing]]]", "things", "[things]"] {
        let found = call(form);
        if found != one {
            wrong.push(format!("{}({}: {form}) says {found:?}, one thing {one:?}", builtin.name, param.name));
        }
    }
    let misfit = format!("`{}` is ", param.name);
    wrong.extend(one.iter().filter(|s| s.starts_with("E211") && s.contains(&misfit)).map(|s| format!("{}: {s}", builtin.name)));
}

#[test]
fn every_list_of_things_takes_one_a_list_a_nested_list_and_a_family() {
    let (mut wrong, mut tried) = (Vec::new(), Vec::new());
    for builtin in builtins().chain(fields()) {
        for param in builtin.params {
            if let Some(of) = things(param.ty) {
                check(builtin, param, of, &mut wrong);
                tried.push(format!("{}.{}", builtin.name, param.name));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    for wanted in
        ["trim.outer", "trim.holes", "trim.by", "coons.curves", "coons.u", "transfinite.v", "plane.curves", "connection.a", "spline.points"]
    {
        assert!(tried.iter().any(|t| t == wanted), "{wanted} is not among {tried:?}");
    }
}

#[test]
fn nets_keep_their_rows() {
    for call in [
        "grid(points: (0, 0, 0))",
        "grid(points: [(0, 0, 0), (1, 0, 0)])",
        "nurbs_surface(net: [(0, 0, 0)])",
        "bezier_surface(net: (0, 0, 0))",
    ] {
        let found = said(&format!("surface s = {call}\n"));
        assert!(found.iter().any(|s| s.starts_with("E211")), "{call}: {found:?}");
    }
    assert_eq!(said("let a = len(zip([[1, 2]], [[3, 4]]))\ncheck a == 1\n"), Vec::<String>::new());
}

#[test]
fn clauses_take_one_thing_and_nested_lists() {
    let model = "curve foot = line((0, 0, 0), (4m, 0, 0))\nsurface wall = extrude(foot, by: (0, 0, 1m))\nlet one for i in 0..1 = wall\n\
                 let feet for i in 0..1 = foot\npoint P = (1m, 0, 0)\nlet spots for i in 0..1 = P\n";
    let mesh = |of: &str, on: &str, near: &str| {
        let clauses = format!("on {on} {{ count: 9 }}\n  near {near} {{ size: 20mm }}");
        said(&format!("{model}mesh m of {of} {{\n  size: 200mm\n  {clauses}\n}}\ngroup g of {of}\nshell s of {of}\nreport [m.triangles]\n"))
    };
    let plain = mesh("wall", "foot", "P");
    assert!(!plain.iter().any(|s| s.starts_with('E')), "{plain:?}");
    for (of, on, near) in
        [("[wall]", "[foot]", "[P]"), ("[[wall]]", "[[foot]]", "[[P]]"), ("one", "feet", "spots"), ("[one]", "[feet]", "[spots]")]
    {
        assert_eq!(mesh(of, on, near), plain);
    }
}
