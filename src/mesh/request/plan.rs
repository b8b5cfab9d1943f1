//! What is asked of a mesh: settings and rules, resolved to entities by the language.

use std::collections::BTreeMap;

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::fault::MeshLimit;
use crate::base::limits::MESH_ELEMENTS;
use crate::base::origin::Origin;
use crate::model::imprint::Imprint;
use crate::model::{Course, PatchId, SurfaceId};
use crate::network::Chain;

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
    /// Mapped where it fits and its elements are well shaped, else Delaunay.
    Auto,
    /// Mapped, or an error.
    Mapped,
    /// Cells between lines of constant u and v, triangles beside borders.
    Isoline,
    /// Nodes grown over the surface, Delaunay triangles improved in space.
    Delaunay,
    /// Nodes at the corners of a quadtree's cells, Delaunay triangles improved in space.
    Quadtree,
    /// As few triangles as keep the limits, however long.
    Display,
}

impl Method {
    /// Whether sides are only as short as limits and written sizes ask for, and triangles as long as they may be.
    pub fn is_coarse(self) -> bool {
        matches!(self, Self::Isoline | Self::Display)
    }

    /// Its word, where it makes nothing but triangles.
    pub fn of_triangles(self) -> Option<&'static str> {
        match self {
            Self::Display => Some("display"),
            Self::Isoline => Some("isoline"),
            Self::Auto | Self::Mapped | Self::Delaunay | Self::Quadtree => None,
        }
    }

    /// Whether it makes faces freely, however many sides they have.
    pub fn is_free(self) -> bool {
        matches!(self, Self::Delaunay | Self::Quadtree | Self::Isoline | Self::Display)
    }
}

/// What a rule or a group speaks of.
#[derive(Clone, Debug)]
pub enum Target {
    /// A curve, chain or link.
    Chain(Chain),
    /// An edge, by the borders that run there, each over the whole length.
    Edge(Vec<Course>),
    /// All faces of a surface.
    Surface(SurfaceId),
    /// One face; wins over its surface. Several patches where a curve inside cuts it.
    Patches(Vec<PatchId>),
    /// A point (groups only).
    Point(DVec3),
}

impl Target {
    /// Whether it speaks of a face, given by its patch and surface: `Some(true)` of this one alone.
    pub fn faces(&self, patch: PatchId, surface: SurfaceId) -> Option<bool> {
        match self {
            Self::Surface(s) => (*s == surface).then_some(false),
            Self::Patches(all) => all.contains(&patch).then_some(true),
            Self::Chain(_) | Self::Edge(_) | Self::Point(_) => None,
        }
    }
}

/// `on ENTITY { … }`: settings for a part of the mesh.
#[derive(Clone, Debug)]
pub struct Rule {
    /// What it speaks of.
    pub target: Target,
    /// Steps over the whole length, with the expression that says so; on a surface, over each of its sides.
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

impl Rule {
    /// A rule that says nothing yet.
    pub fn on(target: Target, origin: Origin) -> Self {
        Self { target, count: None, size: None, bias: None, elements: None, method: None, origin }
    }
}

/// A place of a `near` or `in` clause.
#[derive(Clone, Debug)]
pub enum Place {
    /// A point.
    Point(DVec3),
    /// A curve or link.
    Chain(Chain),
    /// A box along the axes.
    Box(Box3),
}

/// `near … { size radius }` or `in … { size }`: smaller elements at some places.
#[derive(Clone, Debug)]
pub struct Refine {
    /// Where.
    pub at: Vec<Place>,
    /// Target edge length there, model units, with its expression.
    pub size: (f64, Origin),
    /// How far around it holds, model units.
    pub radius: f64,
    /// The clause.
    pub origin: Origin,
}

/// A `group`: its members become node and element sets.
#[derive(Clone, Debug)]
pub struct GroupRequest {
    /// Name as declared.
    pub name: String,
    /// What it holds.
    pub members: Vec<Target>,
    /// The declaration.
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
    /// Target edge length, model units, with its expression; `None`: a 20th of the diagonal.
    pub size: Option<(f64, Origin)>,
    /// Largest distance mesh–surface, model units.
    pub chord_error: Option<(f64, Origin)>,
    /// Largest turn of the normal across an element, radians.
    pub angle_error: Option<(f64, Origin)>,
    /// Floor of the size, model units, with its expression.
    pub min_size: Option<(f64, Origin)>,
    /// Ratio of neighbouring sizes, with its expression; `None`: [`GROWTH`].
    pub growth: Option<(f64, Origin)>,
    /// Rounds of smoothing of free faces, with their expression; `None`: until nothing moves.
    pub smooth: Option<(u32, Origin)>,
    /// Kind of elements.
    pub elements: Elements,
    /// 1 or 2.
    pub order: u8,
    /// How faces are meshed.
    pub method: Method,
    /// Neighbouring faces share nodes.
    pub conforming: bool,
    /// What joins faces that touch without a shared border, with the expression that asks for it.
    pub imprint: Option<(Imprint, Origin)>,
    /// How far apart borders of a surface and of its neighbours may be and still be one edge, model units; the tolerance for
    /// surfaces that are not listed.
    pub glue: BTreeMap<SurfaceId, f64>,
    /// The body of each surface that shares nodes with its own body alone; those that are not listed share with each other.
    pub bodies: BTreeMap<SurfaceId, usize>,
    /// Rules in order of writing.
    pub rules: Vec<Rule>,
    /// `near` and `in` clauses in order of writing.
    pub refines: Vec<Refine>,
    /// Named sets beside those that every surface gets.
    pub groups: Vec<GroupRequest>,
    /// Elements that it may have, those that it is thinned from included; 1 at least.
    pub most_elements: u64,
}

impl Plan {
    /// A limit as it is written, with its expression: model units or radians.
    pub fn limit(&self, limit: MeshLimit) -> Option<(f64, Origin)> {
        match limit {
            MeshLimit::Size => self.size,
            MeshLimit::ChordError => self.chord_error,
            MeshLimit::AngleError => self.angle_error,
        }
    }

    /// The limit on bends that is written, the chord error first, with its expression.
    pub fn bend_limit(&self) -> Option<(MeshLimit, Origin)> {
        let written = |limit: MeshLimit| self.limit(limit).map(|value| (limit, value.1));
        written(MeshLimit::ChordError).or_else(|| written(MeshLimit::AngleError))
    }

    /// What asks for the size: its expression, or the mesh where none is written.
    pub fn size_origin(&self) -> Origin {
        self.size.map_or(self.origin, |size| size.1)
    }

    /// A mesh of surfaces with every setting at its default.
    pub fn of(name: &str, surfaces: Vec<(SurfaceId, bool)>) -> Self {
        Self {
            name: name.to_owned(),
            origin: Origin::NONE,
            surfaces,
            curves: Vec::new(),
            points: Vec::new(),
            size: None,
            chord_error: None,
            angle_error: None,
            min_size: None,
            growth: None,
            smooth: None,
            elements: Elements::Triangles,
            order: 1,
            method: Method::Auto,
            conforming: true,
            imprint: None,
            glue: BTreeMap::new(),
            bodies: BTreeMap::new(),
            rules: Vec::new(),
            refines: Vec::new(),
            groups: Vec::new(),
            most_elements: MESH_ELEMENTS,
        }
    }

    /// Inner nodes that one of its faces may have: each has about two triangles.
    pub fn most_nodes(&self) -> usize {
        (self.most_elements / 2).max(1) as usize
    }

    /// What lengths grow by a unit of distance.
    pub fn slope(&self) -> f64 {
        self.growth.map_or(GROWTH, |g| g.0) - 1.0
    }
}

/// Ratio of neighbouring sizes where none is written.
pub const GROWTH: f64 = 1.3;

/// Height of an equilateral triangle of side 1.
pub(crate) const TALL: f64 = 0.866_025_403_784_438_6;
