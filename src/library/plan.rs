//! What is asked of a mesh, said in Rust.

use crate::base::origin::Origin;
use crate::lang::values::units::radians;
use crate::mesh::request::settings::{Located, MeshSettings, NearSettings, RuleSettings};
use crate::mesh::{Elements, Method};

/// What is asked of a mesh; [`MeshPlan::mesh`] makes it. Everything that is not said is as in a script: triangles of order 1, edges of a
/// 20th of the diagonal, neighbouring faces share their nodes.
///
/// Things are called by their names in the model: surfaces, shells and curves.
///
/// ```
/// use lofting::{Elements, MeshPlan, Script};
///
/// let model = Script::from_str("units m\ncurve rim = circle(center: (0, 0, 0), radius: 2m)\nsurface lid = plane(rim)").run()?;
/// let plan = MeshPlan::new("fine").of(["lid"]).elements(Elements::Triangles).size(0.25).count("rim", 40);
/// let mesh = plan.mesh(&model)?;
/// assert_eq!(mesh.group("rim").map(|rim| rim.nodes.len()), None);
/// assert!(mesh.quality().is_some_and(|quality| quality.min_angle.to_degrees() > 30.0));
/// # Ok::<(), lofting::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct MeshPlan {
    pub(super) name: String,
    pub(super) things: Vec<String>,
    pub(super) lines: Vec<String>,
    pub(super) settings: MeshSettings,
    pub(super) rules: Vec<(String, RuleSettings)>,
    pub(super) refines: Vec<([f64; 3], NearSettings)>,
    pub(super) groups: Vec<(String, Vec<String>)>,
}

/// A value that is written in no script.
fn given<T>(value: T) -> Located<T> {
    Some((value, Origin::NONE))
}

/// Settings of the whole mesh.
impl MeshPlan {
    /// A mesh of all surfaces of a model.
    pub fn new(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            things: Vec::new(),
            lines: Vec::new(),
            settings: MeshSettings::default(),
            rules: Vec::new(),
            refines: Vec::new(),
            groups: Vec::new(),
        }
    }

    /// Of these surfaces and shells alone.
    pub fn of<S: Into<String>>(mut self, things: impl IntoIterator<Item = S>) -> Self {
        self.things.extend(things.into_iter().map(Into::into));
        self
    }

    /// With line elements along these curves.
    pub fn lines<S: Into<String>>(mut self, curves: impl IntoIterator<Item = S>) -> Self {
        self.lines.extend(curves.into_iter().map(Into::into));
        self
    }

    /// Target edge length, model units, above 0.
    pub fn size(mut self, size: f64) -> Self {
        self.settings.size = given(size);
        self
    }

    /// Largest distance between mesh and surfaces, model units, above 0.
    pub fn chord_error(mut self, distance: f64) -> Self {
        self.settings.chord_error = given(distance);
        self
    }

    /// Largest turn of the normal across an element, degrees, above 0.
    pub fn angle_error(mut self, degrees: f64) -> Self {
        self.settings.angle_error = given(radians(degrees));
        self
    }

    /// No edge is asked to be shorter, model units, above 0.
    pub fn min_size(mut self, size: f64) -> Self {
        self.settings.min_size = given(size);
        self
    }

    /// Largest ratio of neighbouring sizes, above 1; 1.3 where nothing is said.
    pub fn growth(mut self, ratio: f64) -> Self {
        self.settings.growth = given(ratio);
        self
    }

    /// Whether plane faces of quads get few irregular nodes, at several times the cost.
    pub fn regular(mut self, regular: bool) -> Self {
        self.settings.regular = given(regular);
        self
    }

    /// Triangles, quads, or both.
    pub fn elements(mut self, elements: Elements) -> Self {
        self.settings.elements = given(elements);
        self
    }

    /// 1, or 2 for elements with mid nodes.
    pub fn order(mut self, order: u8) -> Self {
        self.settings.order = given(order);
        self
    }

    /// How faces are meshed.
    pub fn method(mut self, method: Method) -> Self {
        self.settings.method = given(method);
        self
    }

    /// Whether neighbouring faces share their nodes.
    pub fn conforming(mut self, conforming: bool) -> Self {
        self.settings.conforming = given(conforming);
        self
    }

    /// Whether faces show their other sides.
    pub fn flip(mut self, flip: bool) -> Self {
        self.settings.flip = given(flip);
        self
    }
}

/// Settings of parts of the mesh.
impl MeshPlan {
    fn on(mut self, thing: &str, settings: RuleSettings) -> Self {
        self.rules.push((thing.to_owned(), settings));
        self
    }

    /// So many edges along a curve, or along each side of the faces of a surface, 1 at least.
    pub fn count(self, thing: &str, edges: u32) -> Self {
        self.on(thing, RuleSettings { count: given(edges), ..RuleSettings::default() })
    }

    /// Another edge length on a curve or surface, model units, above 0.
    pub fn size_on(self, thing: &str, size: f64) -> Self {
        self.on(thing, RuleSettings { size: given(size), ..RuleSettings::default() })
    }

    /// Last edge over first edge along a curve, above 0.
    pub fn bias(self, curve: &str, ratio: f64) -> Self {
        self.on(curve, RuleSettings { bias: given(ratio), ..RuleSettings::default() })
    }

    /// Other elements on a surface.
    pub fn elements_on(self, surface: &str, elements: Elements) -> Self {
        self.on(surface, RuleSettings { elements: given(elements), ..RuleSettings::default() })
    }

    /// Another method on a surface.
    pub fn method_on(self, surface: &str, method: Method) -> Self {
        self.on(surface, RuleSettings { method: given(method), ..RuleSettings::default() })
    }

    /// Edges of a length near a point, up to a distance from it, both model units; from there they grow.
    pub fn near(mut self, point: impl Into<[f64; 3]>, size: f64, radius: f64) -> Self {
        self.refines.push((point.into(), NearSettings { size: given(size), radius: given(radius) }));
        self
    }

    /// A named set of nodes and elements on surfaces, shells and curves, beside those that every surface has.
    pub fn group<S: Into<String>>(mut self, name: &str, things: impl IntoIterator<Item = S>) -> Self {
        self.groups.push((name.to_owned(), things.into_iter().map(Into::into).collect()));
        self
    }
}
