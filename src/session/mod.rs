//! Floor 8: a model from script to files, as commands and other programs use it.

pub mod cache;
mod collect;
mod cuts;
pub mod disk;
mod export;
pub mod golden;
pub mod guard;
pub mod json;
pub mod kept;
pub mod live;
pub mod notebook;
mod picture_names;
mod picture_paths;
pub mod pictures;
mod places;
mod plan;
pub mod reference;
pub mod report;
pub mod run;
mod shades;
mod similar;
pub mod stages;
pub mod staging;
pub mod starter;
mod sweep;
pub mod textmate;
pub mod variants;
