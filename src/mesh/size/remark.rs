//! Remarks on a mesh and on the rules of its plan.

use crate::model::fault::ContactFault;
use glam::DVec3;

use crate::base::fault::Fault;
use crate::base::origin::Origin;
use crate::mesh::border::loose::Loose;
use crate::mesh::border::lost::Lost;
use crate::mesh::border::touch::{Kind, Touch};
use crate::mesh::request::fault::{Cure, MeshFault};
use crate::mesh::request::input::Input;
use crate::mesh::size::rule_effects::{FREE_ONLY, KEYS, free_only_origin};
use crate::model::fault::Touching;

/// A remark on a mesh or on the rules of its plan, by their places in it.
#[derive(Clone, Debug, PartialEq)]
pub enum Remark {
    /// W701: a rule without effect.
    Unused {
        /// The rule.
        rule: usize,
        /// Why, in words.
        why: String,
    },
    /// W706: of two equal rules the later one holds.
    Overridden {
        /// The setting.
        key: String,
        /// The rule that loses.
        earlier: usize,
        /// The rule that holds.
        later: usize,
    },
    /// W667: two faces touch without sharing nodes.
    Touch(Touch),
    /// W725: something that became a point or a line.
    Lost(Lost),
    /// W730: a curve that shares no nodes with a face that it lies on.
    Loose(Loose),
    /// W724: sharp angles away from sharp corners.
    Sharp {
        /// The least, radians.
        angle: f64,
        /// Where.
        at: DVec3,
        /// Surface of its face.
        surface: String,
        /// How many faces have such angles.
        faces: usize,
        /// The setting to change there.
        cure: Cure,
    },
}

impl Remark {
    /// The remark on the sharp angles of two parts of a mesh: that on the least.
    pub fn sharper(self, other: Self) -> Self {
        match (self, other) {
            (Self::Sharp { angle: a, at, surface, faces: n, cure }, Self::Sharp { angle: b, faces: m, .. }) if a <= b => {
                Self::Sharp { angle: a, at, surface, faces: n + m, cure }
            }
            (Self::Sharp { faces: n, .. }, Self::Sharp { angle, at, surface, faces: m, cure }) => {
                Self::Sharp { angle, at, surface, faces: n + m, cure }
            }
            (first, _) => first,
        }
    }
}

impl Remark {
    /// The warning, at the places of the rules.
    pub fn fault(&self, input: &Input) -> Fault {
        let plan = input.plan;
        let clause = |n: usize| plan.refines.get(n).map_or(Origin::NONE, |r| r.origin);
        let first = plan.rules.len() + plan.refines.len();
        let setting = |n: usize| FREE_ONLY.get(n).and_then(|key| free_only_origin(plan, key)).unwrap_or(Origin::NONE);
        let origin = |rule: usize| match plan.rules.get(rule) {
            Some(r) => r.origin,
            None if rule >= first => setting(rule - first),
            None => clause(rule - plan.rules.len()),
        };
        let surface = |place: usize| {
            let id = plan.surfaces.get(place).map(|s| s.0);
            id.map_or(Origin::NONE, |id| input.model.surfaces[id.index()].surface.origin())
        };
        match self {
            Self::Touch(Touch { kind, surfaces: (a, b), names, length, at }) => {
                let how = match kind {
                    Kind::Overlap => Touching::Overlap,
                    Kind::Edge => Touching::Edge { length: *length },
                    Kind::Crossing => Touching::Crossing,
                    Kind::Inside => Touching::Inside,
                    Kind::Unknown => Touching::Unknown,
                };
                let names = names.clone();
                let imprint = plan.imprint.is_some();
                ContactFault::FacesTouch { within: plan.origin, a: surface(*a), b: surface(*b), names, how, at: *at, imprint }.into()
            }
            Self::Lost(lost) => lost.fault(input),
            Self::Loose(loose) => loose.fault(input),
            Self::Unused { rule, why } => MeshFault::RuleUnused { rule: origin(*rule), why: why.clone() }.into(),
            Self::Overridden { key, earlier, later } => {
                let key = KEYS.into_iter().find(|k| k == key).unwrap_or("a setting");
                MeshFault::RuleOverridden { key, earlier: origin(*earlier), later: origin(*later) }.into()
            }
            Self::Sharp { angle, at, surface, faces, cure } => {
                let (name, surface) = (plan.name.clone(), surface.clone());
                MeshFault::Sharp { of: plan.origin, name, angle: *angle, at: *at, surface, faces: *faces, cure: *cure }.into()
            }
        }
    }
}
