//! What a surface is: as a net, by its lines, by its simplest form; how it keeps to its curves, and where it folds.

pub mod as_net;
pub mod elementary;
pub mod extend;
pub mod extend_net;
pub mod fairness;
pub mod iso;
pub mod iso_fit;
pub mod iso_line;
pub mod net_report;
pub mod recognize;
pub mod sweep_report;
pub mod validate;
