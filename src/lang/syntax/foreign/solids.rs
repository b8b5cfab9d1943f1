//! Statements that make a shape in OpenSCAD, CadQuery, build123d, FreeCAD and Rhino.

use crate::lang::syntax::foreign::calls::{Call, items, point, points};
use crate::lang::syntax::foreign::makes::keyword_of;
use crate::lang::syntax::foreign::shapes::{Made, behind, shape, stem, turns};
use crate::lang::syntax::foreign::{Meant, Refusal};
use crate::lang::syntax::is_declaration;
use crate::lang::syntax::token::Kind;

const MADE: &str = "what is made gets a name";

impl Refusal<'_> {
    /// `translate([1, 2, 3]) cube(10);`, `for (i = [0:5]) sphere(2);`, `cq.Workplane("XY").box(1, 2, 3)` without a name.
    pub(crate) fn shape_statement(&self) -> Option<Meant> {
        let (family, from) = match self.kind(self.base)? {
            Kind::For => self.scad_loop()?,
            Kind::Name => (String::new(), self.base),
            _ => return None,
        };
        let (made, word) = self.made(from, self.end)?;
        let name = self.fresh.next(self.source, word);
        self.lines(MADE, made.declared(&name, &family)?)
    }

    /// `result = cq.Workplane("XY").box(1, 2, 3)`, `c = circle(5)`, `surface s = cylinder(h=10, r=5)`.
    pub(crate) fn shape_value(&self) -> Option<Meant> {
        let declares = matches!(self.tokens.kinds[self.base], Kind::Surface | Kind::Curve | Kind::Let | Kind::Shell);
        let bound = self.base + usize::from(declares);
        if self.kind(bound) != Some(Kind::Name) || !matches!(self.kind(bound + 1), Some(Kind::Equals | Kind::Of)) {
            return None;
        }
        let (name, value) = (self.text(bound, bound + 1), bound + 2);
        if let Some((made, _)) = self.made(value, self.end) {
            return self.lines("it is made like this", made.declared(name, "")?);
        }
        let calls = self.only_calls(value, self.end).filter(|_| !declares)?;
        let [Call { name: function, .. }] = calls.as_slice() else { return None };
        let word = keyword_of(function).map(|(_, word)| word).filter(|word| *word != "let")?;
        self.replaced("a declaration starts with a keyword", format!("{word} {}", self.text(self.base, self.end)))
    }

    /// `difference() { … }`, `union() { … }`, `hull() { … }`
    pub(crate) fn boolean(&self) -> Option<Meant> {
        let block = self.kind(self.base + 1) == Some(Kind::OpenRound)
            && self.closer(self.base + 1).is_some_and(|close| self.kind(close + 1) == Some(Kind::OpenCurly));
        let (why, typed) = match self.text(self.base, self.base + 1) {
            "difference" | "intersection" => (
                "a solid is the shell of its faces, and a face is cut by others",
                "surface part = trim(first, by: second, keep: (…, …, …))",
            ),
            "union" => ("joined surfaces are a shell", "shell name of …"),
            "hull" | "minkowski" => ("a surface through curves is made of them", "surface name = skin([…, …])"),
            _ => return None,
        };
        block.then(|| Meant { why, typed: typed.to_owned(), at: None })
    }

    /// `with BuildPart() as part:`
    pub(crate) fn block_of_python(&self) -> Option<Meant> {
        let opens = self.text(self.base, self.base + 1) == "with" && self.find(self.base, Kind::Colon).is_some();
        opens.then(|| Meant {
            why: "nothing needs to be opened: delete this line, and give each thing a name",
            typed: "surface name = …".to_owned(),
            at: None,
        })
    }

    /// `for (i = [0:5])`: the family, and the token behind it.
    fn scad_loop(&self) -> Option<(String, usize)> {
        let open = self.base + 1;
        let close = self.closer(open).filter(|_| self.kind(open) == Some(Kind::OpenRound))?;
        let [(name, list)] = <[_; 1]>::try_from(self.arguments(open, close)).ok()?;
        let name = name?;
        let inner = list.strip_prefix('[')?.strip_suffix(']')?;
        let ends: Vec<&str> = inner.split(':').collect();
        let list = match ends.as_slice() {
            [first, last] => format!("{}..{}", first.trim(), behind(last)),
            [_] => list,
            _ => return None,
        };
        Some((format!(" for {name} in {list}"), close + 1))
    }

    /// What the calls from a token to another make, and a word for it.
    pub(crate) fn made(&self, from: usize, end: usize) -> Option<(Made, &'static str)> {
        let calls = self.only_calls(from, end)?;
        if let Some(flat) = calls.iter().position(|c| c.name == "Workplane") {
            return workplane(&calls[flat..]);
        }
        let (last, before) = calls.split_last()?;
        let word = stem(&last.name);
        let made = before.iter().rev().try_fold(shape(last)?, around)?;
        // `circle(center: A, radius: 1m)` is ours already.
        let own = before.is_empty() && self.tokens.kinds[self.base].keyword().is_some() && is_declaration(self.text(self.base, self.end));
        (!own).then_some((made, word))
    }

    /// Several declarations in the place of this one.
    fn lines(&self, why: &'static str, typed: String) -> Option<Meant> {
        typed.lines().all(is_declaration).then(|| Meant { why, typed, at: self.whole() })
    }
}

/// A shape inside one of the transformations of OpenSCAD.
fn around(made: Made, call: &Call) -> Option<Made> {
    let first = call.get(&["v", "a", "height", "angle"], 0);
    match call.name.as_str() {
        "translate" => Some(made.moved("move", format!("by: {}", point(first?)?))),
        "rotate" => match call.named(&["v"]) {
            Some(axis) => {
                let turn = turns(call.get(&["a"], 0)?)?.pop()?;
                Some(made.moved("rotate", format!("{turn}, axis: {}", point(axis)?)))
            }
            None => Some(turns(first?)?.into_iter().fold(made, |made, turn| made.moved("rotate", turn))),
        },
        "scale" => first.filter(|by| items(by).is_none()).map(|by| made.moved("scale", format!("by: {by}"))),
        "mirror" => Some(made.moved("mirror", format!("normal: {}", point(first?)?))),
        "color" | "render" => Some(made),
        "linear_extrude" if call.knows_only(&["height", "h", "center", "convexity"]) => {
            made.extruded(call.get(&["height", "h"], 0)?, call.named(&["center"]) == Some("true"))
        }
        "rotate_extrude" if call.knows_only(&["angle", "convexity"]) => made.turned(call.get(&["angle"], 0)),
        _ => None,
    }
}

/// A chain of CadQuery, from `Workplane(…)` on.
fn workplane(calls: &[Call]) -> Option<(Made, &'static str)> {
    let (first, rest) = calls.split_first()?;
    if first.unnamed().next().is_some_and(|plane| plane != "\"XY\"") {
        return None;
    }
    let (mut made, mut word): (Option<Made>, _) = (None, "part");
    let (mut path, mut at): (Vec<String>, Option<String>) = (Vec::new(), None);
    for call in rest {
        let pair = || point(&format!("({}, {})", call.unnamed().next()?, call.unnamed().nth(1)?));
        match call.name.as_str() {
            "moveTo" | "lineTo" => path.push(pair()?),
            "polyline" => path = items(&points(call.unnamed().next()?)?)?.into_iter().map(str::to_owned).collect(),
            "close" => {
                made = Some(Made::Curve(format!("polyline([{}], closed: true)", std::mem::take(&mut path).join(", "))));
            }
            "center" => at = Some(pair()?),
            "extrude" => made = made?.extruded(call.unnamed().next()?, false),
            "translate" => made = Some(made?.moved("move", format!("by: {}", point(call.unnamed().next()?)?))),
            "cylinder" => {
                let turned = Call { name: "Cylinder".into(), args: call.args.iter().rev().cloned().collect() };
                (made, word) = (shape(&turned), stem("Cylinder"));
            }
            "box" | "circle" | "rect" | "sphere" if made.is_none() => (made, word) = (shape(call), stem(&call.name)),
            _ => return None,
        }
        if made.is_some()
            && let Some(at) = at.take()
        {
            made = made.map(|made| made.moved("move", format!("by: {at}")));
        }
    }
    Some((made?, word)).filter(|_| path.is_empty())
}
