//! An imported part as a value: its faces, the bodies that they make, and what of the file could not be used.

use std::sync::Arc;

use super::coerce::flatten_into;
use super::cx::Cx;
use super::module::State;
use super::origins::{NO_MEMBER, Place};
use super::types::{FromValue, Ty};
use super::value::{ModuleId, ShellValue, Value};
use crate::base::origin::Origin;
use crate::io::cad::part::Unusable;
use crate::surface::Surface;

/// What a file says of one surface.
#[derive(Clone, Debug, Default)]
pub struct Said {
    /// The file's name for it.
    pub name: Arc<str>,
    /// Name of its colour in the file, and red, green and blue from 0 to 1.
    pub color: Option<(Arc<str>, [f64; 3])>,
    /// Where it stands in the file: `#36`, `D45`.
    pub entity: Arc<str>,
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
    pub said: Vec<Said>,
    /// How many faces the file has.
    pub total: usize,
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

impl PartValue {
    /// A body as a shell.
    pub fn shell(&self, body: &Body) -> Value {
        let surfaces = body.faces.iter().filter_map(|k| self.faces.get(*k)).cloned().collect();
        self.shell_of(body.name.clone(), surfaces)
    }

    fn shell_of(&self, name: Arc<str>, surfaces: Vec<Surface>) -> Value {
        let (module, origin) = (self.file.module, self.file.origin);
        Value::Shell(Arc::new(ShellValue { name, module, origin, surfaces, snap: None, imprint: None, flip: false }))
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
    pub fn skins(&self) -> Vec<Vec<Surface>> {
        let body = |body: &Body| body.faces.iter().filter_map(|k| self.faces.get(*k)).cloned().collect();
        let loose = Some(self.loose()).filter(|loose| !loose.is_empty());
        self.bodies.iter().map(body).chain(loose).collect()
    }

    /// The solids that the file has, each as a shell; what makes skins alone where it has none.
    pub fn solids(&self) -> Vec<Value> {
        let solids: Vec<Value> = self.bodies.iter().filter(|body| body.solid).map(|body| self.shell(body)).collect();
        if solids.is_empty() { self.skins().into_iter().map(|skin| self.shell_of(self.name.clone(), skin)).collect() } else { solids }
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

    /// Flattened, with each part as what it is made of.
    pub(super) fn with_parts_open(self, open: impl Fn(&Self, &PartValue) -> Vec<Self>) -> Vec<Self> {
        let mut flat = Vec::new();
        flatten_into(self, &mut flat);
        if flat.iter().all(|value| value.part().is_none()) {
            return flat;
        }
        let opened = |value: Self| match value.part() {
            Some(part) => open(&value, part),
            None => vec![value],
        };
        flat.into_iter().flat_map(opened).collect()
    }
}

impl FromValue for Arc<PartValue> {
    const TY: Ty = Ty::Part;
    fn from_value(value: Value) -> Option<Self> {
        value.part().cloned()
    }
}

impl Cx<'_> {
    /// The part that a face was imported with, and its number there.
    fn part_of(&self, face: &Surface) -> Option<(&Arc<PartValue>, usize)> {
        let Place { module, declaration, member, .. } = self.origins.place(face.origin())?;
        let [face, NO_MEMBER] = member else { return None };
        let State::Done(value) = self.machine.modules.get(module.index())?.states.get(declaration as usize)? else { return None };
        value.part().map(|part| (part, face as usize))
    }

    /// What a file says of a face that was imported.
    pub fn said_of(&self, face: &Surface) -> Option<&Said> {
        self.part_of(face).and_then(|(part, face)| part.file.said.get(face))
    }
}
