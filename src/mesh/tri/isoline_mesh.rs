//! A face between lines of constant u and v [Jeong & Park 2000]: whole cells in two triangles or a few more, what
//! borders cross by one constrained triangulation, and cells cut until every triangle is proved to keep the limits.

pub mod beside;
pub mod corners;
pub mod cut;
pub mod flips;
pub mod summary;

use std::collections::{BTreeMap, BTreeSet};

use glam::{DVec2, DVec3};

use crate::base::fault::Result;
use crate::base::job::Job;
use crate::base::work;
use crate::mesh::chart::affine::Chart;
use crate::mesh::chart::outline::Outline;
use crate::mesh::chart::parametric_surface::ParametricSurface;
use crate::mesh::request::decider::{Decided, Tally};
use crate::mesh::request::limits::Limits;
use crate::mesh::request::sources::Sources;
use crate::mesh::tri::fill::{Filling, fill};
use crate::mesh::tri::isoline::{Cut, IsolineCells};
use crate::mesh::tri::isoline_mesh::beside::sorted;
use crate::mesh::tri::isoline_mesh::corners::{CellCorners, polygon};
use crate::mesh::tri::limit_table::{self, LimitRatios, Normals};
use crate::mesh::tri::no_mesh::NoMesh;
use crate::mesh::tri::placement_settings::ISOLINES;
use crate::mesh::tri::tree::Class;
use crate::mesh::tri::triangulation::Triangulation;

/// A face to be triangulated between isolines.
pub struct IsolineInput<'a> {
    /// The surface in its chart.
    pub chart: &'a Chart,
    /// The border.
    pub outline: &'a Outline,
    /// Chord error and angle.
    pub limits: &'a Limits,
    /// Longest side of a cell, model units.
    pub size: f64,
    /// Places where it is shorter.
    pub rules: &'a Sources,
    /// Floor of all sizes, model units; 0: none.
    pub floor: f64,
    /// Most inner nodes.
    pub most: usize,
    /// Points nearer to each other are one, model units.
    pub point: f64,
}

/// Why there is no mesh.
#[derive(Clone, Copy, Debug)]
pub enum Failure {
    /// One of any method.
    NoMesh(NoMesh),
    /// A limit demands a length below the floor: that length, and where.
    Floor(f64, DVec3),
    /// A limit is not kept: the ratios, and where.
    Missed(LimitRatios, DVec3),
}

/// A face triangulated between isolines.
pub struct IsolineMesh {
    /// Its triangles.
    pub triangulation: Triangulation,
    /// Its cells.
    pub tally: Tally,
    /// What decided how small they are.
    pub decided: Decided,
}

type IsolineResult<T> = std::result::Result<T, Failure>;

/// Triangulates a face; the outer result is an interruption.
pub fn mesh_isolines(input: &IsolineInput, job: &Job) -> Result<IsolineResult<IsolineMesh>> {
    let outline = input.outline;
    let at: Vec<DVec2> = outline.xy.iter().map(|xy| DVec2::from(input.chart.uv(*xy))).collect();
    let mut segments: Vec<[DVec2; 2]> = outline.edges().map(|e| e.map(|n| at[n as usize])).collect();
    // Single nodes inside count as segments without length.
    let mut alone = vec![true; at.len()];
    outline.edges().flatten().for_each(|n| alone[n as usize] = false);
    segments.extend((0..at.len()).filter(|n| alone[*n]).map(|n| [at[n]; 2]));
    let kinks = if input.limits.chord.is_some() { kinks(input.chart) } else { Default::default() };
    let cells = IsolineCells::new(&segments, outline.loops.len(), kinks);
    let mut mesher =
        IsolineMesher { input, at, cells, points: BTreeMap::new(), fillings: BTreeMap::new(), normals: Normals::default(), worst: None };
    let mut again = mesher.settle(vec![0]);
    for _ in 0..ISOLINES.max_rounds {
        job.go_on()?;
        if let Err(failure) = again {
            return Ok(Err(failure));
        }
        match mesher.round() {
            Ok(Some(mesh)) => return Ok(Ok(mesh)),
            other => again = other.map(|_| ()),
        }
    }
    Ok(again.and_then(|()| Err(mesher.missed())))
}

/// Values of u and of v at which directions jump; over seams they come again.
fn kinks(chart: &Chart) -> [Vec<f64>; 2] {
    let (us, vs) = chart.surface().kinks();
    [us, vs].map(|all| all.iter().flat_map(|x| [x - 1.0, *x, x + 1.0]).collect())
}

/// The points round a cell, and its triangles.
struct CellFilling {
    p: Vec<DVec3>,
    filling: Option<Filling>,
}

/// The triangulation between isolines at work.
struct IsolineMesher<'a> {
    input: &'a IsolineInput<'a>,
    /// Places of the border's nodes in (u, v).
    at: Vec<DVec2>,
    cells: IsolineCells<'a>,
    /// Points by the bits of their (u, v).
    points: BTreeMap<(u64, u64), DVec3>,
    /// By cell.
    fillings: BTreeMap<u32, CellFilling>,
    normals: Normals,
    /// The worst triangle seen in the last round.
    worst: Option<(LimitRatios, DVec3)>,
}

impl IsolineMesher<'_> {
    fn missed(&self) -> Failure {
        let (ratio, at) = self.worst.unwrap_or_default();
        Failure::Missed(ratio, at)
    }

    fn place(&self, at: DVec2) -> DVec2 {
        self.input.chart.clamp(self.input.chart.xy(at.into()))
    }

    fn point(&mut self, at: DVec2) -> DVec3 {
        let key = (at.x.to_bits(), at.y.to_bits());
        if let Some(p) = self.points.get(&key) {
            return *p;
        }
        let p = self.input.chart.spot(self.place(at)).p;
        self.points.insert(key, p);
        p
    }

    /// One round: the triangles, or cells cut where they exceed the limits.
    fn round(&mut self) -> IsolineResult<Option<IsolineMesh>> {
        let outline = self.input.outline;
        work::spend(ISOLINES.cell_work * self.cells.all().len() as u64 + ISOLINES.node_work * self.at.len() as u64);
        let mut corners = self.corners();
        let mut triangulation = Triangulation::default();
        (triangulation.p, triangulation.xy, triangulation.fixed) = (outline.p.clone(), outline.xy.clone(), outline.p.len() as u32);
        for (k, corner) in corners.all.iter().enumerate() {
            if corner.dropped {
                continue;
            }
            corners.node[k] = corner.border;
            if corner.border.is_none() && !self.unfit(corner.at) {
                corners.node[k] = Some(triangulation.p.len() as u32);
                triangulation.p.push(self.point(corner.at));
                triangulation.xy.push(self.place(corner.at));
            }
        }
        if triangulation.p.len() > self.input.most {
            return Err(Failure::NoMesh(NoMesh::TooManyNodes));
        }
        let (sure, bad) = self.whole(&corners, &triangulation);
        if !bad.is_empty() {
            return self.cut(bad).map(|()| None);
        }
        let (all, kept) = self.triangulated(&triangulation, &sure)?;
        let sure: BTreeSet<[u32; 3]> = sure.into_iter().map(sorted).collect();
        triangulation.size = vec![self.input.size; triangulation.p.len()];
        let mut triangulation = Triangulation::new(triangulation.p, triangulation.xy, triangulation.size, triangulation.fixed, &all, &kept);
        let of = |c: &[u32; 3]| if sure.contains(&sorted(*c)) { None } else { self.ratio_beside(&triangulation, *c) };
        let mut ratios: Vec<Option<LimitRatios>> = triangulation.tri.iter().map(of).collect();
        self.flip_over(&mut triangulation, &mut ratios);
        let bad = self.beside(&triangulation, &ratios);
        if self.worst.is_some() {
            if bad.is_empty() {
                return Err(self.missed());
            }
            return self.cut(bad).map(|()| None);
        }
        let tally = self.tally(&corners);
        let decided = self.decided(&corners, &triangulation);
        lock(&mut triangulation, outline);
        triangulation.lift_flat();
        Ok(Some(IsolineMesh { triangulation, tally, decided }))
    }

    /// Triangles of the cells that no border crosses, and the cells of which some exceed the limits, with their cuts.
    fn whole(&mut self, corners: &CellCorners, triangulation: &Triangulation) -> (Vec<[u32; 3]>, Vec<(u32, Cut)>) {
        let (mut sure, mut bad) = (Vec::new(), Vec::new());
        for k in 0..self.cells.all().len() as u32 {
            let cell = &self.cells.all()[k as usize];
            if !cell.is_leaf() || cell.class != Class::Interior {
                continue;
            }
            let bounds = (cell.low, cell.high);
            let Some(round) = polygon(corners, bounds) else { continue };
            let nodes: Vec<u32> = round.iter().filter_map(|c| corners.node[*c]).collect();
            let p: Vec<DVec3> = nodes.iter().map(|n| triangulation.p[*n as usize]).collect();
            if self.fillings.get(&k).is_none_or(|known| known.p != p) {
                let at: Vec<DVec2> = round.iter().map(|c| corners.all[*c].at).collect();
                let ratio = |c: [usize; 3]| {
                    limit_table::ratio_of_long(self.input.chart, triangulation, c.map(|i| nodes[i]), self.input.limits, &self.normals)
                        .worst()
                };
                let filling = fill(&at, &p, f64::INFINITY, &ratio);
                self.fillings.insert(k, CellFilling { p, filling });
            }
            let Some(CellFilling { filling: Some(filling), .. }) = self.fillings.get(&k) else { continue };
            if filling.ratio <= 1.0 {
                sure.extend(filling.triangles.iter().map(|t| t.map(|i| nodes[i])));
            } else if let Some(cut) = self.best_cut(k, bounds) {
                bad.push((k, Cut { parts: 2, ..cut }));
            }
        }
        (sure, bad)
    }
}

/// Only edges of borders may not change.
fn lock(triangulation: &mut Triangulation, outline: &Outline) {
    let given: BTreeSet<[u32; 2]> = outline.edges().map(|[a, b]| [a.min(b), a.max(b)]).collect();
    for t in 0..triangulation.tri.len() {
        let c = triangulation.tri[t];
        let edge = |k: usize| [c[(k + 1) % 3].min(c[(k + 2) % 3]), c[(k + 1) % 3].max(c[(k + 2) % 3])];
        triangulation.locked[t] = (0..3).filter(|k| given.contains(&edge(*k))).fold(0, |bits, k| bits | 1 << k);
    }
}
