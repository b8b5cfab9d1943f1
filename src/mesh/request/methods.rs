//! Kinds of elements and methods, with their words.

/// An enum each of whose members has a word of the language.
macro_rules! words {
    ($(#[$meta:meta])* $name:ident { $($(#[$doc:meta])* $member:ident = $word:literal,)* }) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum $name { $($(#[$doc])* $member,)* }

        impl $name {
            /// All its words.
            pub const WORDS: &'static [&'static str] = &[$($word),*];

            /// What a word stands for.
            pub fn of_word(word: &str) -> Option<Self> {
                match word {
                    $($word => Some(Self::$member),)*
                    _ => None,
                }
            }

            /// The word for it.
            pub fn word(self) -> &'static str {
                match self {
                    $(Self::$member => $word,)*
                }
            }
        }
    };
}

words! {
    /// Which elements a face gets.
    Elements {
        /// Triangles only.
        Triangles = "triangles",
        /// Quads only, or an error.
        Quads = "quads",
        /// Quads where they fit, triangles elsewhere.
        Mixed = "mixed",
    }
}

words! {
    /// How a face is meshed.
    Method {
        /// Mapped where it fits and its elements are well shaped, else Delaunay.
        Auto = "auto",
        /// Mapped, or an error.
        Mapped = "mapped",
        /// Nodes at the corners of a quadtree's cells, Delaunay triangles improved in space.
        Quadtree = "quadtree",
        /// Nodes grown over the surface, Delaunay triangles improved in space.
        Delaunay = "delaunay",
        /// Cells between lines of constant u and v, triangles beside borders.
        Isoline = "isoline",
        /// As few triangles as keep the limits, however long.
        Display = "display",
    }
}

impl Method {
    /// Whether sides are only as short as limits and written sizes demand, and triangles as long as they may be.
    pub fn is_coarse(self) -> bool {
        matches!(self, Self::Isoline | Self::Display)
    }

    /// Its word, where it makes nothing but triangles.
    pub fn of_triangles(self) -> Option<&'static str> {
        self.is_coarse().then(|| self.word())
    }

    /// Whether it makes faces freely, however many sides they have.
    pub fn is_free(self) -> bool {
        matches!(self, Self::Delaunay | Self::Quadtree | Self::Isoline | Self::Display)
    }
}
