//! The format that the ending of a path chooses.

use crate::base::origin::Origin;
use crate::io::curve_files::polylines::CurveFormat;
use crate::io::files::fault::FormatFault;
use crate::io::formats::endings::{Sort, ending_for, misfit};
use crate::io::formats::list::{CURVE_FORMATS, FORMATS};
use crate::io::mesh_files::format::Format;

/// The mesh format that a path's ending chooses; E804 or E805 where it chooses none, E230 for one of a later version.
pub fn format_for(of: Origin, path: &str) -> Result<&'static Format, FormatFault> {
    let ending = ending_for(of, path, Sort::Meshes)?;
    FORMATS.iter().find(|format| format.extensions.contains(&ending.as_str())).ok_or_else(|| misfit(of, path, Sort::Meshes))
}

/// The format for curves that a path's ending chooses; E804 or E805 where it chooses none, E230 for one of a later version.
pub fn curve_format_for(of: Origin, path: &str) -> Result<&'static CurveFormat, FormatFault> {
    let ending = ending_for(of, path, Sort::Curves)?;
    CURVE_FORMATS.iter().find(|format| format.name == ending).ok_or_else(|| misfit(of, path, Sort::Curves))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::curve_files::polylines::{Drawing, Polyline};
    use crate::io::files::loss::Loss;
    use glam::DVec3;

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
        assert!(matches!(curve_format_for(Origin::NONE, "a.gltf"), Err(FormatFault::LaterFormat { format: "glTF as text", .. })));
        assert!(matches!(curve_format_for(Origin::NONE, "a.xyz"), Err(FormatFault::NoSuchFormat { .. })));
        assert!(matches!(curve_format_for(Origin::NONE, "a.inp"), Err(FormatFault::Unsupported { .. })));
    }
}
