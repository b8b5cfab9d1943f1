//! Each kind of entity is the curve, surface or body that it describes.

use std::f64::consts::PI;

use lofting::io::files::fault::Share;
use lofting::model::measure;

use super::file::{FRAME, can, file, in_units};
use super::{OPTIONS, areas, read, whole};

const POINTS: &str = "#10=CARTESIAN_POINT('',(0.,0.,0.));\n#11=CARTESIAN_POINT('',(1.,2.,0.));\n#12=CARTESIAN_POINT('',(3.,2.,0.));\n\
                      #13=CARTESIAN_POINT('',(4.,0.,0.));\n";

/// A curve or surface #100 with what it needs.
fn of(entity: &str, others: &str) -> String {
    file(&format!("{FRAME}{POINTS}{others}\n#100={entity};\n"), "#101").replace("#9000=", "#101=GEOMETRIC_SET('',(#100));\n#9000=")
}

/// Curves with their lengths.
fn curves() -> Vec<(&'static str, String, f64)> {
    let arc = |a: f64, b: f64| {
        // ∫ √(1 + 4 t²) dt over the parabola (t², 2 t) with focal distance 1 is that of its derivative 2 √(t² + 1).
        let f = |t: f64| t * (t * t + 1.0).sqrt() + t.asinh();
        f(b) - f(a)
    };
    let simpson = |a: f64, b: f64, f: &dyn Fn(f64) -> f64| {
        let n = 4000;
        let h = (b - a) / f64::from(n);
        (0..=n).map(|k| f(a + h * f64::from(k)) * if k == 0 || k == n { 1.0 } else { 2.0 + 2.0 * f64::from(k % 2) }).sum::<f64>() * h / 3.0
    };
    let cubic = |t: f64| {
        let s = 1.0 - t;
        let d = |p: [f64; 4]| 3.0 * ((p[1] - p[0]) * s * s + 2.0 * (p[2] - p[1]) * s * t + (p[3] - p[2]) * t * t);
        d([0.0, 1.0, 3.0, 4.0]).hypot(d([0.0, 2.0, 2.0, 0.0]))
    };
    let bezier = simpson(0.0, 1.0, &cubic);
    let trims = |a: &str, b: &str, sense: &str| format!("TRIMMED_CURVE('',#20,({a}),({b}),{sense},.PARAMETER.)");
    let range = |a: f64, b: f64| trims(&format!("PARAMETER_VALUE({a:?})"), &format!("PARAMETER_VALUE({b:?})"), ".T.");
    let circle = "#20=CIRCLE('',#4,2.);";
    vec![
        ("circle", of("CIRCLE('',#4,2.)", ""), 4.0 * PI),
        ("trimmed circle", of(&range(0.5, 2.0), circle), 3.0),
        ("trimmed over the start", of(&range(6.0, 1.0), circle), 2.0 * (2.0 * PI - 5.0)),
        ("trimmed backwards", of(&trims("PARAMETER_VALUE(0.5)", "PARAMETER_VALUE(2.0)", ".F."), circle), 2.0 * (2.0 * PI - 1.5)),
        (
            "trimmed by points",
            of(&trims("#21", "#22", ".T."), &format!("{circle}#21=CARTESIAN_POINT('',(2.,0.,0.));#22=CARTESIAN_POINT('',(0.,2.,0.));")),
            PI,
        ),
        ("ellipse", of("ELLIPSE('',#4,3.,2.)", ""), simpson(0.0, 2.0 * PI, &|t| (3.0 * t.sin()).hypot(2.0 * t.cos()))),
        ("hyperbola", of(&range(-0.5, 1.0), "#20=HYPERBOLA('',#4,2.,1.);"), simpson(-0.5, 1.0, &|t| (2.0 * t.sinh()).hypot(t.cosh()))),
        ("parabola", of(&range(-1.0, 2.0), "#20=PARABOLA('',#4,1.);"), arc(-1.0, 2.0)),
        ("line", of(&range(0.5, 2.0), "#20=LINE('',#10,#21);#21=VECTOR('',#3,3.);"), 4.5),
        ("polyline", of("POLYLINE('',(#10,#11,#12,#13))", ""), 2.0 * 5.0_f64.sqrt() + 2.0),
        ("bezier", of("BEZIER_CURVE('',3,(#10,#11,#12,#13),.UNSPECIFIED.,.F.,.F.)", ""), bezier),
        ("quasi-uniform", of("QUASI_UNIFORM_CURVE('',3,(#10,#11,#12,#13),.UNSPECIFIED.,.F.,.F.)", ""), bezier),
        (
            "with knots",
            of("B_SPLINE_CURVE_WITH_KNOTS('',3,(#10,#11,#12,#13),.UNSPECIFIED.,.F.,.F.,(4,4),(0.,7.),.UNSPECIFIED.)", ""),
            bezier,
        ),
        ("uniform", of("UNIFORM_CURVE('',1,(#10,#11,#12,#13),.UNSPECIFIED.,.F.,.F.)", ""), 2.0 * 5.0_f64.sqrt() + 2.0),
        (
            "rational",
            of(
                "(BOUNDED_CURVE() B_SPLINE_CURVE(2,(#21,#22,#23),.CIRCULAR_ARC.,.F.,.F.) B_SPLINE_CURVE_WITH_KNOTS((3,3),(0.,1.),.UNSPECIFIED.) \
                 CURVE() GEOMETRIC_REPRESENTATION_ITEM() RATIONAL_B_SPLINE_CURVE((1.,0.70710678118654752,1.)) REPRESENTATION_ITEM(''))",
                "#21=CARTESIAN_POINT('',(1.,0.,0.));#22=CARTESIAN_POINT('',(1.,1.,0.));#23=CARTESIAN_POINT('',(0.,1.,0.));",
            ),
            0.5 * PI,
        ),
        (
            "composite",
            of(
                "COMPOSITE_CURVE('',(#21,#22),.F.)",
                "#20=POLYLINE('',(#10,#11));#21=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#20);#23=POLYLINE('',(#12,#11));\
                 #22=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.F.,#23);",
            ),
            5.0_f64.sqrt() + 2.0,
        ),
        ("on a surface", of("SURFACE_CURVE('',#20,(#21),.CURVE_3D.)", "#20=CIRCLE('',#4,1.);#21=PLANE('',#4);"), 2.0 * PI),
    ]
}

/// A surface of one face that a vertex bounds, or that its parameters bound, with its area.
fn surfaces() -> Vec<(&'static str, String, f64)> {
    let closed = |entity: &str| {
        let text = format!(
            "{FRAME}{POINTS}#100={entity};\n#101=VERTEX_POINT('',#10);\n#102=VERTEX_LOOP('',#101);\n#103=FACE_BOUND('',#102,.T.);\n\
             #104=ADVANCED_FACE('',(#103),#100,.T.);\n#105=CLOSED_SHELL('',(#104));\n#106=MANIFOLD_SOLID_BREP('',#105);\n"
        );
        file(&text, "#106")
    };
    let trimmed = |entity: &str, others: &str, [a, b, c, d]: [f64; 4]| {
        of(&format!("RECTANGULAR_TRIMMED_SURFACE('',#20,{a:?},{b:?},{c:?},{d:?},.T.,.T.)"), &format!("{others}#20={entity};"))
    };
    // Below a circle about z at a height, with or without a loop that is only the vertex #110.
    let below = |entity: &str, (radius, height): (f64, f64), vertex: &str| {
        let text = format!(
            "{FRAME}#90=CARTESIAN_POINT('',(0.,0.,{height:?}));\n#91=AXIS2_PLACEMENT_3D('',#90,#2,#3);\n#92=CIRCLE('',#91,{radius:?});\n\
             #93=CARTESIAN_POINT('',({radius:?},0.,{height:?}));\n#94=VERTEX_POINT('',#93);\n#95=EDGE_CURVE('',#94,#94,#92,.T.);\n\
             #96=ORIENTED_EDGE('',*,*,#95,.F.);\n#97=EDGE_LOOP('',(#96));\n#98=FACE_BOUND('',#97,.T.);\n#100={entity};\n\
             #104=ADVANCED_FACE('',(#98{vertex}),#100,.T.);\n#105=OPEN_SHELL('',(#104));\n#106=SHELL_BASED_SURFACE_MODEL('',(#105));\n\
             #110=VERTEX_POINT('',#1);\n#111=VERTEX_LOOP('',#110);\n#112=FACE_BOUND('',#111,.T.);\n\
             #120=AXIS1_PLACEMENT('',#1,#2);\n#121=DIRECTION('',(0.,-1.,0.));\n#122=AXIS2_PLACEMENT_3D('',#1,#121,#2);\n"
        );
        file(&text, "#106")
    };
    // A conic about a point of x turned about z: the plane of the conic is seen against y, or along it.
    let turned = |conic: &str, x: f64, seen: &str| {
        let others = format!(
            "\n#120=AXIS1_PLACEMENT('',#1,#2);\n#121=DIRECTION('',(0.,{seen},0.));\n#122=CARTESIAN_POINT('',({x:?},0.,0.));\n\
             #123=AXIS2_PLACEMENT_3D('',#122,#121,#2);\n#124={conic}"
        );
        closed(&format!("SURFACE_OF_REVOLUTION('',#124,#120);{others}"))
    };
    let steep = "CONICAL_SURFACE('',#4,0.,0.4636476090008061)";
    let line = "SURFACE_OF_REVOLUTION('',#130,#120);\n#130=LINE('',#1,#131);\n#131=VECTOR('',#132,1.);\n#132=DIRECTION('',(1.,0.,2.))";
    let spheroid = {
        let e = (1.0_f64 - 4.0 / 9.0).sqrt();
        18.0 * PI + 4.0 * PI / e * ((1.0 + e) / (1.0 - e)).ln()
    };
    let net = "((#10,#13),(#21,#22))";
    let others = "#21=CARTESIAN_POINT('',(0.,0.,3.));#22=CARTESIAN_POINT('',(4.,0.,3.));";
    let apple: f64 = {
        // Turned about the axis at distance 1: the outer arc of a circle of radius 2, to ±120°.
        let to = 2.0 * PI / 3.0;
        2.0 * PI * 2.0 * (2.0 * to + 2.0 * 2.0 * to.sin())
    };
    vec![
        ("sphere", closed("SPHERICAL_SURFACE('',#4,3.)"), 36.0 * PI),
        ("torus", closed("TOROIDAL_SURFACE('',#4,5.,2.)"), 4.0 * PI * PI * 10.0),
        ("apple", closed("DEGENERATE_TOROIDAL_SURFACE('',#4,1.,2.,.T.)"), apple),
        ("cone below one loop", below(steep, (2.0, 4.0), ""), 2.0 * PI * 20.0_f64.sqrt()),
        ("cone below a loop and above a vertex", below(steep, (2.0, 4.0), ",#112"), 2.0 * PI * 20.0_f64.sqrt()),
        ("turned line below one loop", below(line, (2.0, 4.0), ""), 2.0 * PI * 20.0_f64.sqrt()),
        (
            "turned parabola below one loop",
            below("SURFACE_OF_REVOLUTION('',#130,#120);\n#130=PARABOLA('',#122,1.)", (4.0, 4.0), ""),
            8.0 * PI / 3.0 * (5.0_f64.powf(1.5) - 1.0),
        ),
        ("ellipse turned about its diameter", turned("ELLIPSE('',#123,2.,3.)", 0.0, "-1."), spheroid),
        ("plane part", trimmed("PLANE('',#4)", "", [1.0, 4.0, -1.0, 1.0]), 6.0),
        ("cylinder part", trimmed("CYLINDRICAL_SURFACE('',#4,2.)", "", [0.5, 2.0, 0.0, 3.0]), 9.0),
        ("cylinder over its seam", trimmed("CYLINDRICAL_SURFACE('',#4,2.)", "", [6.0, 1.0, 0.0, 3.0]), 6.0 * (2.0 * PI - 5.0)),
        ("cone part", trimmed("CONICAL_SURFACE('',#4,2.,0.7853981633974483)", "", [0.0, 1.0, 0.0, 2.0]), 6.0 * 2.0_f64.sqrt()),
        ("sphere part", trimmed("SPHERICAL_SURFACE('',#4,2.)", "", [0.0, 1.0, -0.5, 0.5]), 8.0 * 0.5_f64.sin()),
        (
            "extruded",
            trimmed("SURFACE_OF_LINEAR_EXTRUSION('',#23,#24)", "#23=CIRCLE('',#4,2.);#24=VECTOR('',#2,2.);", [0.0, 1.5, 0.0, 3.0]),
            18.0,
        ),
        (
            "turned",
            trimmed(
                "SURFACE_OF_REVOLUTION('',#23,#25)",
                "#23=LINE('',#24,#26);#24=CARTESIAN_POINT('',(2.,0.,0.));#26=VECTOR('',#2,1.);#25=AXIS1_PLACEMENT('',#1,#2);",
                [0.0, 1.0, 0.0, 3.0],
            ),
            6.0,
        ),
        ("sphere inside", closed("OFFSET_SURFACE('',#120,-1.,.F.);\n#120=SPHERICAL_SURFACE('',#4,3.)"), 16.0 * PI),
        ("torus around", closed("OFFSET_SURFACE('',#120,0.5,.F.);\n#120=TOROIDAL_SURFACE('',#4,5.,2.)"), 4.0 * PI * PI * 12.5),
        (
            "beside an extruded one",
            of(
                "OFFSET_SURFACE('',#19,0.5,.F.)",
                "#19=RECTANGULAR_TRIMMED_SURFACE('',#20,0.,1.5,0.,3.,.T.,.T.);#20=SURFACE_OF_LINEAR_EXTRUSION('',#23,#24);\
                 #23=CIRCLE('',#4,2.);#24=VECTOR('',#2,2.);",
            ),
            22.5,
        ),
        (
            "beside a turned one",
            of(
                "OFFSET_SURFACE('',#19,-0.5,.F.)",
                "#19=RECTANGULAR_TRIMMED_SURFACE('',#20,0.,1.,0.,3.,.T.,.T.);#20=SURFACE_OF_REVOLUTION('',#23,#25);\
                 #23=LINE('',#24,#26);#24=CARTESIAN_POINT('',(2.,0.,0.));#26=VECTOR('',#2,1.);#25=AXIS1_PLACEMENT('',#1,#2);",
            ),
            4.5,
        ),
        ("bezier patch", of(&format!("BEZIER_SURFACE('',1,1,{net},.UNSPECIFIED.,.F.,.F.,.F.)"), others), 12.0),
        (
            "spline patch",
            of(
                &format!("B_SPLINE_SURFACE_WITH_KNOTS('',1,1,{net},.UNSPECIFIED.,.F.,.F.,.F.,(2,2),(2,2),(0.,1.),(0.,2.),.UNSPECIFIED.)"),
                others,
            ),
            12.0,
        ),
        (
            "rational patch",
            of(
                &format!(
                    "(BOUNDED_SURFACE() B_SPLINE_SURFACE(1,1,{net},.UNSPECIFIED.,.F.,.F.,.F.) \
                     B_SPLINE_SURFACE_WITH_KNOTS((2,2),(2,2),(0.,1.),(0.,1.),.UNSPECIFIED.) GEOMETRIC_REPRESENTATION_ITEM() \
                     RATIONAL_B_SPLINE_SURFACE(((1.,1.),(2.,2.))) REPRESENTATION_ITEM('') SURFACE())"
                ),
                others,
            ),
            12.0,
        ),
        (
            "inside a circle",
            of(
                "CURVE_BOUNDED_SURFACE('',#20,(#21),.F.)",
                "#20=PLANE('',#4);#21=BOUNDARY_CURVE('',(#22),.F.);#22=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#23);#23=CIRCLE('',#4,1.);",
            ),
            PI,
        ),
    ]
}

/// The can without the plane of its foot: the circle of the foot spans what is missing at least.
#[test]
fn the_share_of_faces_that_are_missing_is_bounded_by_their_loops() {
    let text = file(&can(".T.").replace("ADVANCED_FACE('foot',(#42),#16,.F.)", "ADVANCED_FACE('foot',(#42),#11,.F.)"), "#21");
    let part = whole(text.as_bytes());
    let Some(Share::AtLeast(share)) = part.share_missing() else { panic!("{:?}", part.share_missing()) };
    // The circle counts as the polygon between places along it.
    assert!(share > 0.12 && share < 1.0 / 7.0, "{share}");
}

/// Surfaces whose profile crosses its axis, bounded by the vertex at this x of the axis of x: their areas, and what is told.
fn across_axes() -> Vec<(&'static str, String, Vec<f64>, &'static str)> {
    let apple = {
        let to = 2.0 * PI / 3.0;
        4.0 * PI * (2.0 * to + 4.0 * to.sin())
    };
    let lemon = 4.0 * PI * (12.0_f64.sqrt() - 2.0 * PI / 3.0);
    let turned = |curve: &str, x: f64, seen: &str, vertex: f64| {
        let text = format!(
            "{FRAME}#5=AXIS1_PLACEMENT('',#1,#2);\n#6=DIRECTION('',(0.,{seen},0.));\n#7=CARTESIAN_POINT('',({x:?},0.,0.));\n\
             #8=AXIS2_PLACEMENT_3D('',#7,#6,#2);\n#9={curve};\n#10=SURFACE_OF_REVOLUTION('',#9,#5);\n\
             #11=CARTESIAN_POINT('',({vertex:?},0.,0.));\n#12=VERTEX_POINT('',#11);\n#13=VERTEX_LOOP('',#12);\n#14=FACE_BOUND('',#13,.T.);\n\
             #15=ADVANCED_FACE('',(#14),#10,.T.);\n#16=OPEN_SHELL('',(#15));\n#17=SHELL_BASED_SURFACE_MODEL('',(#16));\n"
        );
        file(&text, "#17")
    };
    let torus = |vertex: f64| {
        turned("CIRCLE('',#8,2.)", 1.0, "-1.", vertex).replace("SURFACE_OF_REVOLUTION('',#9,#5)", "TOROIDAL_SURFACE('',#4,1.,2.)")
    };
    let circle = "CIRCLE('',#8,2.)";
    let part = |a: f64, b: f64| {
        format!("TRIMMED_CURVE('',#90,(PARAMETER_VALUE({a:?})),(PARAMETER_VALUE({b:?})),.T.,.PARAMETER.);\n#90=CIRCLE('',#8,2.)")
    };
    let spline = "B_SPLINE_CURVE_WITH_KNOTS('',3,(#20,#21,#22,#23),.UNSPECIFIED.,.F.,.F.,(4,4),(0.,1.),.UNSPECIFIED.);\n\
                  #20=CARTESIAN_POINT('',(0.,0.,-3.));\n#21=CARTESIAN_POINT('',(4.,0.,-1.));\n#22=CARTESIAN_POINT('',(-4.,0.,1.));\n\
                  #23=CARTESIAN_POINT('',(0.,0.,3.))";
    let told = "it is ambiguous which is meant; the one that runs up the axis is used";
    // x and z of the spline, by t from 0 to 1/2: that is half of it, and the other half is its image.
    let at = |t: f64| (12.0 * t * (1.0 - t) * (1.0 - 2.0 * t), -3.0 + 6.0 * t);
    let n = 20_000;
    let lobe: f64 = (0..n)
        .map(|k| {
            let ((x, z), (y, w)) = (at(0.5 * f64::from(k) / f64::from(n)), at(0.5 * f64::from(k + 1) / f64::from(n)));
            PI * (x + y) * (y - x).hypot(w - z)
        })
        .sum();
    vec![
        ("outer part", turned(circle, 1.0, "-1.", 0.0), vec![apple], told),
        ("inner part", turned(circle, 1.0, "1.", 0.0), vec![lemon], told),
        ("outer part with a vertex", turned(circle, 1.0, "1.", 3.0), vec![apple], ""),
        ("inner part with a vertex", turned(circle, 1.0, "-1.", -1.0), vec![lemon], ""),
        ("torus over its axis", torus(0.0), vec![apple], told),
        ("its inner part", torus(-1.0), vec![lemon], ""),
        ("all of a circle between parameters", turned(&part(0.3, 0.3 + 2.0 * PI), 1.0, "-1.", 3.0), vec![apple], ""),
        ("half a circle, twice the same dome", turned(&part(-PI / 3.0, PI / 3.0), 0.0, "-1.", 0.0), vec![4.0 * PI], ""),
        ("an arc, one end farther out", turned(&part(-PI / 4.0, PI / 3.0), 0.0, "-1.", 0.0), vec![4.0 * PI], ""),
        ("a spline of two lobes", turned(spline, 0.0, "1.", 0.0), vec![lobe, lobe], ""),
    ]
}

#[test]
fn the_part_that_an_axis_cuts_off_is_chosen_by_what_bounds_it_or_told() {
    for (name, text, area, told) in across_axes() {
        let part = read(text.as_bytes()).unwrap();
        let said: Vec<&str> = part.warnings.iter().map(|w| w.what.as_str()).collect();
        assert!(said.len() == usize::from(!told.is_empty()) && said.iter().all(|w| w.contains(told)), "{name}: {said:?}");
        let found = areas(&part);
        assert!(found.len() == area.len(), "{name}: {found:?}");
        assert!(found.iter().zip(&area).all(|(a, b)| (a / b - 1.0).abs() < 1e-6), "{name}: {found:?} {area:?}");
    }
}

/// A patch between two places of a conic and two more carried there, with its area.
fn patch(surface: &str, corners: [[f64; 3]; 4], sides: [&str; 4]) -> String {
    let mut text = format!("{FRAME}#5=AXIS1_PLACEMENT('',#1,#2);\n#6={surface};\n");
    for (k, [x, y, z]) in corners.iter().enumerate() {
        text += &format!("#{}=CARTESIAN_POINT('',({x:?},{y:?},{z:?}));\n#{}=VERTEX_POINT('',#{});\n", 10 + k, 20 + k, 10 + k);
    }
    for (k, (side, [a, b])) in sides.iter().zip([[0, 1], [1, 2], [3, 2], [0, 3]]).enumerate() {
        let along = if k < 2 { ".T." } else { ".F." };
        text += &format!("#{}={side};\n#{}=EDGE_CURVE('',#{},#{},#{},.T.);\n", 30 + k, 40 + k, 20 + a, 20 + b, 30 + k);
        text += &format!("#{}=ORIENTED_EDGE('',*,*,#{},{along});\n", 50 + k, 40 + k);
    }
    text += "#60=EDGE_LOOP('',(#50,#51,#52,#53));\n#61=FACE_OUTER_BOUND('',#60,.T.);\n#62=ADVANCED_FACE('',(#61),#6,.T.);\n\
             #63=OPEN_SHELL('',(#62));\n#64=SHELL_BASED_SURFACE_MODEL('',(#63));\n";
    file(&text, "#64")
}

#[test]
fn conics_without_ends_reach_as_far_as_what_lies_on_their_surface() {
    // x = t², y = 2 t, carried along (1, 2, 1): its points are far from those of the parabola as seen along z.
    let (h, d) = (30.0, [1.0, 2.0, 1.0]);
    let at = |t: f64, k: f64| [t * t + d[0] * k, 2.0 * t + d[1] * k, d[2] * k];
    let line = |k: usize| format!("LINE('',#{},#7);\n", 10 + k);
    let others = format!(
        "#7=VECTOR('',#8,1.);\n#8=DIRECTION('',(1.,2.,1.));\n#9=PARABOLA('',#4,1.);\n#70=AXIS2_PLACEMENT_3D('',#71,#2,#3);\n\
         #71=CARTESIAN_POINT('',({:?},{:?},{:?}))",
        d[0] * h,
        d[1] * h,
        d[2] * h
    );
    let (first, last) = (line(1), line(0));
    let text = patch(
        &format!("SURFACE_OF_LINEAR_EXTRUSION('',#9,#7);\n{others}"),
        [at(-1.0, 0.0), at(1.0, 0.0), at(1.0, h), at(-1.0, h)],
        ["PARABOLA('',#4,1.)", first.trim_end_matches(";\n"), "PARABOLA('',#70,1.)", last.trim_end_matches(";\n")],
    );
    let part = read(text.as_bytes()).unwrap();
    assert_eq!(part.warnings, []);
    let n = 2000;
    let f = |t: f64| (4.0 + 4.0 * t * t + (4.0 * t - 2.0) * (4.0 * t - 2.0)).sqrt();
    let sum: f64 = (0..n).map(|k| f(-1.0 + (2 * k + 1) as f64 / f64::from(n))).sum();
    let area = h * sum * 2.0 / f64::from(n);
    assert!((areas(&part)[0] / area - 1.0).abs() < 1e-6, "{:?} {area}", areas(&part));
}

#[test]
fn a_cone_reaches_to_either_side_of_its_apex() {
    // Radius 2 at z = 0, the apex at z = -2.
    let text = |entities: &str, bounds: &str| {
        let shell = "#101=OPEN_SHELL('',(#100));\n#102=SHELL_BASED_SURFACE_MODEL('',(#101));\n";
        let cone = "#5=CONICAL_SURFACE('',#4,2.,0.7853981633974483);\n";
        file(&format!("{FRAME}{cone}{entities}#100=ADVANCED_FACE('',({bounds}),#5,.T.);\n{shell}"), "#102")
    };
    let ring = |n: u32, radius: f64, z: f64, sense: &str| {
        format!(
            "#{0}0=CARTESIAN_POINT('',(0.,0.,{z:?}));\n#{0}1=AXIS2_PLACEMENT_3D('',#{0}0,#2,#3);\n#{0}2=CIRCLE('',#{0}1,{radius:?});\n\
             #{0}3=CARTESIAN_POINT('',({radius:?},0.,{z:?}));\n#{0}4=VERTEX_POINT('',#{0}3);\n#{0}5=EDGE_CURVE('',#{0}4,#{0}4,#{0}2,.T.);\n\
             #{0}6=ORIENTED_EDGE('',*,*,#{0}5,{sense});\n#{0}7=EDGE_LOOP('',(#{0}6));\n#{0}8=FACE_BOUND('',#{0}7,.T.);\n",
            n
        )
    };
    let part = read(text(&ring(2, 1.0, -3.0, ".T."), "#28").as_bytes()).unwrap();
    assert_eq!(part.warnings, []);
    assert!((areas(&part)[0] / (PI * 2.0_f64.sqrt()) - 1.0).abs() < 1e-9, "{:?}", areas(&part));
    let both = ring(2, 1.0, -3.0, ".T.") + &ring(3, 3.0, 1.0, ".F.");
    let part = read(text(&both, "#28,#38").as_bytes()).unwrap();
    assert!(areas(&part).is_empty() && part.warnings[0].what.contains("its loops lie on both sides of its apex"), "{:?}", part.warnings);
}

/// A tetrahedron of loops of points without surfaces.
fn faceted() -> String {
    let mut text = String::from(FRAME);
    for (k, p) in ["0.,0.,0.", "1.,0.,0.", "0.,1.,0.", "0.,0.,1."].iter().enumerate() {
        text += &format!("#{}=CARTESIAN_POINT('',({p}));\n", 10 + k);
    }
    for (k, [a, b, c]) in [[10, 12, 11], [10, 11, 13], [11, 12, 13], [12, 10, 13]].iter().enumerate() {
        text += &format!("#{}=POLY_LOOP('',(#{a},#{b},#{c}));\n#{}=FACE_OUTER_BOUND('',#{},.T.);\n", 20 + k, 30 + k, 20 + k);
        text += &format!("#{}=FACE('',(#{}));\n", 40 + k, 30 + k);
    }
    file(&(text + "#50=CLOSED_SHELL('',(#40,#41,#42,#43));\n#51=FACETED_BREP('corner',#50);\n"), "#51")
}

/// A ball with a smaller one as a void.
fn hollow() -> String {
    let ball = |from: u32, radius: f64| {
        let n = |k: u32| from + k;
        format!(
            "#{}=SPHERICAL_SURFACE('',#4,{radius:?});\n#{}=VERTEX_POINT('',#1);\n#{}=VERTEX_LOOP('',#{});\n#{}=FACE_BOUND('',#{},.T.);\n\
             #{}=ADVANCED_FACE('',(#{}),#{},.T.);\n#{}=CLOSED_SHELL('',(#{}));\n",
            n(0),
            n(1),
            n(2),
            n(1),
            n(3),
            n(2),
            n(4),
            n(3),
            n(0),
            n(5),
            n(4)
        )
    };
    let text = format!(
        "{FRAME}{}{}#70=ORIENTED_CLOSED_SHELL('',*,#35,.F.);\n#71=BREP_WITH_VOIDS('shell',#25,(#70));\n",
        ball(20, 3.0),
        ball(30, 2.0)
    );
    file(&text, "#71")
}

/// The can twice by mapped items: once as it is, once lying on its side and moved.
fn mapped() -> String {
    let more = "#70=REPRESENTATION_MAP(#4,#72);\n#72=SHAPE_REPRESENTATION('',(#21),#9002);\n#73=MAPPED_ITEM('stands',#70,#4);\n\
                #74=CARTESIAN_POINT('',(10.,0.,0.));\n#75=AXIS2_PLACEMENT_3D('',#74,#3,#2);\n#76=MAPPED_ITEM('lies',#70,#75);\n";
    file(&(can(".T.") + more), "#73,#76")
}

/// The can with a colour of its own, a face with another, and a layer.
fn painted() -> String {
    let style = |k: u32, of: u32, color: &str| {
        let n = |j: u32| k + j;
        format!(
            "#{}={color};\n#{}=FILL_AREA_STYLE_COLOUR('',#{});\n#{}=FILL_AREA_STYLE('',(#{}));\n#{}=SURFACE_STYLE_FILL_AREA(#{});\n\
             #{}=SURFACE_SIDE_STYLE('',(#{}));\n#{}=SURFACE_STYLE_USAGE(.BOTH.,#{});\n#{}=PRESENTATION_STYLE_ASSIGNMENT((#{}));\n\
             #{}=STYLED_ITEM('',(#{}),#{of});\n",
            n(0),
            n(1),
            n(0),
            n(2),
            n(1),
            n(3),
            n(2),
            n(4),
            n(3),
            n(5),
            n(4),
            n(6),
            n(5),
            n(7),
            n(6)
        )
    };
    let styles = style(100, 21, "COLOUR_RGB('grass',0.,1.,0.)") + &style(200, 53, "DRAUGHTING_PRE_DEFINED_COLOUR('red')");
    file(&(can(".T.") + &styles + "#300=PRESENTATION_LAYER_ASSIGNMENT('lids','',(#43,#53));\n"), "#21")
}

/// All files that are made here.
pub fn all() -> Vec<(&'static str, String)> {
    let listed = curves().into_iter().chain(surfaces()).map(|(name, text, _)| (name, text));
    let others =
        [("can", file(&can(".T."), "#21")), ("faceted", faceted()), ("hollow", hollow()), ("mapped", mapped()), ("painted", painted())];
    listed.chain(others).collect()
}

#[test]
fn curves_are_as_long_as_they_are_described() {
    for (name, text, length) in curves() {
        let part = read(text.as_bytes()).unwrap();
        assert_eq!(part.warnings, [], "{name}");
        let found: Vec<f64> = part.curves.iter().map(|c| c.value.length()).collect();
        assert!(found.len() == 1 && (found[0] / length - 1.0).abs() < 1e-9, "{name}: {found:?} {length}");
    }
}

#[test]
fn surfaces_are_as_large_as_they_are_described() {
    for (name, text, area) in surfaces() {
        let part = read(text.as_bytes()).unwrap();
        assert_eq!(part.warnings, [], "{name}");
        let found = areas(&part);
        assert!(found.len() == 1 && (found[0] / area - 1.0).abs() < 1e-9, "{name}: {found:?} {area}");
    }
}

#[test]
fn faces_look_out_of_their_solid() {
    let ball = surfaces().remove(0).1;
    for (name, text, volume) in [
        ("can", file(&can(".T."), "#21"), 20.0 * PI),
        ("shell", file(&can(".T."), "#60"), 20.0 * PI),
        ("turned shell", file(&can(".F."), "#60"), -20.0 * PI),
        ("mapped", mapped(), 40.0 * PI),
        ("faceted", faceted(), 1.0 / 6.0),
        ("hollow", hollow(), 4.0 / 3.0 * PI * (27.0 - 8.0)),
        ("ball", ball, 36.0 * PI),
    ] {
        let part = read(text.as_bytes()).unwrap();
        assert_eq!(part.warnings, [], "{name}");
        let faces: Vec<_> = part.built.iter().flatten().map(|s| (s.clone(), false)).collect();
        let found = measure::solid(&faces).volume;
        assert!((found / volume - 1.0).abs() < 1e-9, "{name}: {found} {volume}");
    }
}

#[test]
fn names_colours_layers_and_places_are_kept() {
    let part = read(painted().as_bytes()).unwrap();
    let groups: Vec<(&str, usize)> = part.groups.iter().map(|g| (g.name.as_str(), g.surfaces.len())).collect();
    assert_eq!(groups, [("can", 3), ("lids", 2)]);
    assert_eq!((part.solids.len(), part.shells[0].name.as_str()), (1, "skin"));
    let colors: Vec<(&str, usize, [f64; 3])> = part.colors.iter().map(|(g, rgb)| (g.name.as_str(), g.surfaces.len(), *rgb)).collect();
    assert_eq!(colors, [("grass", 2, [0.0, 1.0, 0.0]), ("red", 1, [1.0, 0.0, 0.0])]);
    let part = read(mapped().as_bytes()).unwrap();
    let groups: Vec<(&str, usize)> = part.groups.iter().map(|g| (g.name.as_str(), g.surfaces.len())).collect();
    assert_eq!(groups, [("stands", 3), ("lies", 3)]);
    let lies = part.groups[1].surfaces.iter().flat_map(|k| &part.built[*k]).map(lofting::surface::bbox);
    let bounds = lies.reduce(|a, b| a.union(b)).unwrap();
    assert!(bounds.min.distance(glam::DVec3::new(10.0, -2.0, -2.0)) < 1e-9, "{bounds:?}");
    assert!(bounds.max.distance(glam::DVec3::new(15.0, 2.0, 2.0)) < 1e-9, "{bounds:?}");
}

#[test]
fn lengths_and_angles_are_in_the_units_of_their_context() {
    let text = |unit: &str| in_units(&can(".T."), "#21", unit);
    let inch = "#9001=(CONVERSION_BASED_UNIT('INCH',#9005) LENGTH_UNIT() NAMED_UNIT(#9006));\n\
                #9005=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#9007);\n#9006=DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.);\n\
                #9007=(LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.));";
    for (unit, scale, name) in [
        ("#9001=(LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT($,.METRE.));", 1000.0, "M"),
        ("#9001=(LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.CENTI.,.METRE.));", 10.0, "CM"),
        (inch, 25.4, "IN"),
    ] {
        let part = read(text(unit).as_bytes()).unwrap();
        assert_eq!((part.unit, &part.warnings[..]), (name, &[][..]));
        let side = areas(&part)[0];
        assert!((side / (20.0 * PI * scale * scale) - 1.0).abs() < 1e-9, "{name}: {side}");
    }
    // Degrees, for a cone and a trim.
    let degrees = "#9003=(CONVERSION_BASED_UNIT('DEGREE',#9008) NAMED_UNIT(*) PLANE_ANGLE_UNIT());\n\
                   #9008=PLANE_ANGLE_MEASURE_WITH_UNIT(PLANE_ANGLE_MEASURE(0.0174532925199433),#9009);\n\
                   #9009=(NAMED_UNIT(*) PLANE_ANGLE_UNIT() SI_UNIT($,.RADIAN.));";
    let arc = curves().remove(1).1;
    let arc = arc.replace("#9003=(NAMED_UNIT(*) PLANE_ANGLE_UNIT() SI_UNIT($,.RADIAN.));", degrees);
    let arc = arc.replace("PARAMETER_VALUE(0.5)", "PARAMETER_VALUE(90.)").replace("PARAMETER_VALUE(2.0)", "PARAMETER_VALUE(180.)");
    let length = read(arc.as_bytes()).unwrap().curves[0].value.length();
    assert!((length - PI).abs() < 1e-9, "{length}");
    assert_eq!(OPTIONS.unit, "mm");
}

/// The can with an area, a volume and a centroid that the file states of its product.
fn stated(area: f64, volume: f64, z: f64) -> String {
    let more = format!(
        "#800=PRODUCT('can','can','',());\n#801=PRODUCT_DEFINITION_FORMATION('','',#800);\n#802=PRODUCT_DEFINITION('','',#801,$);\n\
         #803=PRODUCT_DEFINITION_SHAPE('','',#802);\n#804=SHAPE_DEFINITION_REPRESENTATION(#803,#9000);\n\
         #810=DERIVED_UNIT_ELEMENT(#9001,2.);\n#811=DERIVED_UNIT((#810));\n#812=DERIVED_UNIT_ELEMENT(#9001,3.);\n#813=DERIVED_UNIT((#812));\n\
         #820=MEASURE_REPRESENTATION_ITEM('surface area measure',AREA_MEASURE({area:?}),#811);\n\
         #821=REPRESENTATION('surface area',(#820),#9002);\n\
         #822=PROPERTY_DEFINITION('geometric validation property','surface area',#803);\n#823=PROPERTY_DEFINITION_REPRESENTATION(#822,#821);\n\
         #830=MEASURE_REPRESENTATION_ITEM('volume measure',VOLUME_MEASURE({volume:?}),#813);\n#831=REPRESENTATION('volume',(#830),#9002);\n\
         #832=PROPERTY_DEFINITION('geometric validation property','volume',#803);\n#833=PROPERTY_DEFINITION_REPRESENTATION(#832,#831);\n\
         #840=CARTESIAN_POINT('centre point',(0.,0.,{z:?}));\n#841=REPRESENTATION('centroid',(#840),#9002);\n\
         #842=PROPERTY_DEFINITION('geometric validation property','centroid',#803);\n#843=PROPERTY_DEFINITION_REPRESENTATION(#842,#841);\n"
    );
    file(&(can(".T.") + &more), "#21")
}

#[test]
fn figures_that_the_file_states_are_compared() {
    let said = |text: String| read(text.as_bytes()).unwrap().warnings.into_iter().map(|w| w.what).collect::<Vec<String>>();
    let (area, volume) = (28.0 * PI, 20.0 * PI);
    assert_eq!(said(stated(area, volume, 2.5)), Vec::<String>::new());
    assert_eq!(said(stated(1.25 * area, volume, 2.5)), ["#823 can: its area is 87.964594 mm², the file states 109.955743 mm² (-20.00 %)"]);
    assert_eq!(said(stated(area, 0.5 * volume, 2.5)), ["#833 can: its volume is 62.831853 mm³, the file states 31.415927 mm³ (+100.00 %)"]);
    assert_eq!(said(stated(area, volume, 3.0)), ["#843 can: its centroid is 0.500000 mm from where the file states it"]);
}
