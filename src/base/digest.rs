//! Digests: 128 bits that stand for a text, a list of numbers or other digests; the same on every platform.

use std::hash::Hasher as _;

use glam::{DVec3, DVec4};
use siphasher::sip128::{Hasher128, SipHasher13};

/// What stands for some content; two contents with one digest do not occur in practice (128 bits of SipHash-1-3).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Digest(pub u128);

/// Takes in content piece by piece; each piece is separated from the next.
#[derive(Clone, Debug, Default)]
pub struct Digester(SipHasher13);

impl Digester {
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
    pub fn with(mut self, content: &(impl Content + ?Sized)) -> Self {
        content.tell(&mut self);
        self
    }

    /// The digest of all that was taken in.
    pub fn finish(&self) -> Digest {
        Digest(self.0.finish128().as_u128())
    }
}

/// What has a digest of its content: all that its results depend on, to the last bit. Where it stands in a script is no
/// part of it, nor what is worked out from the rest when it is first asked for.
pub trait Content {
    /// Tells all of it.
    fn tell(&self, to: &mut Digester);
}

/// Implements [`Content`] for a structure field by field. Every field must be named, as content or behind `but` as one that
/// adds nothing, so that a new field cannot be forgotten.
#[macro_export]
macro_rules! content {
    ($name:ty { $($field:ident),* $(,)? } $(but { $($idle:ident),* $(,)? })?) => {
        impl $crate::base::digest::Content for $name {
            fn tell(&self, to: &mut $crate::base::digest::Digester) {
                let Self { $($field,)* $($($idle: _,)*)? } = self;
                $($crate::base::digest::Content::tell($field, to);)*
            }
        }
    };
}

/// Implements [`Content`] for an enumeration without fields by the numbers of its variants.
#[macro_export]
macro_rules! content_of_word {
    ($($name:ty),* $(,)?) => {
        $(impl $crate::base::digest::Content for $name {
            fn tell(&self, to: &mut $crate::base::digest::Digester) {
                $crate::base::digest::Content::tell(&(*self as u64), to);
            }
        })*
    };
}

impl Content for u64 {
    fn tell(&self, to: &mut Digester) {
        to.0.write_u64(*self);
    }
}

impl Content for u32 {
    fn tell(&self, to: &mut Digester) {
        u64::from(*self).tell(to);
    }
}

impl Content for u8 {
    fn tell(&self, to: &mut Digester) {
        u64::from(*self).tell(to);
    }
}

impl Content for usize {
    fn tell(&self, to: &mut Digester) {
        (*self as u64).tell(to);
    }
}

impl Content for bool {
    fn tell(&self, to: &mut Digester) {
        u64::from(*self).tell(to);
    }
}

impl Content for f64 {
    fn tell(&self, to: &mut Digester) {
        self.to_bits().tell(to);
    }
}

impl Content for str {
    fn tell(&self, to: &mut Digester) {
        to.0.write_u64(self.len() as u64);
        to.0.write(self.as_bytes());
    }
}

impl Content for String {
    fn tell(&self, to: &mut Digester) {
        self.as_str().tell(to);
    }
}

impl Content for Digest {
    fn tell(&self, to: &mut Digester) {
        to.0.write(&self.0.to_le_bytes());
    }
}

impl Content for DVec3 {
    fn tell(&self, to: &mut Digester) {
        self.to_array().iter().for_each(|x| x.tell(to));
    }
}

impl Content for DVec4 {
    fn tell(&self, to: &mut Digester) {
        self.to_array().iter().for_each(|x| x.tell(to));
    }
}

impl<T: Content + ?Sized> Content for &T {
    fn tell(&self, to: &mut Digester) {
        (**self).tell(to);
    }
}

impl<T: Content + ?Sized> Content for Box<T> {
    fn tell(&self, to: &mut Digester) {
        (**self).tell(to);
    }
}

impl<T: Content + ?Sized> Content for std::sync::Arc<T> {
    fn tell(&self, to: &mut Digester) {
        (**self).tell(to);
    }
}

impl<T: Content> Content for Option<T> {
    fn tell(&self, to: &mut Digester) {
        self.is_some().tell(to);
        if let Some(content) = self {
            content.tell(to);
        }
    }
}

impl<T: Content> Content for [T] {
    fn tell(&self, to: &mut Digester) {
        self.len().tell(to);
        self.iter().for_each(|content| content.tell(to));
    }
}

impl<T: Content> Content for Vec<T> {
    fn tell(&self, to: &mut Digester) {
        self.as_slice().tell(to);
    }
}

impl<T: Content, const N: usize> Content for [T; N] {
    fn tell(&self, to: &mut Digester) {
        self.iter().for_each(|content| content.tell(to));
    }
}

impl<A: Content, B: Content> Content for (A, B) {
    fn tell(&self, to: &mut Digester) {
        self.0.tell(to);
        self.1.tell(to);
    }
}

impl<A: Content, B: Content, C: Content> Content for (A, B, C) {
    fn tell(&self, to: &mut Digester) {
        self.0.tell(to);
        self.1.tell(to);
        self.2.tell(to);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_are_kept_apart_and_nothing_depends_on_the_platform() {
        let of = |a: &str, b: &str| Digester::new("test").text(a).text(b).finish();
        assert_eq!(of("ab", "c"), of("ab", "c"));
        assert_ne!(of("ab", "c"), of("a", "bc"));
        assert_ne!(Digester::new("a").finish(), Digester::new("b").finish());
        assert_ne!(Digester::new("a").real(0.0).finish(), Digester::new("a").real(-0.0).finish());
        assert_eq!(Digester::new("a").number(7).digest(Digest(9)).finish(), Digest(291_297_908_609_795_430_229_299_162_435_872_836_234));
    }
}
