//! A script that is put together of declarations in one of the forms, with what it must report.

use glam::DVec3;
use lofting::lang::fmt::format;

use super::form::Form;

/// Largest relative difference: a few tolerances of the model over its size.
const ROOM: f64 = 5e-6;

/// A value that is wanted: of lengths to this power, and its room.
struct Wanted {
    label: String,
    value: f64,
    power: i32,
    room: f64,
}

/// A script on its way.
pub struct Scene {
    pub form: Form,
    /// Largest relative difference of what is reported from now on.
    pub room: f64,
    lines: Vec<String>,
    wanted: Vec<Wanted>,
    runs: usize,
}

fn tuple(p: DVec3) -> String {
    // A negative zero is one all the same.
    let [x, y, z] = (p + DVec3::ZERO).to_array();
    format!("({x:?}, {y:?}, {z:?})")
}

impl Scene {
    pub fn new(form: Form) -> Self {
        let lines = vec![format!("units {}", form.unit.0)];
        Self { form, room: ROOM, lines, wanted: Vec::new(), runs: 0 }
    }

    /// Model units to a millimetre of the plain model.
    fn factor(&self) -> f64 {
        self.form.scale / self.form.unit.1
    }

    pub fn point(&self, p: DVec3) -> String {
        tuple((self.form.turn * p + self.form.by) * self.factor())
    }

    /// The difference of two points.
    pub fn way(&self, d: DVec3) -> String {
        tuple(self.form.turn * d * self.factor())
    }

    pub fn direction(&self, d: DVec3) -> String {
        tuple(self.form.turn * d)
    }

    pub fn length(&self, l: f64) -> String {
        format!("{:?}", l * self.factor())
    }

    pub fn points(&self, points: &[DVec3]) -> String {
        format!("[{}]", points.iter().map(|p| self.point(*p)).collect::<Vec<_>>().join(", "))
    }

    /// A curve, reversed or of two runs where the form says so.
    fn curve(&mut self, text: String) -> String {
        if self.form.split {
            self.runs += 1;
            let name = format!("whole_{}", self.runs);
            self.lines.push(format!("let {name} = {text}"));
            return format!("({name}[..37%] + {name}[37%..])");
        }
        if self.form.reversed { format!("(-{text})") } else { text }
    }

    pub fn line(&mut self, a: DVec3, b: DVec3) -> String {
        let text = format!("line({}, {})", self.point(a), self.point(b));
        self.curve(text)
    }

    pub fn arc(&mut self, a: DVec3, b: DVec3, through: DVec3) -> String {
        let text = format!("arc({}, {}, through: {})", self.point(a), self.point(b), self.point(through));
        self.curve(text)
    }

    pub fn circle(&mut self, center: DVec3, radius: f64, normal: DVec3) -> String {
        let start = center + radius * normal.cross(if normal.x.abs() < normal.y.abs() { DVec3::X } else { DVec3::Y }).normalize();
        let text = format!("circle(center: {}, start: {}, normal: {})", self.point(center), self.point(start), self.direction(normal));
        self.curve(text)
    }

    pub fn ellipse(&mut self, center: DVec3, major: DVec3, minor: DVec3) -> String {
        let text = format!("ellipse(center: {}, major: {}, minor: {})", self.point(center), self.way(major), self.way(minor));
        self.curve(text)
    }

    /// Corners as the form has them.
    pub fn corners(&self, corners: &[DVec3], between: bool) -> Vec<DVec3> {
        let mut all = corners.to_vec();
        if self.form.collinear && between {
            all = corners.iter().enumerate().flat_map(|(k, p)| [*p, p.lerp(corners[(k + 1) % corners.len()], 0.4)]).collect();
        }
        if self.form.reversed {
            all.reverse();
        }
        if self.form.permuted {
            all.rotate_left(1);
        }
        all
    }

    pub fn polygon(&mut self, corners: &[DVec3]) -> String {
        let corners = self.corners(corners, true);
        let text = format!("polyline({}, closed: true)", self.points(&corners));
        if self.form.split { self.curve(text) } else { text }
    }

    pub fn rounded(&mut self, corners: &[DVec3], radius: f64) -> String {
        let corners = self.corners(corners, false);
        let text = format!("polyline({}, closed: true, round: {})", self.points(&corners), self.length(radius));
        if self.form.split { self.curve(text) } else { text }
    }

    pub fn extrude(&self, profile: &str, by: DVec3) -> String {
        format!("extrude({profile}, by: {})", self.way(by))
    }

    /// An unbounded plane.
    pub fn cut(&self, at: DVec3, normal: DVec3) -> String {
        format!("plane(at: {}, normal: {})", self.point(at), self.direction(normal))
    }

    pub fn say(&mut self, line: String) {
        self.lines.push(line);
    }

    pub fn surface(&mut self, name: &str, text: &str) {
        self.say(format!("surface {name} = {text}"));
    }

    /// Names in the order of the form.
    pub fn names(&self, names: &[&str]) -> String {
        let mut names = names.to_vec();
        if self.form.permuted {
            names.reverse();
        }
        names.join(", ")
    }

    /// Reports an expression that must have a value of lengths to this power.
    pub fn report(&mut self, label: &str, expression: &str, value: f64, power: i32) {
        self.say(format!("report \"{label}\": {expression}"));
        self.wanted.push(Wanted { label: label.to_owned(), value, power, room: self.room });
    }

    /// The number of pieces that are made and their whole area.
    pub fn pieces(&mut self, made: &str, count: Option<usize>, area: f64) {
        self.say(format!("let pieces = {made}"));
        if let Some(count) = count {
            self.report("pieces", "len(pieces)", count as f64, 0);
        }
        self.report("area", "sum([for piece in pieces: area(piece)])", area, 2);
    }

    /// The values wanted in model units, and their room.
    pub fn wanted(&self) -> impl Iterator<Item = (&str, f64, f64)> {
        self.wanted.iter().map(|w| (w.label.as_str(), w.value * self.factor().powi(w.power), w.room))
    }

    pub fn text(&self) -> String {
        let mut lines = self.lines.clone();
        if self.form.unrelated {
            let [at, to] = [DVec3::new(140.0, 120.0, 10.0), DVec3::new(150.0, 150.0, 10.0)].map(|p| self.point(p));
            lines.push(format!("surface unrelated = extrude(line({at}, {to}), by: {})", self.way(DVec3::new(0.0, 0.0, 20.0))));
        }
        if self.form.shuffled {
            lines[1..].reverse();
        }
        let text = lines.join("\n") + "\n";
        if !self.form.formatted {
            return text;
        }
        format(&text).text
    }
}
