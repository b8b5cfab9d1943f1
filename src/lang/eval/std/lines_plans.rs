//! Lines plans: a hull cut by the planes of its sections.

use std::collections::BTreeSet;
use std::sync::Arc;

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::fault::{Fault, Say, ValueFault};
use crate::base::math;
use crate::base::tolerance::Tolerance;
use crate::draw::Kind;
use crate::draw::lines;
use crate::draw::lines_plan::{Diagonal, Family, LinesPlan, PlanLine};
use crate::hydrostatics::sides::Side;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::scene::Scene;
use crate::lang::eval::std::kinds::Faces;
use crate::lang::values::units;
use crate::lang::values::value::{Dim, Record, Value};
use crate::model::SurfaceId;
use crate::surface::Surface;
use crate::surface::core::plane;
use crate::surface::faults::CrossingFault;
use crate::surface::intersect::with_surfaces::with_surfaces;

/// How far lines may be from the curves that they show, in parts of the hull's diagonal.
const FINE: f64 = 0.00005;
/// How far the lines of two sides may be apart that are equal, in parts of the hull's diagonal.
const EQUAL: f64 = 4.0 * FINE;
/// Shares of the length where stations are that nobody asked for.
const STATIONS: [f64; 11] = [0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95];

/// What a script asks of a lines plan, model units.
pub(super) struct Asked {
    pub stations: Option<Vec<f64>>,
    pub waterlines: Option<Vec<f64>>,
    pub buttocks: Option<Vec<f64>>,
    pub diagonals: Vec<Arc<Record>>,
    pub bow_is_high: bool,
}

/// A hull that is cut.
struct Hull {
    faces: Vec<Surface>,
    /// All edges, with whether they are free or knuckles.
    edges: Vec<(bool, Vec<DVec3>)>,
    bounds: Box3,
    /// 1 where the side of positive y is drawn, −1 where the hull has only the other one.
    side: f64,
    /// Whether it has both sides.
    whole: bool,
    fine: f64,
    tolerance: Tolerance,
}

/// Sections that are asked for along one direction.
#[derive(Clone, Copy)]
struct Cut {
    argument: &'static str,
    family: Family,
    at: DVec3,
    normal: DVec3,
    /// The place as a script says it.
    place: f64,
    stated: bool,
}

impl Hull {
    fn new(cx: &mut Cx, hull: &Faces) -> Result<Self, Halt> {
        let tolerance = cx.tolerance()?;
        let faces = hull.surfaces();
        let scene = Scene::of(cx, cx.module(), &faces)?;
        let members: BTreeSet<SurfaceId> = scene.find_all(&faces)?.into_iter().map(|(id, _)| id).collect();
        let bounds = faces.iter().map(crate::surface::bbox).fold(Box3::EMPTY, |all, own| all.union(own));
        if bounds.is_empty() || !bounds.diagonal().is_finite() {
            let (found, range) = ("nothing with a size".to_owned(), "surfaces with borders".to_owned());
            return Err(ValueFault::OutsideRange { argument: "hull", found, range }.into());
        }
        let fine = FINE * bounds.diagonal();
        let near = scene.model.reach(members.iter().copied(), hull.snap(), &tolerance);
        let near = if hull.has_shell() { near } else { tolerance.point };
        let all = lines::borders(&scene.model, &scene.network, &members, near, fine, &tolerance);
        let edges = all.into_iter().map(|line| (line.kind != Kind::Border, line.points)).collect();
        let side = if bounds.max.y >= -bounds.min.y { 1.0 } else { -1.0 };
        let whole = Side::only(&bounds, tolerance.point).is_none();
        Ok(Self { faces, edges, bounds, side, whole, fine, tolerance })
    }

    /// The larger half of the beam.
    fn half(&self) -> f64 {
        self.bounds.max.y.max(-self.bounds.min.y)
    }

    /// Whether lines that show both sides of the hull are equal when y is turned round.
    fn is_symmetric(&self, lines: &[PlanLine]) -> bool {
        let most = EQUAL * self.bounds.diagonal();
        let is_near = |p: DVec3, line: &PlanLine| {
            line.points.windows(2).any(|w| {
                let along = w[1] - w[0];
                let share = if along == DVec3::ZERO { 0.0 } else { ((p - w[0]).dot(along) / along.length_squared()).clamp(0.0, 1.0) };
                p.distance(w[0] + along * share) <= most
            })
        };
        let turned = |p: &DVec3| DVec3::new(p.x, -p.y, p.z);
        lines.iter().all(|line| {
            crate::base::job::poll();
            let same = |other: &&PlanLine| other.family == line.family && other.at == line.at;
            line.points.iter().all(|p| lines.iter().filter(same).any(|other| is_near(turned(p), other)))
        })
    }

    /// The lines in which a plane meets the hull, with the edges that lie in it.
    fn section(&self, cx: &mut Cx, at: DVec3, normal: DVec3) -> Result<Vec<Vec<DVec3>>, Halt> {
        let origin = cx.origin();
        let cutter = [plane::unbounded(at, normal, origin)?];
        let in_plane = |edge: &&(bool, Vec<DVec3>)| edge.1.iter().all(|p| (*p - at).dot(normal).abs() <= self.tolerance.point);
        let flat: Vec<&Vec<DVec3>> = self.edges.iter().filter(in_plane).map(|edge| &edge.1).collect();
        let runs_along = |fault: &Fault| matches!(fault.of(), Some(CrossingFault::RunAlong { .. }));
        let chains = match with_surfaces(&self.faces, &cutter, origin, &self.tolerance) {
            Ok(found) => found.curves,
            // A flat face in the plane is shown by its edges, the others are cut.
            Err(fault) if runs_along(&fault) && !flat.is_empty() => {
                let mut chains = Vec::new();
                for face in &self.faces {
                    match with_surfaces(std::slice::from_ref(face), &cutter, origin, &self.tolerance) {
                        Ok(found) => chains.extend(found.curves),
                        Err(fault) if runs_along(&fault) => {}
                        Err(fault) => return Err(fault.into()),
                    }
                }
                chains
            }
            Err(fault) => return Err(fault.into()),
        };
        let apart = |edge: &&Vec<DVec3>| {
            let middle = edge[edge.len() / 2];
            edge.len() < 2 || chains.iter().all(|c| c.closest(0.5 * (middle + edge[(edge.len() - 1) / 2])).2 > self.fine)
        };
        let mut out: Vec<Vec<DVec3>> = flat.into_iter().filter(apart).cloned().collect();
        out.extend(chains.iter().map(|chain| lines::chain(chain, self.fine, &self.tolerance)));
        Ok(out)
    }

    /// The parts of a line on the side that is drawn, there with y of 0 or more.
    fn drawn(&self, points: &[DVec3]) -> Vec<Vec<DVec3>> {
        let flip = |p: DVec3| DVec3::new(p.x, p.y * self.side, p.z);
        let is_in = |p: DVec3| p.y >= -self.tolerance.point;
        let level = |p: DVec3| DVec3::new(p.x, p.y.max(0.0), p.z);
        let (mut out, mut run) = (Vec::new(), Vec::new());
        let mut last: Option<DVec3> = None;
        for p in points.iter().map(|p| flip(*p)) {
            if let Some(before) = last
                && is_in(before) != is_in(p)
            {
                run.push(level(before.lerp(p, before.y / (before.y - p.y))));
            }
            if is_in(p) {
                run.push(level(p));
            } else if !run.is_empty() {
                out.push(std::mem::take(&mut run));
            }
            last = Some(p);
        }
        out.push(run);
        out.retain(|run| run.len() > 1);
        out
    }
}

/// The planes of the sections; E306 for one beside the hull.
fn cuts(cx: &mut Cx, hull: &Hull, asked: &Asked, plan: &LinesPlan) -> Result<Vec<Cut>, Halt> {
    let (low, high) = (hull.bounds.min, hull.bounds.max);
    let families = [
        ("stations", Family::Station, &plan.stations, DVec3::X, asked.stations.is_some(), (low.x, high.x)),
        ("waterlines", Family::Waterline, &plan.waterlines, DVec3::Z, asked.waterlines.is_some(), (low.z, high.z)),
        ("buttocks", Family::Buttock, &plan.buttocks, DVec3::Y * hull.side, asked.buttocks.is_some(), (0.0, hull.half())),
    ];
    let mut out = Vec::new();
    for (argument, family, places, normal, stated, (low, high)) in families {
        for place in places {
            let inside = (low - hull.tolerance.point..=high + hull.tolerance.point).contains(place);
            if !inside || family == Family::Buttock && *place <= hull.tolerance.point {
                let range = format!("{} … {}, where the hull is", cx.length(low), cx.length(high));
                let range = if family == Family::Buttock { format!("above 0, at most {}", cx.length(high)) } else { range };
                return Err(ValueFault::OutsideRange { argument, found: cx.length(*place), range }.into());
            }
            out.push(Cut { argument, family, at: normal * *place, normal, place: *place, stated });
        }
    }
    for (k, d) in plan.diagonals.iter().enumerate() {
        let (sin, cos) = math::sin_cos(d.angle);
        let normal = DVec3::new(0.0, hull.side * sin, cos);
        out.push(Cut {
            argument: "diagonals",
            family: Family::Diagonal(k),
            at: DVec3::Z * d.height,
            normal,
            place: d.height,
            stated: true,
        });
    }
    Ok(out)
}

/// Inclined planes from records; E306 and E301 for what says none.
fn diagonals(cx: &mut Cx, records: &[Arc<Record>]) -> Result<Vec<Diagonal>, Halt> {
    let mut out = Vec::new();
    for record in records {
        let get = |key: &str, dim: Dim| match cx.program.names.find(key).and_then(|key| record.get(key)) {
            Some(Value::Number(q)) if q.dim == dim || q.dim.is_none() => Some(q.value),
            _ => None,
        };
        let found = (get("height", Dim::LENGTH), get("angle", Dim::ANGLE), record.keys.len());
        let wrong = || cx.show(&Value::Record(Arc::clone(record)));
        let fault = match found {
            (Some(height), Some(angle), 2) if angle > 0.0 && angle < 90.0 && height.is_finite() => {
                out.push(Diagonal { height, angle: units::radians(angle) });
                continue;
            }
            (Some(_), Some(_), 2) => {
                ValueFault::OutsideRange { argument: "diagonals", found: wrong(), range: "an angle between 0deg and 90deg".to_owned() }
            }
            _ => ValueFault::OutsideRange {
                argument: "diagonals",
                found: wrong(),
                range: "records such as {height: 8m, angle: 30deg}".to_owned(),
            },
        };
        return Err(fault.into());
    }
    Ok(out)
}

/// The lines in which the planes of cuts meet a hull, on both its sides; E306 for a plane that misses it.
fn sections(cx: &mut Cx, hull: &Hull, cuts: &[Cut]) -> Result<Vec<PlanLine>, Halt> {
    let (low, high) = (hull.bounds.min, hull.bounds.max);
    let mut lines = Vec::new();
    for cut in cuts {
        let mut parts = hull.section(cx, cut.at, cut.normal)?;
        if !hull.whole {
            parts = parts.iter().flat_map(|line| hull.drawn(line)).collect();
        }
        // At its very ends a hull may be met in a point only.
        let (first, last) = match cut.family {
            Family::Station => (low.x, high.x),
            Family::Waterline => (low.z, high.z),
            _ => (0.0, hull.half()),
        };
        let touches = (cut.place - first).abs().min((cut.place - last).abs()) <= hull.tolerance.point;
        if parts.is_empty() && cut.stated && (!touches || matches!(cut.family, Family::Diagonal(_))) {
            let (found, range) = (cx.length(cut.place), "where its plane meets the hull".to_owned());
            return Err(ValueFault::OutsideRange { argument: cut.argument, found, range }.into());
        }
        lines.extend(parts.into_iter().map(|points| PlanLine { family: cut.family, at: cut.place, points }));
    }
    Ok(lines)
}

/// Lines on both sides of a whole hull as a plan of its one side has them, or, where its sides differ, as they are.
fn one_side(cx: &mut Cx, hull: &Hull, plan: &mut LinesPlan, cuts: &[Cut]) -> Result<(), Halt> {
    let seen = |line: &&PlanLine| matches!(line.family, Family::Station | Family::Waterline);
    let compared: Vec<PlanLine> = plan.lines.iter().filter(seen).cloned().collect();
    plan.both_sides = !hull.is_symmetric(&compared);
    if !plan.both_sides {
        let parts = |line: &PlanLine| {
            let (family, at) = (line.family, line.at);
            hull.drawn(&line.points).into_iter().map(move |points| PlanLine { family, at, points }).collect::<Vec<_>>()
        };
        plan.lines = plan.lines.iter().flat_map(parts).collect();
        return Ok(());
    }
    plan.reach = (hull.bounds.max.y, -hull.bounds.min.y);
    if !plan.diagonals.is_empty() {
        let (found, range) = ("some, of a hull whose sides differ".to_owned(), "none for such a hull".to_owned());
        return Err(ValueFault::OutsideRange { argument: "diagonals", found, range }.into());
    }
    // Buttocks of the other side; a narrower one need not reach them.
    let buttocks = cuts.iter().filter(|cut| cut.family == Family::Buttock);
    let other: Vec<Cut> = buttocks.map(|cut| Cut { at: -cut.at, stated: false, ..*cut }).collect();
    let (low, high) = (hull.bounds.min.y, hull.bounds.max.y);
    let within: Vec<Cut> = other.into_iter().filter(|cut| (low..=high).contains(&cut.at.y)).collect();
    plan.lines.extend(sections(cx, hull, &within)?);
    Ok(())
}

/// The lines plan of a hull.
pub(super) fn plan(cx: &mut Cx, hull: &Faces, asked: Asked) -> Result<LinesPlan, Halt> {
    let hull = Hull::new(cx, hull)?;
    let (low, high) = (hull.bounds.min, hull.bounds.max);
    let between = |low: f64, high: f64, n: u32| (1..n).map(|k| low + (high - low) * f64::from(k) / f64::from(n)).collect::<Vec<_>>();
    let sorted = |list: Option<&Vec<f64>>, default: Vec<f64>| {
        let mut list = list.cloned().unwrap_or(default);
        list.sort_by(f64::total_cmp);
        list.dedup();
        list
    };
    let unit = cx.unit();
    let mut plan = LinesPlan {
        lines: Vec::new(),
        stations: sorted(asked.stations.as_ref(), STATIONS.map(|f| low.x + (high.x - low.x) * f).to_vec()),
        waterlines: sorted(asked.waterlines.as_ref(), between(low.z, high.z, 6)),
        buttocks: sorted(asked.buttocks.as_ref(), between(0.0, hull.half(), 4)),
        diagonals: diagonals(cx, &asked.diagonals)?,
        bow_is_high: asked.bow_is_high,
        both_sides: false,
        low: DVec3::new(low.x, 0.0, low.z),
        high: DVec3::new(high.x, hull.half(), high.z),
        reach: (hull.half(), hull.half()),
        unit: unit.name.to_owned(),
        millimetres: unit.micrometres as f64 / 1000.0,
    };
    let cuts = cuts(cx, &hull, &asked, &plan)?;
    plan.lines = sections(cx, &hull, &cuts)?;
    let mut outline: Vec<Vec<DVec3>> = if hull.whole { hull.section(cx, DVec3::ZERO, DVec3::Y)? } else { Vec::new() };
    outline.extend(hull.edges.iter().filter(|edge| edge.0).map(|edge| edge.1.clone()));
    if !hull.whole {
        outline = outline.iter().flat_map(|line| hull.drawn(line)).collect();
    }
    plan.lines.extend(outline.into_iter().map(|points| PlanLine { family: Family::Edge, at: 0.0, points }));
    if hull.whole {
        one_side(cx, &hull, &mut plan, &cuts)?;
    }
    Ok(plan)
}
