//! Curves as OBJ lines.

use std::io::{self, Write};

use crate::base::text::{push_count, push_real};
use crate::io::curve_files::polylines::Drawing;
use crate::io::files::loss::Loss;
use crate::io::files::names::{Names, Naming};

/// One object per curve: its points and one `l` through them.
pub(crate) fn write_obj(drawing: &Drawing, out: &mut dyn Write) -> io::Result<Vec<Loss>> {
    writeln!(out, "# made by loft, lengths in {}", drawing.unit)?;
    let mut names = Names::new(Naming::Free);
    let mut first = 1_u64;
    for curve in drawing.curves {
        let mut text = format!("o {}\n", names.give(&curve.name)).into_bytes();
        for p in &curve.points {
            text.push(b'v');
            for x in p.to_array() {
                text.push(b' ');
                push_real(&mut text, x);
            }
            text.push(b'\n');
        }
        let n = curve.points.len() as u64;
        text.push(if n > 1 { b'l' } else { b'p' });
        for k in (first..first + n).chain(Some(first).filter(|_| curve.closed)) {
            text.push(b' ');
            push_count(&mut text, k);
        }
        text.push(b'\n');
        first += n;
        out.write_all(&text)?;
    }
    Ok(names.losses)
}
