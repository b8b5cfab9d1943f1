//! Limits that keep bad input from eating the machine. Checked before allocating.

/// Declares the limits once, as constants and as the table that the reference prints.
macro_rules! limits {
    ($( $(#[doc = $doc:literal])+ pub const $name:ident: $ty:ty = $value:expr; )+) => {
        $( $(#[doc = $doc])+ pub const $name: $ty = $value; )+

        /// All of them: what is limited, and the largest value.
        pub const ALL: &[(&str, f64)] = &[ $( (concat!($($doc),+), $name as f64) ),+ ];
    };
}

limits! {
    /// Nested open brackets.
    pub const NESTED_BRACKETS: usize = 256;
    /// Prefix or right-associative operators in a row.
    pub const OPERATORS_IN_A_ROW: usize = 64;
    /// Nested operators, fields and indices: the height of the tree of an expression.
    pub const EXPRESSION_HEIGHT: usize = 4_000;
    /// Nested function calls.
    pub const CALL_DEPTH: usize = 1_000;
    /// Bytes of one script.
    pub const SOURCE_BYTES: u64 = 32 << 20;
    /// Bytes of one data file.
    pub const DATA_BYTES: u64 = 256 << 20;
    /// Largest coordinate or length of a curve, model units, positive or negative: its fourth power must not overflow.
    pub const COORDINATE: f64 = 1e50;
    /// Largest knot of a spline, positive or negative; two that differ are no nearer than one over it.
    pub const KNOT: f64 = 1e50;
    /// Turns of one helix, in either sense: each takes some kilobytes.
    pub const HELIX_TURNS: f64 = 10_000.0;
    /// Members of one list.
    pub const LIST_MEMBERS: usize = 10_000_000;
    /// Members of all lists held at a time, with 3 for each list itself: 32 bytes each, under 1 GiB together with their contents.
    pub const MEMBERS_MADE: usize = 20_000_000;
    /// Elements of one mesh where `--max-elements` sets no other number.
    pub const MESH_ELEMENTS: u64 = 100_000_000;
    /// Steps of a mesh along one part of a border between two corners.
    pub const MESH_STEPS: u32 = 1_000_000;
    /// Work of one mesh or one of its free faces, in evaluations of curves and surfaces, beside that of its elements.
    pub const MESH_WORK: u64 = 100_000_000;
    /// The same for each element of the mesh.
    pub const WORK_OF_AN_ELEMENT: u64 = 300;
    /// Work of the network or of the surface model, in evaluations of curves and surfaces, beside that of its parts.
    pub const STAGE_WORK: u64 = 50_000_000;
    /// The same for each curve of the network.
    pub const WORK_OF_A_CURVE: u64 = 5_000;
    /// The same for each surface of the model.
    pub const WORK_OF_A_SURFACE: u64 = 200_000;
    /// Work of the areas, volumes and boxes of a report, in evaluations of curves and surfaces, beside that of its surfaces.
    pub const REPORT_WORK: u64 = 50_000_000;
    /// Work of one output or picture, in evaluations of curves and surfaces.
    pub const FILE_WORK: u64 = 100_000_000;
    /// Work of one call, in evaluations of curves and surfaces.
    pub const CALL_WORK: u64 = 100_000_000;
    /// Places of the parts of one STEP file.
    pub const PART_INSTANCES: usize = 100_000;
    /// Control points and pieces of borders that the placed parts of one STEP file may have, beside 4 for each byte.
    pub const PART_COPIES: usize = 4_000_000;
    /// Pixels along a side of a picture.
    pub const PICTURE_SIDE: u32 = 8_192;
    /// Pixels of one picture.
    pub const PICTURE_PIXELS: u64 = 1 << 25;
    /// Nested lists.
    pub const LIST_NESTING: usize = 1_000;
    /// Evaluation steps of one run.
    pub const EVALUATION_STEPS: u64 = 1_000_000_000;
    /// Bytes of results in the folder of `--cache`; those unused for longest are deleted first.
    pub const CACHE_BYTES: u64 = 4 << 30;
    /// Reports of one code that one declaration or stage gives one by one; further ones are counted.
    pub const REPORTS_OF_A_KIND: usize = 1_000;
    /// Reports that the JSON of a run lists in full where the screen shows one for all of them; further ones are counted.
    pub const REPORTS_TOLD: usize = 100_000;
    /// Reports printed in full in one run.
    pub const REPORTS_SHOWN: usize = 20;
}

/// Elements of one mesh that `--max-elements` can set at most: nodes are numbered with 32 bits.
pub const MESH_ELEMENTS_MOST: u64 = 1_000_000_000;

/// Least number of pixels along a side of a picture.
pub const PICTURE_LEAST: u32 = 16;

/// A knot or a step between two knots that derivatives cannot be computed with: they overflow.
pub fn knot_beyond(knots: &[f64]) -> Option<f64> {
    let steps = knots.windows(2).map(|k| k[1] - k[0]).filter(|step| *step > 0.0 && *step < 1.0 / KNOT);
    knots.iter().copied().filter(|k| k.abs() > KNOT).chain(steps).next()
}
