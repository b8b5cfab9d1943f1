//! Which keyword declares what a function makes: the parser says so where a call stands alone. Parsing knows nothing of what evaluates, so the
//! names stand here once more; the test below holds them equal to those of `lang::eval::std`.

/// Functions that make curves.
const CURVES: &[&str] = &[
    "arc",
    "bezier",
    "bspline",
    "chamfer",
    "circle",
    "conic",
    "ellipse",
    "fillet",
    "helix",
    "iso",
    "line",
    "parabola",
    "polyline",
    "polynomial_curve",
    "project",
    "spline",
    "u",
    "v",
];
/// Functions that make surfaces.
const SURFACES: &[&str] = &[
    "along",
    "bezier_surface",
    "bridge",
    "coons",
    "extrude",
    "gordon",
    "grid",
    "hermite",
    "join",
    "nurbs_surface",
    "polynomial",
    "revolve",
    "ruled",
    "scatter",
    "skin",
    "sweep",
    "transfinite",
    "trim",
];
/// Functions that make something else.
const OTHERS: &[&str] = &[
    "abs",
    "acos",
    "acosh",
    "all",
    "angle",
    "any",
    "asin",
    "asinh",
    "at",
    "atan",
    "atan2",
    "blend",
    "box",
    "by_length",
    "ceil",
    "colored",
    "column",
    "cones",
    "connection",
    "contains",
    "cos",
    "cosh",
    "creases",
    "cross",
    "curvatures",
    "curves_of_form",
    "cylinders",
    "deviation",
    "distance",
    "dot",
    "edge",
    "edge_between",
    "equilibrium",
    "error",
    "even_points",
    "exp",
    "extend",
    "fair",
    "fairness",
    "fill",
    "fit",
    "flatten",
    "floor",
    "frame",
    "hull_lines",
    "hydrostatics",
    "imprint",
    "inside",
    "len",
    "lerp",
    "lines_plan",
    "linspace",
    "log",
    "max",
    "mean",
    "meet",
    "mid",
    "min",
    "mirror",
    "mod",
    "move",
    "named",
    "nearest",
    "norm",
    "normal",
    "nurbs",
    "offset",
    "offsets_table",
    "on",
    "others",
    "pi",
    "plane",
    "planes",
    "plot",
    "points",
    "reverse",
    "righting_arms",
    "rotate",
    "round",
    "scale",
    "section",
    "sectional_areas",
    "sign",
    "sin",
    "sinh",
    "sort",
    "spheres",
    "split",
    "sqrt",
    "sum",
    "tan",
    "tangent",
    "text",
    "thicken",
    "tori",
    "unit",
    "zip",
];

/// A function by its name, with the keyword that declares its result: `curve`, `surface`, else `let`; `None` where there is none.
pub(crate) fn keyword_of(function: &str) -> Option<(&'static str, &'static str)> {
    let words = [("curve", CURVES), ("surface", SURFACES), ("let", OTHERS)];
    words.into_iter().find_map(|(word, all)| all.iter().find(|name| **name == function).map(|name| (*name, word)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lang::eval::std::builtins;
    use crate::lang::values::types::Ty;

    #[test]
    fn each_function_has_the_keyword_of_its_type() {
        for builtin in builtins() {
            let word = match builtin.returns {
                Ty::Curve => "curve",
                Ty::Surface => "surface",
                _ => "let",
            };
            assert_eq!(keyword_of(builtin.name), Some((builtin.name, word)));
        }
        let all = CURVES.len() + SURFACES.len() + OTHERS.len();
        let mut names: Vec<&str> = builtins().map(|builtin| builtin.name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(all, names.len());
    }
}
