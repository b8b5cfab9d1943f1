//! From what a `mesh` declaration says to a plan for the mesher: values become surfaces, chains and points.

use std::collections::{BTreeMap, BTreeSet};

use super::consumed::is_part;
use crate::base::fault::{Fault, Say, ValueFault};
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::scene::Scene;
use crate::lang::values::plans::{MeshSpec, RuleSpec};
use crate::lang::values::value::{BodyKind, EntityHome, ModuleId, ShellValue, Value};
use crate::mesh::request::fault::MeshFault;
use crate::mesh::request::plan::{GroupRequest, Place, Refine, Target};
use crate::mesh::{Plan, Rule};
use crate::model::carry::Stage;
use crate::model::{Model, SharedEdge, Shell, SurfaceId};
use crate::network::Chain;
use crate::surface::Surface;

/// Finds what the values of a mesh stand for.
struct Finder<'s> {
    scene: &'s Scene,
    module: ModuleId,
    tolerance: Tolerance,
}

/// The faces of a mesh by what decides their sides.
#[derive(Default)]
pub struct Faces {
    /// Those of no closed shell, with `true` where the other side was given.
    loose: Vec<(SurfaceId, bool)>,
    /// Those that a file does not keep together.
    unsewn: BTreeSet<SurfaceId>,
    /// Those of closed shells.
    closed: BTreeSet<SurfaceId>,
    /// What asks a shell among them to join faces that touch.
    imprint: Option<Origin>,
    /// Those of each solid or closed shell of an imported part.
    bodies: Vec<BTreeSet<SurfaceId>>,
}

impl Faces {
    /// Adds surfaces by themselves, with `true` where the other side was given.
    pub fn add_surfaces(&mut self, plan: &mut Plan, found: &[(SurfaceId, bool)]) {
        self.loose.extend(found);
        plan.surfaces.extend(found);
    }

    /// Adds the surfaces of a shell.
    pub fn add_shell(&mut self, plan: &mut Plan, shell: &ShellValue, built: &Shell) {
        self.imprint = self.imprint.or(shell.imprint);
        for (surface, _) in &built.surfaces {
            let near = plan.glue.entry(*surface).or_insert(built.near);
            *near = near.max(built.near);
        }
        if shell.body == Some(BodyKind::Solid) || shell.body.is_some() && built.closed {
            self.bodies.push(built.surfaces.iter().map(|s| s.0).collect());
        }
        if built.closed {
            self.closed.extend(built.surfaces.iter().map(|s| s.0));
        } else {
            self.loose.extend(&built.surfaces);
            if shell.body.is_some() {
                self.unsewn.extend(built.surfaces.iter().map(|s| s.0));
            }
        }
        plan.surfaces.extend(&built.surfaces);
    }

    /// Adds a face of a file.
    pub fn add_unsewn(&mut self, plan: &mut Plan, found: &[(SurfaceId, bool)]) {
        self.unsewn.extend(found.iter().filter(|(_, turned)| !turned).map(|(surface, _)| *surface));
        self.add_surfaces(plan, found);
    }

    /// Puts each face into the plan once, glues those by themselves as a shell of them would be, and gives faces that are of no closed
    /// shell the sides of the shell that they would make, those of a file also where it is open; `flip` turns all.
    pub fn settle(&self, plan: &mut Plan, scene: &Scene, flip: bool, tolerance: &Tolerance) -> Result<(), Fault> {
        // A face of several shells, or one that is listed again, is there once.
        let mut listed = BTreeSet::new();
        plan.surfaces.retain(|(surface, _)| listed.insert(*surface));
        let alone: Vec<SurfaceId> = plan.surfaces.iter().map(|s| s.0).filter(|s| !plan.glue.contains_key(s)).collect();
        let near = scene.model.reach(alone.iter().copied(), None, tolerance);
        plan.glue.extend(alone.into_iter().map(|s| (s, near)));
        let mut loose = self.loose.clone();
        loose.retain(|(s, _)| !self.closed.contains(s));
        let near = loose.iter().filter_map(|(s, _)| plan.glue.get(s)).fold(near, |near, own| near.max(*own));
        let sides: BTreeMap<SurfaceId, bool> =
            scene.model.outward(&loose, &self.unsewn, near, &scene.network, tolerance)?.into_iter().collect();
        for (surface, other) in &mut plan.surfaces {
            *other = sides.get(surface).copied().unwrap_or(*other) != flip;
        }
        Ok(())
    }

    /// The body of each surface that shares nodes with its own body alone.
    pub fn apart(&self, plan: &Plan, scene: &Scene, tolerance: &Tolerance) -> BTreeMap<SurfaceId, usize> {
        super::bodies::apart(plan, &self.bodies, scene, tolerance)
    }
}

/// The plan of a mesh and the surface model it is made on. Notes about shells go to `sink`.
pub fn of(cx: &mut Cx, module: ModuleId, spec: &MeshSpec, sink: &mut Vec<Fault>) -> Result<(Plan, Scene), Halt> {
    let tolerance = cx.tolerance()?;
    let rules = spec.rules.iter().flat_map(|rule| &rule.things);
    let values = spec.things.iter().chain(rules).map(|(value, _)| value);
    let surfaces: Vec<&Surface> = values.flat_map(surfaces_of).collect();
    let scene = Scene::of(cx, module, surfaces)?;
    let finder = Finder { scene: &scene, module, tolerance };
    let mut plan = Plan::of(&spec.name, Vec::new());
    plan.most_elements = cx.job.most_elements();
    plan.origin = spec.origin;
    let mut faces = Faces::default();
    for (value, _) in &spec.things {
        finder.add(cx, &mut plan, &mut faces, value, sink)?;
    }
    let flip = spec.settings.flip.filter(|said| said.0);
    faces.settle(&mut plan, &scene, flip.is_some(), &tolerance)?;
    if let (Some((_, rule)), true) = (flip, plan.surfaces.is_empty()) {
        sink.push(MeshFault::RuleUnused { rule, why: "`flip` is for faces, and there is none here".to_owned() }.into());
    }
    plan.settings = spec.settings;
    finder.rules(cx, spec, &mut plan, sink)?;
    finder.refines(cx, spec, &mut plan)?;
    finder.groups(cx, spec, &mut plan)?;
    let imprint = spec.settings.imprint.map_or(faces.imprint, |(asked, origin)| asked.then_some(origin));
    if let Some(origin) = imprint {
        if !plan.settings.conforming() {
            sink.push(MeshFault::RuleUnused { rule: origin, why: "`conforming: false` keeps faces apart".to_owned() }.into());
        } else {
            let mut faces: Vec<SurfaceId> = plan.surfaces.iter().map(|s| s.0).collect();
            faces.sort_unstable();
            faces.dedup();
            let mut imprint = scene.model.imprint(&faces, origin, &scene.network, &tolerance, cx.job)?;
            let curves: Vec<&Chain> = plan.curves.iter().map(|(_, chain)| chain).collect();
            imprint.points.extend(scene.model.run_ends(&curves, &faces, &tolerance, cx.job)?);
            plan.imprint = Some((imprint, origin));
        }
    } else {
        plan.bodies = faces.apart(&plan, &scene, &tolerance);
    }
    let scene = super::cuts::along_curves(scene, &mut plan, &tolerance, cx.job)?;
    Ok((plan, scene))
}

impl Finder<'_> {
    /// Puts the rules of a mesh into its plan, one for each target.
    fn rules(&self, cx: &mut Cx, spec: &MeshSpec, plan: &mut Plan, sink: &mut Vec<Fault>) -> Result<(), Halt> {
        for rule in &spec.rules {
            let first = plan.rules.len();
            for (value, _) in &rule.things {
                let mut targets = self.targets(cx, value)?;
                // Where the mesh has the pieces of a surface, a rule on it speaks of them.
                let meshed = |s: &SurfaceId| plan.surfaces.iter().any(|own| own.0 == *s);
                if targets.iter().any(|t| matches!(t, Target::Surface(s) if meshed(s))) {
                    targets.retain(|t| !matches!(t, Target::Surface(s) if !meshed(s)));
                }
                for target in targets {
                    plan.rules.push(Rule { target, settings: rule.settings, origin: rule.origin });
                }
            }
            idle_settings(rule, &plan.rules[first..], sink);
        }
        Ok(())
    }

    /// Puts the places where a mesh is finer into its plan.
    fn refines(&self, cx: &mut Cx, spec: &MeshSpec, plan: &mut Plan) -> Result<(), Halt> {
        for refine in &spec.refines {
            let mut at: Vec<Place> = refine.boxes.iter().copied().map(Place::Box).collect();
            for (value, _) in &refine.things {
                match value {
                    Value::Edge(home, edge) => at.push(Place::Chain(chain_of(cx, home, edge)?)),
                    _ => {
                        for target in self.targets(cx, value)? {
                            match target {
                                Target::Chain(chain) => at.push(Place::Chain(chain)),
                                Target::Point(p) => at.push(Place::Point(p)),
                                Target::Edge(_) | Target::Surface(_) | Target::Patches(_) => {}
                            }
                        }
                    }
                }
            }
            // That nothing was selected was said where it is written.
            if !at.is_empty() {
                plan.refines.push(Refine { at, size: refine.size, radius: refine.radius, origin: refine.origin });
            }
        }
        Ok(())
    }

    /// Puts groups into the plan of a mesh: of each shell with a name, then the declared ones.
    fn groups(&self, cx: &mut Cx, spec: &MeshSpec, plan: &mut Plan) -> Result<(), Halt> {
        let shells = spec.things.iter().filter_map(|(value, _)| if let Value::Shell(shell) = value { Some((shell, value)) } else { None });
        for (shell, value) in shells {
            if !shell.name.is_empty() && !plan.groups.iter().any(|group| *group.name == *shell.name) {
                plan.groups.push(GroupRequest { name: shell.name.to_string(), members: self.targets(cx, value)?, origin: shell.origin });
            }
        }
        for group in &cx.groups(self.module)? {
            let mut members = Vec::new();
            for value in &group.value {
                // What the mesh does not hold is no part of its groups.
                if surfaces_of(value).iter().all(|s| self.scene.find(s).is_some()) {
                    members.extend(self.targets(cx, value)?);
                }
            }
            plan.groups.push(GroupRequest { name: group.name.to_string(), members, origin: group.origin });
        }
        Ok(())
    }
}

/// W701 for settings that say nothing about what their rule speaks of: steps of a face, elements of a curve.
fn idle_settings(spec: &RuleSpec, rules: &[Rule], sink: &mut Vec<Fault>) {
    let faces = rules.iter().any(|rule| matches!(rule.target, Target::Surface(_) | Target::Patches(_)));
    let curves = rules.iter().any(|rule| matches!(rule.target, Target::Chain(_) | Target::Edge(_)));
    // A count on faces is for each of their sides.
    let of_curves = [("bias", spec.settings.bias.map(|s| s.1))];
    let of_faces = [("elements", spec.settings.elements.map(|s| s.1)), ("method", spec.settings.method.map(|s| s.1))];
    let mut idle = |settings: &[(&str, Option<Origin>)], what: &str| {
        for (key, rule) in settings {
            if let Some(rule) = *rule {
                sink.push(MeshFault::RuleUnused { rule, why: format!("`{key}` is for {what}, and there is none here") }.into());
            }
        }
    };
    if faces && !curves {
        idle(&of_curves, "curves");
    }
    if curves && !faces {
        idle(&of_faces, "faces");
    }
}

/// The surfaces that a value is or holds.
pub(super) fn surfaces_of(value: &Value) -> Vec<&Surface> {
    match value {
        Value::Surface(surface) => vec![surface],
        Value::Shell(shell) => shell.surfaces.iter().collect(),
        _ => Vec::new(),
    }
}

impl Finder<'_> {
    /// Adds a thing of the `of` list.
    fn add(&self, cx: &mut Cx, plan: &mut Plan, faces: &mut Faces, value: &Value, sink: &mut Vec<Fault>) -> Result<(), Halt> {
        match value {
            Value::Surface(surface) => {
                let found = self.scene.find_all([surface])?;
                if cx.said_of(surface).is_some() {
                    faces.add_unsewn(plan, &found);
                } else {
                    faces.add_surfaces(plan, &found);
                }
            }
            Value::Shell(shell) => {
                // Whether it is open was said where the shell is declared.
                let mut said = Vec::new();
                let built = self.scene.shell(shell, &self.tolerance, &mut said)?;
                faces.add_shell(plan, shell, &built);
                // Contacts of faces are reported for the mesh, where it has them.
                sink.extend(said.into_iter().filter(|fault| !fault.code().0.starts_with('N') && fault.code().0 != "W667"));
            }
            Value::Curve(chain) => plan.curves.push((cx.name(chain.origin()), chain.clone())),
            Value::Node(p) | Value::Vector(p, _) => plan.points.push(*p),
            Value::Edge(home, edge) => {
                let chain = chain_of(cx, home, edge)?;
                let name = edge_name(cx, &chain, edge);
                plan.curves.push((name, chain));
            }
            Value::Link(..) | Value::Vertex(..) => {
                for target in self.targets(cx, value)? {
                    match target {
                        Target::Chain(chain) => plan.curves.push((cx.name(chain.origin()), chain)),
                        Target::Point(p) => plan.points.push(p),
                        Target::Edge(_) | Target::Surface(_) | Target::Patches(_) => {}
                    }
                }
            }
            other => return Err(wrong(other)),
        }
        Ok(())
    }

    /// Surfaces as targets, and pieces of them that the scene holds: what `split` and `imprint` cut from them.
    fn faces<'s>(&self, surfaces: impl IntoIterator<Item = &'s Surface>) -> Result<Vec<Target>, Halt> {
        let mut found = Vec::new();
        for surface in surfaces {
            let (own, _) = self.scene.find(surface).ok_or(Halt::Bug("a surface is not in its scene"))?;
            let all = self.scene.model.surfaces.iter().enumerate();
            let pieces = all.filter(|(n, named)| *n != own.index() && is_part(&named.surface, surface));
            found.extend(std::iter::once(own).chain(pieces.map(|(n, _)| SurfaceId::at(n))).map(Target::Surface));
        }
        Ok(found)
    }

    /// What a rule or a group speaks of.
    fn targets(&self, cx: &mut Cx, value: &Value) -> Result<Vec<Target>, Halt> {
        Ok(match value {
            // Links are numbered in the network of their own script.
            Value::Link(of, _) if *of != self.module => {
                let what = format!("{} of a module in a mesh or group of another script", value.ty().words());
                return Err(ValueFault::NotInThisVersion { what }.into());
            }
            Value::Surface(surface) => self.faces([surface])?,
            Value::Shell(shell) => self.faces(&shell.surfaces)?,
            Value::Curve(chain) => vec![Target::Chain(chain.clone())],
            Value::Link(_, link) => vec![Target::Chain(self.scene.network.link_chain(*link))],
            Value::Edge(home, edge) => {
                let (model, network) = (cx.model(home)?, cx.network_of(home)?);
                let place = |id: SurfaceId| self.place(&model, id);
                let stage = Stage { model: &self.scene.model, network: &self.scene.network };
                vec![Target::Edge(model.carried(&network, &edge.courses, stage, &place))]
            }
            Value::Patch(home, patch) => {
                let model = cx.model(home)?;
                let own = model.patches[patch.index()].surface;
                let rank = model.patches_of(own).position(|p| p == *patch).unwrap_or(0);
                let there = self.place(&model, own).and_then(|id| self.scene.model.patches_of(id).nth(rank));
                vec![Target::Patches(there.into_iter().collect())]
            }
            Value::Vertex(home, vertex) => vec![Target::Point(cx.model(home)?.vertices[vertex.index()].point)],
            Value::Node(p) | Value::Vector(p, _) => vec![Target::Point(*p)],
            other => return Err(wrong(other)),
        })
    }

    /// A surface of another model in the scene; its other side has its edges and patches elsewhere and does not count.
    fn place(&self, model: &Model, id: SurfaceId) -> Option<SurfaceId> {
        self.scene.find(&model.surfaces[id.index()].surface).filter(|(_, flipped)| !flipped).map(|found| found.0)
    }
}

/// The name of an edge in files: that of the surface or curve that it lies on, and its number.
pub(super) fn edge_name(cx: &Cx, chain: &Chain, edge: &SharedEdge) -> String {
    format!("{}_edge_{}", cx.name(chain.origin()), edge.named_by.index() + 1)
}

/// The curve along an edge.
pub(super) fn chain_of(cx: &mut Cx, home: &EntityHome, edge: &SharedEdge) -> Result<Chain, Halt> {
    let tolerance = cx.tolerance()?;
    let scene = Scene { model: cx.model(home)?, network: cx.network_of(home)? };
    let later = || ValueFault::NotInThisVersion { what: "a line across a trimmed surface as a curve".to_owned() };
    Ok(scene.shared_chain(edge, &tolerance)?.ok_or_else(later)?)
}

fn wrong(value: &Value) -> Halt {
    let wanted = "surfaces, shells, curves and points";
    ValueFault::WrongKind { argument: "of", wanted, found: value.ty().words() }.into()
}
