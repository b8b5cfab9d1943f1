//! Curves on a surface: projected, followed in (u, v), made loops of; the parts that they divide it into.

pub mod cells;
pub mod compose;
pub mod cutters;
pub mod divide;
pub mod faces;
pub mod loops;
pub mod noncontractible;
pub mod outlined;
pub mod over_lines;
pub mod pcurve;
pub mod project;
pub mod shared_runs;
pub mod trim;
pub mod trim_loop;
