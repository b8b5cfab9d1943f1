//! Statements of Gmsh, in its own language and through its interface to Python.

use crate::lang::syntax::foreign::calls::{Call, items};
use crate::lang::syntax::foreign::{Meant, Refusal};
use crate::lang::syntax::is_declaration;
use crate::lang::syntax::token::Kind;

/// Names that are given to entities, which Gmsh numbers: `p1`, `c1`, `l1`, `s1`.
const NAMED: &str = "an entity has a name instead of a number";
/// Where what Gmsh says of its mesh is said.
const MESHED: &str = "settings follow `mesh … of …` in braces";

/// What a statement makes: the words before its number, in its own language; the function in Python; and what it makes.
const KINDS: &[(&str, &str, Entity)] = &[
    ("Point", "addPoint", Entity::Point),
    ("Line", "addLine", Entity::Curve("line")),
    ("Circle", "addCircleArc", Entity::Arc),
    ("Spline", "addSpline", Entity::Curve("spline")),
    ("BSpline", "addBSpline", Entity::Curve("bspline")),
    ("Bezier", "addBezier", Entity::Curve("bezier")),
    ("Curve Loop", "addCurveLoop", Entity::Loop),
    ("Line Loop", "addCurveLoop", Entity::Loop),
    ("Plane Surface", "addPlaneSurface", Entity::Flat),
    ("Surface", "addSurfaceFilling", Entity::Filled),
    ("Ruled Surface", "addSurfaceFilling", Entity::Filled),
    ("Surface Loop", "addSurfaceLoop", Entity::Shell),
    ("Physical Point", "", Entity::Group("p")),
    ("Physical Curve", "", Entity::Group("c")),
    ("Physical Line", "", Entity::Group("c")),
    ("Physical Surface", "", Entity::Group("s")),
];

#[derive(Clone, Copy)]
enum Entity {
    Point,
    Curve(&'static str),
    Arc,
    Loop,
    Flat,
    Filled,
    Shell,
    Group(&'static str),
}

impl Refusal<'_> {
    /// `Point(1) = {0, 0, 0, lc};`, `Curve Loop(1) = {1, 2, 3};`, `Physical Curve("south") = {1};`
    pub(crate) fn gmsh_statement(&self) -> Option<Meant> {
        let open = (self.base + 1..self.end.min(self.base + 3)).find(|t| self.tokens.kinds[*t] == Kind::OpenRound)?;
        let close = self.closer(open)?;
        let list = close + 2;
        let shown = self.kind(close + 1) == Some(Kind::Equals)
            && self.kind(list) == Some(Kind::OpenCurly)
            && self.closer(list) == Some(self.end - 1);
        let words: Vec<&str> = (self.base..open).map(|t| self.text(t, t + 1)).collect();
        let (_, _, entity) = KINDS.iter().find(|k| shown && k.0 == words.join(" "))?;
        let tag = self.text(open + 1, close).split(',').next().unwrap_or("").trim_matches('"').replace(' ', "_");
        let members: Vec<String> = self.arguments(list, self.end - 1).into_iter().map(|a| a.1).collect();
        self.entity(*entity, &tag, &members)
    }

    /// `gmsh.model.geo.addPoint(0, 0, 0, lc, 1)`, `p1 = gmsh.model.occ.addPoint(0, 0, 0)`
    pub(crate) fn gmsh_call(&self) -> Option<Meant> {
        let named = self.kind(self.base + 1) == Some(Kind::Equals);
        let calls = self.only_calls(if named { self.base + 2 } else { self.base }, self.end)?;
        let [call] = calls.as_slice() else { return None };
        if matches!(call.name.as_str(), "initialize" | "finalize" | "synchronize") {
            let why = "a model needs no start and no end, delete this line and declare what it is made of";
            return Some(Meant { why, typed: "curve name = …".to_owned(), at: None });
        }
        if call.name == "generate" {
            return Some(Meant { why: MESHED, typed: "mesh name of … { size: … }".to_owned(), at: None });
        }
        let &(_, _, entity) = KINDS.iter().find(|k| k.1 == call.name)?;
        let (tag, members) = numbered(call, entity)?;
        let tag = if named { self.text(self.base, self.base + 1).to_owned() } else { tag? };
        self.entity(entity, &tag, &members)
    }

    /// `Transfinite Curve {1} = 10;`, `Recombine Surface {1};`, `Mesh 2;`
    pub(crate) fn gmsh_meshing(&self) -> Option<Meant> {
        let word = self.text(self.base, self.base + 1);
        let open = self.find(self.base, Kind::OpenCurly);
        let member = |prefix: &str| -> Option<String> {
            let open = open?;
            Some(reference(prefix, self.text(open + 1, self.closer(open)?).split(',').next()?.trim()))
        };
        let settings = match (word, self.text(self.base + 1, self.base + 2)) {
            ("Transfinite", "Curve" | "Line") => {
                let count = self.find(self.base, Kind::Equals).map_or("…", |equals| self.text(equals + 1, equals + 2));
                let steps = count.parse::<u64>().map_or("…".to_owned(), |n| n.saturating_sub(1).to_string());
                format!("on {} {{ count: {steps} }}", member("c")?)
            }
            ("Transfinite", "Surface") => "method: mapped".to_owned(),
            ("Recombine", "Surface") => "elements: quads".to_owned(),
            ("Mesh", _) => "size: …".to_owned(),
            _ => return None,
        };
        Some(Meant { why: MESHED, typed: format!("mesh name of … {{ {settings} }}"), at: None })
    }

    fn entity(&self, entity: Entity, tag: &str, members: &[String]) -> Option<Meant> {
        let all = |prefix: &str| members.iter().map(|m| reference(prefix, m)).collect::<Vec<_>>();
        let typed = match entity {
            Entity::Point => {
                let [x, y, z] = members.get(..3)? else { return None };
                let [x, y, z] = [x, y, z].map(|text| whole(text));
                format!("point {} = ({x}, {y}, {z})", reference("p", tag))
            }
            Entity::Curve("line") => format!("curve {} = line({})", reference("c", tag), all("p").join(", ")),
            Entity::Curve(function) => format!("curve {} = {function}([{}])", reference("c", tag), all("p").join(", ")),
            Entity::Arc => {
                let [from, center, to] = <[String; 3]>::try_from(all("p")).ok()?;
                format!("curve {} = arc({from}, {to}, center: {center})", reference("c", tag))
            }
            Entity::Loop => format!("let {} = [{}]", reference("l", tag), all("c").join(", ")),
            Entity::Flat => match all("l").as_slice() {
                [outer] => format!("surface {} = plane({outer})", reference("s", tag)),
                [outer, holes @ ..] => {
                    format!("surface {} = trim(plane({outer}), holes: [{}])", reference("s", tag), holes.join(", "))
                }
                [] => return None,
            },
            Entity::Filled => format!("surface {} = coons({})", reference("s", tag), all("l").join(", ")),
            Entity::Shell => format!("shell {} of {}", reference("shell_", tag), all("s").join(", ")),
            Entity::Group(prefix) => format!("group {} of {}", reference("group_", tag), all(prefix).join(", ")),
        };
        is_declaration(&typed).then(|| Meant { why: NAMED, typed, at: self.whole() })
    }
}

/// The number at the end of a call and its members.
fn numbered(call: &Call, entity: Entity) -> Option<(Option<String>, Vec<String>)> {
    let all: Vec<String> = call.unnamed().map(str::to_owned).collect();
    let tag = |k: usize| call.get(&["tag"], k).map(str::to_owned);
    match entity {
        Entity::Point => Some((tag(4), all)),
        Entity::Curve("line") => Some((tag(2), all.get(..2)?.to_vec())),
        Entity::Arc => Some((tag(3), all.get(..3)?.to_vec())),
        Entity::Curve(_) | Entity::Loop | Entity::Flat | Entity::Filled | Entity::Shell => {
            let members = items(all.first()?)?.into_iter().map(str::to_owned).collect();
            Some((tag(1), members))
        }
        Entity::Group(_) => None,
    }
}

/// A number with digits on both sides of its dot.
fn whole(text: &str) -> String {
    let (sign, digits) = text.strip_prefix('-').map_or(("", text), |digits| ("-", digits));
    let before = if digits.starts_with('.') { "0" } else { "" };
    let behind = if digits.ends_with('.') { "0" } else { "" };
    format!("{sign}{before}{digits}{behind}")
}

/// The name of an entity: `p1` for 1 and -1, a name as it is.
fn reference(prefix: &str, text: &str) -> String {
    let plain = text.trim_start_matches('-').trim();
    if plain.starts_with(|c: char| c.is_ascii_digit()) { format!("{prefix}{plain}") } else { plain.to_owned() }
}
