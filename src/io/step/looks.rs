//! Colours of items, and layers.

use std::collections::BTreeMap;

use super::part21::{File, Kind};
use crate::base::job;

/// Red, green and blue from 0 to 1, with the file's name.
pub type Color = ([f64; 3], String);

/// Entities passed on the way from a style to its colour.
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

/// Colours of surfaces and of curves by the item that has them, and the members of layers.
#[derive(Debug, Default)]
pub struct Looks {
    surfaces: BTreeMap<u32, Color>,
    curves: BTreeMap<u32, Color>,
    /// Names of layers with their entity and items, in file order.
    pub layers: Vec<(u32, String, Vec<u32>)>,
}

impl Looks {
    /// What a file says of looks; of two styles of an item the one that overrides counts.
    pub fn of(file: &File) -> Self {
        let mut looks = Self::default();
        let mut over = Vec::new();
        for k in 0..file.records.len() as u32 {
            if k % 1024 == 0 {
                job::look();
            }
            match file.name(k) {
                b"STYLED_ITEM" => looks.style(file, k),
                b"OVER_RIDING_STYLED_ITEM" | b"CONTEXT_DEPENDENT_OVER_RIDING_STYLED_ITEM" => over.push(k),
                b"PRESENTATION_LAYER_ASSIGNMENT" => {
                    let row = file.parameters(k);
                    let items = row.list(2).map(|list| list.values().filter_map(|v| v.entity().ok()).collect());
                    looks.layers.push((k, row.text(0), items.unwrap_or_default()));
                }
                _ => {}
            }
        }
        over.into_iter().for_each(|k| looks.style(file, k));
        looks
    }

    fn style(&mut self, file: &File, k: u32) {
        let row = file.parameters(k);
        let Ok(item) = row.entity(2) else { return };
        let styles: Vec<u32> = row.list(1).map(|l| l.values().filter_map(|v| v.entity().ok()).collect()).unwrap_or_default();
        if let Some(color) = found(file, &styles, b"CURVE_STYLE") {
            self.surfaces.insert(item, color);
        }
        if let Some(color) = found(file, &styles, b"SURFACE_STYLE_USAGE") {
            self.curves.insert(item, color);
        }
    }

    /// The colour of a surface: that of the first of these items that has one.
    pub fn surface(&self, items: &[u32]) -> Option<&Color> {
        items.iter().find_map(|k| self.surfaces.get(k))
    }

    /// The colour of a curve or point in the same way.
    pub fn curve(&self, items: &[u32]) -> Option<&Color> {
        items.iter().find_map(|k| self.curves.get(k))
    }
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
        open.extend(tokens.iter().rev().filter(|t| t.kind == Kind::Ref && t.end != super::part21::Token::NONE).map(|t| t.end));
    }
    None
}
