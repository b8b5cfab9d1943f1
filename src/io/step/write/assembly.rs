//! The products of a file: what each holds, and which products stand in it where. Places that hold the same are one product.

use glam::DVec3;

use crate::base::tolerance::{PARALLEL, Tolerance};
use crate::geometry::Motion;
use crate::io::cad::assembly::Node;
use crate::io::cad::bodies::Faces;
use crate::io::step::write::things::{StepShape, StepThing};
use crate::model::SurfaceId;
use crate::surface::{Side, Surface};

/// Places at which surfaces are compared, and shares of curves.
const PROBES: [(f64, f64); 3] = [(0.31, 0.23), (0.67, 0.41), (0.19, 0.83)];

/// What is made once, and may stand at several places.
#[derive(Clone, Debug)]
pub struct Product {
    /// Its name.
    pub name: String,
    /// What it has by itself, by places in the list of things.
    pub things: Vec<usize>,
    /// Products that stand in it.
    pub parts: Vec<Occurrence>,
    /// From its frame to that of the model, at the first of its places.
    pub motion: Motion,
    /// What its places are called.
    pub places: Vec<String>,
}

/// A product at a place in another one.
#[derive(Clone, Debug)]
pub struct Occurrence {
    /// Place in the list of products.
    pub product: usize,
    /// Its name there.
    pub name: String,
    /// From its frame to that of the product that it stands in.
    pub motion: Motion,
    /// What has the first colour in the product has the second one here.
    pub repaint: Option<Repaint>,
}

/// Red, green and blue from 0 to 1, and what stands for them.
pub type Repaint = ([f64; 3], [f64; 3]);

/// The products of things, parts before what they stand in. The last one is all of it, under `name` unless one product of the tree is;
/// products of one file that stand in none stay beside each other.
pub fn products(things: &[StepThing], nodes: &[Node], name: &str, tolerance: &Tolerance) -> Vec<Product> {
    let still = Motion::translation(DVec3::ZERO);
    let all = |things: Vec<usize>| Product { name: name.to_owned(), things, parts: Vec::new(), motion: still, places: Vec::new() };
    let mut holding: Vec<usize> = things.iter().filter_map(|thing| thing.node).collect();
    holding.sort_unstable();
    holding.dedup();
    // A product that is in no other one goes out as that; a part of an assembly goes out by itself.
    let is_whole = things.iter().all(|thing| thing.node.is_some_and(|k| nodes[k].parent.is_none()));
    if holding.len() < 2 && !is_whole {
        return vec![all((0..things.len()).collect())];
    }
    let mut tree =
        Tree { things, nodes, tolerance, name, own: vec![Vec::new(); nodes.len()], below: vec![Vec::new(); nodes.len()], made: Vec::new() };
    for (k, thing) in things.iter().enumerate() {
        if let Some(node) = thing.node {
            tree.own[node].push(k);
        }
    }
    let mut roots = Vec::new();
    // What holds nothing, not even by its parts, is no product.
    let mut holds: Vec<bool> = tree.own.iter().map(|own| !own.is_empty()).collect();
    for k in (0..nodes.len()).rev().filter(|k| nodes[*k].parent.is_some()) {
        if let (true, Some(parent)) = (holds[k], nodes[k].parent) {
            holds[parent] = true;
        }
    }
    for k in (0..nodes.len()).filter(|k| holds[*k]) {
        match nodes[k].parent {
            Some(parent) => tree.below[parent].push(k),
            None => roots.push(k),
        }
    }
    let loose: Vec<usize> = (0..things.len()).filter(|k| things[*k].node.is_none()).collect();
    let parts: Vec<Occurrence> = roots.iter().map(|root| tree.occurrence(*root, &still)).collect();
    let of_one_file = roots.windows(2).all(|pair| nodes[pair[0]].file == nodes[pair[1]].file);
    if !of_one_file || !loose.is_empty() {
        let top = Product { parts, ..all(loose) };
        tree.made.push((usize::MAX, top));
    }
    tree.made.into_iter().map(|(_, product)| product).collect()
}

/// Whether one product is all of it, the last one.
pub fn is_one(products: &[Product]) -> bool {
    let mut inner = vec![false; products.len()];
    products.iter().flat_map(|product| &product.parts).for_each(|part| inner[part.product] = true);
    inner.iter().filter(|inner| !**inner).count() == 1
}

/// How often each product stands in all of it.
pub fn uses(products: &[Product]) -> Vec<usize> {
    let mut uses = vec![1; products.len()];
    products.iter().flat_map(|product| &product.parts).for_each(|part| uses[part.product] = 0);
    for k in (0..products.len()).rev() {
        for part in &products[k].parts {
            uses[part.product] += uses[k];
        }
    }
    uses
}

struct Tree<'t> {
    things: &'t [StepThing],
    nodes: &'t [Node],
    tolerance: &'t Tolerance,
    /// What a whole without a name is called.
    name: &'t str,
    /// Things of each node by itself.
    own: Vec<Vec<usize>>,
    /// Nodes that stand in each.
    below: Vec<Vec<usize>>,
    /// Products with what their nodes are of.
    made: Vec<(usize, Product)>,
}

impl Tree<'_> {
    /// A node in the frame of what it stands in.
    fn occurrence(&mut self, k: usize, around: &Motion) -> Occurrence {
        let node = &self.nodes[k];
        // A frame of STEP neither mirrors nor scales: what is so placed stays where it is.
        let is_rigid = !node.motion.mirrors() && (node.motion.scale() - 1.0).abs() <= PARALLEL;
        let motion = if is_rigid { node.motion } else { *around };
        let parts: Vec<Occurrence> = self.below[k].clone().into_iter().map(|part| self.occurrence(part, &motion)).collect();
        let same = |(of, product): &(usize, Product)| if *of == node.of { self.same(product, k, &parts, &motion) } else { None };
        let known = self.made.iter().enumerate().find_map(|(n, made)| same(made).map(|repaint| (n, repaint)));
        let (product, repaint) = known.unwrap_or_else(|| {
            let given = [&node.product, &node.name].into_iter().find(|name| !name.is_empty());
            let name = given.map_or_else(|| if node.parent.is_none() { self.name.to_owned() } else { String::new() }, String::clone);
            self.made.push((node.of, Product { name, things: self.own[k].clone(), parts, motion, places: Vec::new() }));
            (self.made.len() - 1, None)
        });
        self.made[product].1.places.push(node.name.clone());
        Occurrence { product, name: node.name.clone(), motion: motion.then(&around.inverse()), repaint }
    }

    /// Whether a product is what a node holds, placed otherwise; if so, the colour that is another one there.
    fn same(&self, product: &Product, k: usize, parts: &[Occurrence], motion: &Motion) -> Option<Option<Repaint>> {
        let by = product.motion.inverse().then(motion);
        let same_part = |(a, b): (&Occurrence, &Occurrence)| {
            a.product == b.product && a.name == b.name && a.repaint == b.repaint && self.is_one(&a.motion, &b.motion)
        };
        let things = || product.things.iter().zip(&self.own[k]).map(|(a, b)| (&self.things[*a], &self.things[*b]));
        let same = product.things.len() == self.own[k].len()
            && product.parts.len() == parts.len()
            && product.parts.iter().zip(parts).all(same_part)
            && things().all(|(a, b)| self.is_copy(a, b, &by));
        if same { repainted(things()) } else { None }
    }

    fn is_one(&self, a: &Motion, b: &Motion) -> bool {
        let is_near = |axis: DVec3| a.vector(axis).distance(b.vector(axis)) <= PARALLEL;
        self.tolerance.same_point(a.point(DVec3::ZERO), b.point(DVec3::ZERO)) && DVec3::AXES.into_iter().all(is_near)
    }

    /// Whether a thing is another one moved, on the same layers.
    fn is_copy(&self, a: &StepThing, b: &StepThing, by: &Motion) -> bool {
        let near = |p: DVec3, q: DVec3| self.tolerance.same_point(by.point(p), q);
        let same_shape = match (&a.shown, &b.shown) {
            (StepShape::Point(p), StepShape::Point(q)) => near(*p, *q),
            (StepShape::Curve(a), StepShape::Curve(b)) => PROBES.iter().all(|(f, _)| near(a.point(*f), b.point(*f))),
            (StepShape::Faces(a), StepShape::Faces(b)) => is_copy(a, b, &near),
            _ => false,
        };
        same_shape && a.layers == b.layers
    }
}

/// A colour, or none, of a thing and of its copy.
type Pair = (Option<[f64; 3]>, Option<[f64; 3]>);

/// The one colour that is another one in copies of things; none where more than that differs.
fn repainted<'t>(pairs: impl Iterator<Item = (&'t StepThing, &'t StepThing)>) -> Option<Option<Repaint>> {
    let mut colors: Vec<Pair> = Vec::new();
    for (a, b) in pairs {
        colors.push((a.color, b.color));
        if let (StepShape::Faces(a), StepShape::Faces(b)) = (&a.shown, &b.shown) {
            let faces = a.shell.surfaces.iter().zip(&b.shell.surfaces);
            colors.extend(faces.map(|(one, other)| (a.colors.get(&one.0).copied(), b.colors.get(&other.0).copied())));
        }
    }
    let Some(first) = colors.iter().find(|(a, b)| a != b).copied() else { return Some(None) };
    let (Some(from), Some(to)) = first else { return None };
    let as_repainted = |(a, b): &Pair| *b == if *a == Some(from) { Some(to) } else { *a };
    colors.iter().all(as_repainted).then_some(Some((from, to)))
}

/// Whether faces are others moved, face by face, with the same names and layers.
fn is_copy(a: &Faces, b: &Faces, near: &dyn Fn(DVec3, DVec3) -> bool) -> bool {
    let same = |(one, other): (&(SurfaceId, bool), &(SurfaceId, bool))| {
        let (s, t) = (&a.model.surfaces[one.0.index()].surface, &b.model.surfaces[other.0.index()].surface);
        one.1 == other.1
            && a.names.get(&one.0) == b.names.get(&other.0)
            && a.layers.get(&one.0) == b.layers.get(&other.0)
            && compared(s).iter().zip(compared(t)).all(|(p, q)| near(*p, q))
    };
    let (one, other) = (&a.shell.surfaces, &b.shell.surfaces);
    a.solid == b.solid && one.len() == other.len() && one.iter().zip(other).all(same)
}

/// Places of a surface that show where it is; of a plane, whose (u, v) may run otherwise in a copy, those of its border.
fn compared(surface: &Surface) -> Vec<DVec3> {
    if !surface.is_flat() {
        return PROBES.iter().map(|(u, v)| surface.point(*u, *v)).collect();
    }
    let of_side = |k: usize| match surface.side(k) {
        Side::Chain { chain, from, to } => [chain.point(from), chain.point(0.5 * (from + to))].to_vec(),
        _ => Vec::new(),
    };
    (0..surface.n_sides()).flat_map(of_side).collect()
}
