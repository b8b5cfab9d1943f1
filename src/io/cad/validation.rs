//! Areas, volumes and centroids that a file states, against those of what came in.

use std::collections::BTreeSet;

use crate::base::bbox::Box3;
use crate::base::job;
use crate::base::tolerance::STATED;
use crate::io::cad::part::{Figure, Part, Stated};
use crate::io::files::fault::Malformed;
use crate::model::measure;
use crate::surface::Surface;

impl Part {
    /// Compares what the file states with what was built; says each difference with its figures.
    pub fn differences(&self) -> Vec<Malformed> {
        self.stated.iter().filter_map(|stated| self.difference(stated)).collect()
    }

    fn difference(&self, stated: &Stated) -> Option<Malformed> {
        job::poll();
        let built = |places: &[usize]| -> Vec<Surface> { places.iter().filter_map(|k| self.built.get(*k)).flatten().cloned().collect() };
        let surfaces = built(&stated.surfaces);
        let faces = || built(&self.round_volumes(&stated.surfaces)).into_iter().map(|s| (s, false)).collect::<Vec<(Surface, bool)>>();
        let compared = |word: &str, found: f64, given: f64, unit: &str| {
            let off = (found - given) / given;
            let difference =
                format!("{}: its {word} is {found:.6} {unit}, the file states {given:.6} {unit} ({:+.2} %)", stated.name, 100.0 * off);
            (off.is_nan() || off.abs() > STATED).then(|| Malformed::line(stated.line, difference))
        };
        let copies = stated.copies.max(1) as f64;
        match stated.figure {
            Figure::Area(given) => compared(
                "area",
                surfaces.iter().map(measure::area).fold(0.0, std::ops::Add::add) / copies,
                given,
                &format!("{}²", self.model_unit),
            ),
            Figure::Volume(given) => {
                compared("volume", measure::solid(&faces()).volume.abs() / copies, given, &format!("{}³", self.model_unit))
            }
            Figure::Centroid(given) => {
                let size = surfaces.iter().map(Surface::hull).fold(Box3::EMPTY, Box3::union).diagonal();
                let off = measure::solid(&faces()).centroid.distance(given);
                let of_faces = measure::sheet(&surfaces).centroid.distance(given);
                let difference = format!("{}: its centroid is {off:.6} {} from where the file states it", stated.name, self.model_unit);
                (off.min(of_faces) > STATED * size).then(|| Malformed::line(stated.line, difference))
            }
        }
    }

    /// Those of some faces that solids have: sheets beside them have no volume. All of them where no solid has any.
    fn round_volumes(&self, faces: &[usize]) -> Vec<usize> {
        let of_solids: BTreeSet<usize> = self.solids.iter().flat_map(|solid| solid.surfaces.iter().copied()).collect();
        let inside: Vec<usize> = faces.iter().copied().filter(|face| of_solids.contains(face)).collect();
        if inside.is_empty() { faces.to_vec() } else { inside }
    }
}
