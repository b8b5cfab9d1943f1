//! Where definitions and solids stand: subfigure instances (408), solid instances (430) and solid assemblies (184).

use std::collections::BTreeSet;

use glam::{DAffine3, DMat3, DVec3};

use crate::base::bbox::Box3;
use crate::base::job;
use crate::base::limits;
use crate::base::tolerance::NUDGE;
use crate::geometry::Motion;
use crate::io::cad::assembly::Node;
use crate::io::cad::defect::{Defect, defect};
use crate::io::cad::part::Group;
use crate::io::iges::entity_data::{Data, Pointer};
use crate::io::iges::entity_table::{EntityTable, NESTED};
use crate::io::iges::part::IgesPartBuilder;

/// The members that an instance places. Motions lead from the frame of a member to the frame that the instance itself stands in.
pub struct Placed {
    /// The definition, solid or assembly that is placed.
    pub of: Pointer,
    /// The name that the definition has; may be empty.
    pub name: String,
    /// The motion of the instance; of an assembly that of its matrix.
    pub motion: Motion,
    /// The members.
    pub members: Vec<(Pointer, Motion)>,
}

/// The motion of a matrix; fails for one that stretches or shears.
fn motion(m: &DAffine3) -> Result<Motion, Defect> {
    let columns = [m.matrix3.x_axis, m.matrix3.y_axis, m.matrix3.z_axis];
    let scale = columns[0].length();
    let apart = |a: DVec3, b: DVec3| a.dot(b).abs() > NUDGE * scale * scale;
    let bends = columns.iter().any(|c| (c.length() - scale).abs() > NUDGE * scale)
        || apart(columns[0], columns[1])
        || apart(columns[1], columns[2])
        || apart(columns[2], columns[0]);
    if bends || scale <= 0.0 {
        return Err(defect("its matrix stretches or shears what it places"));
    }
    // Made exact: rows of six digits are no rotation to the last bit.
    let x = columns[0] / scale;
    let y = (columns[1] - x * x.dot(columns[1])).normalize();
    let mirrors = m.matrix3.determinant() < 0.0;
    let turned = DMat3::from_cols(if mirrors { -x } else { x }, y, (if mirrors { -x } else { x }).cross(y));
    let still = Motion::translation(DVec3::ZERO);
    let flipped = if mirrors { Motion::mirror(DVec3::ZERO, DVec3::X) } else { still };
    let sized = if (scale - 1.0).abs() <= NUDGE { still } else { Motion::scaling(DVec3::ZERO, scale) };
    Ok(flipped.then(&sized).then(&Motion::rigid(turned, DVec3::ZERO, m.translation)))
}

impl EntityTable {
    /// The motion of a matrix entity with those that it points at.
    pub fn motion(&self, matrix: Pointer) -> Result<Motion, Defect> {
        self.placement(matrix)?.map_or(Ok(Motion::translation(DVec3::ZERO)), |m| motion(&m))
    }

    /// What an instance places; none for another entity. First comes the scale, then the matrix, then the translation.
    pub fn placed(&self, d: Pointer) -> Result<Option<Placed>, Defect> {
        let by = |d: Pointer| self.motion(self.entry(d).map_or(0, |e| e.transform));
        match self.data(d)? {
            Data::Instance { of, at, scale } => {
                let Data::Definition { name, members } = self.data(*of)? else {
                    return Err(defect(format!("it places {}, which is not a definition", self.label(*of))));
                };
                if *scale <= 0.0 {
                    return Err(defect("its scale is not above 0"));
                }
                let turned = by(d)?.then(&Motion::translation(*at * self.scale));
                let motion = if *scale == 1.0 { turned } else { Motion::scaling(DVec3::ZERO, *scale).then(&turned) };
                Ok(Some(Placed { of: *of, name: name.clone(), motion, members: members.iter().map(|m| (*m, motion)).collect() }))
            }
            Data::SolidInstance(of) => {
                let motion = by(d)?;
                Ok(Some(Placed { of: *of, name: String::new(), motion, members: vec![(*of, motion)] }))
            }
            Data::SolidAssembly(items) => {
                let motion = by(d)?;
                let item = |(item, matrix): &(Pointer, Pointer)| Ok((*item, self.motion(*matrix)?.then(&motion)));
                let members = items.iter().map(item).collect::<Result<_, Defect>>()?;
                Ok(Some(Placed { of: d, name: String::new(), motion, members }))
            }
            _ => Ok(None),
        }
    }

    /// What stands only where instances place it: members of definitions, solids that solid instances place.
    pub fn placed_parts(&self) -> BTreeSet<Pointer> {
        let mut parts = BTreeSet::new();
        for decoded in &self.decoded {
            match &decoded.data {
                Data::Definition { members, .. } => parts.extend(members),
                Data::SolidInstance(of) => parts.extend([*of]),
                Data::SolidAssembly(items) => parts.extend(items.iter().map(|(item, _)| *item)),
                _ => {}
            }
        }
        parts
    }

    /// A box that holds about all that instances place, where `own` holds all in the frames of definitions.
    pub fn placed_reach(&self, own: Box3) -> Box3 {
        let inner = self.placed_parts();
        let still = Motion::translation(DVec3::ZERO);
        let mut open: Vec<(Pointer, Motion, usize)> =
            self.entries.iter().map(|e| (e.d, still, 0)).filter(|k| !inner.contains(&k.0)).collect();
        let (mut reach, mut n) = (own, 0);
        while let Some((d, around, depth)) = open.pop() {
            job::poll();
            let Ok(Some(placed)) = self.placed(d) else { continue };
            n += 1;
            if depth > NESTED || n > limits::PART_INSTANCES {
                break;
            }
            for (member, motion) in placed.members {
                let motion = motion.then(&around);
                if self.data(member).is_ok_and(|data| data.is_instance()) {
                    open.push((member, motion, depth + 1));
                } else if !own.is_empty() {
                    let pick = |k: usize| DVec3::from_array(std::array::from_fn(|i| if k >> i & 1 == 0 { own.min[i] } else { own.max[i] }));
                    reach = (0..8).fold(reach, |reach, k| reach.with(motion.point(pick(k))));
                }
            }
        }
        reach
    }
}

impl Data {
    /// Whether it places other entities.
    pub fn is_instance(&self) -> bool {
        matches!(self, Self::Instance { .. } | Self::SolidInstance(_) | Self::SolidAssembly(_))
    }
}

impl IgesPartBuilder {
    /// Makes what an instance places, at its place, with a group for it.
    pub(super) fn instance(&mut self, d: Pointer, depth: usize) {
        let mut group = Group::default();
        let placed = match self.table.placed(d) {
            Ok(Some(placed)) if depth <= NESTED => placed,
            Ok(_) => {
                self.unusable(d, "instances are nested too deep, or place themselves".to_owned());
                return;
            }
            Err(Defect(why)) => {
                self.unusable(d, why);
                return;
            }
        };
        if self.part.tree.len() >= limits::PART_INSTANCES {
            // Told once, and what is not placed is missing.
            if !std::mem::replace(&mut self.full, true) {
                self.unusable(
                    d,
                    format!("the file places more than {} instances; this one and those after it are not", limits::PART_INSTANCES),
                );
            }
            return;
        }
        let around = self.at.unwrap_or_else(|| Motion::translation(DVec3::ZERO));
        let outer = (std::mem::take(&mut self.made), std::mem::take(&mut self.instances));
        let before = (self.at, self.node);
        let node = self.part.tree.len();
        let of = *self.definitions.entry(placed.of).or_insert(node);
        let own = self.named(d);
        let name = own.clone().or_else(|| self.named(placed.of)).unwrap_or_else(|| placed.name.clone());
        let product = if placed.name.is_empty() { self.named(placed.of).unwrap_or_default() } else { placed.name.clone() };
        self.part.tree.push(Node { name: name.clone(), product, of, file: 0, parent: self.node, motion: placed.motion.then(&around) });
        self.node = Some(node);
        for (member, motion) in placed.members {
            job::poll();
            let at = Some(motion.then(&around));
            if self.at != at {
                // The same solid or instance may stand in an assembly at several places.
                std::mem::take(&mut self.made).into_values().for_each(|member| group.put(member));
                let inner = std::mem::take(&mut self.instances).into_values();
                inner.flat_map(|inner| inner.members()).for_each(|member| group.put(member));
            }
            self.at = at;
            self.place(member, depth + 1);
        }
        let inner: Vec<Group> = std::mem::take(&mut self.instances).into_values().collect();
        inner.iter().flat_map(Group::members).chain(self.made.values().copied()).for_each(|member| group.put(member));
        (self.made, self.instances) = outer;
        (self.at, self.node) = before;
        for list in [&mut group.points, &mut group.curves, &mut group.surfaces] {
            list.sort_unstable();
        }
        if !group.is_empty() {
            group.own = (!name.is_empty()).then_some(name);
            group.name = self.names.give(&group.own.clone().unwrap_or_else(|| format!("group{}", self.part.groups.len() + 1)));
            self.levels.put(&self.table, d, &group.members());
            self.part.groups.push(group.clone());
            self.instances.insert(d, group);
        }
    }

    /// Makes a member of a definition where it stands, and what a group among them holds.
    fn place(&mut self, d: Pointer, depth: usize) {
        if depth > NESTED || self.table.entry(d).is_none_or(|entry| entry.status.blanked) {
            return;
        }
        if let Ok(Data::Group(inside)) = self.table.data(d) {
            inside.clone().into_iter().for_each(|member| self.place(member, depth + 1));
        }
        if self.table.data(d).is_ok_and(Data::is_instance) {
            return self.instance(d, depth);
        }
        if !self.made.contains_key(&d) {
            let mut groups = Vec::new();
            self.show(d, &mut groups);
            groups.into_iter().for_each(|d| self.group(d));
        }
    }

    /// Says which definitions nothing places.
    pub(super) fn unplaced(&mut self) {
        let is_definition = |data: &Data| matches!(data, Data::Definition { .. });
        let entries = self.table.entries.iter().zip(&self.table.decoded);
        let all: Vec<Pointer> = entries.filter(|(_, decoded)| is_definition(&decoded.data)).map(|(entry, _)| entry.d).collect();
        let unplaced: Vec<Pointer> = all.into_iter().filter(|d| !self.definitions.contains_key(d)).collect();
        for d in unplaced {
            self.skipped(d, "no instance that is shown places the definition");
        }
    }
}
