//! Curves as points along them: csv, svg and OBJ lines.

use std::io::{self, Write};

use glam::DVec3;

use super::deck::Loss;
use super::endings::{Sort, ending_for};
use super::sets::{Names, Naming};
use crate::base::bbox::Box3;
use crate::base::fault::FileFault;
use crate::base::origin::Origin;
use crate::base::text::{push_count, push_real, real};
use crate::base::xml::escaped;

/// A curve as the points that stand for it, in units of the file.
#[derive(Clone, Debug, PartialEq)]
pub struct Polyline {
    /// Name as declared.
    pub name: String,
    /// Points along it; of a closed one the first point is not repeated.
    pub points: Vec<DVec3>,
    /// Whether the last point joins the first.
    pub closed: bool,
}

/// Curves to write.
pub struct Drawing<'a> {
    /// The curves.
    pub curves: &'a [Polyline],
    /// Name of the unit of length in the file, for example "mm".
    pub unit: &'a str,
}

/// A format for curves.
pub struct CurveFormat {
    /// Short name, which is its ending.
    pub name: &'static str,
    /// Writes a drawing.
    pub write: fn(&Drawing, &mut dyn Write) -> io::Result<Vec<Loss>>,
}

/// All formats for curves.
pub const CURVE_FORMATS: &[CurveFormat] = &[
    CurveFormat { name: "csv", write: write_csv },
    CurveFormat { name: "svg", write: write_svg },
    CurveFormat { name: "obj", write: write_obj },
];

/// The format for curves that a path's ending chooses; E804 or E805 where it chooses none, E230 for one of a later version.
pub fn curve_format_for(of: Origin, path: &str) -> Result<&'static CurveFormat, FileFault> {
    let ending = ending_for(of, path, Sort::Curves)?;
    CURVE_FORMATS.iter().find(|format| format.name == ending).ok_or_else(|| super::endings::misfit(of, path, Sort::Curves))
}

/// One line per point: `curve,x [mm],y [mm],z [mm]`; a closed curve ends where it began.
fn write_csv(drawing: &Drawing, out: &mut dyn Write) -> io::Result<Vec<Loss>> {
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
fn write_svg(drawing: &Drawing, out: &mut dyn Write) -> io::Result<Vec<Loss>> {
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

/// One object per curve: its points and one `l` through them.
fn write_obj(drawing: &Drawing, out: &mut dyn Write) -> io::Result<Vec<Loss>> {
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

#[cfg(test)]
mod tests {
    use super::*;

    fn written(name: &str, z: f64) -> (String, Vec<Loss>) {
        let points = vec![DVec3::ZERO, DVec3::new(2.0, 0.0, 0.0), DVec3::new(2.0, 1.5, z)];
        let curves = [Polyline { name: "ribs[1]".into(), points, closed: true }];
        let format = curve_format_for(Origin::NONE, &format!("a/b.{name}")).unwrap();
        let mut out = Vec::new();
        let losses = (format.write)(&Drawing { curves: &curves, unit: "mm" }, &mut out).unwrap();
        (String::from_utf8(out).unwrap(), losses)
    }

    #[test]
    fn curves_in_three_formats() {
        let (csv, _) = written("csv", 0.0);
        assert_eq!(csv, "curve,x [mm],y [mm],z [mm]\nribs[1],0,0,0\nribs[1],2,0,0\nribs[1],2,1.5,0\nribs[1],0,0,0\n");
        let (obj, losses) = written("obj", 0.25);
        assert_eq!(obj, "# made by loft, lengths in mm\no ribs_1\nv 0 0 0\nv 2 0 0\nv 2 1.5 0.25\nl 1 2 3 1\n");
        let family = |losses: &[Loss]| matches!(losses, [Loss::Renamed(renamed)] if renamed.family);
        assert!(family(&losses));
        let (svg, losses) = written("svg", 0.0);
        assert!(family(&losses));
        let path = "<path id=\"ribs_1\" d=\"M0 0 L2 0 L2 -1.5 Z\"";
        assert!(svg.contains(path) && svg.contains("width=\"2.05mm\" height=\"1.55mm\" viewBox=\"-0.025 -1.525 2.05 1.55\""), "{svg}");
        assert_eq!(written("svg", 1.0).1.len(), 2);
    }

    #[test]
    fn other_endings_say_what_there_is() {
        assert!(matches!(curve_format_for(Origin::NONE, "a.glb"), Err(FileFault::LaterFormat { format: "glTF", .. })));
        assert!(matches!(curve_format_for(Origin::NONE, "a.xyz"), Err(FileFault::NoSuchFormat { .. })));
        assert!(matches!(curve_format_for(Origin::NONE, "a.inp"), Err(FileFault::Unsupported { .. })));
    }
}
