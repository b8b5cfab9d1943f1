#!/usr/bin/env python3
"""Random valid loft models of ten families with closed-form results.

joints.py [--loft PATH] [--seed N] [--count N] [--family NAME] [--jobs N]
Case i of a family has the seed N*100000+i. Failing scripts go to FOLDER/<family>-<seed>.loft (`--fail FOLDER`). Needs numpy and shapely.
Each script reports what is asked under a label; the expected values stand in its first lines."""
import argparse, json, math, os, random, subprocess, sys, tempfile, time
from concurrent.futures import ThreadPoolExecutor
from collections import Counter
import numpy as np
from shapely.geometry import Polygon

pi = math.pi
def f(x):
    s = f"{x:.3f}".rstrip("0").rstrip(".")
    return "0" if s in ("-0", "") else s
def P(p): return "(" + ", ".join(f(c) for c in p) + ")"
def PL(ps): return "[" + ", ".join(P(p) for p in ps) + "]"
def rd(r, a, b, d=1): return round(r.uniform(a, b), d)
V = lambda *a: np.array(a, float)
norm = np.linalg.norm
def poly(ps): return f"plane(polyline({PL(ps)}, closed: true))"

def frame(d):
    d = d / norm(d)
    a = V(0, 0, 1) if abs(d[2]) < 0.9 else V(1, 0, 0)
    e1 = np.cross(a, d); e1 /= norm(e1)
    return d, e1, np.cross(d, e1)

def spectral(y, th):
    n = len(y); k = np.fft.fftfreq(n, 1 / n)
    return np.real(np.fft.ifft(1j * k * np.fft.fft(y)))

# ---- 1 tubes on tubes
def tubes(r):
    while True:
        R = rd(r, 10, 60); s = rd(r, 0.1 * R, 0.8 * R)
        off = r.choice([0, 0, rd(r, -R, R)]); h = r.choice([0, rd(r, -20, 20)])
        k = r.randrange(3)  # perpendicular along x, turned about z, oblique
        if k == 0: d = V(r.choice([1, -1]), 0, 0)
        elif k == 1: d = V(rd(r, -1, 1, 2), rd(r, -1, 1, 2), 0)
        else: d = V(rd(r, -1, 1, 2), rd(r, -1, 1, 2), rd(r, -0.7, 0.7, 2))
        if math.hypot(d[0], d[1]) < 0.5: continue
        L = rd(r, 1.3 * R, 3 * R)
        n2 = norm(d); by = np.round(d / n2 * L, 1 if k else 3)
        d, e1, e2 = frame(by); L = norm(by)
        # offset point: perpendicular to d, horizontal
        hz = V(-d[1], d[0], 0) / math.hypot(d[0], d[1])
        c = np.round(hz * off + V(0, 0, h), 2)
        th = np.arange(4096) * 2 * pi / 4096
        p = c + s * (np.outer(np.cos(th), e1) + np.outer(np.sin(th), e2))
        if np.max(np.hypot(p[:, 0], p[:, 1])) > 0.97 * R: continue
        q = p + by
        if np.min(np.hypot(q[:, 0], q[:, 1])) < 1.03 * R: continue
        # the widest ruling must leave big across: |offset| + s < R
        offs = abs(np.dot(c, hz)) + s
        if offs > 0.97 * R: continue
        A = d[0]**2 + d[1]**2; B = p[:, 0]*d[0] + p[:, 1]*d[1]; C = p[:, 0]**2 + p[:, 1]**2 - R*R
        t = (-B + np.sqrt(B*B - A*C)) / A
        if np.max(t) > 0.98 * L: continue
        break
    X = p + t[:, None] * d
    H = math.ceil(np.max(np.abs(X[:, 2])) + rd(r, 5, 30))
    w = 2 * pi / 4096
    out = s * np.sum(L - t) * w; small = 2 * pi * s * L; big = 2 * pi * R * 2 * H
    D = np.stack([spectral(X[:, i], th) for i in range(3)], 1)
    length = np.sum(norm(D, axis=1)) * w
    phi = np.arctan2(X[:, 1], X[:, 0]); phi = np.unwrap(phi)
    hole = R * abs(np.sum(spectral(X[:, 2], th) * phi) * w)
    form = r.choice(["small", "big", "imprint", "meet", "split"])
    st = f"start: {P(np.round(c + 0, 3))}"
    src = [f"surface big = extrude(circle(center: (0, 0, {-H}), radius: {f(R)}), by: (0, 0, {2*H}))",
           f"surface small = extrude(circle(center: {P(c)}, radius: {f(s)}, normal: {P(by)}), by: {P(by)})"]
    if form == "small":
        src += [f"surface t = trim(small, by: big, keep: small.at(1, 0.3))", 'report "area": t.area']; ex = {"area": out}
    elif form == "big":
        keep = f"big.at(0, 0.3)"
        src += [f"surface t = trim(big, by: small, keep: {keep})", 'report "area": t.area']; ex = {"area": big - hole}
    elif form == "imprint":
        src += ["let p = imprint(big, small)", 'report "count": len(p)', 'report "sum": sum([for q in p: area(q)])']
        ex = {"count": 4, "sum": big + small}
    elif form == "split":
        src += ["let p = split(small, by: big)", 'report "count": len(p)', 'report "sum": sum([for q in p: area(q)])', 'report "most": max([for q in p: area(q)])']
        ex = {"count": 2, "sum": small, "most": max(out, small - out)}
    else:
        src += ["let m = meet(big, small)", 'report "count": len(m)', 'report "length": sum([for q in m: length(q)])']; ex = {"count": 1, "length": length}
    return form, src, ex

# ---- 2 ribs
def rect_src(r, ps):
    k = r.randrange(3)
    if k == 0: return poly(ps)
    if k == 1: return "plane([" + ", ".join(f"line({P(ps[i])}, {P(ps[(i+1)%4])})" for i in range(4)) + "])"
    return f"extrude(line({P(ps[0])}, {P(ps[1])}), by: {P(np.array(ps[3]) - np.array(ps[0]))})"
def ribs(r):
    g = r.choice([1, 10, 50])
    w = g * r.randint(4, 60); l = g * r.randint(4, 60); h = r.choice([w, l, g * r.randint(2, 40)])
    z = g * r.randint(-30, 30)
    x0 = r.choice([-w / 2, 0, g * r.randint(-20, 20)]); y0 = r.choice([-l / 2, 0, g * r.randint(-20, 20)])
    base = [(x0, y0, z), (x0 + w, y0, z), (x0 + w, y0 + l, z), (x0, y0 + l, z)]
    where = r.choice(["full", "full", "inside", "side", "over", "through"])
    y = y0 + (l * r.randint(1, 9)) // 10
    if not y0 < y < y0 + l: y = y0 + l / 2
    a, b, z1, z2 = x0, x0 + w, z, z + r.choice([1, -1]) * h
    if where == "inside":
        a = x0 + w * r.choice([0.1, 0.25, 0.3]); b = x0 + w * r.choice([0.5, 0.7, 0.75])
        if r.random() < .3: a = x0
    if where == "over": a, b = x0 - g * r.randint(0, 5), x0 + w + g * r.randint(1, 9)
    if where == "through": z1, z2 = z - g * r.randint(1, 20), z + g * r.randint(1, 20)
    if where == "side": y = r.choice([y0, y0 + l])
    rib = [(a, y, z2), (b, y, z2), (b, y, z1), (a, y, z1)]
    k = r.randrange(4); rib = rib[k:] + rib[:k]
    if r.random() < .5: rib.reverse()
    if r.random() < .5:  # the other way round
        sw = lambda ps: [(q[1], q[0], q[2]) for q in ps]; base, rib = sw(base), sw(rib)
    L = min(b, x0 + w) - max(a, x0)
    S = w * l + (b - a) * abs(z2 - z1)
    src = [f"surface base = {rect_src(r, base)}", f"surface rib = {rect_src(r, rib)}"]
    form = r.choice(["meet", "mesh", "imprint"])
    if form == "meet": src += ["curve foot = base & rib", 'report "length": foot.length']; ex = {"length": L}
    elif form == "mesh":
        src += [f"mesh m of base, rib {{ size: {f(max(w, l) / 8)}mm imprint: true }}", 'report "area": m.area']; ex = {"area": S}
    else:
        src += ["let p = imprint(base, rib)", 'report "sum": sum([for q in p: area(q)])', 'report "count": len(p)']
        n = (1 if where in ("inside", "side") else 2) + (2 if where == "through" else 1)
        ex = {"sum": S, "count": n}
    return form + " " + where, src, ex

# ---- 3 slices
def unitish(r, d=2):
    while True:
        n = V(rd(r, -1, 1, d), rd(r, -1, 1, d), rd(r, -1, 1, d))
        if norm(n) > 0.3: return n
def slices(r):
    kind = r.choice(["ball", "ball", "zone", "cylinder", "cone"])
    form = r.choice(["trim", "split", "imprint"])
    if kind in ("ball", "zone"):
        R = rd(r, 5, 100); c = V(*(r.choice([0, rd(r, -50, 50)]) for _ in range(3)))
        body = f"move(revolve(arc((0, 0, {f(-R)}), (0, 0, {f(R)}), through: ({f(R)}, 0, 0))), by: {P(c)})"
        if r.random() < .5:
            body = f"revolve(arc({P(c - V(0,0,R))}, {P(c + V(0,0,R))}, through: {P(c + V(R,0,0))}), axis: (0, 0, 1), about: {P(c)})"
        n = unitish(r)
        if r.random() < .25: n = V(*r.choice([(1, 0, 0), (0, 1, 0), (0, 0, 1)]))
        u = n / norm(n)
        if kind == "ball":
            at = np.round(c + u * R * r.uniform(-.9, .9), 1); s = np.dot(at - c, u)
            if abs(s) > 0.95 * R: at = c; s = 0
            src = [f"surface body = {body}"]; cut = f"plane(at: {P(at)}, normal: {P(n)})"
            hi = 2 * pi * R * (R - s); lo = 2 * pi * R * (R + s); tot = hi + lo
            kp = c + u * R
        else:
            at = np.round(c + u * R * r.uniform(.05, .85), 1); a2 = np.round(c - u * R * r.uniform(.05, .85), 1)
            s, s2 = np.dot(at - c, u), np.dot(a2 - c, u)
            src = [f"surface body = {body}"]; form = "zone"
            e = frame(u)[1]
            src += [f"surface t = trim(body, by: [plane(at: {P(at)}, normal: {P(n)}), plane(at: {P(a2)}, normal: {P(n)})], keep: body.nearest)"]
            src[-1] = src[-1].replace("body.nearest", "(" + ", ".join(f"{x:.9f}" for x in (c + e * math.sqrt(R*R - ((s+s2)/2)**2) + u * (s+s2)/2)) + ")")
            src += ['report "area": t.area']
            return "zone", src, {"area": 2 * pi * R * (s - s2)}
    elif kind == "cylinder":
        R = rd(r, 5, 60); H = rd(r, 2 * R, 5 * R); c = V(*(r.choice([0, rd(r, -50, 50)]) for _ in range(2)), 0)
        z = rd(r, .4, .6) * H; n = V(rd(r, -.6, .6, 2), rd(r, -.6, .6, 2), 1)
        while math.hypot(n[0], n[1]) * R > .38 * H: n = V(rd(r, -.6, .6, 2), rd(r, -.6, .6, 2), 1)
        at = np.round(c + V(0, 0, z), 2)
        src = [f"surface body = extrude(circle(center: {P(c)}, radius: {f(R)}), by: (0, 0, {f(H)}))"]
        cut = f"plane(at: {P(at)}, normal: {P(n)})"
        lo = 2 * pi * R * at[2]; hi = 2 * pi * R * (H - at[2]); tot = lo + hi; kp = c + V(R, 0, H)
    else:
        R = rd(r, 5, 60); H = rd(r, 5, 150); k = R / H
        while True:
            p, q = rd(r, -.6, .6, 2), rd(r, -.6, .6, 2); m = math.hypot(p, q)
            h = rd(r, .2, .7) * H
            # z = H - h + p x + q y ; stays above z=0 on the cone
            if k * m < .8 and k * h / (1 - k * m) < .93 * R: break
        at = V(0, 0, round(H - h, 2)); h = H - at[2]; n = V(-p, -q, 1)
        l = k * h; e = k * m
        area = pi * l * l / (1 - e * e) ** 1.5
        sa = R / math.hypot(R, H)
        hi = area / sa; tot = pi * R * R / sa; lo = tot - hi
        src = [f"surface body = revolve(line(({f(R)}, 0, 0), (0, 0, {f(H)})))"]
        cut = f"plane(at: {P(at)}, normal: {P(n)})"; kp = V(0, 0, H)
    if form == "trim":
        src += [f"surface t = trim(body, by: {cut}, keep: ({kp[0]:.9f}, {kp[1]:.9f}, {kp[2]:.9f}))", 'report "area": t.area']; ex = {"area": hi}
    elif form == "split" or kind != "cylinder":
        src += [f"let p = split(body, by: {cut})", 'report "count": len(p)', 'report "least": min([for q in p: area(q)])', 'report "sum": sum([for q in p: area(q)])']
        ex = {"count": 2, "least": min(hi, lo), "sum": tot}; form = "split"
    else:
        u, e1, e2 = frame(n); Q = 4 * R
        sq = [at + V(x, y, -(n[0] * x + n[1] * y)) for x, y in ((-Q, -Q), (Q, -Q), (Q, Q), (-Q, Q))]
        src += [f"surface sheet = plane(polyline([{', '.join('(%.6f, %.6f, %.6f)' % tuple(v) for v in sq)}], closed: true))", "let p = imprint(body, sheet)",
                'report "count": len(p)', 'report "sum": sum([for q in p: area(q)])']
        ex = {"count": 4, "sum": tot + (2 * Q) ** 2 * norm(n)}
    return kind + " " + form, src, ex

# ---- 4 webs
def webs(r):
    W = rd(r, 20, 80); rise = rd(r, 0.1, 0.6) * W / 2; L = rd(r, 30, 120)  # vault y in -W/2..W/2, x in 0..L
    R = (W * W / 4 + rise * rise) / (2 * rise); zc = rise - R
    vault = f"extrude(arc((0, {f(-W/2)}, 0), (0, {f(W/2)}, 0), through: (0, 0, {f(rise)})), by: ({f(L)}, 0, 0))"
    W, rise = float(f(W/2)) * 2, float(f(rise)); R = (W * W / 4 + rise * rise) / (2 * rise); zc = rise - R
    kind = r.choice(["flat", "slanted", "round", "tube"])
    y0, y1 = -W / 2 - rd(r, 1, 10), W / 2 + rd(r, 1, 10)
    z0 = -rd(r, 2, 20); z1 = rise + rd(r, 2, 30); hgt = z1 - z0
    n = 2001
    if kind == "tube":
        c = V(round(L / 2, 1), rd(r, -.1, .1) * W); s = rd(r, .1, .3) * min(W, L)
        s = min(s, round(.4 * min(W, L / 1.0), 1)); s = float(f(s)); c = np.round(c, 2)
        wall = f"extrude(circle(center: ({f(c[0])}, {f(c[1])}, {f(z0)}), radius: {f(s)}), by: (0, 0, {f(hgt)}))"
        v = V(0, 0, rd(r, 2, 30))  # would lie in the wall: use a conical spread by scaling instead
        th = np.arange(4096) * 2 * pi / 4096
        y = c[1] + s * np.sin(th); z = zc + np.sqrt(R * R - y * y)
        fx = np.stack([c[0] + s * np.cos(th), y, z], 1)
        D = np.stack([spectral(fx[:, i], th) for i in range(3)], 1); wt = np.full(4096, 2 * pi / 4096)
        # web: ruled from fx to the same curve moved outwards is not unique; a level web by extrude along x needs half a tube, so here the fx length alone and imprint of two
        bA = 2 * pi * s * hgt; vA = 2 * R * math.asin(W / 2 / R) * L
        src = [f"surface a = {vault}", f"surface b = {wall}", "curve fx = a & b", "surface w = ruled(fx, scale(fx, by: 0.5, about: (%s, %s, %s)))" % (f(c[0]), f(c[1]), f(zc))]
        # ruled to the half-size curve towards a point below: a cone strip; area = 3/4 of the cone from apex
        ap = V(c[0], c[1], float(f(zc))); N = np.cross(fx - ap, D); cone = .5 * np.sum(norm(N, axis=1) * wt)
        area = .75 * cone
        cnt = 5
        # the strip must lie under the vault and inside the tube; it does (star-shaped about the apex on the vault's axis side)
        lo = ap + .5 * (fx - ap)
        if lo[:, 2].min() < z0 + .5 or True:
            pass
        form = r.choice(["imprint", "mesh"])
        src += ['report "fx": fx.length', 'report "w": w.area']
        ex = {"fx": np.sum(norm(D, axis=1) * wt), "w": area}
        if form == "imprint":
            src += ["let p = imprint(a, b, w)", 'report "count": len(p)', 'report "sum": sum([for q in p: area(q)])']
            ex.update(count=cnt, sum=vA + bA + area)
        else:
            src += [f"mesh m of a, b, w {{ size: {f(W/12)}mm chord_error: {f(max(W*.002,.005))}mm imprint: true }}", 'report "mesh": m.area']
            ex["mesh"] = (vA + bA + area, 2e-2)
        return "tube " + form, src, ex
    if kind == "flat": x0 = x1 = round(L * rd(r, .3, .7), 1)
    else: x0, x1 = round(L * rd(r, .2, .45), 1), round(L * rd(r, .4, .6), 1)
    A, B = V(x0, y0), V(x1, y1); A = V(*[float(f(t)) for t in A]); B = V(*[float(f(t)) for t in B])
    if kind == "round":
        bow = rd(r, .05, .2) * L; d = (B - A) / norm(B - A); nrm = V(d[1], -d[0])  # towards +x
        M = np.round((A + B) / 2 + nrm * bow, 2)
        wall = f"extrude(arc(({f(A[0])}, {f(A[1])}, {f(z0)}), ({f(B[0])}, {f(B[1])}, {f(z0)}), through: ({f(M[0])}, {f(M[1])}, {f(z0)})), by: (0, 0, {f(hgt)}))"
        # circle through A, B, M
        ax, ay, bx, by_, cx, cy = *A, *B, *M
        dd = 2 * (ax*(by_-cy)+bx*(cy-ay)+cx*(ay-by_))
        ux = ((ax*ax+ay*ay)*(by_-cy)+(bx*bx+by_*by_)*(cy-ay)+(cx*cx+cy*cy)*(ay-by_))/dd
        uy = ((ax*ax+ay*ay)*(cx-bx)+(bx*bx+by_*by_)*(ax-cx)+(cx*cx+cy*cy)*(bx-ax))/dd
        rr = math.hypot(ax-ux, ay-uy)
        bA = rr * 2 * math.asin(min(1, norm(B - A) / 2 / rr)) * hgt
        if np.dot(M - V(ux, uy), (A + B) / 2 - V(ux, uy)) < 0: bA = rr * 2 * pi * hgt - bA
        xs = lambda y: ux + np.sqrt(rr * rr - (y - uy) ** 2)
        dxs = lambda y: -(y - uy) / np.sqrt(rr * rr - (y - uy) ** 2)
    else:
        wall = f"extrude(line(({f(A[0])}, {f(A[1])}, {f(z0)}), ({f(B[0])}, {f(B[1])}, {f(z0)})), by: (0, 0, {f(hgt)}))"
        bA = norm(B - A) * hgt; k = (B[0] - A[0]) / (B[1] - A[1])
        xs = lambda y: A[0] + k * (y - A[1]); dxs = lambda y: k + 0 * y
    vx = rd(r, 5, 30); vz = rd(r, 1, 30); v = V(vx, 0, vz)  # +x (the convex side), up: rulings of the vault run along x
    g, wq = np.polynomial.legendre.leggauss(200); y = g * W / 2; wq = wq * W / 2
    z = zc + np.sqrt(R*R - y*y); D = np.stack([dxs(y), np.ones_like(y), -y / (z - zc)], 1)
    if np.max(xs(y)) > .97 * L or np.min(xs(y)) < .03 * L: return webs(r)
    area = np.sum(norm(np.cross(D, v), axis=1) * wq); fl = np.sum(norm(D, axis=1) * wq)
    vA = 2 * R * math.asin(W / 2 / R) * L
    src = [f"surface a = {vault}", f"surface b = {wall}", r.choice(["curve fx = a & b", "curve fx = meet(a, b)[0]"]), f"surface w = extrude(fx, by: {P(v)})",
           'report "fx": fx.length', 'report "w": w.area']
    ex = {"fx": fl, "w": area}
    form = r.choice(["imprint", "mesh", "shell"])
    if form == "imprint":
        src += ["let p = imprint(a, b, w)", 'report "count": len(p)', 'report "sum": sum([for q in p: area(q)])']; ex.update(count=4, sum=vA + bA + area)
    elif form == "shell":
        src += ["shell s of a, b, w { imprint: true }", 'report "sum": s.area']; ex.update(sum=vA + bA + area)
    else:
        src += [f"mesh m of a, b, w {{ size: {f(W/12)}mm chord_error: {f(max(W*.002,.005))}mm imprint: true }}", 'report "mesh": m.area']
        ex["mesh"] = (vA + bA + area, 2e-2)
    return kind + " " + form, src, ex

# ---- 5 trays
def trays(r):
    a, b = rd(r, 20, 200), rd(r, 20, 200); rad = r.choice([2, 5, rd(r, .05, .4) * min(a, b)]); rad = float(f(rad)); H = rd(r, 10, 80)
    while rad > .45 * min(a, b): rad = float(f(rad / 2))
    c = V(r.choice([0, rd(r, -50, 50)]), r.choice([0, rd(r, -50, 50)]), 0)
    hx, hy = a / 2, b / 2
    pts = [c + V(x, y, 0) for x, y in ((-hx, -hy), (hx, -hy), (hx, hy), (-hx, hy))]
    for p in pts: p[:] = [float(f(t)) for t in p]
    k = r.randrange(4); pts = pts[k:] + pts[:k]
    per = 2 * (a + b) - 8 * rad + 2 * pi * rad; A = a * b - (4 - pi) * rad * rad
    src = [f"curve rim = polyline({PL(pts)}, closed: true, round: {f(rad)})", f"surface wall = extrude(rim, by: (0, 0, {f(H)}))"]
    form = r.choice(["oblique", "split", "hole", "closed", "oblique body", "shelf", "half"])
    sx, sy = rd(r, -.2, .2, 2), rd(r, -.2, .2, 2)
    z = float(f(H * r.uniform(.4, .6)))
    while abs(sx) * hx + abs(sy) * hy > .35 * H: sx, sy = sx / 2, sy / 2; sx, sy = float(f(sx)), float(f(sy))
    cut = f"plane(at: {P(c + V(0, 0, z))}, normal: {P(V(-sx, -sy, 1))})"
    if form == "oblique":
        src += [f"surface t = trim(wall, by: {cut}, keep: rim.at(13%))", 'report "area": t.area']; ex = {"area": per * z}
    elif form == "split":
        src += [f"let p = split(wall, by: {cut})", 'report "count": len(p)', 'report "sum": sum([for q in p: area(q)])', 'report "least": min([for q in p: area(q)])']
        ex = {"count": 2, "sum": per * H, "least": min(per * z, per * (H - z))}
    elif form == "hole":
        q = rd(r, .1, .4) * min(H, b - 2 * rad); q = max(float(f(q)), .5); q = min(q, float(f(.4 * min(H, b - 2 * rad))))
        src += [f"surface pipe = extrude(circle(center: {P(c + V(0, 0, float(f(H/2))))}, radius: {f(q)}, normal: (1, 0, 0)), by: ({f(a)}, 0, 0))",
                f"surface t = trim(wall, by: pipe, keep: rim.at(13%))", 'report "area": t.area']; ex = {"area": per * H - pi * q * q}
    elif form == "closed":
        src += [f"surface floor = plane(rim)", f"surface lid = plane(move(rim, by: (0, 0, {f(H)})))", "shell s of floor, wall, lid", 'report "volume": s.volume', 'report "area": s.area']
        ex = {"volume": A * H, "area": 2 * A + per * H}
    elif form == "oblique body":
        src += [f"surface floor = plane(rim)", f"curve edge = meet(wall, {cut})[0]", f"surface t = trim(wall, by: edge, keep: rim.at(13%))", "surface lid = plane(edge)", "shell s of floor, t, lid",
                'report "volume": s.volume', 'report "area": s.area']
        ex = {"volume": A * z, "area": A * (1 + math.sqrt(1 + sx*sx + sy*sy)) + per * z}
    elif form == "shelf":
        m = 5
        pl = [c + V(x, y, z) for x, y in ((-hx-m, -hy-m), (hx+m, -hy-m), (hx+m, hy+m), (-hx-m, hy+m))]
        pl = [V(*[float(f(t)) for t in p]) for p in pl]
        src += [f"surface shelf = {poly(pl)}", "let p = imprint(wall, shelf)", 'report "count": len(p)', 'report "sum": sum([for q in p: area(q)])']
        ex = {"count": 4, "sum": per * H + (a + 2*m) * (b + 2*m)}
    else:
        src += [f"surface floor = plane(rim)", f"surface t = trim(floor, by: plane(at: {P(c)}, normal: {P(V(sx or 1, sy, 0))}), keep: rim.at(13%))",
                f"surface u = trim(wall, by: plane(at: {P(c)}, normal: {P(V(sx or 1, sy, 0))}), keep: rim.at(13%))", 'report "area": t.area', 'report "wall": u.area']; ex = {"area": A / 2, "wall": per * H / 2}
    return form, src, ex

# ---- 6 holes in (u, v)
G, GW = np.polynomial.legendre.leggauss(40); G = (G + 1) / 2; GW = GW / 2
def bez(net):
    net = np.array(net); nv, nu = net.shape[0] - 1, net.shape[1] - 1
    bern = lambda n, t: np.stack([math.comb(n, i) * t**i * (1-t)**(n-i) for i in range(n+1)], -1)
    def dS(u, v):
        bu, bv = bern(nu, u), bern(nv, v)
        du = nu * (net[:, 1:] - net[:, :-1]); dv = nv * (net[1:] - net[:-1])
        Su = np.einsum("...i,...j,jik->...k", bern(nu-1, u), bv, du); Sv = np.einsum("...i,...j,jik->...k", bu, bern(nv-1, v), dv)
        return norm(np.cross(Su, Sv), axis=-1)
    return dS
def uvholes(r):
    n, m = r.choice([(3, 3), (3, 3), (4, 4), (2, 3), (3, 2)]); S = r.choice([1, 10, 100])
    net = [[(S * (i / (n-1)), S * (j / (m-1)), S * rd(r, 0, .6)) for i in range(n)] for j in range(m)]
    net = [[tuple(float(f(t)) for t in p) for p in row] for row in net]
    dS = bez(net); d = r.choice([1, 2, 2])
    while True:
        t = [V(rd(r, .05, .95, d), rd(r, .05, .95, d)) for _ in range(3)]
        e = [t[(i+1)%3] - t[i] for i in range(3)]
        ar = abs(e[0][0]*e[1][1] - e[0][1]*e[1][0]) / 2
        if ar > .004 and min(norm(x) for x in e) > .05: break
    U, Vv = np.meshgrid(G, G); W = np.outer(GW, GW)
    tot = np.sum(dS(U, Vv) * W)
    a, b, c = t
    pu = a[0] + U * (b[0]-a[0] + Vv * (c[0]-b[0])); pv = a[1] + U * (b[1]-a[1] + Vv * (c[1]-b[1]))
    tri = np.sum(dS(pu, pv) * W * U) * 2 * ar
    src = ["surface base = bezier_surface([" + ", ".join(PL(row) for row in net) + "])",
           f"surface t = trim(base, {'holes' if r.random() < .7 else 'outer'}: [polyline([" + ", ".join(f"({f(p[0])}, {f(p[1])}, 0)" for p in t) + "], closed: true)], uv: true)", 'report "area": t.area']
    return ("holes" if "holes" in src[1] else "outer"), src, {"area": (tot - tri if "holes" in src[1] else tri, 1e-6)}

# ---- 7 flat tubes
def flat_tubes(r):
    a = rd(r, 2, 60); ratio = rd(r, 1, 10); b = float(f(a / ratio)); H = rd(r, 1, 4) * a; H = float(f(H)); c = V(r.choice([0, rd(r, -50, 50)]), r.choice([0, rd(r, -50, 50)]), 0)
    al = r.choice([0, 0, rd(r, 0, 90)]) * pi / 180
    if al == 0: M, m = V(a, 0, 0), V(0, b, 0)
    else:
        M = np.round(a * V(math.cos(al), math.sin(al), 0), 2); m = V(-M[1], M[0], 0) * 0.1 * max(1, round(10 / ratio)); m = np.round(m, 3)
    A, B = norm(M), norm(m)
    th = np.arange(8192) * 2 * pi / 8192
    per = np.sum(np.sqrt((A * np.sin(th))**2 + (B * np.cos(th))**2)) * 2 * pi / 8192
    z = float(f(H * r.uniform(.4, .6)))
    while True:
        n = V(rd(r, -1, 1, 2), rd(r, -1, 1, 2), 1)
        if math.hypot(np.dot(n, M), np.dot(n, m)) < .36 * H: break
    cut = f"plane(at: {P(c + V(0, 0, z))}, normal: {P(n)})"
    src = [f"surface tube = extrude(ellipse(center: {P(c)}, major: {P(M)}, minor: {P(m)}), by: (0, 0, {f(H)}))"]
    form = r.choice(["trim", "split", "body", "tool"])
    if form == "trim": src += [f"surface t = trim(tube, by: {cut}, keep: tube.at(0, 0.3))", 'report "area": t.area']; ex = {"area": per * z}
    elif form == "split":
        src += [f"let p = split(tube, by: {cut})", 'report "count": len(p)', 'report "sum": sum([for q in p: area(q)])', 'report "least": min([for q in p: area(q)])']
        ex = {"count": 2, "sum": per * H, "least": min(per * z, per * (H - z))}
    elif form == "tool":
        Q = math.ceil(3 * A); sq = [c + V(x, y, z - (n[0]*x + n[1]*y)) for x, y in ((-Q, -Q), (Q, -Q), (Q, Q), (-Q, Q))]
        src += [f"surface sheet = plane(polyline([{', '.join('(%.6f, %.6f, %.6f)' % tuple(v) for v in sq)}], closed: true))", "let p = imprint(tube, sheet)", 'report "count": len(p)', 'report "sum": sum([for q in p: area(q)])']
        ex = {"count": 4, "sum": per * H + 4 * Q * Q * norm(n)}
    else:
        src += [f"curve edge = meet(tube, {cut})[0]", "surface t = trim(tube, by: edge, keep: tube.at(0, 0.3))", "surface lid = plane(edge)", "surface floor = plane(tube.u(0))", "shell s of floor, t, lid", 'report "volume": s.volume', 'report "area": s.area']
        ex = {"volume": pi * A * B * z, "area": pi * A * B * (1 + norm(n)) + per * z}
    return form, src, ex

# ---- 8 polygons
def rpoly(r, n, g, R):
    while True:
        if r.random() < .5:
            c = (r.randint(-R//2, R//2), r.randint(-R//2, R//2))
            pts = sorted(((r.uniform(0, 2*pi), r.uniform(.3, 1) * R) for _ in range(n)))
            p = [(g * round((c[0] + d * math.cos(t)) / g), g * round((c[1] + d * math.sin(t)) / g)) for t, d in pts]
        else: p = [(g * round(r.uniform(-R, R) / g), g * round(r.uniform(-R, R) / g)) for _ in range(n)]
        if len(set(p)) < n: continue
        q = Polygon(p)
        if not q.is_valid or q.area < .05 * R * R: continue
        # no near-straight or needle corners
        ok = True
        for i in range(n):
            a, b = np.subtract(p[i-1], p[i]), np.subtract(p[(i+1) % n], p[i])
            an = abs(math.atan2(a[0]*b[1]-a[1]*b[0], np.dot(a, b)))
            if an < .15: ok = False
        if ok: return p, q
def polygons(r):
    g = r.choice([10, 10, 1, .1]); R = r.choice([40, 60, 100])
    if g == .1: g = 0.1
    while True:
        a, A = rpoly(r, r.randint(3, 6), g, R); b, B = rpoly(r, r.randint(3, 6), g, R)
        I = A.intersection(B)
        if I.area > 0.5: break
    p3 = lambda p: [(float(x), float(y), 0) for x, y in p]
    if r.random() < .5: b = b[::-1]
    src = [f"surface a = {poly(p3(a))}", f"surface b = {poly(p3(b))}"]
    form = r.choice(["imprint", "imprint", "mesh"])
    if form == "imprint": src += ["let p = imprint(a, b)", 'report "sum": sum([for q in p: area(q)])']; ex = {"sum": A.union(B).area}
    else: src += [f"mesh m of imprint(a, b) {{ size: {f(R/6)}mm }}", 'report "mesh": m.area']; ex = {"mesh": A.union(B).area}
    return f"{form} {g}", src, ex

# ---- 9 outlines with arcs
def rounded(p, rad, n=600):
    out = []; k = len(p)
    for i in range(k):
        a, o, b = V(*p[i-1]), V(*p[i]), V(*p[(i+1) % k])
        u, w = (a-o)/norm(a-o), (b-o)/norm(b-o)
        th = math.acos(max(-1, min(1, np.dot(u, w)))); d = rad / math.tan(th/2)
        bis = (u+w)/norm(u+w); c = o + bis * rad / math.sin(th/2)
        s, e = o + u*d - c, o + w*d - c
        sa = math.atan2(s[1], s[0]); da = math.atan2(s[0]*e[1]-s[1]*e[0], np.dot(s, e))
        for j in range(n+1): t = sa + da*j/n; out.append((c[0]+rad*math.cos(t), c[1]+rad*math.sin(t)))
    return out
def fits(p, rad):
    for i in range(len(p)):
        u, w = np.subtract(p[i-1], p[i]), np.subtract(p[(i+1) % len(p)], p[i])
        if abs(u[0]*w[1]-u[1]*w[0]) < .1 * norm(u) * norm(w): return False
    k = len(p); d = []
    for i in range(k):
        a, o, b = V(*p[i-1]), V(*p[i]), V(*p[(i+1) % k]); u, w = (a-o)/norm(a-o), (b-o)/norm(b-o)
        d.append(rad / math.tan(math.acos(max(-1, min(1, np.dot(u, w)))) / 2))
    return all(d[i] + d[(i+1) % k] < .95 * norm(np.subtract(p[i], p[(i+1) % k])) for i in range(k))
def outlines(r):
    g = r.choice([10, 1]); R = r.choice([40, 60, 100])
    def one():
        while True:
            if r.random() < .2:
                c, q = (rd(r, -R/2, R/2, 0), rd(r, -R/2, R/2, 0)), rd(r, .2*R, .8*R, 0)
                t = np.arange(4000) * 2*pi/4000
                return f"plane(circle(center: ({f(c[0])}, {f(c[1])}, 0), radius: {f(q)}))", Polygon(np.stack([c[0]+q*np.cos(t), c[1]+q*np.sin(t)], 1)), pi*q*q
            p, _ = rpoly(r, r.randint(3, 5), g, R); rad = r.choice([2, 5, rd(r, 1, 12)])
            if not fits(p, rad): continue
            Q = Polygon(rounded(p, rad))
            if Q.is_valid: return f"plane(polyline({PL([(float(x), float(y), 0) for x, y in p])}, closed: true, round: {f(rad)}))", Q, None
    while True:
        sa, A, _ = one(); sb, B, _ = one()
        if A.intersection(B).area > .5: break
    form = r.choice(["imprint", "imprint", "mesh"])
    src = [f"surface a = {sa}", f"surface b = {sb}"]; U = A.union(B).area
    if form == "imprint": src += ["let p = imprint(a, b)", 'report "sum": sum([for q in p: area(q)])']; ex = {"sum": (U, 5e-6)}
    else: src += [f"mesh m of imprint(a, b) {{ size: {f(R/10)}mm }}", 'report "mesh": m.area']; ex = {"mesh": (U, 3e-2)}
    return form, src, ex

# ---- 10 planes in space
def planes(r):
    S = r.choice([10, 50, 100]); g = r.choice([1, 1, .5])
    def vec(): return V(*(g * round(rd(r, -S, S) / g) for _ in range(3)))
    T = r.choice(["cross", "T", "T", "L"])
    while True:
        o, e, h = vec(), vec(), vec(); N = np.cross(e, h)
        if norm(e) < .3*S or norm(h) < .3*S or norm(N) < .5 * norm(e) * norm(h): continue
        if T == "cross":
            o2, e2, h2 = vec(), vec(), vec()
        else:
            st = [.0, .1, .2, .25, .3, .5, .6, .75, .8, 1.0]
            if T == "L": s = [(0, 0), (1, 0)]
            else: s = [(r.choice(st), r.choice(st)), (r.choice(st), r.choice(st))]
            q = [o + x*e + y*h for x, y in s]; o2, e2, h2 = q[0], q[1]-q[0], vec()
        N2 = np.cross(e2, h2)
        if norm(e2) < .3*S or norm(h2) < .3*S or norm(N2) < .4 * norm(e2) * norm(h2): continue
        D = np.cross(N, N2)
        if norm(D) < .3 * norm(N) * norm(N2): continue
        if T == "cross":
            d = D / norm(D); p0 = np.linalg.solve(np.array([N, N2, d]), V(np.dot(N, o), np.dot(N2, o2), 0))
            lo, hi = -1e9, 1e9; brd = []
            for O, E, Hh in ((o, e, h), (o2, e2, h2)):
                M = np.stack([E, Hh], 1); s0 = np.linalg.lstsq(M, p0-O, rcond=None)[0]; s1 = np.linalg.lstsq(M, d, rcond=None)[0]
                l2, h3 = -1e9, 1e9
                for k in range(2):
                    if abs(s1[k]) < 1e-9:
                        if not 0 < s0[k] < 1: l2 = 1e9
                        continue
                    t0, t1 = sorted((-s0[k]/s1[k], (1-s0[k])/s1[k])); l2, h3 = max(l2, t0), min(h3, t1)
                brd.append((l2, h3)); lo, hi = max(lo, l2), min(hi, h3)
            if hi - lo < .05 * S: continue
            L = hi - lo
        else: L = norm(e2)
        break
    quad = lambda O, E, Hh: [O, O+E, O+E+Hh, O+Hh]
    A = norm(N) + norm(N2)
    form = r.choice(["meet", "imprint", "mesh"])
    src = [f"surface a = {poly(quad(o, e, h))}", f"surface b = {poly(quad(o2, e2, h2))}"]
    if form == "meet": src += ["curve x = a & b", 'report "length": x.length']; ex = {"length": L}
    elif form == "imprint":
        src += ["let p = imprint(a, b)", 'report "sum": sum([for q in p: area(q)])']; ex = {"sum": A}
    else: src += [f"mesh m of a, b {{ size: {f(S/5)}mm imprint: true }}", 'report "mesh": m.area']; ex = {"mesh": A}
    return T + " " + form, src, ex

FAMILIES = {"tubes": tubes, "ribs": ribs, "slices": slices, "webs": webs, "trays": trays, "uvholes": uvholes, "flat_tubes": flat_tubes,
            "polygons": polygons, "outlines": outlines, "planes": planes}

def make(fam, seed):
    r = random.Random(f"{fam}-{seed}"); np.random.seed(0)
    form, src, ex = FAMILIES[fam](r)
    ex = {k: (v if isinstance(v, tuple) else (float(v), 2e-6)) for k, v in ex.items()}
    head = [f"// {fam} {form}, seed {seed}"] + [f"// {k} == {v[0]:.12g} within {v[1]:g}" for k, v in ex.items()]
    return form, "\n".join(head + ["units mm"] + src) + "\n", ex

def run(loft, fam, seed, tmp):
    form, text, ex = make(fam, seed)
    path = f"{tmp}/{fam}-{seed}.loft"; open(path, "w").write(text)
    t = time.time(); 
    try:
        p = subprocess.run([loft, "run", path, "-o", f"{tmp}/out-{fam}-{seed}", "--json", "--threads", "1"], capture_output=True, text=True, timeout=20)
    except subprocess.TimeoutExpired: return dict(fam=fam, seed=seed, form=form, kind="refused", why="timeout 20 s", dt=20, text=text)
    dt = time.time() - t
    try: j = json.loads(p.stdout)
    except Exception: return dict(fam=fam, seed=seed, form=form, kind="refused", why=f"status {p.returncode}: {p.stderr[:120]}", dt=dt, text=text)
    res = dict(fam=fam, seed=seed, form=form, dt=dt, text=text, kind="right", why="")
    if p.returncode != 0 or not j["ok"]:
        errs = [d for d in j["diagnostics"] if d["severity"] == "error"]
        d = errs[0] if errs else {"code": "?", "message": p.stderr[:80]}
        return dict(res, kind="refused", why=f"{d['code']} {d['message']}")
    got = {x["title"]: x["rows"][0][0] for x in j["reports"]}
    bad = []
    for k, (v, tol) in ex.items():
        g = got.get(k)
        if g is None or not abs(g - v) <= tol * max(abs(v), 1e-12): bad.append(f"{k} {g} for {v:.10g}")
    warns = sorted({d["code"] for d in j["diagnostics"] if d["severity"] == "warning"})
    if bad: return dict(res, kind="wrong", why="; ".join(bad) + (" " + ",".join(warns) if warns else ""))
    return dict(res, warns=warns)

def main():
    ap = argparse.ArgumentParser(); ap.add_argument("--loft", default="target/release/loft"); ap.add_argument("--seed", type=int, default=1)
    ap.add_argument("--count", type=int, default=30); ap.add_argument("--family"); ap.add_argument("--jobs", type=int, default=2); ap.add_argument("--fail", default="target/joints"); ap.add_argument("--only", type=int, help="one case: its seed"); ap.add_argument("-q", action="store_true")
    a = ap.parse_args(); os.makedirs(a.fail, exist_ok=True)
    fams = a.family.split(",") if a.family else list(FAMILIES); rows = []
    with tempfile.TemporaryDirectory() as tmp, ThreadPoolExecutor(a.jobs) as ex:
        for fam in fams:
            seeds = [a.only] if a.only is not None else [a.seed * 100000 + i for i in range(a.count)]
            rs = list(ex.map(lambda s: run(a.loft, fam, s, tmp), seeds))
            for r in rs:
                p = f"{a.fail}/{fam}-{r['seed']}.loft"
                if r["kind"] != "right": open(p, "w").write(f"// {r['kind']}: {r['why']}\n" + r["text"])
                elif os.path.exists(p): os.remove(p)
            n = Counter(r["kind"] for r in rs); slow = [r for r in rs if r["dt"] > 3]
            print(f"{fam:11} right {n['right']:4} wrong {n['wrong']:3} refused {n['refused']:3} slow {len(slow):3} of {len(rs)}  ({sum(r['dt'] for r in rs):.0f} s, max {max(r['dt'] for r in rs):.1f})", flush=True)
            if not a.q:
                for c, k in Counter((r["why"].split()[0] if r["kind"] == "refused" else "wrong") for r in rs if r["kind"] != "right").most_common():
                    x = [r for r in rs if r["kind"] != "right" and (r["why"].split()[0] if r["kind"] == "refused" else "wrong") == c]
                    print(f"    {k:3} {c}: {x[0]['why'][:110]}"); print("        " + " ".join(f"{r['seed'] - a.seed * 100000}[{r['form']}]" for r in x))
                if slow: print("    slow: " + " ".join(f"{r['seed']}[{r['form']}] {r['dt']:.1f}s" for r in slow))
            rows += rs
    n = Counter(r["kind"] for r in rows); print(f"all: right {n['right']} wrong {n['wrong']} refused {n['refused']} of {len(rows)}")
if __name__ == "__main__": main()
