//! All formats for meshes and for curves.

use crate::io::curve_files::csv::write_csv;
use crate::io::curve_files::obj::write_obj;
use crate::io::curve_files::polylines::CurveFormat;
use crate::io::curve_files::svg::write_svg;
use crate::io::mesh_files::format::Format;
use crate::io::mesh_files::{bdf, glb, inp, msh, obj_write, ply, stl_write, threemf, vtu};

/// All mesh formats.
pub const FORMATS: &[Format] =
    &[stl_write::FORMAT, obj_write::FORMAT, ply::FORMAT, vtu::FORMAT, msh::FORMAT, inp::FORMAT, bdf::FORMAT, glb::FORMAT, threemf::FORMAT];

const fn element_count() -> usize {
    let (mut n, mut k) = (0, 0);
    while k < FORMATS.len() {
        n += FORMATS[k].elements.len();
        k += 1;
    }
    n
}

/// Element names of all formats: what `element:` may say.
pub const ELEMENT_NAMES: [&str; element_count()] = {
    let mut names = [""; element_count()];
    let (mut n, mut k) = (0, 0);
    while k < FORMATS.len() {
        let mut i = 0;
        while i < FORMATS[k].elements.len() {
            names[n] = FORMATS[k].elements[i].0;
            n += 1;
            i += 1;
        }
        k += 1;
    }
    names
};

/// All formats for curves.
pub const CURVE_FORMATS: &[CurveFormat] = &[
    CurveFormat { name: "csv", write: write_csv },
    CurveFormat { name: "svg", write: write_svg },
    CurveFormat { name: "obj", write: write_obj },
];
