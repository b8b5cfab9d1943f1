//! STEP files made in tests: entities in, clear text out.

/// A file of these entities, lines `#1=NAME(…);`, around a representation in millimetres with these items.
///
/// Numbers from 9000 on are taken.
pub fn file(entities: &str, items: &str) -> String {
    in_units(entities, items, "#9001=(LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.));")
}

/// The same with a unit of length #9001 of its own.
pub fn in_units(entities: &str, items: &str, unit: &str) -> String {
    format!(
        "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\nFILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\n\
         ENDSEC;\nDATA;\n{entities}\n#9000=SHAPE_REPRESENTATION('',({items}),#9002);\n{unit}\n\
         #9002=(GEOMETRIC_REPRESENTATION_CONTEXT(3) GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#9004)) \
         GLOBAL_UNIT_ASSIGNED_CONTEXT((#9001,#9003)) REPRESENTATION_CONTEXT('',''));\n\
         #9003=(NAMED_UNIT(*) PLANE_ANGLE_UNIT() SI_UNIT($,.RADIAN.));\n\
         #9004=UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-05),#9001,'distance_accuracy_value','');\nENDSEC;\nEND-ISO-10303-21;\n"
    )
}

/// A point and a frame: `#1` the origin, `#2` z, `#3` x, `#4` the placement.
pub const FRAME: &str = "#1=CARTESIAN_POINT('',(0.,0.,0.));\n#2=DIRECTION('',(0.,0.,1.));\n#3=DIRECTION('',(1.,0.,0.));\n\
                         #4=AXIS2_PLACEMENT_3D('',#1,#2,#3);\n";

/// A cylinder of radius 2 from z = 0 to 5 in a shell #20, named by #21.
pub fn can(sense: &str) -> String {
    format!(
        "{FRAME}#5=CARTESIAN_POINT('',(0.,0.,5.));\n#6=AXIS2_PLACEMENT_3D('',#5,#2,#3);\n#7=CARTESIAN_POINT('',(2.,0.,0.));\n\
         #8=CARTESIAN_POINT('',(2.,0.,5.));\n#9=VERTEX_POINT('',#7);\n#10=VERTEX_POINT('',#8);\n#11=CIRCLE('',#4,2.);\n#12=CIRCLE('',#6,2.);\n\
         #13=EDGE_CURVE('',#9,#9,#11,.T.);\n#14=EDGE_CURVE('',#10,#10,#12,.T.);\n#15=CYLINDRICAL_SURFACE('',#4,2.);\n#16=PLANE('',#4);\n\
         #17=PLANE('',#6);\n#18=VECTOR('',#2,1.);\n#19=LINE('',#7,#18);\n\
         #22=EDGE_CURVE('',#9,#10,#19,.T.);\n\
         #30=ORIENTED_EDGE('',*,*,#13,.T.);\n#31=ORIENTED_EDGE('',*,*,#22,.T.);\n#32=ORIENTED_EDGE('',*,*,#14,.F.);\n\
         #33=ORIENTED_EDGE('',*,*,#22,.F.);\n#34=EDGE_LOOP('',(#30,#31,#32,#33));\n#35=FACE_OUTER_BOUND('',#34,.T.);\n\
         #36=ADVANCED_FACE('side',(#35),#15,.T.);\n\
         #40=ORIENTED_EDGE('',*,*,#13,.F.);\n#41=EDGE_LOOP('',(#40));\n#42=FACE_OUTER_BOUND('',#41,.T.);\n#43=ADVANCED_FACE('foot',(#42),#16,.F.);\n\
         #50=ORIENTED_EDGE('',*,*,#14,.T.);\n#51=EDGE_LOOP('',(#50));\n#52=FACE_OUTER_BOUND('',#51,.T.);\n#53=ADVANCED_FACE('head',(#52),#17,.T.);\n\
         #20=CLOSED_SHELL('skin',(#36,#43,#53));\n#60=ORIENTED_CLOSED_SHELL('',*,#20,{sense});\n#21=MANIFOLD_SOLID_BREP('can',#20);\n"
    )
}
