//! Curves as SVG paths, in the plane in which they lie.

use std::io::{self, Write};

use crate::base::bbox::Box3;
use crate::base::text::{push_real, real};
use crate::base::xml::escaped;
use crate::io::curve_files::polylines::Drawing;
use crate::io::files::loss::Loss;
use crate::io::files::names::{Names, Naming};

/// Which two coordinates a drawing shows: those of the plane it lies in, else x and y.
fn plane(bounds: &Box3) -> ([usize; 2], bool) {
    let size = (bounds.max - bounds.min).to_array();
    match size {
        [_, _, 0.0] => ([0, 1], true),
        [_, 0.0, _] => ([0, 2], true),
        [0.0, _, _] => ([1, 2], true),
        _ => ([0, 1], false),
    }
}

/// One path per curve, in true size where the unit is one of SVG's; y (or z) points up.
pub(crate) fn write_svg(drawing: &Drawing, out: &mut dyn Write) -> io::Result<Vec<Loss>> {
    let bounds = Box3::of(drawing.curves.iter().flat_map(|curve| curve.points.iter().copied()));
    if bounds.is_empty() {
        return Err(io::Error::other("there is no point to draw"));
    }
    let ([a, b], flat) = plane(&bounds);
    let (low, high) = (bounds.min.to_array(), bounds.max.to_array());
    // A hundredth of the drawing around it, so that lines at the border show whole.
    let margin = bounds.diagonal() / 100.0;
    let (width, height) = (high[a] - low[a] + 2.0 * margin, high[b] - low[b] + 2.0 * margin);
    let unit = if matches!(drawing.unit, "mm" | "cm" | "in") { drawing.unit } else { "" };
    writeln!(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}{unit}\" height=\"{1}{unit}\" viewBox=\"{2} {3} {0} {1}\">",
        real(width),
        real(height),
        real(low[a] - margin),
        real(-high[b] - margin)
    )?;
    let mut names = Names::new(Naming::Free);
    for curve in drawing.curves {
        let mut text = format!("<path id=\"{}\" d=\"", escaped(&names.give(&curve.name))).into_bytes();
        for (k, p) in curve.points.iter().enumerate() {
            let p = p.to_array();
            text.extend_from_slice(if k == 0 { b"M" } else { b" L" });
            push_real(&mut text, p[a]);
            text.push(b' ');
            push_real(&mut text, -p[b]);
        }
        text.extend_from_slice(if curve.closed { b" Z" } else { b"" });
        text.extend_from_slice(b"\" fill=\"none\" stroke=\"black\" vector-effect=\"non-scaling-stroke\"/>\n");
        out.write_all(&text)?;
    }
    writeln!(out, "</svg>")?;
    let mut losses = names.losses;
    if !flat {
        losses.push(Loss::LeftOut("the z coordinates of curves in space".to_owned()));
    }
    Ok(losses)
}
