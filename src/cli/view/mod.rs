//! `loft view`: serves a page that shows a model and follows its script.

pub mod answer;
pub mod command;
pub mod compress;
pub mod connections;
pub mod events;
pub mod file_state;
pub mod frames;
pub mod gate;
pub mod http;
pub mod listen;
pub mod model;
pub mod one_file;
pub mod revision;
pub mod routes;
pub mod script_file;
pub mod server;
pub mod shown_model;
pub mod watch;
pub mod work;
