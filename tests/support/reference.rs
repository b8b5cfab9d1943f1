//! Values that others computed, as they were given.

use std::path::Path;

use serde_json::Value;

/// The reference of this name, without `.json`.
pub fn reference(name: &str) -> Value {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/data/reference/{name}.json"));
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}
