//! How a step of the mesher takes over what it made in an earlier run: the caller knows where that is kept.

use crate::base::digest::{Digest, StableHasher};
use crate::base::fault::Result;

/// The steps found before under the key, or what the second function finds; failures are not kept.
pub type RecallSteps<'a> = dyn Fn(&dyn Fn() -> Digest, &dyn Fn() -> Result<u32>) -> Result<u32> + Sync + 'a;

/// A result for the face at this place of the layout: the one found before, or what the last function makes. The second function hashes all
/// that the result depends on beside the face.
pub type RecallFace<'a, T> = dyn Fn(usize, &dyn Fn(&mut StableHasher), &dyn Fn() -> T) -> T + Sync + 'a;
