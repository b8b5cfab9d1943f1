//! What an expression evaluates to.

use std::sync::Arc;

use glam::DVec3;

use crate::base::origin::Origin;
use crate::draw::Drawing;
use crate::lang::values::part::PartValue;
use crate::lang::values::table::Table;
use crate::lang::words::names::Name;
use crate::mesh::Mesh;
use crate::model::{Model, PatchId, SharedEdge, VertexId};
use crate::network::{Chain, LinkId};
use crate::surface::Surface;

crate::ids! {
    /// One evaluated script: the main one is 0, each `use` makes another.
    ModuleId,
}

impl ModuleId {
    /// The main script.
    pub const MAIN: Self = Self(0);
}

/// Exponents of length, angle and mass.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Dim {
    /// Power of a length.
    pub length: i8,
    /// Power of an angle.
    pub angle: i8,
    /// Power of a mass.
    pub mass: i8,
}

impl Dim {
    /// A bare number.
    pub const NONE: Self = Self { length: 0, angle: 0, mass: 0 };
    /// A length.
    pub const LENGTH: Self = Self { length: 1, ..Self::NONE };
    /// An area.
    pub const AREA: Self = Self { length: 2, ..Self::NONE };
    /// A volume.
    pub const VOLUME: Self = Self { length: 3, ..Self::NONE };
    /// A curvature.
    pub const CURVATURE: Self = Self { length: -1, ..Self::NONE };
    /// An angle.
    pub const ANGLE: Self = Self { angle: 1, ..Self::NONE };
    /// A mass.
    pub const MASS: Self = Self { mass: 1, ..Self::NONE };

    /// Whether this is a bare number.
    pub fn is_none(self) -> bool {
        self == Self::NONE
    }

    /// Whether this is a power of a length (a bare number fits it in model units).
    pub fn is_length_power(self) -> bool {
        self.length != 0 && self.angle == 0 && self.mass == 0
    }

    /// Dimension of a product; `None` when an exponent leaves its range.
    pub fn times(self, other: Self) -> Option<Self> {
        Some(Self {
            length: self.length.checked_add(other.length)?,
            angle: self.angle.checked_add(other.angle)?,
            mass: self.mass.checked_add(other.mass)?,
        })
    }

    /// Dimension of a quotient.
    pub fn over(self, other: Self) -> Option<Self> {
        self.times(other.power(-1)?)
    }

    /// Dimension of a whole power.
    pub fn power(self, n: i8) -> Option<Self> {
        Some(Self { length: self.length.checked_mul(n)?, angle: self.angle.checked_mul(n)?, mass: self.mass.checked_mul(n)? })
    }

    /// Dimension of the n-th root; `None` when an exponent is not a multiple of n.
    pub fn root(self, n: i8) -> Option<Self> {
        let part = |e: i8| (e % n == 0).then_some(e / n);
        Some(Self { length: part(self.length)?, angle: part(self.angle)?, mass: part(self.mass)? })
    }
}

/// A number with its dimension: lengths in the main script's units, angles in **degrees**, masses in kg.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Quantity {
    /// The number.
    pub value: f64,
    /// Its dimension.
    pub dim: Dim,
    /// Written with `%` (value 0.3 for `30%`): a tolerance that is relative.
    pub percent: bool,
}

impl Quantity {
    /// A bare number.
    pub fn bare(value: f64) -> Self {
        Self { value, dim: Dim::NONE, percent: false }
    }

    /// A number with a dimension.
    pub fn new(value: f64, dim: Dim) -> Self {
        Self { value, dim, percent: false }
    }
}

/// The surface model that patches, edges and vertices are numbered in: that of a script, or one of a few surfaces of which the script
/// does not declare all (written inside a shell, cut, moved).
#[derive(Clone, Debug)]
pub struct EntityHome {
    /// The script, whose network it stands on.
    pub module: ModuleId,
    /// The model of those surfaces; `None` for the script's own.
    pub annex: Option<Arc<Model>>,
    /// It stands on no network: one of the script's surfaces is made from it.
    pub alone: bool,
}

impl From<ModuleId> for EntityHome {
    fn from(module: ModuleId) -> Self {
        Self { module, annex: None, alone: false }
    }
}

impl From<&EntityHome> for EntityHome {
    fn from(home: &EntityHome) -> Self {
        home.clone()
    }
}

impl PartialEq for EntityHome {
    fn eq(&self, other: &Self) -> bool {
        let same = match (&self.annex, &other.annex) {
            (None, None) => true,
            // Of two runs each has built its own from the same surfaces.
            (Some(a), Some(b)) => {
                let pairs = || a.surfaces.iter().zip(&b.surfaces);
                Arc::ptr_eq(a, b) || a.surfaces.len() == b.surfaces.len() && pairs().all(|(a, b)| a.surface.is(&b.surface))
            }
            _ => false,
        };
        self.module == other.module && self.alone == other.alone && same
    }
}

/// `{a: 1, b: 2}`, or a row of a table, which has places as well as names.
#[derive(Clone, Debug, Default)]
pub struct Record {
    /// Keys in order of writing.
    pub keys: Arc<Vec<Name>>,
    /// Values in the same order.
    pub values: Vec<Value>,
    /// Whether it may be indexed and walked like a list (a row of a table with a header).
    pub row: bool,
    /// The imported part, body or group that it is the record of.
    pub part: Option<Arc<PartValue>>,
}

impl Record {
    /// The value of a field.
    pub fn get(&self, key: Name) -> Option<&Value> {
        self.keys.iter().position(|k| *k == key).and_then(|i| self.values.get(i))
    }
}

/// A shell as declared (`shell s of …`) or moved: surfaces as values.
#[derive(Clone, Debug)]
pub struct ShellValue {
    /// Name as declared (`hall`, `halls[2]`).
    pub name: Arc<str>,
    /// Script it belongs to.
    pub module: ModuleId,
    /// Its declaration.
    pub origin: Origin,
    /// Its surfaces.
    pub surfaces: Vec<Surface>,
    /// How far apart borders may be and still be one edge, model units, with the expression that says so.
    pub snap: Option<(f64, Origin)>,
    /// What says that its faces were cut by each other: more than two of them may share an edge, and a mesh joins lines that end in a face.
    pub imprint: Option<Origin>,
    /// Whether it shows the other side: a closed one points inwards, an open one away from where its first surface does.
    pub flip: bool,
    /// The kind of body of an imported part that it is as a whole: meshes keep those apart.
    pub body: Option<BodyKind>,
}

/// What a file calls faces that it keeps together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BodyKind {
    /// Faces round a volume.
    Solid,
    /// A skin, which may be open.
    Shell,
}

/// A mesh: of a `mesh` declaration, or data (imported, moved).
#[derive(Clone, Debug)]
pub enum MeshValue {
    /// Declared: the n-th mesh of a script; built on demand by [`crate::lang::eval::context::Cx::mesh`].
    Declared {
        /// Script it belongs to.
        module: ModuleId,
        /// Place in [`crate::lang::eval::context::Cx::meshes`] of that script.
        index: u32,
    },
    /// Data.
    Data(Arc<Mesh>, Origin),
}

/// `plane(at:, normal:)`: unbounded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// A point of it, model units.
    pub at: DVec3,
    /// Unit normal.
    pub normal: DVec3,
}

/// A value. Cheap to clone.
#[derive(Clone, Debug, Default)]
pub enum Value {
    /// `none`.
    #[default]
    None,
    /// `true` or `false`.
    Bool(bool),
    /// A number with or without dimension.
    Number(Quantity),
    /// Whole numbers from the first to before the second.
    Range(i64, i64),
    /// A point (dimension length), a bare tuple or any other vector quantity.
    Vector(DVec3, Dim),
    /// Text.
    Text(Arc<str>),
    /// A word for a choice.
    Word(Arc<str>),
    /// A list.
    List(Arc<Vec<Value>>),
    /// A record or a row of a table.
    Record(Arc<Record>),
    /// A curve or a modeling curve: a chain of runs.
    Curve(Chain),
    /// A node: the place where curves meet or end, model units.
    Node(DVec3),
    /// A link of a script's network.
    Link(ModuleId, LinkId),
    /// An edge of a surface model.
    Edge(EntityHome, Arc<SharedEdge>),
    /// A vertex of a surface model.
    Vertex(EntityHome, VertexId),
    /// A patch of a surface model.
    Patch(EntityHome, PatchId),
    /// A surface.
    Surface(Surface),
    /// A shell.
    Shell(Arc<ShellValue>),
    /// A mesh.
    Mesh(Arc<MeshValue>),
    /// An unbounded plane.
    Plane(Arc<Plane>),
    /// Imported cells.
    Table(Arc<Table>),
    /// A module: `ribs` after `use "ribs.loft" as ribs`.
    Module(ModuleId),
    /// The network of a script: `network`.
    Network(ModuleId),
    /// A plot or a lines plan, for `picture`.
    Drawing(Arc<Drawing>),
}

impl Value {
    /// A bare number.
    pub fn number(value: f64) -> Self {
        Self::Number(Quantity::bare(value))
    }

    /// A quantity.
    pub fn quantity(value: f64, dim: Dim) -> Self {
        Self::Number(Quantity::new(value, dim))
    }

    /// A length in model units.
    pub fn length(value: f64) -> Self {
        Self::quantity(value, Dim::LENGTH)
    }

    /// An angle given in radians.
    pub fn angle(radians: f64) -> Self {
        Self::quantity(crate::lang::values::units::degrees(radians), Dim::ANGLE)
    }

    /// A point in model units.
    pub fn point(point: DVec3) -> Self {
        Self::Vector(point, Dim::LENGTH)
    }

    /// A list.
    pub fn list(items: Vec<Self>) -> Self {
        Self::List(Arc::new(items))
    }

    /// Text.
    pub fn text(text: &str) -> Self {
        Self::Text(text.into())
    }

    /// How many members a list, range or row has; `None` for anything else.
    pub fn len(&self) -> Option<usize> {
        match self {
            Self::List(items) => Some(items.len()),
            Self::Range(a, b) => Some(usize::try_from(b.saturating_sub(*a)).unwrap_or(0)),
            Self::Record(r) if r.row => Some(r.values.len()),
            _ => None,
        }
    }

    /// Whether it is a list, range or row without members.
    pub fn is_empty(&self) -> bool {
        self.len() == Some(0)
    }

    /// The member at a place of a list, range or row.
    pub fn item(&self, i: usize) -> Option<Self> {
        match self {
            Self::List(items) => items.get(i).cloned(),
            Self::Range(a, b) => {
                let k = a.checked_add(i64::try_from(i).ok()?)?;
                (k < *b).then(|| Self::number(k as f64))
            }
            Self::Record(r) if r.row => r.values.get(i).cloned(),
            _ => None,
        }
    }

    /// Calls `f` on each thing of nested lists, in order.
    pub fn for_each_flat<E>(&self, f: &mut impl FnMut(&Self) -> Result<(), E>) -> Result<(), E> {
        match self {
            Self::List(items) => items.iter().try_for_each(|v| v.for_each_flat(f)),
            Self::Range(..) => (0..self.len().unwrap_or(0)).filter_map(|i| self.item(i)).try_for_each(|v| f(&v)),
            other => f(other),
        }
    }
}
