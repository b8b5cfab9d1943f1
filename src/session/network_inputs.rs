//! The curves that go into a network: declared ones, and those that surfaces stand on.

use std::collections::BTreeMap;

use super::canonical;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::geometry::Curve;
use crate::network::Chain;
use crate::network::chain::same_curve;
use crate::network::graph::Input;
use crate::surface::Surface;

/// Curves found again by their shape: curves that are one share their ends.
#[derive(Default)]
struct Shapes {
    by_ends: BTreeMap<[u64; 6], Vec<usize>>,
}

impl Shapes {
    fn key(curve: &Curve) -> [u64; 6] {
        let (a, b) = (curve.start(), curve.end());
        // Adding zero makes the two zeros one.
        [a.x, a.y, a.z, b.x, b.y, b.z].map(|x| (x + 0.0).to_bits())
    }

    fn find(&self, curve: &Curve, inputs: &[Input]) -> Option<usize> {
        self.by_ends.get(&Self::key(curve))?.iter().copied().find(|&i| same_curve(&inputs[i].curve, curve))
    }

    fn add(&mut self, curve: &Curve, index: usize) {
        self.by_ends.entry(Self::key(curve)).or_default().push(index);
    }
}

/// What goes into the network, in canonical order: declared curves with their names, nameless and `let` ones that surfaces stand on,
/// with cuts where runs of modeling curves end. Other `let` curves are construction geometry and stay out. `name` is the text that a
/// curve was made by.
pub fn inputs(
    curves: &[(&str, &Chain)],
    modeling: Vec<&Chain>,
    surfaces: &[&Surface],
    name: &dyn Fn(Origin) -> String,
    tolerance: &Tolerance,
) -> Vec<Input> {
    let whole = |(name, chain): &(&str, &Chain)| {
        let curve = chain.whole_curve().cloned().or_else(|| chain.runs().first().map(|run| run.curve.clone()))?;
        Some(Input { name: (*name).to_owned(), curve, cuts: Vec::new() })
    };
    let mut inputs: Vec<Input> = curves.iter().filter_map(whole).collect();
    canonical::sort_curves(&mut inputs, tolerance);
    let below = || surfaces.iter().flat_map(|s| s.chains().iter());
    if modeling.is_empty() && below().next().is_none() {
        return inputs;
    }
    let mut shapes = Shapes::default();
    inputs.iter().enumerate().for_each(|(i, input)| shapes.add(&input.curve, i));
    add_nameless(below(), name, &mut inputs, &mut shapes, tolerance);
    for run in modeling.into_iter().chain(below()).flat_map(Chain::runs) {
        let Some(index) = shapes.find(&run.curve, &inputs) else { continue };
        let length = run.curve.length();
        let inside = [run.s0, run.s1].into_iter().map(|s| if s > length { s - length } else { s });
        inputs[index].cuts.extend(inside.filter(|s| *s > 0.0 && *s < length));
    }
    inputs.iter_mut().for_each(|input| input.cuts.sort_by(f64::total_cmp));
    canonical::sort_curves(&mut inputs, tolerance);
    inputs
}

/// Adds the curves of chains that no input is, under the text they were made by.
fn add_nameless<'p>(
    chains: impl Iterator<Item = &'p Chain>,
    name: &dyn Fn(Origin) -> String,
    inputs: &mut Vec<Input>,
    shapes: &mut Shapes,
    tolerance: &Tolerance,
) {
    let runs = chains.flat_map(Chain::runs).filter(|run| shapes.find(&run.curve, inputs).is_none());
    let mut nameless: Vec<(Curve, String)> = runs.map(|run| (run.curve.clone(), name(run.curve.origin()))).collect();
    canonical::sort_named(&mut nameless, tolerance);
    let mut names: BTreeMap<String, usize> = inputs.iter().map(|i| (i.name.clone(), 1)).collect();
    for (curve, name) in nameless {
        if shapes.find(&curve, inputs).is_none() {
            shapes.add(&curve, inputs.len());
            inputs.push(Input { name: unique(&mut names, name), curve, cuts: Vec::new() });
        }
    }
}

/// The name, or with a number behind it where it is taken.
fn unique(names: &mut BTreeMap<String, usize>, name: String) -> String {
    let name = if name.is_empty() { "curve".to_owned() } else { name };
    let taken = names.entry(name.clone()).or_insert(0);
    *taken += 1;
    if *taken == 1 { name } else { format!("{name} ({taken})") }
}
