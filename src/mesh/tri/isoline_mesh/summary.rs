//! The summary of a face triangulated between isolines: its cells, how far their marks agree with the winding, and what decided their sizes.

use crate::base::job;
use crate::mesh::request::decider::{Decided, Tally, Why};
use crate::mesh::tri::isoline_mesh::IsolineMesher;
use crate::mesh::tri::isoline_mesh::corners::CellCorners;
use crate::mesh::tri::marks::{corners, marks};
use crate::mesh::tri::tree::Class;
use crate::mesh::tri::triangulation::Triangulation;

impl IsolineMesher<'_> {
    /// Counts of cells, and at how many corners beside borders the marks agree with the winding.
    pub(crate) fn tally(&self, known: &CellCorners) -> Tally {
        let mut tally = Tally::default();
        let loops = self.input.outline.loops.len() as u32;
        for cell in self.cells.all().iter().filter(|c| c.is_leaf()) {
            job::poll();
            match cell.class {
                Class::Exterior => continue,
                Class::Interior => tally.whole += 1,
                Class::Partial => tally.crossed += 1,
            }
            // The face is on the left of its loops.
            let turned = cell.segments.iter().filter(|s| **s < loops).map(|s| self.cells.segment(*s)).map(|[a, b]| [b, a]);
            let found = marks((cell.low, cell.high), turned);
            if cell.class != Class::Partial || found == [0; 4] {
                continue;
            }
            for (mark, at) in found.iter().zip(corners((cell.low, cell.high))) {
                let Some(k) = known.of(at).filter(|k| known.all[*k].border.is_none()) else { continue };
                let kept = known.node[k].is_some() || self.cells.holds(at);
                tally.corners += 1;
                tally.agree += usize::from((*mark == 2) == kept);
            }
        }
        tally
    }

    /// What decided the cells round each node; no lengths of edges are asked here but the size.
    pub(crate) fn decided(&self, corners: &CellCorners, triangulation: &Triangulation) -> Decided {
        let mut why_of = vec![Why::Size; triangulation.p.len()];
        for (corner, node) in corners.all.iter().zip(&corners.node) {
            job::poll();
            let Some(n) = node.filter(|n| *n >= triangulation.fixed) else { continue };
            let smallest = |k: &u32| self.cells.all()[*k as usize].width().element_product();
            let leaf = self.cells.around(corner.at).into_iter().min_by(|a, b| smallest(a).total_cmp(&smallest(b)));
            why_of[n as usize] = leaf.map_or(Why::Size, |k| self.cells.all()[k as usize].why);
        }
        let mut found = Decided::default();
        for (n, (p, why)) in triangulation.p.iter().zip(why_of).enumerate() {
            let length = if why == Why::Size { self.input.size } else { f64::NAN };
            found.push(why, length, *p, n >= triangulation.fixed as usize);
        }
        found.sorted()
    }
}
