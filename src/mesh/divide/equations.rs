//! Unknown counts of segments, the equations between them, and why these may have no solution.

/// One segment (or one inner direction of a face, whose sides may all be poles).
#[derive(Clone, Debug)]
pub struct Unknown {
    /// Least count that limits (chord, angle, shape) allow, with at least 1.
    pub least: u32,
    /// Wanted count: the largest of size and limits.
    pub demand: u32,
    /// A written count.
    pub written: Option<u32>,
    /// Length, model units; the longest step is the first to be halved.
    pub length: f64,
    /// The count is even unless a written one prevents it: best for freely meshed faces of quads.
    pub even: bool,
}

/// What a face requires.
#[derive(Clone, Debug)]
pub enum Relation {
    /// Both sums are equal.
    Equal(Vec<usize>, Vec<usize>),
    /// The border of a freely meshed face of quads: an even sum.
    EvenSum(Vec<usize>),
    /// Three sides filled with quads: an even sum, each side less than the other two together.
    ThreeSides([Vec<usize>; 3]),
}

/// Why there is no solution. Indices are of segments and relations.
#[derive(Clone, Debug, PartialEq)]
pub enum Conflict {
    /// Two written counts meet: sums of both sides and a written segment behind each (`None` where only the size decides).
    Differ {
        /// The face's relation.
        relation: usize,
        /// Sum along one side and the written segment behind it.
        a: (u32, Option<usize>),
        /// Sum along the other.
        b: (u32, Option<usize>),
    },
    /// A written count makes a segment too coarse.
    TooCoarse {
        /// The written segment.
        written: usize,
        /// The segment that needs more.
        needs: usize,
        /// What it needs.
        least: u32,
    },
    /// Three sides that quads cannot fill.
    ThreeSides {
        /// The face's relation.
        relation: usize,
        /// Sums of the sides.
        counts: [u32; 3],
        /// Written segments behind them.
        written: Vec<usize>,
    },
    /// A written count is odd where a freely meshed face of quads needs an even one, or makes such a count odd.
    Odd {
        /// The written segment, where there is one.
        written: Option<usize>,
        /// The segment that needs an even count.
        needs: usize,
    },
    /// Counts would grow without end: a side is opposite to a part of itself.
    Endless {
        /// The face's relation.
        relation: usize,
    },
}
