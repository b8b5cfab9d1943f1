//! Levels of entities as layers: numbers, and the names that a file has for them.

use std::collections::{BTreeMap, BTreeSet};

use crate::io::cad::part::{Group, PartPlace};
use crate::io::iges::entity_data::{Data, Pointer};
use crate::io::iges::entity_table::EntityTable;

/// What is on each level.
#[derive(Debug, Default)]
pub struct Levels(BTreeMap<i32, Group>);

impl Levels {
    /// Puts things on the levels that an entity has.
    pub fn put(&mut self, table: &EntityTable, d: Pointer, things: &[PartPlace]) {
        let Some(entry) = table.entry(d) else { return };
        let listed;
        let levels = match entry.level {
            0 => return,
            level @ 1.. => &[level][..],
            list => match table.data(list.unsigned_abs()) {
                Ok(Data::Levels(all)) => {
                    listed = all.clone();
                    &listed
                }
                _ => return,
            },
        };
        for level in levels.iter().filter(|level| **level > 0) {
            let group = self.0.entry(*level).or_default();
            things.iter().for_each(|thing| group.put(*thing));
        }
    }

    /// The layers by their numbers; what has no name has its number for one.
    pub fn layers(self, table: &EntityTable) -> Vec<Group> {
        let names: BTreeMap<i32, &String> = table
            .entries
            .iter()
            .zip(&table.decoded)
            .filter_map(|(entry, decoded)| match &decoded.data {
                Data::LevelName(name) if !name.is_empty() => Some((entry.level, name)),
                _ => None,
            })
            .collect();
        let layer = |(level, group): (i32, Group)| {
            // A face may be there by itself and by its solid.
            let once = |list: Vec<usize>| list.into_iter().collect::<BTreeSet<usize>>().into_iter().collect();
            Group {
                name: names.get(&level).map_or_else(|| level.to_string(), |name| (*name).clone()),
                own: names.get(&level).map(|name| (*name).clone()),
                points: once(group.points),
                curves: once(group.curves),
                surfaces: once(group.surfaces),
            }
        };
        self.0.into_iter().map(layer).collect()
    }
}
