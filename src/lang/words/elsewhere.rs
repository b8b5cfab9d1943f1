//! What other tools call the words of this language: Gmsh, OpenSCAD, CadQuery, build123d, Abaqus, Rhino, Python.

use crate::lang::words::names::nearest;

/// Their word in small letters without `_`, and ours that may be meant by it, the likeliest first.
const WORDS: &[(&str, &[&str])] = &[
    // Settings of meshes.
    ("elementsize", &["size"]),
    ("meshsize", &["size"]),
    ("maxsize", &["size"]),
    ("sizemax", &["size"]),
    ("globalsize", &["size"]),
    ("edgelength", &["size"]),
    ("characteristiclength", &["size"]),
    ("charlength", &["size"]),
    ("seed", &["size"]),
    ("lc", &["size"]),
    ("cl", &["size"]),
    ("h", &["size"]),
    ("hmax", &["size"]),
    ("maxh", &["size"]),
    ("minelementsize", &["min_size"]),
    ("sizemin", &["min_size"]),
    ("hmin", &["min_size"]),
    ("minh", &["min_size"]),
    ("growthrate", &["growth"]),
    ("grading", &["growth", "bias"]),
    ("deflection", &["chord_error"]),
    ("lineartolerance", &["chord_error"]),
    ("lineardeflection", &["chord_error"]),
    ("deviation", &["chord_error"]),
    ("chordheight", &["chord_error"]),
    ("chorddeviation", &["chord_error"]),
    ("sag", &["chord_error"]),
    ("angulartolerance", &["angle_error"]),
    ("angulardeflection", &["angle_error"]),
    ("angletolerance", &["angle_error"]),
    ("maxangle", &["angle_error"]),
    ("elementtype", &["elements", "element"]),
    ("elemtype", &["elements", "element"]),
    ("elementshape", &["elements"]),
    ("eltype", &["elements", "element"]),
    ("recombine", &["elements"]),
    ("algorithm", &["method"]),
    ("algo", &["method"]),
    ("technique", &["method"]),
    ("elementorder", &["order"]),
    ("degree", &["order", "degree"]),
    ("smoothing", &["smooth"]),
    ("divisions", &["count"]),
    ("segments", &["count"]),
    ("numelements", &["count"]),
    ("elementcount", &["count"]),
    ("subdivisions", &["count"]),
    ("num", &["count"]),
    ("n", &["count", "normal"]),
    ("fn", &["count"]),
    ("progression", &["bias"]),
    ("ratio", &["bias", "by", "rho"]),
    ("distance", &["radius", "by"]),
    ("camera", &["view"]),
    ("style", &["shade"]),
    // Words of choices.
    ("tri", &["triangles"]),
    ("tria", &["triangles"]),
    ("trias", &["triangles"]),
    ("triangle", &["triangles"]),
    ("quad", &["quads"]),
    ("quadrilateral", &["quads"]),
    ("quadrilaterals", &["quads"]),
    ("quaddominated", &["mixed"]),
    ("structured", &["mapped"]),
    ("transfinite", &["mapped", "transfinite"]),
    ("free", &["delaunay"]),
    ("frontal", &["delaunay"]),
    ("unstructured", &["delaunay"]),
    ("ascii", &["text"]),
    ("iso", &["isometric", "iso"]),
    // Arguments.
    ("r", &["radius"]),
    ("rad", &["radius"]),
    ("centre", &["center"]),
    ("centerpoint", &["center"]),
    ("origin", &["center", "at", "about"]),
    ("pos", &["center", "at"]),
    ("position", &["center", "at"]),
    ("throughpoint", &["through"]),
    ("via", &["through"]),
    ("height", &["by", "height"]),
    ("vector", &["by"]),
    ("vec", &["by"]),
    ("direction", &["by", "along", "normal"]),
    ("dir", &["by", "along", "normal"]),
    ("amount", &["by"]),
    ("offset", &["by"]),
    ("translation", &["by"]),
    ("factor", &["by"]),
    ("scale", &["by"]),
    ("axisofrotation", &["axis"]),
    ("rotationaxis", &["axis"]),
    ("around", &["about", "axis"]),
    ("pivot", &["about"]),
    ("basepoint", &["about"]),
    ("theta", &["angle"]),
    ("degrees", &["angle"]),
    ("deg", &["angle"]),
    ("planenormal", &["normal"]),
    ("tol", &["within"]),
    ("tolerance", &["within", "chord_error"]),
    ("pts", &["points"]),
    ("poles", &["points", "net"]),
    ("controlpoints", &["points", "net"]),
    ("vertices", &["points"]),
    ("starttangent", &["start"]),
    ("endtangent", &["end"]),
    ("tangents", &["start"]),
    ("periodic", &["closed"]),
    ("close", &["closed"]),
    ("isclosed", &["closed"]),
    ("openings", &["holes"]),
    ("voids", &["holes"]),
    ("inner", &["holes"]),
    ("innerwires", &["holes"]),
    ("boundary", &["outer", "curves"]),
    ("border", &["outer", "curves"]),
    ("outerwire", &["outer"]),
    ("tool", &["by"]),
    ("tools", &["by"]),
    // Functions.
    ("segment", &["line"]),
    ("lineto", &["line"]),
    ("makeline", &["line"]),
    ("threepointarc", &["arc"]),
    ("circlearc", &["arc"]),
    ("arc3p", &["arc"]),
    ("polygon", &["polyline"]),
    ("makepolygon", &["polyline"]),
    ("interpolate", &["spline"]),
    ("interpcurve", &["spline"]),
    ("bsplinecurve", &["bspline"]),
    ("beziercurve", &["bezier"]),
    ("nurbscurve", &["nurbs"]),
    ("translate", &["move"]),
    ("symmetry", &["mirror"]),
    ("dilate", &["scale"]),
    ("linearextrude", &["extrude"]),
    ("rotateextrude", &["revolve"]),
    ("revolution", &["revolve"]),
    ("planesurface", &["plane"]),
    ("makeface", &["plane"]),
    ("face", &["plane"]),
    ("fill", &["coons"]),
    ("filling", &["coons"]),
    ("coonspatch", &["coons"]),
    ("edgesrf", &["coons"]),
    ("ruledsurface", &["ruled"]),
    ("transfinitesurface", &["transfinite"]),
    ("difference", &["trim"]),
    ("subtract", &["trim"]),
    ("intersect", &["meet"]),
    ("intersection", &["meet"]),
    ("closestpoint", &["nearest"]),
    ("arctan", &["atan"]),
    ("arctan2", &["atan2"]),
    ("arcsin", &["asin"]),
    ("arccos", &["acos"]),
    ("ln", &["log"]),
    ("ceiling", &["ceil"]),
    ("magnitude", &["norm"]),
    ("normalize", &["unit"]),
    ("normalized", &["unit"]),
    ("crossproduct", &["cross"]),
    ("dotproduct", &["dot"]),
    ("average", &["mean"]),
    ("concat", &["flatten"]),
    ("str", &["text"]),
    ("tostring", &["text"]),
    ("fabs", &["abs"]),
    ("sorted", &["sort"]),
    ("reversed", &["reverse"]),
    ("avg", &["mean"]),
    // Fields.
    ("len", &["length", "len"]),
    ("arclength", &["length"]),
    ("perimeter", &["length"]),
    ("startpoint", &["start"]),
    ("endpoint", &["end"]),
    ("midpoint", &["mid"]),
    ("middle", &["mid"]),
    ("center", &["centroid", "mid", "center"]),
    ("boundingbox", &["bbox"]),
    ("bounds", &["bbox"]),
    ("wires", &["loops"]),
    ("points", &["points", "nodes"]),
    ("elements", &["triangles"]),
];

/// What is typed for a function that this language has no word for.
const INSTEAD: &[(&str, &str)] = &[
    ("sphere", "revolve(arc((0, 0, -1m), (0, 0, 1m), through: (1m, 0, 0)))"),
    ("cylinder", "extrude(circle(center: (0, 0, 0), radius: 1m), by: (0, 0, 3m))"),
    ("cone", "revolve(line((1m, 0, 0), (0, 0, 2m)))"),
    ("torus", "revolve(circle(center: (3m, 0, 0), radius: 1m, normal: (0, 1, 0)))"),
    ("cube", "extrude(polyline([(0, 0), (1m, 0), (1m, 1m), (0, 1m)], closed: true), by: (0, 0, 1m))"),
    ("box", "extrude(polyline([(0, 0), (1m, 0), (1m, 1m), (0, 1m)], closed: true), by: (0, 0, 1m))"),
    ("rect", "polyline([(0, 0), (2m, 0), (2m, 1m), (0, 1m)], closed: true)"),
    ("square", "polyline([(0, 0), (1m, 0), (1m, 1m), (0, 1m)], closed: true)"),
    ("rectangle", "polyline([(0, 0), (2m, 0), (2m, 1m), (0, 1m)], closed: true)"),
    ("union", "shell name of a, b"),
    ("fuse", "shell name of a, b"),
    ("assert", "check a == b"),
    ("pow", "a ^ b"),
    ("int", "floor(x)"),
    ("float", "x"),
];

/// A word as [`WORDS`] has it.
fn plain(word: &str) -> String {
    word.chars().filter(|c| !matches!(c, '_' | '$')).flat_map(char::to_lowercase).collect()
}

/// Our word among `known` that another tool calls `word`.
pub(crate) fn ours<'a>(word: &str, known: impl Iterator<Item = &'a str> + Clone) -> Option<&'a str> {
    let word = plain(word);
    let candidates = WORDS.iter().filter(|w| w.0 == word).flat_map(|w| w.1);
    // What differs in `_` and capitals alone is meant first: `chordError`.
    known.clone().find(|k| plain(k) == word).or_else(|| candidates.into_iter().find_map(|ours| known.clone().find(|k| k == ours)))
}

/// The word that was probably meant: what other tools call it, else the nearest.
pub(crate) fn meant<'a>(word: &str, known: impl Iterator<Item = &'a str> + Clone) -> Option<&'a str> {
    ours(word, known.clone()).filter(|ours| *ours != word).or_else(|| nearest(word, known))
}

/// What is typed in the place of a function of other tools.
pub(crate) fn instead(function: &str) -> Option<&'static str> {
    let word = plain(function);
    INSTEAD.iter().find(|w| w.0 == word).map(|w| w.1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lang::eval::std::{builtins, fields};
    use crate::lang::values::settings::{BLOCKS, words};

    #[test]
    fn every_word_of_ours_is_a_word() {
        let known = |word: &str| {
            builtins().chain(fields()).any(|b| b.name == word || b.params.iter().any(|p| p.name == word))
                || BLOCKS.iter().any(|b| b.1.iter().any(|s| s.key == word))
                || words().any(|w| w == word)
        };
        let strange: Vec<&&str> = WORDS.iter().flat_map(|w| w.1).filter(|w| !known(w) && **w != "element" && **w != "height").collect();
        assert!(strange.is_empty(), "{strange:?}");
        assert!(WORDS.iter().chain(&[]).all(|w| w.0 == plain(w.0)));
    }

    #[test]
    fn words_of_others_are_found() {
        let mesh = ["size", "chord_error", "elements", "growth"];
        let meant = |word| meant(word, mesh.iter().copied());
        assert_eq!(
            [meant("element_size"), meant("MeshSize"), meant("chordError"), meant("sise")],
            [Some("size"), Some("size"), Some("chord_error"), Some("size")]
        );
        assert_eq!(meant("colour"), None);
    }
}
