"""More parts of the independent kernel: conics turned about an axis, threads, touching holes, cuts through poles and apexes, fillets."""

import math

from OCP.BRepBndLib import BRepBndLib
from OCP.BRepBuilderAPI import BRepBuilderAPI_Copy, BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeVertex
from OCP.BRepFilletAPI import BRepFilletAPI_MakeChamfer, BRepFilletAPI_MakeFillet
from OCP.BRepLib import BRepLib
from OCP.BRepOffsetAPI import BRepOffsetAPI_DraftAngle, BRepOffsetAPI_MakePipeShell, BRepOffsetAPI_ThruSections
from OCP.BRepPrimAPI import BRepPrimAPI_MakeCylinder, BRepPrimAPI_MakeRevol
from OCP.Bnd import Bnd_Box
from OCP.ElCLib import ElCLib
from OCP.GC import GC_MakeArcOfCircle, GC_MakeSegment
from OCP.Geom import (
    Geom_BSplineSurface,
    Geom_ConicalSurface,
    Geom_CylindricalSurface,
    Geom_OffsetSurface,
    Geom_SurfaceOfRevolution,
)
from OCP.Geom2d import Geom2d_Line
from OCP.GeomAPI import GeomAPI_PointsToBSplineSurface
from OCP.Law import Law_Linear
from OCP.ShapeUpgrade import ShapeUpgrade_UnifySameDomain
from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal
from OCP.TColgp import TColgp_Array2OfPnt
from OCP.gp import gp_Ax1, gp_Ax2, gp_Ax3, gp_Circ, gp_Dir, gp_Dir2d, gp_Elips, gp_Hypr, gp_Parab, gp_Pln, gp_Pnt, gp_Pnt2d

from parts import (
    O,
    X,
    Z,
    _hills,
    _side,
    at,
    ball,
    beside,
    box,
    circle,
    common,
    cone,
    cut,
    drop,
    ellipse,
    face,
    faces,
    filleted,
    fuse,
    hilly,
    loft,
    moved,
    offset,
    on_edges,
    polygon,
    prism,
    revolved,
    ring,
    rod,
    s_pipe,
    segment,
    sewn,
    shelled,
    spline,
    turned,
    vase,
    whole,
    wire,
)


def chamfered(shape, d):
    return on_edges(BRepFilletAPI_MakeChamfer(shape), shape, [d])


def var_fillet(shape, r1, r2, chosen):
    return on_edges(BRepFilletAPI_MakeFillet(shape), shape, [r1, r2], chosen)


def helix_edge(r, pitch, turns, cone_angle=0.0):
    if cone_angle:
        s = Geom_ConicalSurface(gp_Ax3(O, Z), cone_angle, r)
    else:
        s = Geom_CylindricalSurface(gp_Ax3(O, Z), r)
    line = Geom2d_Line(gp_Pnt2d(0, 0), gp_Dir2d(2 * math.pi, pitch))
    e = BRepBuilderAPI_MakeEdge(line, s, 0.0, turns * math.hypot(2 * math.pi, pitch)).Edge()
    BRepLib.BuildCurves3d_s(e)
    return e


def helix_sweep(turns, profile_wire, r=10, pitch=6, frenet=True, cone_angle=0.0):
    m = BRepOffsetAPI_MakePipeShell(wire(helix_edge(r, pitch, turns, cone_angle)))
    m.SetMode(frenet)
    m.Add(profile_wire)
    m.Build()
    m.MakeSolid()
    return m.Shape()


def spring():
    return helix_sweep(4, circle(1.5, at(10, 0, 0, (0, 10, 6 / (2 * math.pi)))))


def cone_spring():
    return helix_sweep(3, circle(1.0, at(10, 0, 0, (0, 1, 0.1))), 10, 5, True, 0.3)


def ogive():
    tool = prism(
        face(
            wire(
                spline((-20, 0, 5), (-5, 0, 9), (8, 0, 3), (22, 0, 8)),
                segment((22, 0, 8), (22, 0, 40)),
                segment((22, 0, 40), (-20, 0, 40)),
                segment((-20, 0, 40), (-20, 0, 5)),
            )
        ),
        0,
        60,
        0,
    )
    return cut(ball(15), moved(tool, 0, -30, 0))


def drafted_box():
    b = box(30, 20, 10)
    m = BRepOffsetAPI_DraftAngle(b)
    for f in faces(b)[:4]:
        m.Add(f, Z, math.radians(5), gp_Pln(O, Z))
    m.Build()
    return m.Shape()


def star_wire(n, r1, r2, z=0):
    return polygon(*[((r1 if k % 2 else r2) * math.cos(math.pi * k / n), (r1 if k % 2 else r2) * math.sin(math.pi * k / n), z) for k in range(2 * n)])


def multi_plate():
    """One plane face left in several pieces: one face with several outer loops in IGES? (OCCT splits)."""
    return cut(box(40, 40, 10), box(60, 10, 5, -10, 15, 7))


def perforated_tube():
    t = cut(rod(10, 60), rod(8, 80, at(0, 0, -5)))
    tools = []
    for k in range(6):
        for z in (10, 25, 40):
            a = math.pi / 3 * k + (0.2 if z == 25 else 0)
            tools.append(rod(2, 30, at(0, 0, z, (math.cos(a), math.sin(a), 0))))
    return cut(t, *tools)


def perforated_ball():
    b = cut(ball(15), ball(12))
    dirs = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1), (1, 1, 1), (-1, 1, 1), (1, -1, 1), (1, 1, -1)]
    return cut(b, *[rod(2, 40, at(0, 0, 0, d)) for d in dirs])


def ball_cut_ball():
    return cut(ball(15), ball(8, at(9, 3, 11)))


def ball_tangent_rod():
    return cut(ball(15), rod(7.5, 60, at(7.5, 0, -30)))


def viviani_in():
    return common(ball(15), rod(7.5, 60, at(7.5, 0, -30)))


def torus_cut_torus():
    return cut(ring(20, 6), ring(20, 4, at(20, 0, 0, (1, 0, 0))))


def torus_spindle():
    return BRepPrimAPI_MakeRevol(
        face(
            wire(
                BRepBuilderAPI_MakeEdge(gp_Circ(gp_Ax2(gp_Pnt(3, 0, 0), gp_Dir(0, -1, 0)), 5), gp_Pnt(0, 0, -4), gp_Pnt(0, 0, 4)).Edge(),
                segment((0, 0, 4), (0, 0, -4)),
            )
        ),
        gp_Ax1(O, Z),
    ).Shape()


def lemon():
    return BRepPrimAPI_MakeRevol(
        face(
            wire(
                BRepBuilderAPI_MakeEdge(gp_Circ(gp_Ax2(gp_Pnt(-3, 0, 0), gp_Dir(0, -1, 0)), 5), gp_Pnt(0, 0, -4), gp_Pnt(0, 0, 4)).Edge(),
                segment((0, 0, 4), (0, 0, -4)),
            )
        ),
        gp_Ax1(O, Z),
    ).Shape()


def pipe_aux():
    m = BRepOffsetAPI_MakePipeShell(wire(segment((0, 0, 0), (0, 0, 40))))
    m.SetMode(wire(helix_edge(20, 40, 1)), True)
    m.Add(polygon((-5, -5, 0), (5, -5, 0), (5, 5, 0), (-5, 5, 0)))
    m.Build()
    m.MakeSolid()
    return m.Shape()


def pipe_law():
    m = BRepOffsetAPI_MakePipeShell(wire(spline((0, 0, 0), (0, 5, 15), (0, 0, 40))))
    law = Law_Linear()
    law.Set(0, 1, 1, 0.4)
    m.SetLaw(circle(6), law)
    m.Build()
    m.MakeSolid()
    return m.Shape()


def rev_of_line_skew():
    """Hyperboloid: a skew line revolved (as a revolution surface)."""
    c = GC_MakeSegment(gp_Pnt(8, 0, 0), gp_Pnt(0, 8, 20)).Value()
    return whole(Geom_SurfaceOfRevolution(c, gp_Ax1(O, Z)), 0.0, 2 * math.pi, 0.0, 10.0)


def rev_of_ellipse():
    prof = BRepBuilderAPI_MakeEdge(gp_Elips(gp_Ax2(O, gp_Dir(0, -1, 0), X), 12, 7), gp_Pnt(0, 0, -7), gp_Pnt(0, 0, 7)).Edge()
    return revolved(face(wire(prof, segment((0, 0, 7), (0, 0, -7)))))


def ellipsoid_cut():
    return cut(rev_of_ellipse(), rod(3, 40, at(0, 0, -20, (0.3, 0.2, 1))))


def ellipsoid_seam_cut():
    return cut(rev_of_ellipse(), rod(2, 40, at(0, 0, 1, (1, 0, 0))))


def rev_torus_of_ellipse():
    return revolved(face(ellipse(6, 3, gp_Ax2(gp_Pnt(20, 0, 0), gp_Dir(0, -1, 0), X))))


def rev_ell_tilted_cut():
    return cut(rev_torus_of_ellipse(), turned(box(80, 80, 80, 0, -40, -40), (0, 0, 1), 37), rod(2.5, 60, at(-20, 0, -30, (0.1, 0, 1))))


def parab_dish():
    c = BRepBuilderAPI_MakeEdge(gp_Parab(gp_Ax2(O, gp_Dir(0, -1, 0), gp_Dir(0, 0, 1)), 5.0), gp_Pnt(0, 0, 0), gp_Pnt(20, 0, 20)).Edge()
    return revolved(face(wire(c, segment((20, 0, 20), (0, 0, 20)), segment((0, 0, 20), (0, 0, 0)))))


def hyper_bell():
    h = gp_Hypr(gp_Ax2(O, gp_Dir(0, -1, 0), gp_Dir(1, 0, 0)), 5.0, 4.0)
    p1, p2 = (ElCLib.Value_s(-1.2, h), ElCLib.Value_s(1.2, h))
    c = BRepBuilderAPI_MakeEdge(h, -1.2, 1.2).Edge()
    t = lambda p: (p.X(), p.Y(), p.Z())
    a, b = (t(p1), t(p2))
    return revolved(face(wire(c, segment(b, (0, 0, b[2])), segment((0, 0, b[2]), (0, 0, a[2])), segment((0, 0, a[2]), a))))


def offset_rev_trim():
    f = beside(Geom_SurfaceOfRevolution(_side(), gp_Ax1(O, Z)), 1.0, 0.3, 2.8, 0.1, 0.9)
    return cut(f, prism(face(circle(3, at(0, 0, 20, (0, 1, 0)))), 0, 40, 0))


def offset_cone():
    return beside(Geom_ConicalSurface(gp_Ax3(O, Z), 0.4, 6.0), 1.0, 0.0, 2 * math.pi, 0.0, 15.0)


def offset_offset():
    s = Geom_OffsetSurface(GeomAPI_PointsToBSplineSurface(_hills()).Surface(), 1.0)
    return whole(Geom_OffsetSurface(s, 0.7))


def thick_loft():
    l = loft(polygon((-8, -8, 0), (8, -8, 0), (8, 8, 0), (-8, 8, 0)), polygon((-5, -5, 20), (5, -5, 20), (5, 5, 20), (-5, 5, 20)))
    return shelled(l, [5], -1.0)


def _flat_at(f, z):
    b = Bnd_Box()
    BRepBndLib.Add_s(f, b)
    lo, hi = (b.CornerMin(), b.CornerMax())
    return abs(lo.Z() - z) < 0.001 and abs(hi.Z() - z) < 0.001


def occ_bottle():
    """The OCCT tutorial bottle body, roughly: base profile prism filleted, neck, shelled, thread left out."""
    h, w, t = (70.0, 50.0, 30.0)
    a = GC_MakeArcOfCircle(gp_Pnt(-w / 2, -t / 4, 0), gp_Pnt(0, -t / 2, 0), gp_Pnt(w / 2, -t / 4, 0)).Value()
    b = GC_MakeArcOfCircle(gp_Pnt(w / 2, t / 4, 0), gp_Pnt(0, t / 2, 0), gp_Pnt(-w / 2, t / 4, 0)).Value()
    prof = wire(
        BRepBuilderAPI_MakeEdge(a).Edge(),
        segment((w / 2, -t / 4, 0), (w / 2, t / 4, 0)),
        BRepBuilderAPI_MakeEdge(b).Edge(),
        segment((-w / 2, t / 4, 0), (-w / 2, -t / 4, 0)),
    )
    body = filleted(prism(face(prof), 0, 0, h), t / 12)
    neck = rod(t / 4, h / 10, at(0, 0, h))
    body = fuse(body, neck)
    tops = [k for k, f in enumerate(faces(body)) if _flat_at(f, h + h / 10)]
    return shelled(body, tops, -t / 50)


def multi_shell_void():
    return cut(box(40, 20, 20), ball(5, at(10, 10, 10)), ball(4, at(30, 10, 10)), box(4, 4, 4, 18, 8, 8))


def sewn_cyl():
    c = rod(10, 30)
    return sewn(*[BRepBuilderAPI_Copy(f).Shape() for f in faces(c)])


def unified():
    b = fuse(box(10, 10, 10), box(10, 10, 10, 10), rod(5, 10, at(10, 5, 5)))
    u = ShapeUpgrade_UnifySameDomain(b, True, True, True)
    u.Build()
    return u.Shape()


def ball_pole_touch():
    """A circle hole whose border passes through the pole and a second across the seam."""
    return cut(ball(15), rod(4, 20, at(0, 4, 0)), rod(3, 40, at(10, 0, -20)))


def ball_thin_wedge():
    return common(ball(12), BRepPrimAPI_MakeCylinder(at(), 20.0, 15.0, 0.05).Shape())


def cone_hole_seam():
    return cut(cone(12, 3, 30), rod(2, 40, at(0, 0, 12, (1, 0, 0))))


def cone_hole_apex():
    return cut(cone(10, 0, 20), rod(1, 40, at(0, 0, -5)))


def cone_plane_apex():
    return cut(cone(10, 0, 20), turned(box(60, 60, 60, -30, -30, 0), (0, 1, 0), 63.4349488))


def double_cone():
    return fuse(cone(10, 0, 20), cone(0, 10, 20, at(0, 0, 20)))


def rod_half_slot():
    return cut(rod(10, 30), box(30, 3, 20, 0, -1.5, 15))


def keyway():
    return cut(rod(10, 50), fuse(box(20, 4, 6, -10 + 0, -2, 7), rod(2, 6, at(-10, 0, 7)), rod(2, 6, at(10, 0, 7))))


def cross_rods():
    return fuse(rod(5, 40, at(0, 0, -20)), rod(5, 40, at(-20, 0, 0, (1, 0, 0))), rod(5, 40, at(0, -20, 0, (0, 1, 0))))


def steinmetz():
    return common(rod(5, 40, at(0, 0, -20)), rod(5, 40, at(-20, 0, 0, (1, 0, 0))))


def nested_lofts():
    return loft(circle(8), star_wire(6, 8, 5, 20), circle(4, at(0, 0, 40)))


def loft_point():
    m = BRepOffsetAPI_ThruSections(True, False)
    m.AddWire(polygon((-8, -8, 0), (8, -8, 0), (8, 8, 0), (-8, 8, 0)))
    m.AddVertex(BRepBuilderAPI_MakeVertex(gp_Pnt(0, 0, 20)).Vertex())
    m.Build()
    return m.Shape()


def loft_point_smooth():
    m = BRepOffsetAPI_ThruSections(True, False)
    m.AddVertex(BRepBuilderAPI_MakeVertex(gp_Pnt(0, 0, -10)).Vertex())
    m.AddWire(circle(8))
    m.AddWire(circle(6, at(2, 0, 10)))
    m.AddVertex(BRepBuilderAPI_MakeVertex(gp_Pnt(0, 0, 20)).Vertex())
    m.Build()
    return m.Shape()


def loft_many():
    return loft(*[ellipse(9 + 2 * math.sin(k), 5 + 1.5 * math.cos(k), at(math.sin(k / 2) * 3, 0, 5 * k)) for k in range(8)])


def loft_ruled_many():
    return loft(*[star_wire(5, 8, 4 + k % 2, 6 * k) for k in range(4)], ruled=True)


def wing():

    def foil(c, x, y, z):
        up = [(1, 0.01), (0.8, 0.04), (0.5, 0.08), (0.2, 0.09), (0.05, 0.05), (0, 0)]
        lo = [(0, 0), (0.05, -0.03), (0.2, -0.05), (0.5, -0.05), (0.8, -0.03), (1, -0.01)]
        return wire(
            spline(*[(x + c * a, y, z + c * b) for a, b in up]),
            spline(*[(x + c * a, y, z + c * b) for a, b in lo]),
            segment((x + c, y, z - 0.01 * c), (x + c, y, z + 0.01 * c)),
        )

    return loft(foil(30, 0, 0, 0), foil(22, 8, 40, 2), foil(12, 18, 80, 8))


def degree_surface():
    """B-spline of degree 11 x 7 with uneven knots."""
    du, dv = (11, 7)
    nu, nv = (du + 1 + 2, dv + 1 + 3)
    P = TColgp_Array2OfPnt(1, nu, 1, nv)
    for i in range(nu):
        for j in range(nv):
            P.SetValue(i + 1, j + 1, gp_Pnt(3 * i, 3 * j, 2 * math.sin(i * 0.8 + j * 0.5)))

    def arr(ks, ms):
        K = TColStd_Array1OfReal(1, len(ks))
        M = TColStd_Array1OfInteger(1, len(ms))
        for k, x in enumerate(ks):
            K.SetValue(k + 1, x)
        for k, x in enumerate(ms):
            M.SetValue(k + 1, x)
        return (K, M)

    Ku, Mu = arr([0, 0.1, 0.7, 1], [du + 1, 1, 1, du + 1])
    Kv, Mv = arr([0, 0.02, 5, 9, 10], [dv + 1, 1, 1, 1, dv + 1])
    return whole(Geom_BSplineSurface(P, Ku, Kv, Mu, Mv, du, dv))


def degree_cut():
    return cut(degree_surface(), prism(face(circle(5, at(18, 15, -20))), 0, 0, 40))


def hills_many():
    return cut(hilly(), *[prism(face(circle(2, at(8 + 8 * i, 6 + 9 * j, -10))), 0, 0, 20) for i in range(4) for j in range(3)])


def slab_hills():
    return prism(hilly(), 0, 0, 10)


def rotor():
    body = fuse(rod(12, 20), *[turned(box(15, 2, 16, 10, -1, 2), (0, 0, 1), 60 * k) for k in range(6)])
    return body


def helical_gear():
    m = BRepOffsetAPI_MakePipeShell(wire(segment((0, 0, 0), (0, 0, 10))))
    m.SetMode(wire(helix_edge(20, 60, 10 / 60)), True)
    m.Add(star_wire(8, 12, 9))
    m.Build()
    m.MakeSolid()
    return m.Shape()


def fillet_ball_box():
    return filleted(fuse(box(30, 30, 10, -15, -15), ball(9, at(0, 0, 10))), 1.5)


def fillet_var():
    return var_fillet(box(30, 20, 10), 1.0, 4.0, {0, 2, 5})


def fillet_hole():
    return filleted(cut(box(40, 40, 10), rod(8, 30, at(20, 20, -5))), 1.0)


def chamf_box():
    return chamfered(box(30, 20, 10), 2.0)


def chamf_hole():
    return chamfered(cut(box(40, 40, 10), rod(8, 30, at(20, 20, -5))), 1.0)


def offset_boss():
    return offset(fuse(box(40, 40, 10, -20, -20), rod(8, 30)), 1.0)


def cyl_many_turns():
    return whole(Geom_CylindricalSurface(gp_Ax3(O, Z), 10.0), -20.0, -20.0 + 3.0, 0.0, 12.0)


def cone_patch_apex():
    return whole(Geom_ConicalSurface(gp_Ax3(O, Z), 0.5, 0.0), 0.3, 3.0, 0.0, 15.0)


def cone_patch_neg():
    return whole(Geom_ConicalSurface(gp_Ax3(O, Z), -0.4, 8.0), 5.0, 8.0, 0.0, 12.0)


def torus_all_ways():
    return cut(
        ring(20, 6), rod(2, 80, at(0, 0, -40, (0, 0, 1))), rod(2, 60, at(0, 0, 0, (1, 0, 0))), rod(2, 60, at(20, 0, -30)), rod(2, 60, at(-20, 0, -30))
    )


def torus_slice():
    return common(ring(20, 6), BRepPrimAPI_MakeCylinder(at(), 40.0, 40.0, 1.0).Shape())


def torus_villarceau():
    a = math.degrees(math.asin(6 / 20))
    return cut(ring(20, 6), turned(box(100, 100, 50, -50, -50, 0), (1, 0, 0), a))


def torus_tangent_plane():
    return cut(ring(20, 6), box(100, 100, 50, 14, -50, -25))


def thin_washers():
    return cut(rod(30, 0.1), rod(10, 1, at(0, 0, -0.5)))


def long_pipe():
    return cut(rod(1, 2000), rod(0.9, 2100, at(0, 0, -5)))


def bspl_closed_loft():
    return cut(loft(circle(8), circle(5, at(0, 0, 12)), circle(9, at(3, 0, 25))), rod(2, 60, at(0, 0, 12, (1, 0, 0))))


def pipe_cut():
    return cut(s_pipe(), box(60, 60, 60, -30, 0.5, 10))


def vase_cut():
    return cut(vase(), rod(3, 60, at(0, 0, 20, (1, 0, 0))), turned(box(60, 60, 60, -30, -30, 35), (0, 1, 0), 10))


def drop_cut():
    return cut(drop(), rod(2, 60, at(1.5, 0, -30)))


def drop_half():
    return cut(drop(), box(60, 60, 60, 0, -30, -30))


# Name and maker of each.
PARTS = [
    (maker.__name__, maker)
    for maker in [
        spring,
        cone_spring,
        ogive,
        drafted_box,
        multi_plate,
        perforated_tube,
        perforated_ball,
        ball_cut_ball,
        ball_tangent_rod,
        viviani_in,
        torus_cut_torus,
        torus_spindle,
        lemon,
        pipe_aux,
        pipe_law,
        rev_of_line_skew,
        rev_of_ellipse,
        ellipsoid_cut,
        ellipsoid_seam_cut,
        rev_torus_of_ellipse,
        rev_ell_tilted_cut,
        parab_dish,
        hyper_bell,
        offset_rev_trim,
        offset_cone,
        offset_offset,
        thick_loft,
        occ_bottle,
        multi_shell_void,
        sewn_cyl,
        unified,
        ball_pole_touch,
        ball_thin_wedge,
        cone_hole_seam,
        cone_hole_apex,
        cone_plane_apex,
        double_cone,
        rod_half_slot,
        keyway,
        cross_rods,
        steinmetz,
        nested_lofts,
        loft_point,
        loft_point_smooth,
        loft_many,
        loft_ruled_many,
        wing,
        degree_cut,
        hills_many,
        slab_hills,
        rotor,
        helical_gear,
        fillet_ball_box,
        fillet_var,
        fillet_hole,
        chamf_box,
        chamf_hole,
        offset_boss,
        cyl_many_turns,
        cone_patch_apex,
        cone_patch_neg,
        torus_all_ways,
        torus_slice,
        torus_villarceau,
        torus_tangent_plane,
        thin_washers,
        long_pipe,
        bspl_closed_loft,
        pipe_cut,
        vase_cut,
        drop_cut,
        drop_half,
    ]
]
