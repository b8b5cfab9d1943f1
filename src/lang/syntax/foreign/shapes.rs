//! Shapes of other tools, as this language makes them: a solid is the shell of its faces.

use crate::lang::syntax::foreign::calls::{Call, degrees, half, items, negative, part, point, points};

/// What a call of another tool makes.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Made {
    /// The expression of a curve.
    Curve(String),
    /// The expression of a surface.
    Surface(String),
    /// What a closed curve in a plane encloses, extruded: the curve, the way, and the motions of the whole, the first one first.
    Solid { foot: String, by: String, motions: Vec<(&'static str, String)> },
}

/// What it is that a word names.
#[derive(Clone, Copy)]
enum Meaning {
    Box,
    Cylinder,
    Sphere,
    Cone,
    Torus,
    Circle,
    Rectangle,
    /// A polyline, closed or not.
    Path(bool),
    Line,
    Spline,
    /// An arc of start, end and a point between, at these places.
    Arc([usize; 3]),
    /// A surface through sections.
    Skin,
}

/// Words of other tools, the order of their arguments, and whether the shape lies about the origin.
const SHAPES: &[(&str, Meaning, &[&str], bool)] = &[
    // OpenSCAD.
    ("cube", Meaning::Box, &["size"], false),
    ("cylinder", Meaning::Cylinder, &["h", "r1", "r2"], false),
    ("sphere", Meaning::Sphere, &["r"], true),
    ("circle", Meaning::Circle, &["r"], true),
    ("square", Meaning::Rectangle, &["size"], false),
    ("polygon", Meaning::Path(true), &["points"], false),
    // CadQuery and build123d.
    ("box", Meaning::Box, &["x", "y", "z"], true),
    ("Box", Meaning::Box, &["x", "y", "z"], true),
    ("Cylinder", Meaning::Cylinder, &["r", "h"], true),
    ("Sphere", Meaning::Sphere, &["r"], true),
    ("Cone", Meaning::Cone, &["r1", "r2", "h"], true),
    ("Torus", Meaning::Torus, &["major", "minor"], true),
    ("Circle", Meaning::Circle, &["r"], true),
    ("rect", Meaning::Rectangle, &["x", "y"], true),
    ("rectangle", Meaning::Rectangle, &["x", "y"], true),
    ("Rectangle", Meaning::Rectangle, &["x", "y"], true),
    ("Polyline", Meaning::Path(false), &[], false),
    ("Line", Meaning::Line, &[], false),
    ("Spline", Meaning::Spline, &[], false),
    ("ThreePointArc", Meaning::Arc([0, 2, 1]), &[], false),
    // FreeCAD.
    ("makeBox", Meaning::Box, &["x", "y", "z"], false),
    ("makeCylinder", Meaning::Cylinder, &["r", "h"], false),
    ("makeSphere", Meaning::Sphere, &["r"], true),
    ("makeCone", Meaning::Cone, &["r1", "r2", "h"], false),
    ("makeTorus", Meaning::Torus, &["major", "minor"], true),
    ("makeCircle", Meaning::Circle, &["r"], true),
    ("makeLine", Meaning::Line, &[], false),
    ("makePolygon", Meaning::Path(false), &["points"], false),
    ("makeLoft", Meaning::Skin, &["sections"], false),
    // Rhino.
    ("AddSphere", Meaning::Sphere, &["r"], true),
    ("AddCircle", Meaning::Circle, &["r"], true),
    ("AddLine", Meaning::Line, &[], false),
    ("AddPolyline", Meaning::Path(false), &["points"], false),
    ("AddInterpCurve", Meaning::Spline, &["points"], false),
    ("AddArc3Pt", Meaning::Arc([0, 1, 2]), &[], false),
    ("AddLoftSrf", Meaning::Skin, &["sections"], false),
    // What is tried by those who know none of them.
    ("cone", Meaning::Cone, &["r1", "r2", "h"], false),
    ("torus", Meaning::Torus, &["major", "minor"], true),
    ("loft", Meaning::Skin, &["sections"], false),
];

/// Names that arguments have besides those of [`SHAPES`].
const ALIASES: &[(&str, &[&str])] = &[
    ("h", &["h", "height"]),
    ("r", &["r", "radius"]),
    ("x", &["x", "width", "length"]),
    ("y", &["y", "depth", "width"]),
    ("z", &["z", "height"]),
    ("r1", &["r1", "bottom_radius", "radius1"]),
    ("r2", &["r2", "top_radius", "radius2"]),
    ("major", &["major", "major_radius", "R", "r1"]),
    ("minor", &["minor", "minor_radius", "r", "r2"]),
    ("size", &["size"]),
    ("points", &["points", "pts"]),
    ("sections", &["sections", "curves"]),
];

/// A word of [`SHAPES`] that begins a name of what has none: in small letters.
pub(crate) fn stem(name: &str) -> &'static str {
    match SHAPES.iter().find(|s| s.0 == name).map(|s| s.1) {
        Some(Meaning::Box) => "block",
        Some(Meaning::Cylinder) => "cylinder",
        Some(Meaning::Sphere) => "ball",
        Some(Meaning::Cone) => "cone",
        Some(Meaning::Torus) => "torus",
        Some(Meaning::Circle) => "circle",
        Some(Meaning::Rectangle) => "square",
        Some(Meaning::Skin) => "skin",
        _ => "curve",
    }
}

/// The arguments of a call by the names of its word.
struct GivenArguments<'a> {
    call: &'a Call,
    order: &'static [&'static str],
    /// A point that stands first: the centre.
    center: Option<String>,
}

impl<'a> GivenArguments<'a> {
    fn get(&self, name: &str) -> Option<&'a str> {
        let names = ALIASES.iter().find(|a| a.0 == name).map_or(&[][..], |a| a.1);
        let place = self.order.iter().position(|n| *n == name).unwrap_or(usize::MAX - 1);
        self.call.get(names, place.saturating_add(usize::from(self.center.is_some())))
    }

    /// A radius, also where its diameter is given.
    fn radius(&self) -> Option<String> {
        let half_of = self.call.named(&["d", "diameter"]).map(half);
        half_of.or_else(|| self.get("r").map(str::to_owned))
    }

    /// Three sizes of a box or two of a rectangle, also in a list, or one for all.
    fn sizes(&self, n: usize) -> Option<Vec<String>> {
        let Some(size) = self.get("size") else {
            return ["x", "y", "z"][..n].iter().map(|name| self.get(name).map(str::to_owned)).collect();
        };
        match items(size) {
            Some(parts) => (parts.len() == n).then(|| parts.into_iter().map(str::to_owned).collect()),
            None => Some(vec![size.to_owned(); n]),
        }
    }

    fn points(&self) -> Option<String> {
        match self.get("points").filter(|_| self.call.unnamed().count() < 2) {
            Some(list) => points(list),
            None => {
                self.call.unnamed().map(point).collect::<Option<Vec<_>>>().filter(|p| p.len() > 1).map(|p| format!("[{}]", p.join(", ")))
            }
        }
    }
}

/// What a call of another tool makes; `None` where this language has nothing like it, or an argument says what is not known.
pub(crate) fn shape(call: &Call) -> Option<Made> {
    let (_, shape, order, centred) = *SHAPES.iter().find(|s| s.0 == call.name)?;
    let known: Vec<&str> = ALIASES.iter().flat_map(|a| a.1).copied().chain(["d", "diameter", "center", "centre", "centered"]).collect();
    if !call.knows_only(&known) {
        return None;
    }
    let round = matches!(shape, Meaning::Circle | Meaning::Sphere);
    let first = call.unnamed().next().filter(|first| round && call.unnamed().count() > 1 || items(first).is_some());
    let center = call.named(&["center", "centre"]).or(first).filter(|_| round);
    let given = GivenArguments { call, order, center: center.and_then(point) };
    if round && center.is_some() && given.center.is_none() {
        return None;
    }
    let centred = match call.named(&["center", "centered"]).filter(|_| !round) {
        Some(word) => word.eq_ignore_ascii_case("true"),
        None => centred,
    };
    let at = given.center.clone().unwrap_or_else(|| "(0, 0, 0)".to_owned());
    Some(match shape {
        Meaning::Box => {
            let [x, y, z] = <[String; 3]>::try_from(given.sizes(3)?).ok()?;
            let back = centred.then(|| [&x, &y, &z].map(|side| negative(&half(side))).join(", "));
            solid(rectangle(&x, &y), &z, back)
        }
        Meaning::Cylinder => {
            let height = given.get("h")?;
            let radius = given.radius().or_else(|| given.get("r1").map(str::to_owned))?;
            let back = centred.then(|| format!("0, 0, {}", negative(&half(height))));
            match given.get("r2").filter(|r2| **r2 != radius) {
                Some(top) => Made::Surface(cone(&radius, top, height)).back(back),
                None => solid(format!("circle(center: (0, 0, 0), radius: {radius})"), height, back),
            }
        }
        Meaning::Cone => {
            let height = given.get("h")?;
            let back = centred.then(|| format!("0, 0, {}", negative(&half(height))));
            Made::Surface(cone(given.get("r1")?, given.get("r2")?, height)).back(back)
        }
        Meaning::Sphere => {
            let radius = given.radius()?;
            let under = negative(&radius);
            let ball = Made::Surface(format!("revolve(arc((0, 0, {under}), (0, 0, {radius}), through: ({radius}, 0, 0)))"));
            match given.center {
                Some(at) => ball.moved("move", format!("by: {at}")),
                None => ball,
            }
        }
        Meaning::Torus => {
            let (major, minor) = (given.get("major")?, given.get("minor")?);
            Made::Surface(format!("revolve(circle(center: ({major}, 0, 0), radius: {minor}, normal: (0, 1, 0)))"))
        }
        Meaning::Circle => Made::Curve(format!("circle(center: {at}, radius: {})", given.radius()?)),
        Meaning::Rectangle => {
            let [x, y] = <[String; 2]>::try_from(given.sizes(2)?).ok()?;
            let back = centred.then(|| format!("{}, {}, 0", negative(&half(&x)), negative(&half(&y))));
            Made::Curve(rectangle(&x, &y)).back(back)
        }
        Meaning::Path(closed) => Made::Curve(format!("polyline({}{})", given.points()?, if closed { ", closed: true" } else { "" })),
        Meaning::Line => {
            let ends: Vec<String> = call.unnamed().map(point).collect::<Option<_>>()?;
            let [from, to] = <[String; 2]>::try_from(ends).ok()?;
            Made::Curve(format!("line({from}, {to})"))
        }
        Meaning::Spline => Made::Curve(format!("spline({})", given.points()?)),
        Meaning::Arc(places) => {
            let ends: Option<Vec<String>> = places.iter().map(|k| call.unnamed().nth(*k).and_then(point)).collect();
            let [from, to, through] = <[String; 3]>::try_from(ends?).ok()?;
            Made::Curve(format!("arc({from}, {to}, through: {through})"))
        }
        Meaning::Skin => Made::Surface(format!("skin([{}])", items(given.get("sections")?)?.join(", "))),
    })
}

/// A rectangle in the plane z = 0 with a corner at the origin.
fn rectangle(x: &str, y: &str) -> String {
    format!("polyline([(0, 0), ({x}, 0), ({x}, {y}), (0, {y})], closed: true)")
}

fn cone(bottom: &str, top: &str, height: &str) -> String {
    format!("revolve(line(({bottom}, 0, 0), ({top}, 0, {height})))")
}

fn solid(foot: String, height: &str, back: Option<String>) -> Made {
    Made::Solid { foot, by: format!("(0, 0, {height})"), motions: Vec::new() }.back(back)
}

impl Made {
    fn back(self, by: Option<String>) -> Self {
        match by {
            Some(by) => self.moved("move", format!("by: ({by})")),
            None => self,
        }
    }

    /// The same behind a motion: the function and its arguments after the first.
    pub fn moved(self, function: &'static str, arguments: String) -> Self {
        let inside = |e: String| format!("{function}({e}, {arguments})");
        match self {
            Self::Curve(e) => Self::Curve(inside(e)),
            Self::Surface(e) => Self::Surface(inside(e)),
            Self::Solid { foot, by, mut motions } => {
                motions.push((function, arguments));
                Self::Solid { foot, by, motions }
            }
        }
    }

    /// A closed curve in the plane z = 0, extruded upwards.
    pub fn extruded(self, height: &str, centred: bool) -> Option<Self> {
        let back = centred.then(|| format!("0, 0, {}", negative(&half(height))));
        match self {
            Self::Curve(foot) => Some(solid(foot, height, back)),
            _ => None,
        }
    }

    /// A curve of the plane z = 0, set upright and turned about the axis z by these degrees.
    pub fn turned(self, angle: Option<&str>) -> Option<Self> {
        let Self::Curve(profile) = self else { return None };
        let angle = angle.filter(|a| *a != "360").map_or_else(String::new, |a| format!(", angle: {}", degrees(a)));
        Some(Self::Surface(format!("revolve(rotate({profile}, angle: 90deg, axis: (1, 0, 0)){angle})")))
    }

    /// Its declarations, a line each; `family` is what stands behind the name, as in `curve rib for i in 0..4 = …`.
    pub fn declared(&self, name: &str, family: &str) -> Option<String> {
        match self {
            Self::Curve(e) => Some(format!("curve {name}{family} = {e}")),
            Self::Surface(e) => Some(format!("surface {name}{family} = {e}")),
            Self::Solid { .. } if !family.is_empty() => None,
            Self::Solid { foot, .. } => {
                let bound = format!("{name}_foot");
                let faces = self.faces(&bound);
                let faces = if faces.ends_with(']') { faces[1..faces.len() - 1].to_owned() } else { faces };
                Some(format!("curve {bound} = {foot}\nshell {name} of {faces}"))
            }
        }
    }

    /// The list of the faces of a solid over this curve; any other thing as it is.
    pub fn faces(&self, foot: &str) -> String {
        match self {
            Self::Curve(e) | Self::Surface(e) => e.clone(),
            Self::Solid { by, motions, .. } => {
                let faces = format!("[plane({foot}), extrude({foot}, by: {by}), plane(move({foot}, by: {by}))]");
                motions.iter().fold(faces, |faces, (function, arguments)| format!("{function}({faces}, {arguments})"))
            }
        }
    }

    /// One expression that is the whole of it.
    pub fn expression(&self) -> String {
        match self {
            Self::Solid { foot, .. } => self.faces(foot),
            _ => self.faces(""),
        }
    }
}

/// `[x, y, z]` and `45` as the turns that OpenSCAD makes of them, about x first.
pub(crate) fn turns(angles: &str) -> Option<Vec<String>> {
    const AXES: [&str; 3] = ["(1, 0, 0)", "(0, 1, 0)", "(0, 0, 1)"];
    match items(angles) {
        None => Some(vec![format!("angle: {}", degrees(angles))]),
        Some(parts) if parts.len() == 3 => {
            let about = parts.iter().zip(AXES).filter(|(angle, _)| **angle != "0");
            Some(about.map(|(angle, axis)| format!("angle: {}, axis: {axis}", degrees(angle))).collect())
        }
        Some(_) => None,
    }
}

/// One more than the last number of a range.
pub(crate) fn behind(last: &str) -> String {
    match last.trim().parse::<u64>() {
        Ok(n) => format!("{}", n.saturating_add(1)),
        Err(_) => format!("({} + 1)", part(last.trim())),
    }
}
