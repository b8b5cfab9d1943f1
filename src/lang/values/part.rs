//! An imported part as a value: its faces, the bodies that they make, and what of the file could not be used.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::base::origin::Origin;
use crate::io::cad::assembly::Node;
use crate::io::cad::healing::{Repair, Rule};
use crate::io::cad::part::Unusable;
use crate::io::files::fault::Malformed;
use crate::lang::values::conversions::FromValue;
use crate::lang::values::types::Ty;
use crate::lang::values::value::{BodyKind, ModuleId, ShellValue, Value};
use crate::lang::words::plural::counted;
use crate::surface::Surface;

/// What a file says of one surface.
#[derive(Clone, Debug, Default)]
pub struct SurfaceProperties {
    /// The file's name for it.
    pub name: Arc<str>,
    /// The name as it stands in the file, where it has one; others may have the same.
    pub own: Option<Arc<str>>,
    /// Layers of the file that it lies on.
    pub layers: Vec<Arc<str>>,
    /// Name of its colour in the file, and red, green and blue from 0 to 1.
    pub color: Option<(Arc<str>, [f64; 3])>,
    /// Where it stands in the file: `#36`, `D45`.
    pub entity: Arc<str>,
    /// Of [`PartFile::tree`].
    pub node: Option<usize>,
}

/// Faces that the file keeps together.
#[derive(Clone, Debug)]
pub struct Body {
    /// As a script names it: `part.shells[0]`.
    pub name: Arc<str>,
    /// Of [`PartValue::faces`].
    pub faces: Vec<usize>,
    /// The file calls it a solid.
    pub solid: bool,
}

/// What stands in a file about all of it; every part of it has the same.
#[derive(Clone, Debug)]
pub struct PartFile {
    /// Path as written.
    pub path: Arc<str>,
    /// The import.
    pub origin: Origin,
    /// Script it belongs to.
    pub module: ModuleId,
    /// Of each surface, in the order of the part's faces.
    pub said: Vec<SurfaceProperties>,
    /// Names of solids and shells by those of scripts (`part.solids[0]`), where the file has one: as it stands there, and that of which
    /// there is one only.
    pub bodies: BTreeMap<Arc<str>, [Arc<str>; 2]>,
    /// Products at their places, where the file is an assembly.
    pub tree: Vec<Node>,
    /// How many faces the file has.
    pub total: usize,
    /// What was repaired.
    pub repairs: Vec<Repair>,
    /// What else was said of the file.
    pub notes: Vec<Malformed>,
}

/// A part, or a body or group of it.
#[derive(Clone, Debug)]
pub struct PartValue {
    /// As a script names it: `part`, `part.solids[0]`.
    pub name: Arc<str>,
    /// The file.
    pub file: Arc<PartFile>,
    /// Its surfaces, each with an origin of its own.
    pub faces: Vec<Surface>,
    /// What the file keeps together.
    pub bodies: Vec<Body>,
    /// Faces without a surface.
    pub unusable: Vec<Unusable>,
}

/// Faces that make a skin, with the kind of body that they are.
pub type Skin = (Vec<Surface>, Option<BodyKind>);

impl Body {
    /// What the file calls it.
    pub fn kind(&self) -> BodyKind {
        if self.solid { BodyKind::Solid } else { BodyKind::Shell }
    }
}

impl PartValue {
    /// A body as a shell.
    pub fn shell(&self, body: &Body) -> Value {
        let surfaces = body.faces.iter().filter_map(|k| self.faces.get(*k)).cloned().collect();
        self.shell_of(body.name.clone(), (surfaces, Some(body.kind())))
    }

    fn shell_of(&self, name: Arc<str>, (surfaces, body): Skin) -> Value {
        let (module, origin) = (self.file.module, self.file.origin);
        Value::Shell(Arc::new(ShellValue { name, module, origin, surfaces, snap: None, imprint: None, flip: false, body }))
    }

    /// Its faces in no body.
    pub fn loose(&self) -> Vec<Surface> {
        let mut free = vec![true; self.faces.len()];
        self.bodies.iter().flat_map(|body| &body.faces).for_each(|k| free[*k] = false);
        self.faces.iter().zip(free).filter(|(_, free)| *free).map(|(face, _)| face.clone()).collect()
    }

    /// Each body as a shell, then the faces in none.
    pub fn things(&self) -> Vec<Value> {
        let bodies = self.bodies.iter().map(|body| self.shell(body));
        bodies.chain(self.loose().into_iter().map(Value::Surface)).collect()
    }

    /// Skins: a body each, and all faces in no body as one.
    pub fn skins(&self) -> Vec<Skin> {
        let body = |body: &Body| (body.faces.iter().filter_map(|k| self.faces.get(*k)).cloned().collect(), Some(body.kind()));
        let loose = Some((self.loose(), None)).filter(|loose: &Skin| !loose.0.is_empty());
        self.bodies.iter().map(body).chain(loose).collect()
    }

    /// The solids that the file has, each as a shell; what makes skins alone where it has none.
    pub fn solids(&self) -> Vec<Value> {
        let solids: Vec<Value> = self.bodies.iter().filter(|body| body.solid).map(|body| self.shell(body)).collect();
        if solids.is_empty() { self.skins().into_iter().map(|skin| self.shell_of(self.name.clone(), skin)).collect() } else { solids }
    }

    /// What came in, with lengths in a unit; what was repaired by which rule and what could not be used, a line each.
    pub fn summary(&self, unit: &str) -> Vec<String> {
        let file = &self.file;
        let mut lines = vec![format!(
            "  {} from \"{}\", {}",
            counted(self.faces.len(), "surface", "surfaces"),
            file.path,
            counted(self.bodies.len(), "body", "bodies")
        )];
        let whole = self.faces.len() == file.said.len();
        for body in &self.bodies {
            let kind = if body.solid { "solid" } else { "shell" };
            lines.push(format!("  {}: {kind} of {}", body.name, counted(body.faces.len(), "surface", "surfaces")));
        }
        if !self.unusable.is_empty() {
            lines.push(format!("  {} of {} in the file could not be used:", self.unusable.len(), counted(file.total, "face", "faces")));
            lines.extend(self.unusable.iter().map(|face| format!("    line {}: {}: {}", face.line, face.entity, face.cause)));
        }
        if whole {
            for rule in Rule::ALL {
                let all: Vec<&Repair> = file.repairs.iter().filter(|repair| repair.rule == rule).collect();
                if !all.is_empty() {
                    lines.push(format!("  {}: {}", rule.words(), counted(all.len(), "time", "times")));
                    lines.extend(all.iter().map(|repair| format!("    line {}: {}", repair.line, repair.in_words(unit))));
                }
            }
            if !file.notes.is_empty() {
                lines.push("  also said of the file:".to_owned());
                lines.extend(file.notes.iter().map(|note| format!("    line {}: {}", note.line, note.what)));
            }
        }
        lines
    }

    /// Its faces as a list.
    pub fn list(&self) -> Value {
        Value::list(self.faces.iter().cloned().map(Value::Surface).collect())
    }
}

impl Value {
    /// The part that this record stands for.
    pub fn part(&self) -> Option<&Arc<PartValue>> {
        match self {
            Self::Record(record) => record.part.as_ref(),
            _ => None,
        }
    }
}

impl FromValue for Arc<PartValue> {
    const TY: Ty = Ty::Part;
    fn from_value(value: Value) -> Option<Self> {
        value.part().cloned()
    }
}
