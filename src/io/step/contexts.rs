//! Which products at which places a context of a style means.
//!
//! | context | what is meant |
//! |---|---|
//! | occurrence, mapped item, product definition | what is placed by it, or in the product |
//! | occurrence of a higher product (`SPECIFIED_HIGHER_USAGE_OCCURRENCE`) | what all occurrences on the way place |
//! | shape, representation of a shape, relationship that places | what the shape is of |
//! | anything else | everything |

use std::collections::BTreeMap;

use super::part21::File;
use crate::base::job;

/// Occurrences inside each other, and entities passed on the way to one.
const PASSED: usize = 64;

/// What shapes and representations are of.
#[derive(Debug, Default)]
pub struct Contexts {
    /// What has the shape that a representation is of.
    shown: BTreeMap<u32, u32>,
    /// The shape that a relationship between representations places.
    placed: BTreeMap<u32, u32>,
}

impl Contexts {
    /// What a file says of representations.
    pub fn of(file: &File) -> Self {
        let mut contexts = Self::default();
        for k in 0..file.records.len() as u32 {
            if k % 1024 == 0 {
                job::look();
            }
            let row = file.parameters(k);
            match file.name(k) {
                b"SHAPE_DEFINITION_REPRESENTATION" => {
                    if let (Ok(shape), Ok(representation)) = (row.entity(0), row.entity(1)) {
                        contexts.shown.entry(representation).or_insert(shape);
                    }
                }
                b"CONTEXT_DEPENDENT_SHAPE_REPRESENTATION" => {
                    if let (Ok(relation), Ok(shape)) = (row.entity(0), row.entity(1)) {
                        contexts.placed.insert(relation, shape);
                    }
                }
                _ => {}
            }
        }
        contexts
    }

    /// Entities of which all must be on the way to a placed item for the context to mean it; none where it means every one.
    pub fn meant(&self, file: &File, context: u32) -> Vec<u32> {
        let (mut meant, mut open) = (Vec::new(), vec![context]);
        for _ in 0..PASSED {
            let Some(k) = open.pop() else { break };
            let row = file.parameters(k);
            match file.name(k) {
                b"NEXT_ASSEMBLY_USAGE_OCCURRENCE" | b"MAPPED_ITEM" => meant.push(k),
                b"PRODUCT_DEFINITION" | b"PRODUCT_DEFINITION_WITH_ASSOCIATED_DOCUMENTS" => meant.push(k),
                b"SPECIFIED_HIGHER_USAGE_OCCURRENCE" => open.extend([row.entity(6), row.entity(7)].into_iter().flatten()),
                b"PRODUCT_DEFINITION_SHAPE" => open.extend(row.entity(2)),
                b"CONTEXT_DEPENDENT_SHAPE_REPRESENTATION" => open.extend(row.entity(1)),
                _ => open.extend(self.shown.get(&k).or(self.placed.get(&k)).copied()),
            }
        }
        meant.sort_unstable();
        meant.dedup();
        meant
    }
}
