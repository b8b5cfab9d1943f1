//! What CAD formats have in common: exact surfaces with the loops of curves on them, made into surface values, and the part that
//! offers them by name. Readers of a format make [`face::Face`]s and put them into a [`part::Part`]; writers of solids take
//! [`bodies::Bodies`], faces with the edges that they share.

pub mod assembly;
pub mod axis_cut;
pub mod base;
mod beside;
pub mod bodies;
mod build;
pub mod carry;
pub mod compose;
pub mod damage;
pub mod face;
pub mod face_loops;
pub mod ground;
pub mod healing;
pub mod interior;
mod natural;
pub mod nets;
pub mod part;
mod poles;
mod stated;
