//! Digests: 128 bits that stand for a text, a list of numbers or other digests; the same on every platform.

use std::hash::Hasher as _;

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

    /// The digest of all that was taken in.
    pub fn finish(&self) -> Digest {
        Digest(self.0.finish128().as_u128())
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
