//! What is asked of a mesh, said in Rust.

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
    pub(super) size: Option<f64>,
    pub(super) chord_error: Option<f64>,
    pub(super) angle_error: Option<f64>,
    pub(super) min_size: Option<f64>,
    pub(super) growth: Option<f64>,
    pub(super) elements: Elements,
    pub(super) order: u8,
    pub(super) method: Method,
    pub(super) conforming: bool,
    pub(super) flip: bool,
    pub(super) rules: Vec<(String, Setting)>,
    pub(super) refines: Vec<([f64; 3], f64, f64)>,
    pub(super) groups: Vec<(String, Vec<String>)>,
}

/// A setting of one thing.
#[derive(Clone, Copy, Debug)]
pub(super) enum Setting {
    Count(u32),
    Size(f64),
    Bias(f64),
    Elements(Elements),
    Method(Method),
}

/// Settings of the whole mesh.
impl MeshPlan {
    /// A mesh of all surfaces of a model.
    pub fn new(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            things: Vec::new(),
            lines: Vec::new(),
            size: None,
            chord_error: None,
            angle_error: None,
            min_size: None,
            growth: None,
            elements: Elements::Triangles,
            order: 1,
            method: Method::Auto,
            conforming: true,
            flip: false,
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
    pub fn size(self, size: f64) -> Self {
        Self { size: Some(size), ..self }
    }

    /// Largest distance between mesh and surfaces, model units, above 0.
    pub fn chord_error(self, distance: f64) -> Self {
        Self { chord_error: Some(distance), ..self }
    }

    /// Largest turn of the normal across an element, degrees, above 0.
    pub fn angle_error(self, degrees: f64) -> Self {
        Self { angle_error: Some(degrees), ..self }
    }

    /// No edge is asked to be shorter, model units, above 0.
    pub fn min_size(self, size: f64) -> Self {
        Self { min_size: Some(size), ..self }
    }

    /// Largest ratio of neighbouring sizes, above 1; 1.3 where nothing is said.
    pub fn growth(self, ratio: f64) -> Self {
        Self { growth: Some(ratio), ..self }
    }

    /// Triangles, quads, or both.
    pub fn elements(self, elements: Elements) -> Self {
        Self { elements, ..self }
    }

    /// 1, or 2 for elements with mid nodes.
    pub fn order(self, order: u8) -> Self {
        Self { order, ..self }
    }

    /// How faces are meshed.
    pub fn method(self, method: Method) -> Self {
        Self { method, ..self }
    }

    /// Whether neighbouring faces share their nodes.
    pub fn conforming(self, conforming: bool) -> Self {
        Self { conforming, ..self }
    }

    /// Whether faces show their other sides.
    pub fn flip(self, flip: bool) -> Self {
        Self { flip, ..self }
    }
}

/// Settings of parts of the mesh.
impl MeshPlan {
    fn set(mut self, thing: &str, setting: Setting) -> Self {
        self.rules.push((thing.to_owned(), setting));
        self
    }

    /// So many edges along a curve, or along each side of the faces of a surface, 1 at least.
    pub fn count(self, thing: &str, edges: u32) -> Self {
        self.set(thing, Setting::Count(edges))
    }

    /// Another edge length on a curve or surface, model units, above 0.
    pub fn size_on(self, thing: &str, size: f64) -> Self {
        self.set(thing, Setting::Size(size))
    }

    /// Last edge over first edge along a curve, above 0.
    pub fn bias(self, curve: &str, ratio: f64) -> Self {
        self.set(curve, Setting::Bias(ratio))
    }

    /// Other elements on a surface.
    pub fn elements_on(self, surface: &str, elements: Elements) -> Self {
        self.set(surface, Setting::Elements(elements))
    }

    /// Another method on a surface.
    pub fn method_on(self, surface: &str, method: Method) -> Self {
        self.set(surface, Setting::Method(method))
    }

    /// Edges of a length near a point, up to a distance from it, both model units; from there they grow.
    pub fn near(mut self, point: impl Into<[f64; 3]>, size: f64, radius: f64) -> Self {
        self.refines.push((point.into(), size, radius));
        self
    }

    /// A named set of nodes and elements on surfaces, shells and curves, beside those that every surface has.
    pub fn group<S: Into<String>>(mut self, name: &str, things: impl IntoIterator<Item = S>) -> Self {
        self.groups.push((name.to_owned(), things.into_iter().map(Into::into).collect()));
        self
    }
}
