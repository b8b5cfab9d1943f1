//! Colours of items, and layers.

use std::collections::BTreeMap;

use crate::base::job;
use crate::io::step::contexts::Contexts;
use crate::io::step::records::{File, TokenKind};

/// Red, green and blue from 0 to 1, with the file's name.
pub type Color = ([f64; 3], String);

/// Entities passed on the way from a style to its colour, and styles that override each other.
const PASSED: usize = 64;

/// Colours by name.
const NAMED: [(&str, [f64; 3]); 8] = [
    ("black", [0.0, 0.0, 0.0]),
    ("red", [1.0, 0.0, 0.0]),
    ("green", [0.0, 1.0, 0.0]),
    ("blue", [0.0, 0.0, 1.0]),
    ("yellow", [1.0, 1.0, 0.0]),
    ("magenta", [1.0, 0.0, 1.0]),
    ("cyan", [0.0, 1.0, 1.0]),
    ("white", [1.0, 1.0, 1.0]),
];

/// A colour that an entity of the file gives to an item.
#[derive(Debug)]
struct Style {
    /// The styled item.
    entity: u32,
    color: Color,
    /// What must all be on the way to a placed item that has it.
    meant: Vec<u32>,
    /// The styled item that it overrides.
    over: Option<u32>,
}

/// Styles by the item that has them, in file order.
type Styles = BTreeMap<u32, Vec<Style>>;

/// Colours of surfaces and of curves by the item that has them, and the members of layers.
#[derive(Debug, Default)]
pub struct StyleTable {
    surfaces: Styles,
    curves: Styles,
    /// Names of layers with their entity and items, in file order.
    pub layers: Vec<(u32, String, Vec<u32>)>,
}

impl StyleTable {
    /// Colours and layers of a file.
    pub fn of(file: &File) -> Self {
        let mut table = Self::default();
        let contexts = Contexts::of(file);
        for k in 0..file.records.len() as u32 {
            if k % 1024 == 0 {
                job::poll();
            }
            match file.name(k) {
                b"STYLED_ITEM" | b"OVER_RIDING_STYLED_ITEM" | b"CONTEXT_DEPENDENT_OVER_RIDING_STYLED_ITEM" => {
                    table.style(file, &contexts, k);
                }
                b"PRESENTATION_LAYER_ASSIGNMENT" => {
                    let row = file.parameters(k);
                    let items = row.list(2).map(|list| list.values().filter_map(|v| v.entity().ok()).collect());
                    table.layers.push((k, row.text(0), items.unwrap_or_default()));
                }
                _ => {}
            }
        }
        table
    }

    fn style(&mut self, file: &File, contexts: &Contexts, k: u32) {
        let row = file.parameters(k);
        let Ok(item) = row.entity(2) else { return };
        // What is said of the representation of a product is said of the product.
        let item = if let [one] = contexts.meant(file, item)[..] { one } else { item };
        let over = row.entity(3).ok();
        let entities = |n: usize| row.list(n).map(|l| l.values().filter_map(|v| v.entity().ok()).collect::<Vec<u32>>()).unwrap_or_default();
        let contexts_of_item = entities(4);
        for (without, list) in [(b"CURVE_STYLE".as_slice(), &mut self.surfaces), (b"SURFACE_STYLE_USAGE", &mut self.curves)] {
            // One styled item may have a style for each of several contexts.
            for style in entities(1) {
                let own = file.parameters(style);
                let of_context = file.name(style) == b"PRESENTATION_STYLE_BY_CONTEXT";
                let inner = if of_context { own.entities(0).unwrap_or_default() } else { vec![style] };
                let Some(color) = found(file, &inner, without) else { continue };
                let context = own.entity(1).ok().filter(|_| of_context);
                let mut meant: Vec<u32> = contexts_of_item.iter().copied().chain(context).flat_map(|k| contexts.meant(file, k)).collect();
                meant.sort_unstable();
                meant.dedup();
                let known = list.entry(item).or_default();
                if !known.iter().any(|style| style.entity == k && style.meant == meant) {
                    known.push(Style { entity: k, color, meant, over });
                }
            }
        }
    }

    /// The colour of a surface: that of the first of these items that has one. Of the styles of one item a narrower context counts, then
    /// what overrides, then what stands later; what overrides a style elsewhere on the way goes before it. Placed by `way`: the occurrences,
    /// products and mapped items from the item up.
    pub fn surface(&self, items: &[u32], way: &[u32]) -> Option<&Color> {
        picked(&self.surfaces, items, way)
    }

    /// The colour of a curve or point in the same way.
    pub fn curve(&self, items: &[u32], way: &[u32]) -> Option<&Color> {
        picked(&self.curves, items, way)
    }
}

fn picked<'s>(styles: &'s Styles, items: &[u32], way: &[u32]) -> Option<&'s Color> {
    if styles.is_empty() {
        return None;
    }
    let holds = |style: &&Style| style.meant.iter().all(|k| way.contains(k));
    let of = |item: &u32| styles.get(item).into_iter().flatten().filter(holds);
    let all = || items.iter().chain(way).flat_map(of);
    let rank = |style: &&Style| (style.meant.len(), style.over.is_some(), style.entity);
    let mut now = items.iter().chain(way).find_map(|item| of(item).max_by_key(rank))?;
    for _ in 0..PASSED {
        match all().filter(|style| style.over == Some(now.entity)).max_by_key(rank) {
            Some(next) => now = next,
            None => break,
        }
    }
    Some(&now.color)
}

/// The first colour below styles, not below entities of one name.
fn found(file: &File, styles: &[u32], without: &[u8]) -> Option<Color> {
    let mut open: Vec<u32> = styles.iter().rev().copied().collect();
    for _ in 0..PASSED {
        let k = open.pop()?;
        let row = file.parameters(k);
        match file.name(k) {
            name if name == without => continue,
            b"COLOUR_RGB" => {
                let part = |n: usize| row.number(n).ok().map(|x| x.clamp(0.0, 1.0));
                return Some(([part(1)?, part(2)?, part(3)?], row.text(0)));
            }
            b"DRAUGHTING_PRE_DEFINED_COLOUR" | b"PRE_DEFINED_COLOUR" => {
                let name = row.text(0);
                return NAMED.iter().find(|(word, _)| *word == name).map(|(_, rgb)| (*rgb, name));
            }
            _ => {}
        }
        let tokens = &file.tokens[row.first as usize..row.end as usize];
        open.extend(
            tokens.iter().rev().filter(|t| t.kind == TokenKind::Ref && t.end != crate::io::step::records::Token::NONE).map(|t| t.end),
        );
    }
    None
}
