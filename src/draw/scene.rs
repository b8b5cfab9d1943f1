//! What is drawn, in space: sheets of triangles, lines, marks and names.

use glam::DVec3;

use super::color::{self, Ramp, Rgb};

/// How a sheet is coloured.
#[derive(Clone, Debug, PartialEq)]
pub enum Paint {
    /// One colour on both sides.
    Even(Rgb),
    /// The side that the normal points to, and the other one.
    Sides(Rgb, Rgb),
    /// Stripes of reflected light: broken where the tangent plane breaks, bent where curvature does.
    Zebra,
    /// Dark lines that parallel lamps, level in the picture, are reflected in.
    Reflections,
    /// Bands of equal angle between the normal and z.
    Isophotes,
    /// A value for each triangle, coloured by the scene's scale.
    OfTriangles(Vec<f32>),
    /// A value for each point, coloured by the scene's scale; between points in proportion.
    OfPoints(Vec<f32>),
}

/// Triangles that are shaded alike.
#[derive(Clone, Debug, PartialEq)]
pub struct Sheet {
    /// Name as declared; what the legend calls it where names are coloured.
    pub name: String,
    /// Corners, model units.
    pub points: Vec<DVec3>,
    /// Unit normals, one per point; none where triangles are flat.
    pub normals: Vec<DVec3>,
    /// Triangles by their corners.
    pub triangles: Vec<[u32; 3]>,
    /// For each triangle which of its sides (0–1, 1–2, 2–0: bits 1, 2, 4) are edges of elements; none where there are no
    /// elements.
    pub edges: Vec<u8>,
    /// How it is coloured.
    pub paint: Paint,
    /// Gauss and mean curvature at each point, where both were asked for, 1/model unit² and 1/model unit.
    pub bends: Vec<[f32; 2]>,
}

/// What a line shows; later ones are drawn over earlier ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// An edge of elements (of lines in a mesh).
    Element,
    /// Where two surfaces or patches meet.
    Border,
    /// A curve or link.
    Curve,
    /// Where a surface is bent.
    Kink,
    /// An edge of three faces or more.
    Crowded,
    /// An edge of one face only.
    Free,
    /// A tooth of a curvature comb, or the line along their tips.
    Comb,
}

impl Kind {
    /// All of them.
    pub const ALL: [Self; 7] = [Self::Element, Self::Border, Self::Curve, Self::Kink, Self::Crowded, Self::Free, Self::Comb];

    /// Its colour.
    pub fn color(self) -> Rgb {
        match self {
            Self::Element => color::ELEMENT,
            Self::Curve => color::CURVE,
            Self::Border => color::BORDER,
            Self::Kink => color::KINK,
            Self::Crowded => color::CROWDED,
            Self::Free => color::FREE,
            Self::Comb => color::COMB,
        }
    }

    /// Its width in a picture 800 pixels high.
    pub fn width(self) -> f64 {
        match self {
            Self::Element | Self::Comb => 1.1,
            Self::Curve => 2.2,
            Self::Border => 1.9,
            Self::Kink => 2.8,
            Self::Crowded | Self::Free => 3.4,
        }
    }

    /// What the legend calls it.
    pub fn words(self) -> &'static str {
        match self {
            Self::Element => "element edge",
            Self::Curve => "curve",
            Self::Border => "border",
            Self::Kink => "kink",
            Self::Crowded => "three or more faces",
            Self::Free => "free edge",
            Self::Comb => "curvature comb",
        }
    }

    /// Whether the legend explains it.
    pub fn is_explained(self) -> bool {
        matches!(self, Self::Kink | Self::Crowded | Self::Free)
    }
}

/// A line in space.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// What it shows.
    pub kind: Kind,
    /// Points along it, model units.
    pub points: Vec<DVec3>,
}

/// A point that is marked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mark {
    /// Where it is, model units.
    pub at: DVec3,
    /// A node of the network or a vertex, else a point or mesh node.
    pub node: bool,
}

/// A name with the places it may stand at.
#[derive(Clone, Debug, PartialEq)]
pub struct Label {
    /// The words.
    pub text: String,
    /// Places of the thing, the best first: the name stands at the first one that is seen and has room.
    pub places: Vec<DVec3>,
    /// Names with a smaller number are placed first.
    pub rank: u8,
    /// It stands on its place instead of beside it.
    pub centered: bool,
}

/// What colours mean where they stand for values.
#[derive(Clone, Debug, PartialEq)]
pub struct Scale {
    /// What is shown: `quality`, `longest side`.
    pub title: String,
    /// Unit of the numbers, empty for a ratio.
    pub unit: String,
    /// Value at the low end.
    pub low: f64,
    /// Value at the high end; more than `low`.
    pub high: f64,
    /// Colours.
    pub ramp: Ramp,
}

impl Scale {
    /// The colour of a value.
    pub fn color(&self, value: f64) -> Rgb {
        if value.is_finite() { self.ramp.at((value - self.low) / (self.high - self.low)) } else { color::UNKNOWN }
    }
}

/// Everything that is drawn, in space.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scene {
    /// Faces.
    pub sheets: Vec<Sheet>,
    /// Lines.
    pub lines: Vec<Line>,
    /// Marks.
    pub marks: Vec<Mark>,
    /// Names.
    pub labels: Vec<Label>,
    /// What colours of values mean.
    pub scale: Option<Scale>,
    /// What colours of faces mean: a colour and its words.
    pub keys: Vec<(Rgb, String)>,
    /// Points that the picture is framed by; none for everything.
    pub focus: Vec<DVec3>,
}

impl Scene {
    /// Every point that is drawn.
    pub fn points(&self) -> Vec<DVec3> {
        let sheets = self.sheets.iter().flat_map(|s| &s.points);
        let lines = self.lines.iter().flat_map(|l| &l.points);
        sheets.chain(lines).copied().chain(self.marks.iter().map(|m| m.at)).collect()
    }

    /// How many triangles.
    pub fn triangles(&self) -> usize {
        self.sheets.iter().map(|s| s.triangles.len()).sum()
    }

    /// Invariants: arrays fit each other and indices are inside; the sentence says what is broken.
    pub fn check(&self) -> Result<(), String> {
        for (k, sheet) in self.sheets.iter().enumerate() {
            let n = sheet.points.len();
            if !sheet.normals.is_empty() && sheet.normals.len() != n {
                return Err(format!("sheet {k} has {} normals for {n} points", sheet.normals.len()));
            }
            if !sheet.edges.is_empty() && sheet.edges.len() != sheet.triangles.len() {
                return Err(format!("sheet {k} has edges for {} of {} triangles", sheet.edges.len(), sheet.triangles.len()));
            }
            let values = match &sheet.paint {
                Paint::OfTriangles(values) => Some((values.len(), sheet.triangles.len())),
                Paint::OfPoints(values) => Some((values.len(), n)),
                _ => None,
            };
            if let Some((found, wanted)) = values
                && (found != wanted || self.scale.is_none())
            {
                return Err(format!("sheet {k} has {found} values for {wanted} places, or no scale"));
            }
            if sheet.triangles.iter().flatten().any(|c| *c as usize >= n) {
                return Err(format!("sheet {k} has a triangle with a corner that is not there"));
            }
        }
        if self.points().iter().any(|p| !p.is_finite()) {
            return Err("a point is not finite".to_owned());
        }
        match self.lines.iter().position(|line| line.points.len() < 2) {
            Some(k) => Err(format!("line {k} has no two points")),
            None => Ok(()),
        }
    }
}
