//! What is asked of a mesh: settings and rules, resolved to entities by the language.

use crate::base::origin::Origin;
use crate::model::SurfaceId;
use crate::network::Chain;
use glam::DVec3;

/// Which elements a face gets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Elements {
    /// Triangles only.
    Triangles,
    /// Quads only, or an error.
    Quads,
    /// Quads where they fit, triangles elsewhere.
    Mixed,
}

/// How a face is meshed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Mapped where it fits, else Delaunay.
    Auto,
    /// Mapped, or an error.
    Mapped,
    /// A method of a later version.
    Later(&'static str),
}

/// What a rule speaks of.
#[derive(Clone, Debug)]
pub enum Target {
    /// A curve, chain or link.
    Chain(Chain),
    /// All faces of a surface.
    Surface(SurfaceId),
}

/// `on ENTITY { … }`: settings for a part of the mesh.
#[derive(Clone, Debug)]
pub struct Rule {
    /// What it speaks of.
    pub target: Target,
    /// Steps over the whole length, with the expression that says so.
    pub count: Option<(u32, Origin)>,
    /// Target edge length, model units.
    pub size: Option<(f64, Origin)>,
    /// Last step over first step.
    pub bias: Option<(f64, Origin)>,
    /// Elements of faces.
    pub elements: Option<(Elements, Origin)>,
    /// Method of faces.
    pub method: Option<(Method, Origin)>,
    /// The clause.
    pub origin: Origin,
}

/// All that is asked of one mesh.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Name as declared.
    pub name: String,
    /// The declaration.
    pub origin: Origin,
    /// Surfaces, with `true` where the other side is up.
    pub surfaces: Vec<(SurfaceId, bool)>,
    /// Curves that become line elements, with their names.
    pub curves: Vec<(String, Chain)>,
    /// Points that become nodes.
    pub points: Vec<DVec3>,
    /// Target edge length, model units; `None`: a 20th of the diagonal.
    pub size: Option<f64>,
    /// Largest distance mesh–surface, model units.
    pub chord_error: Option<f64>,
    /// Largest turn of the normal across an element, radians.
    pub angle_error: Option<f64>,
    /// Kind of elements.
    pub elements: Elements,
    /// 1 or 2.
    pub order: u8,
    /// How faces are meshed.
    pub method: Method,
    /// Neighbouring faces share nodes.
    pub conforming: bool,
    /// Rules in order of writing.
    pub rules: Vec<Rule>,
}
