//! Faces that would have more elements than a mesh may have: refused before they are made, at the setting that demands most of them.

use crate::base::fault::{Fault, Result};
use crate::base::limits::{MESH_WORK, WORK_OF_AN_ELEMENT};
use crate::base::origin::Origin;
use crate::mesh::chart::parametric_surface::{SizeField, UniformSize};
use crate::mesh::request::limits::Limits;
use crate::mesh::request::plan::Target;
use crate::mesh::request::settings::GROWTH;
use crate::mesh::request::sources::{Source, Sources};
use crate::mesh::request::work::{allow, too_many};
use crate::mesh::size::border_spacing::SPACING;
use crate::mesh::size::too_large::of_size;
use crate::mesh::tri::background::Background;
use crate::mesh::tri::build::{NodePlacement, Task, expected_nodes};
use crate::mesh::tri::graded_size::GradedSize;
use crate::mesh::tri::triangle_fit::FaceFit;

/// Share of the uncharged elements up to which the estimate by the least length alone suffices.
const SMALL_FACE_SHARE: f64 = 0.1;

/// A field with some of the parts of another one.
fn partial_field<'s>(field: &GradedSize, sources: &'s Sources, background: Option<Background>) -> GradedSize<'s> {
    GradedSize { sources, range: field.range, spacing: field.spacing, background }
}

impl FaceFit<'_> {
    /// E217 where wanted lengths, graded from short edges and by bends, demand too many elements.
    pub(crate) fn refuse_large(&self, field: &GradedSize) -> Result<()> {
        let across = self.surface.hull().diagonal() / field.least();
        let most = self.face_input.input.plan.most_elements;
        if across * across < SMALL_FACE_SHARE * most.min(MESH_WORK / WORK_OF_AN_ELEMENT) as f64 {
            return Ok(());
        }
        let [elements] = self.expected([field]);
        if elements > most as f64 {
            return Err(self.too_large(field, Some(elements)));
        }
        allow(elements as u64, &mut 0);
        Ok(())
    }

    /// Most inner nodes of the face.
    pub(crate) fn most(&self) -> usize {
        self.face_input.input.plan.most_nodes()
    }

    /// The fault for so many elements, or for more than allowed.
    pub(crate) fn too_large(&self, field: &GradedSize, elements: Option<f64>) -> Fault {
        too_many(self.face_input.input.plan, self.largest_demand(field), elements.map(|n| n as u64))
    }

    /// The fault where limits alone decide.
    pub(crate) fn too_many_for_limits(&self) -> Fault {
        let of = self.limit(self.limits.chord.is_some());
        too_many(self.face_input.input.plan, of, None)
    }

    /// Estimated numbers of elements for fields.
    fn expected<const N: usize>(&self, fields: [&dyn SizeField; N]) -> [f64; N] {
        let lattice = NodePlacement::Triangles;
        let task = |field| Task {
            interpolated: None,
            chart_surface: self.chart,
            field,
            outline: self.outline,
            settings: self.settings,
            lattice,
            most: self.most(),
            limit_check: None,
            sliding: None,
        };
        expected_nodes(fields.map(task).each_ref()).map_or([0.0; N], |nodes| nodes.map(|n| 2.0 * n))
    }

    /// The expression that demands most of the elements.
    fn largest_demand(&self, field: &GradedSize) -> Origin {
        let (plan, slope) = (self.face_input.input.plan, field.sources.slope());
        let default = Sources::new(field.sources.items().to_vec(), (GROWTH - 1.0) / SPACING);
        let grown = partial_field(field, &default, field.background.clone());
        let refined = |source: &&Source| (source.tag as usize) < plan.refines.len();
        let (rules, edges): (Vec<Source>, Vec<Source>) = field.sources.items().iter().partition(refined);
        let least = rules.iter().min_by(|a, b| a.size.total_cmp(&b.size)).map(|source| source.tag as usize);
        let [none, rules, edges] = [Vec::new(), rules, edges].map(|items| Sources::new(items, slope));
        let (edges, rules) = (partial_field(field, &edges, None), partial_field(field, &rules, None));
        let (bends, size) = (partial_field(field, &none, field.background.clone()), UniformSize(self.face.size.0 * field.spacing));
        let [grown, by_edges, by_rules, by_bends, by_size] = self.expected([&grown, &edges, &rules, &bends, &size]);
        if let Some(growth) = plan.settings.growth.filter(|g| g.0 < GROWTH && grown <= plan.most_elements as f64) {
            return growth.1;
        }
        let own = of_size(self.face_input.input, self.face.size.1);
        let most = by_edges.max(by_rules).max(by_bends);
        if by_size > plan.most_elements as f64 || by_size >= most {
            own
        } else if by_bends == most {
            self.limit(self.limits.chord.is_some() && !self.turns_more(field))
        } else if by_rules == most {
            least.map_or(own, |rule| plan.refines[rule].size.1)
        } else {
            self.of_edges().or(plan.settings.growth.map(|g| g.1)).unwrap_or(own)
        }
    }

    /// The expression of the chord error, or of the largest angle.
    fn limit(&self, chord: bool) -> Origin {
        let plan = self.face_input.input.plan;
        let limit = if chord {
            plan.settings.chord_error.or(plan.settings.angle_error)
        } else {
            plan.settings.angle_error.or(plan.settings.chord_error)
        };
        limit.map_or(plan.origin, |limit| limit.1)
    }

    /// Whether the angle demands more elements than the chord error.
    fn turns_more(&self, field: &GradedSize) -> bool {
        if self.limits.angle.is_none() || self.limits.chord.is_none() {
            return self.limits.chord.is_none();
        }
        let none = Sources::new(Vec::new(), field.sources.slope());
        let by = |limits: Limits| partial_field(field, &none, Some(self.background(&limits)));
        let [angle, chord] = self.expected([&by(Limits { chord: None, ..self.limits }), &by(Limits { angle: None, ..self.limits })]);
        angle > chord
    }

    /// The shortest steps that are written for a curve.
    fn of_edges(&self) -> Option<Origin> {
        let rules = self.face_input.input.plan.rules.iter().filter_map(|rule| {
            let length = match &rule.target {
                Target::Chain(chain) => chain.length(),
                Target::Edge(courses) => courses.first()?.iter().map(|part| part.s.1 - part.s.0).sum(),
                Target::Surface(_) | Target::Patches(_) | Target::Point(_) => return None,
            };
            let by_count = rule.settings.count.map(|(n, of)| (length / f64::from(n), of));
            by_count.or(rule.settings.size)
        });
        rules.min_by(|a, b| a.0.total_cmp(&b.0)).map(|rule| rule.1)
    }
}
