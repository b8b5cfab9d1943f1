//! A box that holds about all of an item, found from its points alone.

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::job;
use crate::io::step::reader::Step;

impl Step<'_> {
    /// A box that holds about all of an item, model units: vertices, control points, whole circles and spheres.
    pub fn reach(&self, item: u32, seen: &mut [u32], round: u32) -> Box3 {
        let file = self.file;
        let mut reach = Box3::EMPTY;
        let mut open = vec![item];
        while let Some(k) = open.pop() {
            if std::mem::replace(&mut seen[k as usize], round) == round {
                continue;
            }
            job::poll();
            let row = file.parameters(k);
            let name = file.name(k);
            let see = |reach: Box3, point: u32| self.point(point).map_or(reach, |p| reach.with(p));
            match name {
                b"CARTESIAN_POINT" => reach = see(reach, k),
                // Where something is placed is no part of it.
                b"AXIS1_PLACEMENT" | b"AXIS2_PLACEMENT_2D" | b"AXIS2_PLACEMENT_3D" => continue,
                b"PCURVE" | b"DIRECTION" | b"VECTOR" | b"PLANE" | b"LINE" => continue,
                b"CYLINDRICAL_SURFACE" | b"CONICAL_SURFACE" | b"SURFACE_OF_REVOLUTION" | b"SURFACE_OF_LINEAR_EXTRUSION" => continue,
                b"TOROIDAL_SURFACE" | b"SPHERICAL_SURFACE" | b"DEGENERATE_TOROIDAL_SURFACE" | b"CIRCLE" | b"ELLIPSE" => {
                    // Only where the curve or surface is whole; a part of it has vertices.
                    if let Some(around) = self.around(k) {
                        reach = reach.union(around);
                    }
                    continue;
                }
                b"HYPERBOLA" | b"PARABOLA" => continue,
                b"EDGE_CURVE" => {
                    let ends = (row.entity(1), row.entity(2));
                    open.extend(ends.0.iter().chain(&ends.1));
                    if let Ok(geometry) = row.entity(3)
                        && (ends.0 == ends.1 || !matches!(file.name(geometry), b"CIRCLE" | b"ELLIPSE"))
                    {
                        open.push(geometry);
                    }
                    continue;
                }
                b"ADVANCED_FACE" | b"FACE_SURFACE" => {
                    let bounds = row.entities(1).unwrap_or_default();
                    let is_vertex = |b: &u32| file.parameters(*b).entity(1).is_ok_and(|l| file.name(l) == b"VERTEX_LOOP");
                    let is_whole = bounds.iter().all(is_vertex);
                    open.extend(bounds);
                    if let Ok(surface) = row.entity(2)
                        && (is_whole
                            || !matches!(file.name(surface), b"TOROIDAL_SURFACE" | b"SPHERICAL_SURFACE" | b"DEGENERATE_TOROIDAL_SURFACE"))
                    {
                        open.push(surface);
                        // A whole turned surface has no edges: its profile says how large it is.
                        if is_whole && file.name(surface) == b"SURFACE_OF_REVOLUTION" {
                            open.extend(file.parameters(surface).entity(1));
                        }
                    }
                    continue;
                }
                _ => {}
            }
            open.extend(file.references(k));
        }
        reach
    }

    /// The box around a circle, ellipse, sphere or torus.
    fn around(&self, k: u32) -> Option<Box3> {
        let row = self.file.parameters(k);
        let frame = self.frame(row.entity(1).ok()?).ok()?;
        let first = row.number(2).ok()? * self.scale;
        let second = row.number(3).map_or(0.0, |x| x * self.scale);
        let sum = first.abs() + second.abs();
        let (x, y, z) = match self.file.name(k) {
            b"SPHERICAL_SURFACE" => (first, first, first),
            b"CIRCLE" => (first, first, 0.0),
            b"ELLIPSE" => (first, second, 0.0),
            _ => (sum, sum, second),
        };
        // Half the size of an ellipsoid's box along each axis.
        let squared = |v: DVec3| v * v;
        let half = (squared(frame.x * x) + squared(frame.y * y) + squared(frame.z * z)).map(f64::sqrt);
        Some(Box3::of([frame.at - half, frame.at + half]))
    }
}
