//! Curves as csv: a line for each point.

use std::io::{self, Write};

use crate::base::text::push_real;
use crate::io::curve_files::polylines::Drawing;
use crate::io::files::loss::Loss;

/// One line per point: `curve,x [mm],y [mm],z [mm]`; a closed curve ends where it began.
pub(crate) fn write_csv(drawing: &Drawing, out: &mut dyn Write) -> io::Result<Vec<Loss>> {
    let unit = drawing.unit;
    let mut text = format!("curve,x [{unit}],y [{unit}],z [{unit}]\n").into_bytes();
    for curve in drawing.curves {
        let name =
            if curve.name.contains([',', '"', '#', ';']) { format!("\"{}\"", curve.name.replace('"', "\"\"")) } else { curve.name.clone() };
        for p in curve.points.iter().chain(curve.points.first().filter(|_| curve.closed)) {
            text.extend_from_slice(name.as_bytes());
            for x in p.to_array() {
                text.push(b',');
                push_real(&mut text, x);
            }
            text.push(b'\n');
        }
        out.write_all(&text)?;
        text.clear();
    }
    out.write_all(&text)?;
    Ok(Vec::new())
}
