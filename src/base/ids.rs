//! Typed 32-bit ids into plain arrays.

/// Declares id types: `ids! { /// A node of the network. NodeId }`.
#[doc(hidden)]
#[macro_export]
macro_rules! ids {
    ($($(#[$doc:meta])* $name:ident),+ $(,)?) => { $(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(pub u32);
        impl $name {
            /// The id of the item at `index`.
            pub fn at(index: usize) -> Self {
                Self(u32::try_from(index).unwrap_or(u32::MAX))
            }
            /// The place of the item in its array.
            pub fn index(self) -> usize {
                self.0 as usize
            }
        }
    )+ };
}
