//! A whole run: phases, what was not made, and what a script declares.

pub mod declared;
pub mod phases;
pub mod symbols;
pub mod unmade;
