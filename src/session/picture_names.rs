//! Names beside what a picture shows: those that a script can be asked with.

use std::collections::BTreeMap;

use glam::DVec3;

use super::picture_things::Things;
use super::pictures::PictureContext;
use crate::base::fault::Say;
use crate::draw::{Label, Scene as Drawing};
use crate::lang::eval::context::Cx;
use crate::lang::syntax::ast::Keyword;
use crate::lang::values::plans::PictureSpec;
use crate::lang::values::value::{ModuleId, Value};
use crate::network::chain::same_curve;
use crate::network::{Chain, LinkId, Network};

/// Places along a curve where its name may stand, as fractions, the best first.
const ALONG: [f64; 7] = [0.5, 0.4, 0.6, 0.25, 0.75, 0.12, 0.88];
/// Places on a surface where its name may stand.
const ON: usize = 24;
/// Ranks: points and nodes first, then surfaces, curves, links.
const RANKS: (u8, u8, u8, u8) = (0, 1, 2, 3);

/// The name of a link as a script says it: that of its curve, with its place where the curve has several.
pub(super) fn of_link(network: &Network, link: LinkId) -> String {
    let curve = &network.curves[network.links[link.index()].curve.index()];
    match curve.links.iter().position(|(own, _)| *own == link) {
        Some(_) if curve.links.len() == 1 => curve.name.clone(),
        Some(k) => format!("{}.links[{k}]", curve.name),
        None => curve.name.clone(),
    }
}

/// Curves with the names by which a script can say them, by the bits of where they begin.
type Named = BTreeMap<[u64; 3], Vec<(Chain, String)>>;

/// Names of the curves of imported files, read when first asked for.
#[derive(Default)]
pub(super) struct Imported {
    curves: Option<Named>,
}

fn start(chain: &Chain) -> [u64; 3] {
    chain.start().to_array().map(f64::to_bits)
}

impl Imported {
    /// The name of a curve: as declared; of one that was imported the name in its file, or its place there.
    pub fn name(&mut self, cx: &mut Cx, chain: &Chain) -> String {
        let name = cx.name(chain.origin());
        // What a file holds comes from the path of its import.
        if !name.starts_with('"') {
            return name;
        }
        let curves = self.curves.get_or_insert_with(|| read(cx));
        let same = |other: &Chain| match (other.whole_curve(), chain.whole_curve()) {
            (Some(a), Some(b)) => same_curve(a, b),
            _ => false,
        };
        let found = curves.get(&start(chain)).and_then(|list| list.iter().find(|(other, _)| same(other)));
        found.map_or(name, |(_, name)| name.clone())
    }
}

/// Declared names first, then names in the files, then places in their lists.
fn read(cx: &mut Cx) -> Named {
    let mut curves = Named::new();
    let mut put = |chain: &Chain, name: String| curves.entry(start(chain)).or_default().push((chain.clone(), name));
    if let Ok(sound) = cx.sound(ModuleId::MAIN) {
        sound.parts.curves.iter().for_each(|declared| put(&declared.value, declared.name.to_string()));
    }
    let imports = cx.symbols().into_iter().filter(|s| s.keyword == Keyword::Import).filter_map(|s| s.name);
    for import in imports.collect::<Vec<String>>() {
        let Some(Value::Record(record)) = cx.value_of(&import) else { continue };
        for (key, value) in record.keys.iter().zip(&record.values) {
            if let Value::Curve(chain) = value {
                put(chain, cx.program.names.text(*key).to_owned());
            }
        }
        let list = record.keys.iter().position(|key| cx.program.names.text(*key) == "curves");
        let Some(Value::List(items)) = list.and_then(|k| record.values.get(k)) else { continue };
        for (k, item) in items.iter().enumerate() {
            if let Value::Curve(chain) = item {
                put(chain, format!("{import}.curves[{k}]"));
            }
        }
    }
    curves
}

fn along(chain: &Chain) -> Vec<DVec3> {
    ALONG.iter().map(|f| chain.point(*f)).collect()
}

/// Adds the names of what is drawn where they are wanted.
pub(super) fn add(spec: &PictureSpec, things: &Things, context: &PictureContext, drawing: &mut Drawing) {
    let network = context.network(spec, things);
    let drawn = network.is_some() || !things.curves.is_empty() || !things.points.is_empty();
    if !spec.show.labels.unwrap_or(drawn) {
        return;
    }
    let mut labels = surfaces(drawing);
    if let Some(net) = network {
        labels.extend(nodes(context, net));
        labels.extend((0..net.links.len()).map(LinkId::at).map(|link| {
            let rank = if net.curves[net.links[link.index()].curve.index()].links.len() == 1 { RANKS.2 } else { RANKS.3 };
            Label { text: of_link(net, link), places: along(&net.link_chain(link)), rank, centered: false }
        }));
    } else {
        labels.extend(things.curves.iter().map(|(name, chain)| Label {
            text: name.clone(),
            places: along(chain),
            rank: RANKS.2,
            centered: false,
        }));
    }
    for (name, at) in &things.points {
        let name = if name.is_empty() { declared(context, *at) } else { Some(name.clone()) };
        labels.extend(name.map(|text| Label { text, places: vec![*at], rank: RANKS.0, centered: false }));
    }
    labels.retain(|label| !label.text.is_empty());
    let mut seen: Vec<(String, DVec3)> = Vec::new();
    labels.retain(|label| {
        let key = (label.text.clone(), label.places.first().copied().unwrap_or_default());
        let new = !seen.contains(&key);
        if new && label.rank == RANKS.0 {
            seen.push(key);
        }
        new
    });
    drawing.labels = labels;
}

/// The declared point at a place.
fn declared(context: &PictureContext, at: DVec3) -> Option<String> {
    let near = |p: &&crate::lang::eval::pipeline::Declared<DVec3>| context.tolerance.same_point(p.value, at);
    context.sound.parts.points.iter().find(near).map(|p| p.name.to_string())
}

/// Surfaces by name, at the middles of some of their triangles, those nearest to the middle of all first.
fn surfaces(drawing: &Drawing) -> Vec<Label> {
    let mut places: BTreeMap<&str, Vec<DVec3>> = BTreeMap::new();
    let mut order: Vec<&str> = Vec::new();
    for sheet in &drawing.sheets {
        let step = (sheet.triangles.len() / ON).max(1);
        let middle = |t: &[u32; 3]| t.iter().map(|c| sheet.points[*c as usize]).sum::<DVec3>() / 3.0;
        if !places.contains_key(sheet.name.as_str()) {
            order.push(&sheet.name);
        }
        places.entry(&sheet.name).or_default().extend(sheet.triangles.iter().skip(step / 2).step_by(step).map(middle));
    }
    let label = |name: &str| {
        let mut own = places.get(name).cloned().unwrap_or_default();
        let mean = own.iter().sum::<DVec3>() / own.len().max(1) as f64;
        own.sort_by(|a, b| a.distance_squared(mean).total_cmp(&b.distance_squared(mean)));
        Label { text: name.to_owned(), places: own, rank: RANKS.1, centered: true }
    };
    order.into_iter().map(label).collect()
}

/// Nodes: the declared point there, else `a & b` for curves that meet, else the end of a curve.
fn nodes(context: &PictureContext, network: &Network) -> Vec<Label> {
    let mut of_node: Vec<Vec<(usize, bool, bool)>> = vec![Vec::new(); network.nodes.len()];
    for (k, curve) in network.curves.iter().enumerate() {
        let last = curve.nodes.len() - 1;
        for (n, node) in curve.nodes.iter().enumerate() {
            let own = &mut of_node[node.index()];
            if !own.iter().any(|u| u.0 == k) {
                own.push((k, n == 0, n == last));
            }
        }
    }
    let name = |n: usize| {
        let curve = |k: usize| network.curves[k].name.as_str();
        declared(context, network.nodes[n].point).or_else(|| match of_node[n].as_slice() {
            [(k, true, _)] => Some(format!("{}.start", curve(*k))),
            [(k, _, true)] => Some(format!("{}.end", curve(*k))),
            [(a, ..), (b, ..), ..] => Some(format!("{} & {}", curve(*a), curve(*b))),
            _ => None,
        })
    };
    let label = |n: usize| name(n).map(|text| Label { text, places: vec![network.nodes[n].point], rank: RANKS.0, centered: false });
    (0..network.nodes.len()).filter_map(label).collect()
}
