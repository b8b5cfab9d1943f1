//! The constants that steer the optimization, division and coarsening of free triangle meshes, phase by phase. Lengths are shares of the
//! wanted length there, unless said otherwise.

use crate::mesh::size::border_spacing::SPACING;
use crate::mesh::tri::longest::LONGEST;
use crate::mesh::tri::optimize::{FINEST, OptimizeSettings, SearchBudget};

/// Optimization of faces of even lengths. More rounds of smoothing move nodes on and make no triangle better: the mean quality differs in
/// the third digit. Relaxation beyond the mean reaches in five rounds what takes eight at the mean.
pub(crate) const EVEN_FACE: OptimizeSettings = OptimizeSettings {
    smoothing_rounds: 5,
    relaxation: 1.6,
    still_quality: FINEST,
    min_quality: 0.92,
    fair_quality: 1.0,
    max_length_ratio: LONGEST / SPACING,
    searches: SearchBudget {
        triangles_per_search: 400,
        triangles_per_extra_search: 16,
        max_extra_searches: 24,
        max_rounds: 4,
        by_shape: true,
    },
};

/// The same where lengths grow from short pieces of the border: beyond the mean nodes would overshoot.
pub(crate) const GRADED_FACE: OptimizeSettings = OptimizeSettings { smoothing_rounds: 8, relaxation: 1.0, ..EVEN_FACE };

/// The same where lengths vary with the bends of the surface: neighbouring triangles cannot all be equilateral, and division and repair
/// move most nodes again.
pub(crate) const BENT_FACE: OptimizeSettings = OptimizeSettings {
    smoothing_rounds: 4,
    still_quality: 0.98,
    min_quality: 0.83,
    fair_quality: 0.78,
    searches: SearchBudget::FEW,
    ..EVEN_FACE
};

/// The same for corners of quadtree cells, which start far from where they end. Halves of squares have a quality of 0.83.
pub(crate) const TREE_FACE: OptimizeSettings =
    OptimizeSettings { smoothing_rounds: 30, min_quality: 0.8, searches: SearchBudget::FEW, ..EVEN_FACE };

/// Wanted lengths lowered until all triangles keep the limits (`triangle_fit.rs`).
pub(crate) struct FitSettings {
    /// Factor on lengths that are lowered, beside the one that the limit demands.
    pub(crate) size_factor: f64,
    /// Least length that is lowered, over the longest side of the triangle because of which it is.
    pub(crate) least_over_side: f64,
    /// Largest number of triangulations of a face.
    pub(crate) max_rounds: usize,
}

pub(crate) const FIT: FitSettings = FitSettings { size_factor: 0.96, least_over_side: 0.5, max_rounds: 12 };

/// Repair of bad triangles (`optimize.rs`, `optimize/repair.rs`).
pub(crate) struct RepairSettings {
    /// Largest number of rounds of repair, smoothing and flips.
    pub(crate) max_rounds: usize,
    /// Largest share of triangles over a limit, one in so many, with which a face is repaired before they are divided: dividing more of them
    /// repairs most of the face as well.
    pub(crate) few_over_limit: usize,
    /// Length of a move that ends the smoothing of a node.
    pub(crate) min_move: f64,
    /// Least gain of quality of a change.
    pub(crate) min_gain: f64,
    /// The same from the fair quality on.
    pub(crate) min_fair_gain: f64,
    /// Least quality of the first guess of a patch, over that of the worst triangle, for the search to start.
    pub(crate) min_start_ratio: f64,
    /// Work of a bad triangle, in evaluations of the surface.
    pub(crate) triangle_work: u64,
    /// The same of the plan of a patch.
    pub(crate) patch_work: u64,
    /// Largest number of passes over triangles on the wrong side of the surface.
    pub(crate) max_upright_passes: usize,
}

pub(crate) const REPAIR: RepairSettings = RepairSettings {
    max_rounds: 6,
    few_over_limit: 100,
    min_move: 0.005,
    min_gain: 0.001,
    min_fair_gain: 0.01,
    min_start_ratio: 0.6,
    triangle_work: 20,
    patch_work: 20,
    max_upright_passes: 3,
};

/// Search for the best place of a node in its star (`shape.rs`).
pub(crate) struct StarSearchSettings {
    /// Largest number of steps from one start.
    pub(crate) max_steps: usize,
    /// Length of a step that ends the search.
    pub(crate) min_step: f64,
    /// Weight of the side of an equilateral triangle.
    pub(crate) min_weight: f64,
    /// Largest number of starts, each with the derivatives at its place.
    pub(crate) max_starts: usize,
    /// Largest error of the predicted quality without another start.
    pub(crate) max_prediction_error: f64,
    /// Least gain of quality of a step.
    pub(crate) min_gain: f64,
}

pub(crate) const STAR_SEARCH: StarSearchSettings =
    StarSearchSettings { max_steps: 12, min_step: 0.002, min_weight: 0.001, max_starts: 3, max_prediction_error: 0.01, min_gain: 0.0001 };

/// Search round the worst triangles, where no single change helps (`optimize/local_search.rs`).
pub(crate) struct LocalSearchSettings {
    /// Largest number of sweeps over the nodes round a triangle.
    pub(crate) max_sweeps: usize,
    /// Number of sweeps after which a change without prospect is dropped.
    pub(crate) trial_sweeps: usize,
    /// Largest penalty of a change then, over the one to beat.
    pub(crate) max_trial_ratio: f64,
    /// Share of the way to the demand of its worst sides that a node moves in a sweep.
    pub(crate) sweep_share: f64,
    /// Largest penalty after a change, over the one before.
    pub(crate) max_penalty_ratio: f64,
}

pub(crate) const LOCAL_SEARCH: LocalSearchSettings =
    LocalSearchSettings { max_sweeps: 20, trial_sweeps: 3, max_trial_ratio: 3.0, sweep_share: 0.2, max_penalty_ratio: 0.97 };

/// Search for the best place of a border node that slides (`optimize/slide.rs`).
pub(crate) struct SlideSettings {
    /// Quality below which nodes slide for a triangle: holes keep even steps where nothing is wrong.
    pub(crate) min_quality: f64,
    /// Share of a range that is kept at each step of a golden section.
    pub(crate) section: f64,
    /// Number of sections: these leave 1.3 % of the whole range.
    pub(crate) sections: usize,
}

pub(crate) const SLIDE: SlideSettings = SlideSettings { min_quality: 0.9, section: 0.618, sections: 9 };

/// Division of triangles that exceed a limit (`optimize/divide.rs`).
pub(crate) struct DivisionSettings {
    /// Largest number of rounds.
    pub(crate) max_rounds: usize,
    /// Number of rounds before lengths are lowered at triangles over a limit: repair there would exceed it again and again.
    pub(crate) rounds_before_lowering: usize,
    /// Number of rounds after which repair keeps the limits.
    pub(crate) rounds_before_strict_repair: usize,
    /// Factor on lengths that are lowered.
    pub(crate) size_factor: f64,
    /// Reduction of the wanted quality while more than one triangle in `few` exceeds a limit.
    pub(crate) rough_reduction: f64,
    /// One triangle in so many over a limit counts as few.
    pub(crate) few: usize,
    /// Largest share of triangles to divide, one in so many; where more exceed a limit, lengths are wrong.
    pub(crate) many: usize,
    /// One part in so many of the work that is left when all limits are kept is not spent on improvements.
    pub(crate) reserved_work: u64,
}

pub(crate) const DIVISION: DivisionSettings = DivisionSettings {
    max_rounds: 64,
    rounds_before_lowering: 2,
    rounds_before_strict_repair: 16,
    size_factor: 0.93,
    rough_reduction: 0.05,
    few: 200,
    many: 12,
    reserved_work: 2,
};

/// Coarsening within the limits (`coarsen.rs`).
pub(crate) struct CoarsenSettings {
    /// Largest number of rounds of removals and flips.
    pub(crate) max_rounds: usize,
    /// Share of the nodes that a round must remove for another one to follow.
    pub(crate) min_removed_share: f64,
    /// Least quality of a new triangle: long ones are wanted, needles are not.
    pub(crate) min_quality: f64,
    /// Largest sum of squared ratios after a flip, or of fourth powers after a move, over the one before: none alternates.
    pub(crate) max_gain_ratio: f64,
    /// Places between two nodes at which one in place of both is tried, as shares of the way.
    pub(crate) merge_places: [f64; 3],
    /// Number of nodes between two checks for an interrupt.
    pub(crate) nodes_per_check: usize,
    /// Length of a move, over the way to the mean of the triangles weighted by their squared ratios; the second where the first fails.
    pub(crate) move_shares: [f64; 2],
    /// Largest number of rounds in which pairs are joined with ratios above the limit before the nodes round them are moved.
    pub(crate) max_relaxed_rounds: usize,
    /// Largest ratio from which such moves start.
    pub(crate) max_start_ratio: f64,
    /// Largest number of sweeps of such moves.
    pub(crate) max_sweeps: usize,
    /// Largest worst ratio after a sweep, over the one before, for another sweep to follow.
    pub(crate) max_sweep_gain_ratio: f64,
    /// Work of a round of such joins, in evaluations of the surface for each triangle.
    pub(crate) relaxed_work: u64,
}

pub(crate) const COARSEN: CoarsenSettings = CoarsenSettings {
    max_rounds: 8,
    min_removed_share: 0.002,
    min_quality: 0.01,
    max_gain_ratio: 0.98,
    merge_places: [0.5, 0.25, 0.75],
    nodes_per_check: 1024,
    move_shares: [1.5, 0.75],
    max_relaxed_rounds: 2,
    max_start_ratio: 1.25,
    max_sweeps: 4,
    max_sweep_gain_ratio: 0.985,
    relaxed_work: 3000,
};
