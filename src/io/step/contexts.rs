//! Which products at which places a context of a style means.
//!
//! | context | what is meant |
//! |---|---|
//! | occurrence, mapped item, product definition | what is placed by it, or in the product |
//! | occurrence of a higher product (`SPECIFIED_HIGHER_USAGE_OCCURRENCE`) | what all occurrences on the way place |
//! | shape, representation of a shape, relationship that places | what the shape is of |
//! | anything else | everything |

use std::collections::{BTreeMap, BTreeSet};

use crate::base::job;
use crate::io::step::records::File;

/// What shapes and representations are of.
#[derive(Debug, Default)]
pub struct Contexts {
    /// What has the shape that a representation is of.
    shown: BTreeMap<u32, u32>,
    /// The shape that a relationship between representations places.
    placed: BTreeMap<u32, u32>,
}

impl Contexts {
    /// The contexts of the representations of a file.
    pub fn of(file: &File) -> Self {
        let mut contexts = Self::default();
        for k in 0..file.records.len() as u32 {
            if k % 1024 == 0 {
                job::poll();
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
        let mut passed = BTreeSet::new();
        while let Some(k) = open.pop() {
            if !passed.insert(k) {
                continue;
            }
            job::poll();
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::step::part21;

    /// Occurrences #1, #2 … in one another, and #1001, #1002 …, each of the one before and the next occurrence.
    #[test]
    fn a_row_of_higher_occurrences_may_be_of_any_length() {
        let deep = 300;
        let mut text = String::from("ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\n");
        for k in 1..=deep {
            text += &format!("#{k}=NEXT_ASSEMBLY_USAGE_OCCURRENCE('','','',$,$,$);\n");
            let upper = if k == 1 { 1 } else { 1000 + k - 1 };
            text += &format!("#{}=SPECIFIED_HIGHER_USAGE_OCCURRENCE('','','',$,$,$,#{upper},#{k});\n", 1000 + k);
        }
        text += "ENDSEC;\nEND-ISO-10303-21;\n";
        let file = part21::read(text.as_bytes()).unwrap();
        let last = (0..file.records.len() as u32).find(|k| file.id(*k) == 1000 + deep).unwrap();
        assert_eq!(Contexts::of(&file).meant(&file, last).len(), deep as usize);
    }
}
