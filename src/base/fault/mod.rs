//! Everything that can go wrong or deserves a word, with measurements instead of text.
//!
//! The kernel returns a [`Fault`]; it knows points, gaps and [`Origin`]s but no source text, names or units.
//! Each family, declared on the floor it speaks of, has one table of its codes, [`Describe::code`], and states sentence, labels and help in
//! [`Describe::describe`], asking a [`Say`] for names and quantities; `lang::diag` is the one place that turns the result into a diagnostic under the script.
//! Warnings and notes are faults as well: the letter of their code tells, and they travel in a `Vec<Fault>` beside
//! the value.

mod edit;
pub mod quantities;
mod values;

use std::any::Any;
use std::fmt;
use std::mem::discriminant;

use glam::DVec3;

pub use edit::Edit;
pub use values::{EdgePlace, LengthRange, ValueFault};

use super::origin::Origin;

/// Result of kernel work.
pub type Result<T> = std::result::Result<T, Fault>;

/// One thing that went wrong or deserves a word. Its family is declared on the floor that it speaks of.
#[derive(Debug)]
pub enum Fault {
    /// A fault of a family.
    Family(Box<dyn Family>),
    /// Stopped from outside (Ctrl-C).
    Interrupted,
}

/// A code of `docs/codes/`, for example `E501`; the letter is the severity.
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

impl Severity {
    /// `error`, `warning` or `note`.
    pub fn word(self) -> &'static str {
        match self {
            Self::Error => "error",
            Self::Warning => "warning",
            Self::Note => "note",
        }
    }
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

/// A fault in words, before its subjects are found in the script. Its code is that of the fault.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
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
    pub fn new(message: impl Into<String>) -> Self {
        Self { message: message.into(), labels: Vec::new(), help: None, notes: Vec::new(), edits: Vec::new() }
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

    /// Adds labels on the expressions of two entities that are alike: "this curve" and "and this one".
    pub fn both(self, a: Origin, b: Origin, text: &'static str) -> Self {
        self.at(a, text).at(b, "and this one")
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
    /// The same of what meets something: an unbounded plane is a value without an origin.
    fn met(&self, origin: Origin, otherwise: &str) -> String {
        if origin.is_some() { self.quoted(origin, otherwise) } else { "the plane".to_owned() }
    }
}

/// Says everything in bare numbers; what `Display` uses.
pub struct PlainWords;

impl Say for PlainWords {
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
    /// Code of `docs/codes/`.
    fn code(&self) -> Code;
    /// Sentence, labels and help.
    fn describe(&self, say: &dyn Say) -> Report;
}

/// The table of codes of a family, each variant with its own: `codes! { Open "E502", Nested "E662" }`. Behind a semicolon stand
/// variants whose code depends on what they hold.
macro_rules! codes {
    ($($variant:ident $code:literal),+ $(; $($pattern:pat => $chosen:expr),+)?) => {
        fn code(&self) -> $crate::base::fault::Code {
            $crate::base::fault::Code(match self {
                $(Self::$variant { .. } => $code,)+
                $($($pattern => $chosen,)+)?
            })
        }
    };
}
pub(crate) use codes;

/// A fault of a family, whichever it is; every enumeration that can describe its variants is one.
pub trait Family: Describe + Any + fmt::Debug + Send + Sync {
    /// A copy.
    fn copied(&self) -> Box<dyn Family>;
    /// Whether both are the same fault with the same measurements.
    fn equals(&self, other: &dyn Family) -> bool;
    /// Whether both are the same variant of one family.
    fn is_like(&self, other: &dyn Family) -> bool;
}

impl<T: Describe + Any + fmt::Debug + Clone + PartialEq + Send + Sync> Family for T {
    fn copied(&self) -> Box<dyn Family> {
        Box::new(self.clone())
    }

    fn equals(&self, other: &dyn Family) -> bool {
        (other as &dyn Any).downcast_ref::<T>() == Some(self)
    }

    fn is_like(&self, other: &dyn Family) -> bool {
        (other as &dyn Any).downcast_ref::<T>().is_some_and(|other| discriminant(self) == discriminant(other))
    }
}

impl Fault {
    /// The fault as one of a family; `None` where it is of another one.
    pub fn of<T: Family>(&self) -> Option<&T> {
        match self {
            Self::Family(fault) => (fault.as_ref() as &dyn Any).downcast_ref(),
            Self::Interrupted => None,
        }
    }

    /// Sentence, labels and help.
    pub fn describe(&self, say: &dyn Say) -> Report {
        match self {
            Self::Family(fault) => fault.describe(say),
            Self::Interrupted => Report::new("interrupted"),
        }
    }

    /// Code of `docs/codes/`; found without describing the fault.
    pub fn code(&self) -> Code {
        match self {
            Self::Family(fault) => fault.code(),
            Self::Interrupted => Code("E999"),
        }
    }

    /// Whether both are the same variant of one family; found without describing either.
    pub fn same_kind(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Family(a), Self::Family(b)) => a.is_like(b.as_ref()),
            (Self::Interrupted, Self::Interrupted) => true,
            _ => false,
        }
    }
}

impl Clone for Fault {
    fn clone(&self) -> Self {
        match self {
            Self::Family(fault) => Self::Family(fault.copied()),
            Self::Interrupted => Self::Interrupted,
        }
    }
}

impl PartialEq for Fault {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Family(a), Self::Family(b)) => a.equals(b.as_ref()),
            (Self::Interrupted, Self::Interrupted) => true,
            _ => false,
        }
    }
}

impl<T: Family> From<T> for Fault {
    fn from(fault: T) -> Self {
        Self::Family(Box::new(fault))
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.describe(&PlainWords).message)
    }
}

impl std::error::Error for Fault {}
