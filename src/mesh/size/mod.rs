//! Which setting decides the steps of each segment, and how far apart nodes are along it.

pub mod bend_spacing;
pub mod border_spacing;
pub mod choose;
pub mod face_settings;
pub mod gaps;
pub mod girth;
pub mod least_counts;
pub mod opposite_segments;
pub mod proximity;
pub mod remark;
pub mod row_bends;
pub mod row_profile;
pub mod row_spacing;
pub mod rule_effects;
pub mod rule_lines;
pub mod segment_rules;
pub mod sizing;
pub mod sliding_segments;
pub mod spacing_sampler;
pub mod spacing_solver;
pub mod too_large;
pub mod uneven;
