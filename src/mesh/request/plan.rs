//! What is requested of a mesh: settings and rules, resolved to entities by the language.

use std::collections::BTreeMap;

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::limits::MESH_ELEMENTS;
use crate::base::origin::Origin;
use crate::mesh::request::fault::MeshLimit;
use crate::mesh::request::settings::{MeshSettings, RuleSettings};
use crate::model::imprint::Imprint;
use crate::model::{Course, PatchId, SurfaceId};
use crate::network::Chain;

/// What a rule or a group applies to.
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
    /// Whether it applies to a face, given by its patch and surface: `Some(true)` of this one alone.
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
    /// What it applies to.
    pub target: Target,
    /// Its settings.
    pub settings: RuleSettings,
    /// The clause.
    pub origin: Origin,
}

impl Rule {
    /// A rule without settings yet.
    pub fn on(target: Target, origin: Origin) -> Self {
        Self { target, settings: RuleSettings::default(), origin }
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

/// `near … { size radius }` or `in … { size }`: smaller elements at some places; [`SizeRequests`](super::size_requests::SizeRequests) acts on it.
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

/// All that is requested of one mesh.
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
    /// What is written of the whole mesh.
    pub settings: MeshSettings,
    /// What joins faces that touch without a shared border, with its expression.
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
            MeshLimit::Size => self.settings.size,
            MeshLimit::ChordError => self.settings.chord_error,
            MeshLimit::AngleError => self.settings.angle_error,
        }
    }

    /// The limit on bends that is written, the chord error first, with its expression.
    pub fn bend_limit(&self) -> Option<(MeshLimit, Origin)> {
        let written = |limit: MeshLimit| self.limit(limit).map(|value| (limit, value.1));
        written(MeshLimit::ChordError).or_else(|| written(MeshLimit::AngleError))
    }

    /// Where the size is from: its expression, or the mesh where none is written.
    pub fn size_origin(&self) -> Origin {
        self.settings.size.map_or(self.origin, |size| size.1)
    }

    /// A mesh of surfaces with every setting at its default.
    pub fn of(name: &str, surfaces: Vec<(SurfaceId, bool)>) -> Self {
        Self {
            name: name.to_owned(),
            origin: Origin::NONE,
            surfaces,
            curves: Vec::new(),
            points: Vec::new(),
            settings: MeshSettings::default(),
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
        self.settings.growth() - 1.0
    }
}

/// Height of an equilateral triangle of side 1.
pub(crate) const TALL: f64 = 0.866_025_403_784_438_6;
