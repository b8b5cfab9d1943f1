//! Floor 0: what every other floor stands on. Knows nothing of curves, text or files.

pub mod bbox;
pub mod boxtree;
pub mod bytes;
pub mod digest;
pub mod fault;
pub mod ids;
pub mod inline_list;
pub mod job;
pub mod limits;
pub mod math;
pub mod origin;
pub mod par;
pub mod predicates;
pub mod quadrature;
pub mod range;
pub mod solve;
pub mod text;
pub mod tolerance;
pub mod triangulate;
pub mod triangulate_points;
pub mod visible;
pub mod work;
pub mod xml;
