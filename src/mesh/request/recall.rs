//! How a step of the mesher takes over what it made in an earlier run: the caller knows where that is kept.

use crate::base::digest::{Digest, StableHasher};
use crate::base::fault::Result;

/// The steps found before under the key, or what the second function finds; failures are not kept.
pub type RecallSteps<'a> = dyn Fn(&dyn Fn() -> Digest, &dyn Fn() -> Result<u32>) -> Result<u32> + Sync + 'a;

/// What was found before of a face, by its place in the layout, or what the last function finds; beside the face it depends on what the
/// second one hashes.
pub type RecallFace<'a, T> = dyn Fn(usize, &dyn Fn(&mut StableHasher), &dyn Fn() -> T) -> T + Sync + 'a;
