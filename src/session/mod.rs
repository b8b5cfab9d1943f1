//! Floor 8: a loaded model.
