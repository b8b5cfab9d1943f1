//! Everything that can go wrong or deserves a word, with measurements instead of text.
//!
//! The kernel returns a [`Fault`]; it knows points, gaps and [`Origin`]s but no source text, names or units.
//! Each family states its code, sentence, labels and help in [`Describe::describe`], asking a [`Say`] for names and
//! quantities; `lang::diag` is the one place that turns the result into a diagnostic under the script.
//! Warnings and notes are faults as well: the letter of their code tells, and they travel in a `Vec<Fault>` beside
//! the value.

mod blends;
mod curves;
mod cut;
mod edit;
mod files;
mod join;
mod loops;
mod mesh;
mod nets;
mod network;
mod no_flow;
mod scatter;
mod surface;
mod surface_shape;
mod sweep;
mod values;
mod walls;

use std::fmt;
use std::mem::discriminant;

use glam::DVec3;

pub use blends::{BlendFault, NoBlend};
pub use curves::{CurveFault, KnotFault};
pub use cut::CutFault;
pub use edit::Edit;
pub use files::{FileFault, Malformed, Share};
pub use join::JoinFault;
pub use loops::{LoopFault, LoopRole};
pub use mesh::{Close, Cure, LostPart, MeshFault, MeshLimit};
pub use nets::NetFault;
pub use network::{CurveEnd, NetworkFault, round_down, round_up};
pub use no_flow::NoFlow;
pub use scatter::ScatterFault;
pub use surface::{Construction, SurfaceFault, Touching};
pub use sweep::SweepFault;
pub use values::{LengthRange, ValueFault};
pub use walls::{WallEdge, WallFault};

use super::origin::Origin;

/// Result of kernel work.
pub type Result<T> = std::result::Result<T, Fault>;

/// One thing that went wrong or deserves a word; families as in `diagnostics.md`.
#[derive(Clone, Debug, PartialEq)]
pub enum Fault {
    /// Families 2 and 3: a value of the wrong kind or outside its range.
    Value(Box<ValueFault>),
    /// Family 4: curves.
    Curve(Box<CurveFault>),
    /// Family 5: network and chains.
    Network(Box<NetworkFault>),
    /// Family 6: surfaces and model.
    Surface(Box<SurfaceFault>),
    /// Family 6: loops of faces and the curves of a loop.
    Loop(Box<LoopFault>),
    /// Family 6: surfaces that meet and what they cut.
    Cut(Box<CutFault>),
    /// Family 6: sweeps.
    Sweep(Box<SweepFault>),
    /// Family 6: nets of profiles and guides.
    Net(Box<NetFault>),
    /// Family 6: roundings between surfaces.
    Blend(Box<BlendFault>),
    /// Family 6: surfaces through scattered points.
    Scatter(Box<ScatterFault>),
    /// Family 7: surfaces that make no one surface.
    Join(Box<JoinFault>),
    /// Family 6: offsets and walls.
    Wall(Box<WallFault>),
    /// Family 7: meshes.
    Mesh(Box<MeshFault>),
    /// Family 8: files.
    File(Box<FileFault>),
    /// Stopped from outside (Ctrl-C).
    Interrupted,
}

/// A code of `diagnostics.md`, for example `E501`; the letter is the severity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Code(pub &'static str);

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The model is wrong.
    Error,
    /// The model is right but probably not meant so.
    Warning,
    /// Worth knowing.
    Note,
}

impl Code {
    /// Severity by the letter.
    pub fn severity(self) -> Severity {
        match self.0.as_bytes().first() {
            Some(b'W') => Severity::Warning,
            Some(b'N') => Severity::Note,
            _ => Severity::Error,
        }
    }
}

/// What a label points at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    /// The expression that made an entity.
    Entity(Origin),
    /// The argument of the call that is being made, by parameter name.
    Argument(&'static str),
    /// The n-th value of a list or rest argument, by parameter name.
    Item(&'static str, usize),
    /// The call itself.
    Call,
}

/// A fault in words, before its subjects are found in the script.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// Code of `diagnostics.md`.
    pub code: Code,
    /// One sentence without final dot.
    pub message: String,
    /// Culprits, the first one foremost, each with a few words.
    pub labels: Vec<(Subject, String)>,
    /// Something that can be typed.
    pub help: Option<String>,
    /// Further lines.
    pub notes: Vec<String>,
    /// The help as it would be typed; several are other ways.
    pub edits: Vec<(Subject, Edit)>,
}

impl Report {
    /// A report with a sentence and nothing else yet.
    pub fn new(code: &'static str, message: impl Into<String>) -> Self {
        Self { code: Code(code), message: message.into(), labels: Vec::new(), help: None, notes: Vec::new(), edits: Vec::new() }
    }

    /// Adds a label.
    pub fn label(mut self, subject: Subject, text: impl Into<String>) -> Self {
        self.labels.push((subject, text.into()));
        self
    }

    /// Adds a label on an entity's expression.
    pub fn at(self, origin: Origin, text: impl Into<String>) -> Self {
        self.label(Subject::Entity(origin), text)
    }

    /// Sets the help.
    pub fn help(mut self, text: impl Into<String>) -> Self {
        self.help = Some(text.into());
        self
    }

    /// Adds an edit that does what the help says.
    pub fn edit(mut self, subject: Subject, edit: Edit) -> Self {
        self.edits.push((subject, edit));
        self
    }

    /// Adds a further line.
    pub fn note(mut self, text: impl Into<String>) -> Self {
        self.notes.push(text.into());
        self
    }
}

/// Speaks of entities and quantities as the user does: names and model units.
pub trait Say {
    /// Name of the declaration that made the entity, without quotes; empty when it has none.
    fn name(&self, origin: Origin) -> String;
    /// A length in model units, for example `0.310 mm`.
    fn length(&self, length: f64) -> String;
    /// Places, for example `(4, 0, 1.25) m`, with digits that tell them apart.
    fn points(&self, places: &[DVec3]) -> Vec<String>;
    /// One place.
    fn point(&self, place: DVec3) -> String {
        self.points(&[place]).pop().unwrap_or_default()
    }
    /// Two places.
    fn pair(&self, a: DVec3, b: DVec3) -> (String, String) {
        let mut texts = self.points(&[a, b]).into_iter();
        (texts.next().unwrap_or_default(), texts.next().unwrap_or_default())
    }
    /// An angle given in radians, for example `5.88°`.
    fn angle(&self, radians: f64) -> String;
    /// The name in backquotes, or `otherwise` when it has none.
    fn quoted(&self, origin: Origin, otherwise: &str) -> String {
        let name = self.name(origin);
        if name.is_empty() { otherwise.to_owned() } else { format!("`{name}`") }
    }
}

/// Says everything in bare numbers; what `Display` uses.
pub struct Plain;

impl Say for Plain {
    fn name(&self, _: Origin) -> String {
        String::new()
    }
    fn length(&self, length: f64) -> String {
        format!("{length:.6}")
    }
    fn points(&self, places: &[DVec3]) -> Vec<String> {
        places.iter().map(|p| format!("({:.6}, {:.6}, {:.6})", p.x, p.y, p.z)).collect()
    }
    fn angle(&self, radians: f64) -> String {
        format!("{:.4}°", radians.to_degrees())
    }
}

/// A family of faults that can say what happened.
pub trait Describe {
    /// Code, sentence, labels and help.
    fn describe(&self, say: &dyn Say) -> Report;
}

impl Describe for Fault {
    fn describe(&self, say: &dyn Say) -> Report {
        match self {
            Self::Value(f) => f.describe(say),
            Self::Curve(f) => f.describe(say),
            Self::Network(f) => f.describe(say),
            Self::Surface(f) => f.describe(say),
            Self::Loop(f) => f.describe(say),
            Self::Cut(f) => f.describe(say),
            Self::Sweep(f) => f.describe(say),
            Self::Net(f) => f.describe(say),
            Self::Blend(f) => f.describe(say),
            Self::Scatter(f) => f.describe(say),
            Self::Join(f) => f.describe(say),
            Self::Wall(f) => f.describe(say),
            Self::Mesh(f) => f.describe(say),
            Self::File(f) => f.describe(say),
            Self::Interrupted => Report::new("E999", "interrupted"),
        }
    }
}

impl Fault {
    /// Code of `diagnostics.md`.
    pub fn code(&self) -> Code {
        self.describe(&Plain).code
    }

    /// Whether both are the same variant of one family; told without describing either.
    pub fn same_kind(&self, other: &Self) -> bool {
        fn same<T>(a: &T, b: &T) -> bool {
            discriminant(a) == discriminant(b)
        }
        match (self, other) {
            (Self::Value(a), Self::Value(b)) => same(&**a, &**b),
            (Self::Curve(a), Self::Curve(b)) => same(&**a, &**b),
            (Self::Network(a), Self::Network(b)) => same(&**a, &**b),
            (Self::Surface(a), Self::Surface(b)) => same(&**a, &**b),
            (Self::Loop(a), Self::Loop(b)) => same(&**a, &**b),
            (Self::Cut(a), Self::Cut(b)) => same(&**a, &**b),
            (Self::Sweep(a), Self::Sweep(b)) => same(&**a, &**b),
            (Self::Net(a), Self::Net(b)) => same(&**a, &**b),
            (Self::Blend(a), Self::Blend(b)) => same(&**a, &**b),
            (Self::Scatter(a), Self::Scatter(b)) => same(&**a, &**b),
            (Self::Join(a), Self::Join(b)) => same(&**a, &**b),
            (Self::Wall(a), Self::Wall(b)) => same(&**a, &**b),
            (Self::Mesh(a), Self::Mesh(b)) => same(&**a, &**b),
            (Self::File(a), Self::File(b)) => same(&**a, &**b),
            _ => same(self, other),
        }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.describe(&Plain).message)
    }
}

impl std::error::Error for Fault {}

macro_rules! from_family {
    ($($variant:ident($family:ty)),+) => { $(
        impl From<$family> for Fault {
            fn from(fault: $family) -> Self {
                Self::$variant(Box::new(fault))
            }
        }
    )+ };
}
from_family!(
    Value(ValueFault),
    Curve(CurveFault),
    Network(NetworkFault),
    Surface(SurfaceFault),
    Loop(LoopFault),
    Cut(CutFault),
    Sweep(SweepFault),
    Net(NetFault),
    Blend(BlendFault),
    Scatter(ScatterFault),
    Join(JoinFault),
    Wall(WallFault),
    Mesh(MeshFault),
    File(FileFault)
);
