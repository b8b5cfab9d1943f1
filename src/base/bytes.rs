//! Plain data as bytes, little end first: what is kept on disk between runs. Reading trusts nothing.

use std::ops::Range;

use glam::DVec3;

/// Data that can be written.
pub trait Put {
    /// Appends it.
    fn put(&self, to: &mut Vec<u8>);
}

/// Data that can be written whole, and read back or found to be something else.
pub trait Plain: Put + Sized {
    /// Fewest bytes that one takes; bounds what a length in a damaged file makes a reader allocate.
    const LEAST: usize;
    /// Takes it from the front; `None` when what is there is something else.
    fn take(from: &mut Bytes) -> Option<Self>;
}

/// Bytes that were not read yet.
#[derive(Clone, Copy, Debug)]
pub struct Bytes<'a>(pub &'a [u8]);

impl<'a> Bytes<'a> {
    /// The next `n` bytes.
    pub fn next(&mut self, n: usize) -> Option<&'a [u8]> {
        let (first, rest) = self.0.split_at_checked(n)?;
        self.0 = rest;
        Some(first)
    }

    /// Whether all was read.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        self.next(N)?.try_into().ok()
    }
}

/// The bytes of some data.
pub fn bytes_of(data: &impl Put) -> Vec<u8> {
    let mut bytes = Vec::new();
    data.put(&mut bytes);
    bytes
}

/// The data of some bytes; `None` when they are not exactly that.
pub fn read<T: Plain>(bytes: &[u8]) -> Option<T> {
    let mut bytes = Bytes(bytes);
    let data = T::take(&mut bytes)?;
    bytes.is_empty().then_some(data)
}

/// Implements [`Plain`] for a structure field by field, in the order given.
#[doc(hidden)]
#[macro_export]
macro_rules! plain {
    ($name:ty { $($field:ident),* $(,)? }) => {
        impl $crate::base::bytes::Put for $name {
            fn put(&self, to: &mut Vec<u8>) {
                let Self { $($field),* } = self;
                $($crate::base::bytes::Put::put($field, to);)*
            }
        }

        impl $crate::base::bytes::Plain for $name {
            const LEAST: usize = 1;
            fn take(from: &mut $crate::base::bytes::Bytes) -> Option<Self> {
                Some(Self { $($field: $crate::base::bytes::Plain::take(from)?),* })
            }
        }
    };
}

macro_rules! numbers {
    ($($number:ty),*) => {
        $(impl Put for $number {
            fn put(&self, to: &mut Vec<u8>) {
                to.extend_from_slice(&self.to_le_bytes());
            }
        }

        impl Plain for $number {
            const LEAST: usize = size_of::<$number>();
            fn take(from: &mut Bytes) -> Option<Self> {
                Some(<$number>::from_le_bytes(from.array()?))
            }
        })*
    };
}

numbers!(u8, u32, u64, u128, f32, f64);

impl Put for usize {
    fn put(&self, to: &mut Vec<u8>) {
        (*self as u64).put(to);
    }
}

impl Plain for usize {
    const LEAST: usize = 8;
    fn take(from: &mut Bytes) -> Option<Self> {
        u64::take(from)?.try_into().ok()
    }
}

impl Put for bool {
    fn put(&self, to: &mut Vec<u8>) {
        u8::from(*self).put(to);
    }
}

impl Plain for bool {
    const LEAST: usize = 1;
    fn take(from: &mut Bytes) -> Option<Self> {
        match u8::take(from)? {
            0 => Some(false),
            1 => Some(true),
            _ => None,
        }
    }
}

impl Put for String {
    fn put(&self, to: &mut Vec<u8>) {
        self.len().put(to);
        to.extend_from_slice(self.as_bytes());
    }
}

impl Plain for String {
    const LEAST: usize = 8;
    fn take(from: &mut Bytes) -> Option<Self> {
        let length = usize::take(from)?;
        String::from_utf8(from.next(length)?.to_vec()).ok()
    }
}

impl Put for DVec3 {
    fn put(&self, to: &mut Vec<u8>) {
        self.to_array().put(to);
    }
}

impl Plain for DVec3 {
    const LEAST: usize = 24;
    fn take(from: &mut Bytes) -> Option<Self> {
        Some(Self::from_array(Plain::take(from)?))
    }
}

impl<T: Put> Put for Range<T> {
    fn put(&self, to: &mut Vec<u8>) {
        self.start.put(to);
        self.end.put(to);
    }
}

impl<T: Plain> Plain for Range<T> {
    const LEAST: usize = 2 * T::LEAST;
    fn take(from: &mut Bytes) -> Option<Self> {
        Some(T::take(from)?..T::take(from)?)
    }
}

impl<A: Put, B: Put> Put for (A, B) {
    fn put(&self, to: &mut Vec<u8>) {
        self.0.put(to);
        self.1.put(to);
    }
}

impl<A: Plain, B: Plain> Plain for (A, B) {
    const LEAST: usize = A::LEAST + B::LEAST;
    fn take(from: &mut Bytes) -> Option<Self> {
        Some((A::take(from)?, B::take(from)?))
    }
}

impl<T: Put> Put for Option<T> {
    fn put(&self, to: &mut Vec<u8>) {
        self.is_some().put(to);
        if let Some(data) = self {
            data.put(to);
        }
    }
}

impl<T: Plain> Plain for Option<T> {
    const LEAST: usize = 1;
    fn take(from: &mut Bytes) -> Option<Self> {
        Some(if bool::take(from)? { Some(T::take(from)?) } else { None })
    }
}

impl<T: Put, const N: usize> Put for [T; N] {
    fn put(&self, to: &mut Vec<u8>) {
        self.iter().for_each(|data| data.put(to));
    }
}

impl<T: Plain + Default, const N: usize> Plain for [T; N] {
    const LEAST: usize = N * T::LEAST;
    fn take(from: &mut Bytes) -> Option<Self> {
        let mut data: [T; N] = std::array::from_fn(|_| T::default());
        for slot in &mut data {
            *slot = T::take(from)?;
        }
        Some(data)
    }
}

impl<T: Put + ?Sized> Put for &T {
    fn put(&self, to: &mut Vec<u8>) {
        (**self).put(to);
    }
}

impl<T: Put> Put for Vec<T> {
    fn put(&self, to: &mut Vec<u8>) {
        self.len().put(to);
        self.iter().for_each(|data| data.put(to));
    }
}

impl<T: Plain> Plain for Vec<T> {
    const LEAST: usize = 8;
    fn take(from: &mut Bytes) -> Option<Self> {
        let length = usize::take(from)?;
        // No more room than the bytes that are left can fill.
        if length > from.0.len() / T::LEAST.max(1) {
            return None;
        }
        let mut data = Self::with_capacity(length.min(from.0.len() / size_of::<T>().max(1)));
        for _ in 0..length {
            data.push(T::take(from)?);
        }
        Some(data)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Data = (Vec<[u32; 3]>, (Option<String>, (Range<u32>, (Vec<DVec3>, (bool, Vec<f64>)))));

    fn data() -> Data {
        let points = vec![DVec3::new(1.0, -0.0, f64::MIN_POSITIVE), DVec3::splat(f64::INFINITY)];
        (vec![[1, 2, 3], [4, 5, 6]], (Some("äö".to_owned()), (7..9, (points, (true, vec![0.1 + 0.2])))))
    }

    #[test]
    fn data_comes_back_bit_by_bit() {
        assert_eq!(read::<Data>(&bytes_of(&data())), Some(data()));
        let bits = |d: &Data| d.1.1.1.0.iter().flat_map(|p| p.to_array().map(f64::to_bits)).collect::<Vec<_>>();
        assert_eq!(read::<Data>(&bytes_of(&data())).map(|d| bits(&d)), Some(bits(&data())));
    }

    #[test]
    fn damaged_bytes_are_refused_or_read_without_harm() {
        let whole = bytes_of(&data());
        for end in 0..whole.len() {
            assert_eq!(read::<Data>(&whole[..end]), None, "{end}");
        }
        assert_eq!(read::<Data>(&[whole.as_slice(), &[0]].concat()), None);
        for at in 0..whole.len() {
            for value in [0, 1, 0x7f, 0xff] {
                let mut damaged = whole.clone();
                damaged[at] = value;
                // A length of 2^63 must neither allocate nor overflow.
                let _ = read::<Data>(&damaged);
            }
        }
    }
}
