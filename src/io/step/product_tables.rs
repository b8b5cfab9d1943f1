//! Which representations products have, and which products are parts of others, as the file states it.

use std::collections::{BTreeMap, BTreeSet};

use crate::base::job;
use crate::io::step::records::File;

/// A product in another one.
#[derive(Clone, Debug)]
pub(crate) struct ProductUse {
    pub(super) entity: u32,
    pub(super) child: u32,
    pub(super) name: String,
    /// The relationship between the representations, and the one of the two that is the child's, where the file has it.
    pub(super) link: Option<u32>,
}

#[derive(Debug, Default)]
pub(crate) struct Tables {
    /// Items and context of each representation.
    pub(super) representations: BTreeMap<u32, (Vec<u32>, Option<u32>)>,
    /// Representations of each product definition.
    pub(super) shapes: BTreeMap<u32, Vec<u32>>,
    /// Representations that are the same thing in the same place.
    pub(super) same: BTreeMap<u32, Vec<u32>>,
    pub(super) occurrences: BTreeMap<u32, Vec<ProductUse>>,
    /// Products that are parts of others.
    pub(super) parts: BTreeSet<u32>,
    /// Representations that mapped items of what products show place.
    pub(super) mapped: BTreeSet<u32>,
    /// Representations that mapped items of any but views place.
    pub(super) mapped_by_any: BTreeSet<u32>,
    /// Representations of drawings: saved views, which show once more what stands elsewhere.
    pub(super) views: BTreeSet<u32>,
    /// Representations of what is no product: features, properties.
    pub(super) aspects: BTreeSet<u32>,
    pub(super) products: Vec<u32>,
}

/// Whether an entity is a representation of a shape.
pub(crate) fn is_representation(file: &File, k: u32) -> bool {
    file.names(k).any(|n| n.ends_with(b"SHAPE_REPRESENTATION"))
}

/// The representation that a mapped item places.
pub(crate) fn mapped_by(file: &File, item: u32) -> Option<u32> {
    (file.name(item) == b"MAPPED_ITEM").then(|| file.parameters(item).entity(1).and_then(|map| file.parameters(map).entity(1)).ok())?
}

impl Tables {
    pub(super) fn of(file: &File) -> Self {
        let mut tables = Self::default();
        let mut defined: BTreeMap<u32, u32> = BTreeMap::new();
        let (mut shown, mut links, mut used) = (Vec::new(), Vec::new(), Vec::new());
        for k in 0..file.records.len() as u32 {
            if k % 1024 == 0 {
                job::poll();
            }
            let row = file.parameters(k);
            match file.name(k) {
                b"PRODUCT_DEFINITION" | b"PRODUCT_DEFINITION_WITH_ASSOCIATED_DOCUMENTS" => tables.products.push(k),
                b"PRODUCT_DEFINITION_SHAPE" => {
                    if let Ok(of) = row.entity(2) {
                        defined.insert(k, of);
                    }
                }
                b"SHAPE_DEFINITION_REPRESENTATION" => shown.extend(row.entity(0).ok().zip(row.entity(1).ok())),
                b"NEXT_ASSEMBLY_USAGE_OCCURRENCE" => used.push(k),
                b"CONTEXT_DEPENDENT_SHAPE_REPRESENTATION" => links.extend(row.entity(0).ok().zip(row.entity(1).ok())),
                b"SHAPE_REPRESENTATION_RELATIONSHIP" => {
                    if let (Ok(a), Ok(b)) = (row.entity(2), row.entity(3)) {
                        tables.same.entry(a).or_default().push(b);
                        tables.same.entry(b).or_default().push(a);
                    }
                }
                _ if is_representation(file, k) => {
                    let row = file.under(k, b"REPRESENTATION").unwrap_or(row);
                    let items = row.list(1).map(|list| list.values().filter_map(|v| v.entity().ok()).collect()).unwrap_or_default();
                    tables.representations.insert(k, (items, row.entity(2).ok()));
                    if file.is(k, b"DRAUGHTING_MODEL") {
                        tables.views.insert(k);
                    }
                }
                _ => {}
            }
        }
        for (shape, representation) in shown {
            match defined.get(&shape) {
                Some(of) => tables.shapes.entry(*of).or_default().push(representation),
                None => drop(tables.aspects.insert(representation)),
            }
        }
        // The relationship that places an occurrence.
        let links: BTreeMap<u32, u32> = links.into_iter().filter_map(|(link, shape)| Some((*defined.get(&shape)?, link))).collect();
        for k in used {
            let row = file.parameters(k);
            let (Ok(parent), Ok(child)) = (row.entity(3), row.entity(4)) else { continue };
            let text = |n: usize| row.text(n).trim().to_owned();
            let name = [1, 0, 5].into_iter().map(text).find(|t| !t.is_empty()).unwrap_or_default();
            tables.parts.insert(child);
            tables.occurrences.entry(parent).or_default().push(ProductUse { entity: k, child, name, link: links.get(&k).copied() });
        }
        tables.map(file);
        tables
    }

    /// Finds what mapped items place.
    fn map(&mut self, file: &File) {
        let owned: BTreeSet<u32> = self.shapes.values().flatten().copied().collect();
        self.views.retain(|view| !owned.contains(view));
        let placed = |k: &u32| {
            let items = self.representations.get(k).map_or(&[][..], |(items, _)| items);
            items.iter().filter_map(|item| mapped_by(file, *item)).collect::<Vec<u32>>()
        };
        self.mapped_by_any = self.representations.keys().filter(|k| !self.views.contains(k)).flat_map(placed).collect();
        let (mut open, mut seen): (Vec<u32>, _) = (owned.iter().copied().collect(), owned);
        while let Some(k) = open.pop() {
            let own = placed(&k);
            let same = self.same.get(&k).into_iter().flatten();
            open.extend(own.iter().chain(same).filter(|k| seen.insert(**k)));
            self.mapped.extend(own);
        }
    }

    /// The representations that are one with some, which none of another product is.
    pub(super) fn one_with(&self, first: &[u32], owned: &BTreeSet<u32>) -> Vec<u32> {
        let mut all: Vec<u32> = first.to_vec();
        let mut seen: BTreeSet<u32> = all.iter().copied().collect();
        let mut at = 0;
        while let Some(k) = all.get(at).copied() {
            at += 1;
            for other in self.same.get(&k).into_iter().flatten() {
                if !owned.contains(other) && self.representations.contains_key(other) && seen.insert(*other) {
                    all.push(*other);
                }
            }
        }
        all
    }
}
