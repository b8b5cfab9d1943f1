//! Digests: 128 bits that stand for a text, a list of numbers or other digests; the same on every platform.

use std::hash::Hasher as _;

use glam::{DVec3, DVec4};
use siphasher::sip128::{Hasher128, SipHasher13};

/// What stands for some content; two contents with one digest do not occur in practice (128 bits of SipHash-1-3).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Digest(pub u128);

/// Takes in content piece by piece; each piece is separated from the next.
#[derive(Clone, Debug, Default)]
pub struct StableHasher(SipHasher13);

impl StableHasher {
    /// Nothing taken in yet; `purpose` keeps digests of different things apart.
    pub fn new(purpose: &str) -> Self {
        Self::default().text(purpose)
    }

    /// Takes in a text.
    pub fn text(self, text: &str) -> Self {
        self.bytes(text.as_bytes())
    }

    /// Takes in bytes, their number first.
    pub fn bytes(mut self, bytes: &[u8]) -> Self {
        self.0.write_u64(bytes.len() as u64);
        self.0.write(bytes);
        self
    }

    /// Takes in a whole number.
    pub fn number(mut self, n: u64) -> Self {
        self.0.write_u64(n);
        self
    }

    /// Takes in a real by its bits.
    pub fn real(self, x: f64) -> Self {
        self.number(x.to_bits())
    }

    /// Takes in a digest.
    pub fn digest(mut self, digest: Digest) -> Self {
        self.0.write(&digest.0.to_le_bytes());
        self
    }

    /// Takes in content.
    pub fn with(mut self, content: &(impl StableHash + ?Sized)) -> Self {
        content.hash_into(&mut self);
        self
    }

    /// The digest of all that was taken in.
    pub fn finish(&self) -> Digest {
        Digest(self.0.finish128().as_u128())
    }
}

/// What has a digest of its content: all that its results depend on, to the last bit. Where it stands in a script is no
/// part of it, nor what is worked out from the rest when it is first asked for.
pub trait StableHash {
    /// Tells all of it.
    fn hash_into(&self, to: &mut StableHasher);
}

/// Implements [`StableHash`] for a structure field by field. Every field must be named, as content or behind `but` as one that
/// adds nothing, so that a new field cannot be forgotten.
#[doc(hidden)]
#[macro_export]
macro_rules! content {
    ($name:ty { $($field:ident),* $(,)? } $(but { $($idle:ident),* $(,)? })?) => {
        impl $crate::base::digest::StableHash for $name {
            fn hash_into(&self, to: &mut $crate::base::digest::StableHasher) {
                let Self { $($field,)* $($($idle: _,)*)? } = self;
                $($crate::base::digest::StableHash::hash_into($field, to);)*
            }
        }
    };
}

/// Implements [`StableHash`] for an enumeration without fields by the numbers of its variants.
#[doc(hidden)]
#[macro_export]
macro_rules! content_of_word {
    ($($name:ty),* $(,)?) => {
        $(impl $crate::base::digest::StableHash for $name {
            fn hash_into(&self, to: &mut $crate::base::digest::StableHasher) {
                $crate::base::digest::StableHash::hash_into(&(*self as u64), to);
            }
        })*
    };
}

impl StableHash for u64 {
    fn hash_into(&self, to: &mut StableHasher) {
        to.0.write_u64(*self);
    }
}

impl StableHash for u32 {
    fn hash_into(&self, to: &mut StableHasher) {
        u64::from(*self).hash_into(to);
    }
}

impl StableHash for u8 {
    fn hash_into(&self, to: &mut StableHasher) {
        u64::from(*self).hash_into(to);
    }
}

impl StableHash for usize {
    fn hash_into(&self, to: &mut StableHasher) {
        (*self as u64).hash_into(to);
    }
}

impl StableHash for bool {
    fn hash_into(&self, to: &mut StableHasher) {
        u64::from(*self).hash_into(to);
    }
}

impl StableHash for f64 {
    fn hash_into(&self, to: &mut StableHasher) {
        self.to_bits().hash_into(to);
    }
}

impl StableHash for str {
    fn hash_into(&self, to: &mut StableHasher) {
        to.0.write_u64(self.len() as u64);
        to.0.write(self.as_bytes());
    }
}

impl StableHash for String {
    fn hash_into(&self, to: &mut StableHasher) {
        self.as_str().hash_into(to);
    }
}

impl StableHash for Digest {
    fn hash_into(&self, to: &mut StableHasher) {
        to.0.write(&self.0.to_le_bytes());
    }
}

impl StableHash for DVec3 {
    fn hash_into(&self, to: &mut StableHasher) {
        self.to_array().iter().for_each(|x| x.hash_into(to));
    }
}

impl StableHash for DVec4 {
    fn hash_into(&self, to: &mut StableHasher) {
        self.to_array().iter().for_each(|x| x.hash_into(to));
    }
}

impl<T: StableHash + ?Sized> StableHash for &T {
    fn hash_into(&self, to: &mut StableHasher) {
        (**self).hash_into(to);
    }
}

impl<T: StableHash + ?Sized> StableHash for Box<T> {
    fn hash_into(&self, to: &mut StableHasher) {
        (**self).hash_into(to);
    }
}

impl<T: StableHash + ?Sized> StableHash for std::sync::Arc<T> {
    fn hash_into(&self, to: &mut StableHasher) {
        (**self).hash_into(to);
    }
}

impl<T: StableHash> StableHash for Option<T> {
    fn hash_into(&self, to: &mut StableHasher) {
        self.is_some().hash_into(to);
        if let Some(content) = self {
            content.hash_into(to);
        }
    }
}

impl<T: StableHash> StableHash for [T] {
    fn hash_into(&self, to: &mut StableHasher) {
        self.len().hash_into(to);
        self.iter().for_each(|content| content.hash_into(to));
    }
}

impl<T: StableHash> StableHash for Vec<T> {
    fn hash_into(&self, to: &mut StableHasher) {
        self.as_slice().hash_into(to);
    }
}

impl<T: StableHash, const N: usize> StableHash for [T; N] {
    fn hash_into(&self, to: &mut StableHasher) {
        self.iter().for_each(|content| content.hash_into(to));
    }
}

impl<A: StableHash, B: StableHash> StableHash for (A, B) {
    fn hash_into(&self, to: &mut StableHasher) {
        self.0.hash_into(to);
        self.1.hash_into(to);
    }
}

impl<A: StableHash, B: StableHash, C: StableHash> StableHash for (A, B, C) {
    fn hash_into(&self, to: &mut StableHasher) {
        self.0.hash_into(to);
        self.1.hash_into(to);
        self.2.hash_into(to);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_are_kept_apart_and_nothing_depends_on_the_platform() {
        let of = |a: &str, b: &str| StableHasher::new("test").text(a).text(b).finish();
        assert_eq!(of("ab", "c"), of("ab", "c"));
        assert_ne!(of("ab", "c"), of("a", "bc"));
        assert_ne!(StableHasher::new("a").finish(), StableHasher::new("b").finish());
        assert_ne!(StableHasher::new("a").real(0.0).finish(), StableHasher::new("a").real(-0.0).finish());
        assert_eq!(
            StableHasher::new("a").number(7).digest(Digest(9)).finish(),
            Digest(291_297_908_609_795_430_229_299_162_435_872_836_234)
        );
    }
}
