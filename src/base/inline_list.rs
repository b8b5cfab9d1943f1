//! Lists that nearly always have the same few items: so many stand in the list itself, and only others in a block of their own.

use std::ops::{Deref, DerefMut};

use crate::base::digest::{StableHash, StableHasher};

/// A list of `N` items inside, or of any other number outside.
#[derive(Clone, Debug)]
pub enum InlineList<T, const N: usize> {
    /// `N` items.
    Inside([T; N]),
    /// Any other number.
    Outside(Box<[T]>),
}

impl<T, const N: usize> From<[T; N]> for InlineList<T, N> {
    fn from(items: [T; N]) -> Self {
        Self::Inside(items)
    }
}

impl<T, const N: usize> From<Vec<T>> for InlineList<T, N> {
    fn from(items: Vec<T>) -> Self {
        match <[T; N]>::try_from(items) {
            Ok(items) => Self::Inside(items),
            Err(items) => Self::Outside(items.into()),
        }
    }
}

impl<T, const N: usize> Deref for InlineList<T, N> {
    type Target = [T];

    #[inline]
    fn deref(&self) -> &[T] {
        match self {
            Self::Inside(items) => items,
            Self::Outside(items) => items,
        }
    }
}

impl<T, const N: usize> DerefMut for InlineList<T, N> {
    #[inline]
    fn deref_mut(&mut self) -> &mut [T] {
        match self {
            Self::Inside(items) => items,
            Self::Outside(items) => items,
        }
    }
}

impl<T: Copy, const N: usize> From<&[T]> for InlineList<T, N> {
    fn from(items: &[T]) -> Self {
        <[T; N]>::try_from(items).map_or_else(|_| Self::Outside(items.into()), Self::Inside)
    }
}

impl<T, const N: usize> Default for InlineList<T, N> {
    fn default() -> Self {
        Vec::new().into()
    }
}

impl<T: PartialEq, const N: usize> PartialEq for InlineList<T, N> {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}

impl<'a, T, const N: usize> IntoIterator for &'a InlineList<T, N> {
    type Item = &'a T;
    type IntoIter = std::slice::Iter<'a, T>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl<T: StableHash, const N: usize> StableHash for InlineList<T, N> {
    fn hash_into(&self, to: &mut StableHasher) {
        (**self).hash_into(to);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_are_the_same_inside_and_outside() {
        for n in 0..4 {
            let items: Vec<u32> = (0..n).collect();
            let list: InlineList<u32, 2> = items.clone().into();
            assert_eq!(matches!(list, InlineList::Inside(_)), n == 2);
            assert_eq!(*list, *items);
            let digest = |content: &dyn Fn(&mut StableHasher)| {
                let mut to = StableHasher::new("list");
                content(&mut to);
                to.finish()
            };
            assert_eq!(digest(&|to| list.hash_into(to)), digest(&|to| items.hash_into(to)));
        }
    }
}
