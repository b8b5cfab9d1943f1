//! Files read as far as the numbers of their entities, and the box that holds them.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::job;
use crate::io::cad::part::ReadOptions;
use crate::io::files::fault::Malformed;
use crate::io::iges::entity_data::{Data, Pointer};
use crate::io::iges::entity_table::EntityTable;
use crate::io::iges::records;

/// A file read as far as its numbers: entities with pointers, no geometry yet.
#[derive(Debug)]
pub struct OpenedIges {
    pub(super) table: EntityTable,
}

/// Reads a file, or says where it stops being one.
pub fn open(bytes: &[u8], options: &ReadOptions) -> Result<OpenedIges, Malformed> {
    let records = records::read(bytes)?;
    let last = records.entries.last().map_or(1, |e| e.line);
    let table = EntityTable::new(records, bytes.len(), options);
    let is_used = |data: &Data| !matches!(data, Data::Damaged | Data::Silent);
    if !table.decoded.iter().any(|d| is_used(&d.data)) {
        let why = table.warnings.last().map_or(String::new(), |w| format!(": {}", w.what));
        return Err(Malformed::line(last, format!("the file holds no entity that can be read{why}")));
    }
    Ok(OpenedIges { table })
}

impl OpenedIges {
    /// How many entities of each type the file has.
    pub fn counts(&self) -> BTreeMap<u32, usize> {
        let mut counts = BTreeMap::new();
        for entry in &self.table.entries {
            job::poll();
            *counts.entry(entry.kind).or_insert(0) += 1;
        }
        counts
    }

    /// A box that holds about all its points, model units: for the tolerance of the model.
    pub fn reach(&self) -> Box3 {
        let mut reach = Box3::EMPTY;
        // Axes, the places of endless surfaces and the ground of faces reach beyond what is offered.
        let mut hidden = BTreeSet::new();
        for decoded in &self.table.decoded {
            job::poll();
            match &decoded.data {
                Data::Revolution { axis, .. } => hidden.extend([*axis]),
                Data::PlaneSurface { at, .. } | Data::Round { kind: 192 | 194, at, .. } => hidden.extend([*at]),
                Data::Trimmed { surface, outer: Some(_), .. } | Data::Face { surface, has_outer: true, .. } => hidden.extend([*surface]),
                // Curves in (u, v), which not all files mark as such.
                Data::CurveOnSurface { uv, .. } => hidden.extend([*uv]),
                Data::Boundary { curves, .. } => hidden.extend(curves.iter().flat_map(|curve| &curve.uv)),
                Data::Loop(edges) => hidden.extend(edges.iter().flat_map(|edge| &edge.uv)),
                _ => {}
            }
        }
        // What the ground is made of is placed with it; what a border is made of counts all the same.
        let mut spaces = BTreeSet::new();
        for decoded in &self.table.decoded {
            match &decoded.data {
                Data::CurveOnSurface { space, .. } => spaces.extend([*space]),
                Data::Boundary { curves, .. } => spaces.extend(curves.iter().map(|curve| curve.space)),
                Data::Edges(edges) => spaces.extend(edges.iter().map(|edge| edge.curve)),
                _ => {}
            }
        }
        let shown = self.with_parts(spaces);
        let hidden: BTreeSet<Pointer> = self.with_parts(hidden).difference(&shown).copied().collect();
        for (entry, decoded) in self.table.entries.iter().zip(&self.table.decoded) {
            job::poll();
            if entry.status.purpose == 5 || hidden.contains(&entry.d) {
                continue;
            }
            let Ok(m) = self.table.placement(entry.transform) else { continue };
            let mut see = |p: DVec3| {
                let p = p * self.table.scale;
                reach = reach.with(m.map_or(p, |m| m.transform_point3(p)));
            };
            let flat = |p: &[f64; 2], z: f64| DVec3::new(p[0], p[1], z);
            match &decoded.data {
                Data::Point(p) => see(*p),
                Data::Points { points, .. } | Data::Vertices(points) => points.iter().for_each(|p| see(*p)),
                Data::Line { start, end, .. } => [start, end].into_iter().for_each(|p| see(*p)),
                Data::Spline(s) => s.points.iter().for_each(|p| see(*p)),
                Data::Net(net) => net.points.iter().for_each(|p| see(*p)),
                Data::Arc { z, center, start, end } => {
                    [center, start, end].into_iter().for_each(|p| see(flat(p, *z)));
                }
                Data::ConicArc { z, start, end, .. } => [start, end].into_iter().for_each(|p| see(flat(p, *z))),
                Data::Polynomials { pieces, .. } => pieces.iter().for_each(|[x, y, z]| see(DVec3::new(x[0], y[0], z[0]))),
                _ => {}
            }
        }
        self.table.placed_reach(reach)
    }

    /// Entities with all that they are made of: profiles, axes, rails, pieces.
    fn with_parts(&self, mut all: BTreeSet<Pointer>) -> BTreeSet<Pointer> {
        let mut open: Vec<Pointer> = all.iter().copied().collect();
        while let Some(d) = open.pop() {
            job::poll();
            let parts = match self.table.data(d) {
                Ok(Data::Composite(pieces)) => pieces.clone(),
                Ok(Data::Revolution { axis, profile, .. }) => vec![*axis, *profile],
                Ok(Data::Ruled { rails, .. }) => rails.to_vec(),
                Ok(Data::Tabulated { profile, .. }) => vec![*profile],
                Ok(Data::OffsetCurve { base, .. } | Data::OffsetSurface { base, .. }) => vec![*base],
                _ => Vec::new(),
            };
            open.extend(parts.into_iter().filter(|part| all.insert(*part)));
        }
        all
    }
}
