//! The constants that steer free quad meshes, phase by phase. Qualities are least sines of corners, 0 to 1; lengths are shares of the wanted
//! length there, unless said otherwise.

use std::ops::Range;

use crate::mesh::quad::pair::SingleTriangles;
use crate::mesh::size::border_spacing::SQUARE_SPACING;
use crate::mesh::tri::longest::LONGEST;
use crate::mesh::tri::optimize::OptimizeSettings;
use crate::mesh::tri::optimize_settings::TREE_FACE;

/// Optimization of a face of quads.
pub(crate) const QUAD_FACE: OptimizeSettings =
    OptimizeSettings { smoothing_rounds: 8, relaxation: 1.0, max_length_ratio: LONGEST / SQUARE_SPACING, ..TREE_FACE };

/// Nets made for wanted lengths until one keeps the limits (`net_fit.rs`).
pub(crate) struct NetFitSettings {
    /// Distance of nodes over the side of an equilateral triangle that keeps the limits: half a square has a longer side.
    pub(crate) square_side: f64,
    /// Work of an element over that of a triangle: nets are smoothed, split and smoothed again, and repaired.
    pub(crate) element_work: u64,
    /// Quality below which elements are repaired.
    pub(crate) min_quality: f64,
    /// Largest number of rounds of repair.
    pub(crate) max_repair_rounds: usize,
    /// Largest number of rounds in which long sides are shortened at the cost of their neighbours.
    pub(crate) max_evening_rounds: usize,
    /// Largest number of rounds in which nodes at long sides are opened.
    pub(crate) max_opening_rounds: usize,
    /// Largest length of a side over the allowed one, but in strict tries: where rows of squares meet.
    pub(crate) max_side_ratio: f64,
    /// Number of tries in which no side of a bent face may be longer than allowed: lengths are lowered everywhere for one that is, and the next
    /// try has another one.
    pub(crate) strict_tries: usize,
    /// Factor on lengths where a limit is exceeded, beside the one that the limit demands.
    pub(crate) size_factor: f64,
    /// Least factor on all lengths for the longest side.
    pub(crate) min_spacing_factor: f64,
    /// Largest number of nets of a face.
    pub(crate) max_tries: usize,
    /// Number of tries after which concave quads are reported instead of made anew.
    pub(crate) tries_without_concave: usize,
    /// Number of tries in which lengths are lowered only where a limit is exceeded.
    pub(crate) local_tries: usize,
}

pub(crate) const NET_FIT: NetFitSettings = NetFitSettings {
    square_side: 0.7,
    element_work: 4,
    min_quality: 0.8,
    max_repair_rounds: 6,
    max_evening_rounds: 60,
    max_opening_rounds: 8,
    max_side_ratio: 1.2,
    strict_tries: 1,
    size_factor: 0.9,
    min_spacing_factor: 0.9,
    max_tries: 20,
    tries_without_concave: 8,
    local_tries: 4,
};

/// Triangles that stay single in meshes of quads and triangles.
pub(crate) const MIXED_SINGLES: SingleTriangles = SingleTriangles { min_pair_quality: 0.5, equal_pair_quality: 0.5 };

/// The same in cells that are halved: a triangle becomes three quads.
pub(crate) const CELL_SINGLES: SingleTriangles = SingleTriangles { min_pair_quality: 0.2, equal_pair_quality: 0.45 };

/// Pairing of triangles (`pair.rs`).
pub(crate) struct PairSettings {
    /// Largest number of new pairs of an exchange along a row.
    pub(crate) max_row_pairs: usize,
    /// Largest number of rounds of exchanges.
    pub(crate) max_rounds: usize,
    /// Costs are multiples of the inverse, so that rounding does not decide between equal ones.
    pub(crate) cost_steps: f64,
    /// Least gain of an exchange.
    pub(crate) min_gain: f64,
}

pub(crate) const PAIRING: PairSettings = PairSettings { max_row_pairs: 7, max_rounds: 3, cost_steps: 1e6, min_gain: 1.0 / 1e6 };

/// Costs of a row of sides that are not halved (`odd.rs`), for each cell that it crosses.
pub(crate) struct RowCosts {
    /// From side to opposite side.
    pub(crate) straight: u32,
    /// Round a corner.
    pub(crate) corner: u32,
    /// Through a triangle.
    pub(crate) triangle: u32,
    /// Through a triangle with its third side on the border, whose middle becomes a flat corner.
    pub(crate) flat_triangle: u32,
    /// More through a cell that another row crosses.
    pub(crate) crossed_again: u32,
    /// Largest number of ends of rows that are joined in all ways; more are joined to the nearest.
    pub(crate) max_permuted_ends: usize,
}

pub(crate) const ROW_COSTS: RowCosts =
    RowCosts { straight: 2, corner: 5, triangle: 6, flat_triangle: 60, crossed_again: 40, max_permuted_ends: 6 };

/// Quads taken out between irregular nodes (`collapse.rs`).
pub(crate) struct CollapseSettings {
    /// Largest number of faces round both nodes together.
    pub(crate) max_valences: i64,
    /// Quality of the faces left from which on they may be worse than before.
    pub(crate) min_quality: f64,
    /// Largest number of rounds.
    pub(crate) max_rounds: usize,
}

pub(crate) const COLLAPSE: CollapseSettings = CollapseSettings { max_valences: 8, min_quality: 0.55, max_rounds: 3 };

/// Cavities about irregular nodes filled anew (`regular.rs`).
pub(crate) struct RegularSettings {
    /// Largest numbers of quads of a cavity, in turn.
    pub(crate) max_faces: [usize; 3],
    /// Largest number of rounds over all irregular nodes with each.
    pub(crate) max_rounds: usize,
    /// Quality of the quads of a pattern from which on they may be worse than those before.
    pub(crate) min_quality: f64,
    /// Least side of a quad.
    pub(crate) min_side: f64,
    /// Number of sweeps over the nodes of a pattern.
    pub(crate) sweeps: usize,
    /// Work of a face of a cavity, in evaluations of the surface.
    pub(crate) face_work: u64,
}

pub(crate) const REGULAR: RegularSettings =
    RegularSettings { max_faces: [60, 250, 1000], max_rounds: 3, min_quality: 0.65, min_side: 0.4, sweeps: 12, face_work: 4 };

/// Quads of polygons (`polygon.rs`).
pub(crate) struct PolygonSettings {
    /// Least quality of a quad, before nodes inside are moved.
    pub(crate) min_quality: f64,
}

pub(crate) const POLYGON: PolygonSettings = PolygonSettings { min_quality: 0.05 };

/// Cavities about bad quads filled anew (`remesh.rs`).
pub(crate) struct RemeshSettings {
    /// Quality below which quads are bad.
    pub(crate) min_quality: f64,
    /// Quality from which on better ones are worth no more.
    pub(crate) enough: f64,
    /// Least gain.
    pub(crate) min_gain: f64,
    /// What an irregular node costs in quality.
    pub(crate) irregular_cost: f64,
    /// Largest number of corners of a cavity.
    pub(crate) max_corners: usize,
    /// The same where it gets two nodes inside.
    pub(crate) max_corners_of_two: usize,
    /// Largest number of nodes inside before.
    pub(crate) max_old_inner: usize,
    /// Largest sum of the costs of new quads (`polygon.rs`).
    pub(crate) max_cost: f64,
    /// Largest number of ways to fill a cavity whose nodes are moved.
    pub(crate) max_optimized: usize,
    /// Steps of the moves of nodes inside, over the longest side that is allowed everywhere.
    pub(crate) steps: [f64; 4],
    /// Number of sweeps of each step.
    pub(crate) sweeps: usize,
    /// Least side of a quad.
    pub(crate) min_side: f64,
    /// Largest number of rounds.
    pub(crate) max_rounds: usize,
    /// Work of a corner of a cavity, in evaluations of the surface.
    pub(crate) corner_work: u64,
}

pub(crate) const REMESH: RemeshSettings = RemeshSettings {
    min_quality: 0.7,
    enough: 0.8,
    min_gain: 0.02,
    irregular_cost: 0.01,
    max_corners: 16,
    max_corners_of_two: 12,
    max_old_inner: 6,
    max_cost: 400.0,
    max_optimized: 3,
    steps: [0.2, 0.1, 0.05, 0.02],
    sweeps: 3,
    min_side: 0.4,
    max_rounds: 4,
    corner_work: 8,
};

/// Opening of nodes at long sides (`open.rs`).
pub(crate) struct OpeningSettings {
    /// Least quality of the quads round a node that is opened.
    pub(crate) min_quality: f64,
    /// Distance of each of the two nodes from the opened one, over the length of the side.
    pub(crate) node_distance: f64,
    /// Least angle of a quad at the border, radians: 54°.
    pub(crate) min_border_angle: f64,
}

pub(crate) const OPENING: OpeningSettings = OpeningSettings { min_quality: 0.5, node_distance: 0.3, min_border_angle: 0.95 };

/// Moves of nodes (`smooth.rs`).
pub(crate) struct SmoothSettings {
    /// Length of a move that ends the smoothing of a node.
    pub(crate) min_move: f64,
    /// Quality down to which elements may get worse for even lengths.
    pub(crate) min_smoothed_quality: f64,
    /// Quality down to which elements may get worse for shorter sides.
    pub(crate) min_evened_quality: f64,
    /// Sides longer than this share of the allowed length are shortened.
    pub(crate) max_side_ratio: f64,
    /// Least length of a side, or over the mean of those round a node, that a move for others may shorten.
    pub(crate) min_side: f64,
    /// Least gain of a search.
    pub(crate) min_gain: f64,
    /// Steps of a search, from the first to the last one, over the mean side.
    pub(crate) search_steps: Range<f64>,
    /// Work of a search, in evaluations of the surface, beside those.
    pub(crate) search_work: u64,
    /// Number of nodes between two checks for an interrupt.
    pub(crate) nodes_per_check: usize,
}

pub(crate) const SMOOTHING: SmoothSettings = SmoothSettings {
    min_move: 0.005,
    min_smoothed_quality: 0.85,
    min_evened_quality: 0.75,
    max_side_ratio: 0.97,
    min_side: 0.4,
    min_gain: 0.001,
    search_steps: 0.01..0.25,
    search_work: 40,
    nodes_per_check: 1 << 14,
};

/// Swaps of sides (`swap.rs`). Costs are in irregular nodes.
pub(crate) struct SwapSettings {
    /// Largest number of rounds over all faces.
    pub(crate) max_rounds: usize,
    /// Least gain of a swap.
    pub(crate) min_gain: f64,
    /// Cost of the worst shape.
    pub(crate) shape_cost: f64,
    /// Least quality of a new face.
    pub(crate) min_quality: f64,
    /// Cost of a triangle: it gets a node with three faces in its middle, and others round it.
    pub(crate) triangle_cost: f64,
}

pub(crate) const SWAPS: SwapSettings =
    SwapSettings { max_rounds: 6, min_gain: 0.01, shape_cost: 12.0, min_quality: 0.2, triangle_cost: 2.0 };

/// Repair of elements over the limits (`limit_repair.rs`).
pub(crate) struct LimitRepairSettings {
    /// Largest number of rounds of moves.
    pub(crate) max_rounds: usize,
    /// Largest number of rounds without fewer elements over the limits.
    pub(crate) max_idle_rounds: usize,
    /// Largest share of elements over the limits, one in so many; where there are more, lengths are wrong.
    pub(crate) few: usize,
    /// Least quality of elements that a move changes, unless it was lower.
    pub(crate) min_quality: f64,
    /// Largest number of elements that are moved by their bounds in a round; more are moved by samples, for a twentieth of the work.
    pub(crate) max_bounded_in_round: usize,
    /// The same in all rounds.
    pub(crate) max_bounded: usize,
    /// Ratio at which a search ends.
    pub(crate) target_ratio: f64,
    /// Bounds over samples: of elements that keep the limits, up to the largest of others.
    pub(crate) bound_over_sample: Range<f64>,
}

pub(crate) const LIMIT_REPAIR: LimitRepairSettings = LimitRepairSettings {
    max_rounds: 12,
    max_idle_rounds: 2,
    few: 12,
    min_quality: 0.65,
    max_bounded_in_round: 24,
    max_bounded: 32,
    target_ratio: 0.98,
    bound_over_sample: 1.1..3.0,
};

/// Which of two placements of nodes a face keeps (`placements.rs`).
pub(crate) struct PlacementSettings {
    /// Quality of the worst quad of either below which that decides, not the number of irregular nodes.
    pub(crate) min_quality: f64,
}

pub(crate) const PLACEMENTS: PlacementSettings = PlacementSettings { min_quality: 0.55 };
