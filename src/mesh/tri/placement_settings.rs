//! The constants that steer the placement of nodes of free triangle meshes, phase by phase. Distances and lengths are shares of the wanted
//! length there, unless said otherwise.

use std::ops::Range;

/// Estimate of the number of nodes before any is placed (`build.rs`).
pub(crate) struct EstimateSettings {
    /// Largest number of triangles that are divided, beside those between border nodes.
    pub(crate) max_divisions: usize,
    /// Number of nodes in a triangle up to which one wanted length is taken for all of it.
    pub(crate) nodes_of_one_size: f64,
    /// Ratio of lengths that count as equal.
    pub(crate) equal_size_ratio: f64,
}

pub(crate) const ESTIMATE: EstimateSettings = EstimateSettings { max_divisions: 10_000, nodes_of_one_size: 8.0, equal_size_ratio: 1.25 };

/// Placement of nodes by an advancing front (`front.rs`).
pub(crate) struct FrontSettings {
    /// Least distance of two nodes.
    pub(crate) min_node_spacing: f64,
    /// Least distance of the first guess of a node from others, where the wanted length is that at its parent: the one at its own place is
    /// hardly ever less than half of that.
    pub(crate) min_guess_spacing: f64,
    /// Distance of two places within which the test of the one against other nodes holds for the other.
    pub(crate) same_place_distance: f64,
    /// Least distance of a node from an edge of the border.
    pub(crate) min_border_distance: f64,
    /// Distance of samples along the border.
    pub(crate) border_sample_spacing: f64,
    /// Radius of the search for samples of the border: a step and half the distance of samples.
    pub(crate) border_search_radius: f64,
    /// Largest error of the length of a step, as a share of it, that is not corrected by a second step.
    pub(crate) max_step_error: f64,
    /// Length of a step over the wanted one from which its direction is undetermined: where the map is singular, as at a corner in which
    /// control points coincide, a step goes anywhere.
    pub(crate) max_step_ratio: f64,
    /// Number of nodes between two checks for an interrupt.
    pub(crate) nodes_per_check: usize,
    /// Largest number of samples of an edge at equal distances.
    pub(crate) max_equal_samples: usize,
    /// Largest number of times that an edge is halved for samples at equal distances.
    pub(crate) max_edge_halvings: u32,
    /// Work of a sample, in evaluations of a curve: it is stored three times.
    pub(crate) sample_work: u64,
}

pub(crate) const FRONT: FrontSettings = FrontSettings {
    min_node_spacing: 0.7,
    min_guess_spacing: 0.5 * 0.7,
    same_place_distance: 0.02,
    min_border_distance: 0.52,
    border_sample_spacing: 0.5,
    border_search_radius: 1.3,
    max_step_error: 0.01,
    max_step_ratio: 2.0,
    nodes_per_check: 4096,
    max_equal_samples: 4096,
    max_edge_halvings: 20,
    sample_work: 8,
};

/// Angles of corners of the border that two triangles fill, radians: 75° to 150°.
pub(crate) const TWO_TRIANGLE_CORNERS: Range<f64> = 1.309..2.618;

/// Rows of squares along the border (`front/squares.rs`).
pub(crate) struct SquareRowSettings {
    /// Least distance of two nodes of lattices: one in the middle of a square has 0.707 to its corners.
    pub(crate) min_lattice_spacing: f64,
    /// Least distance of a node from those of the first row: half a step, so that the gap between two rows is as often too narrow as too
    /// wide.
    pub(crate) min_first_row_spacing: f64,
    /// Least distance of two nodes of the first row.
    pub(crate) min_spacing_within_row: f64,
    /// Least distance of a node from an edge of the border.
    pub(crate) min_border_distance: f64,
    /// Least angle at the border over a straight one that counts as bent outwards.
    pub(crate) min_outward_turn: f64,
    /// Steps of the border over the wanted length that the lattice takes for its own.
    pub(crate) followed_steps: Range<f64>,
    /// Angles of a cell at the border where it bends outwards, radians: 57° to 126°.
    pub(crate) corner_angles: Range<f64>,
    /// Least number of edges of a straight run whose steps a lattice follows.
    pub(crate) min_run_edges: usize,
    /// Largest cosine between runs that count as perpendicular.
    pub(crate) max_perpendicular_cosine: f64,
}

pub(crate) const SQUARE_ROWS: SquareRowSettings = SquareRowSettings {
    min_lattice_spacing: 0.75,
    min_first_row_spacing: 0.55,
    min_spacing_within_row: 0.65,
    min_border_distance: 0.6,
    min_outward_turn: 1.02,
    followed_steps: 0.7..1.08,
    corner_angles: 1.0..2.2,
    min_run_edges: 3,
    max_perpendicular_cosine: 0.02,
};

/// Holes of plane faces as rectangles of a lattice of squares (`front/square_lattice.rs`). Lengths are steps of the lattice.
pub(crate) struct SquareHoleSettings {
    /// Least number of steps of a border that becomes a rectangle.
    pub(crate) min_steps: usize,
    /// Distance up to which the lattice is moved, over the largest way that a node of it has to go.
    pub(crate) reach: f64,
    /// Distance from other borders in which the lattice is not moved.
    pub(crate) rows_beside_border: f64,
    /// Largest number of nodes in the box round a face over that inside its outer loop.
    pub(crate) max_box_over_area: f64,
    /// Number of nodes up to which it may be more.
    pub(crate) small_box: f64,
    /// Least wanted length beside a hole.
    pub(crate) min_wanted: f64,
    /// Least wanted length where the lattice has nodes that are not moved for a hole.
    pub(crate) min_wanted_elsewhere: f64,
    /// Least distance of other nodes from those of the lattice: one in the middle of a cell that was stretched is nearer.
    pub(crate) min_spacing_beside: f64,
    /// Number of sweeps that spread the moves.
    pub(crate) sweeps: usize,
    /// Share of the way to the mean of its neighbours that a node goes in a sweep.
    pub(crate) relaxation: f64,
    /// Largest number of nodes laid in a search for other rectangles.
    pub(crate) max_search: usize,
    /// Number of rows about a hole whose cells are looked at.
    pub(crate) scored_rows: i32,
    /// Least sine of a corner of a cell.
    pub(crate) min_quality: f64,
    /// Least side of a cell.
    pub(crate) min_side: f64,
}

pub(crate) const SQUARE_HOLES: SquareHoleSettings = SquareHoleSettings {
    min_steps: 4,
    reach: 3.0,
    rows_beside_border: 1.5,
    max_box_over_area: 8.0,
    small_box: 10_000.0,
    min_wanted: 0.4,
    min_wanted_elsewhere: 0.85,
    min_spacing_beside: 0.95,
    sweeps: 12,
    relaxation: 1.4,
    max_search: 40_000_000,
    scored_rows: 2,
    min_quality: 0.3,
    min_side: 0.3,
};

/// Placement of nodes at the corners of a quadtree (`quadtree.rs`).
pub(crate) struct QuadtreeSettings {
    /// Side of a cell: its diagonal is then hardly longer than a side may be.
    pub(crate) cell_side: f64,
    /// Least distance of a node from the border, over the side of the cells round it.
    pub(crate) min_border_distance: f64,
    /// Least distance of two nodes, over the longer side of the cells round one of them: where the chart is compressed, as towards a
    /// pole, cells are much narrower than long, and their corners would crowd.
    pub(crate) min_node_spacing: f64,
    /// Least distance of a node, in the chart, from an edge of the border whose chord is off the surface, over the side of the cells.
    pub(crate) min_chart_distance: f64,
    /// Distance of an edge from the surface, over its length, from which on distances to its chord are no measure.
    pub(crate) max_edge_deviation: f64,
    /// Number of parts of an edge at whose ends its distance from the surface is sampled.
    pub(crate) edge_parts: u32,
    /// Largest number of root cells along a side.
    pub(crate) max_roots: f64,
    /// Number of samples along each direction for the largest wanted length.
    pub(crate) size_samples: usize,
}

pub(crate) const QUADTREE: QuadtreeSettings = QuadtreeSettings {
    cell_side: 0.74,
    min_border_distance: 0.5,
    min_node_spacing: 0.55,
    min_chart_distance: 0.25,
    max_edge_deviation: 0.05,
    edge_parts: 8,
    max_roots: 2048.0,
    size_samples: 16,
};

/// The grid of wanted lengths over a chart (`background.rs`).
pub(crate) struct BackgroundSettings {
    /// Number of lines along the longer side of the first grid, from which the mean length is taken.
    pub(crate) first_lines: usize,
    /// Largest number of lines along the longer side.
    pub(crate) max_lines: usize,
    /// Number of breaks above which there are as many lines, and the largest number of lines for that reason.
    pub(crate) many_breaks: usize,
    pub(crate) max_lines_by_breaks: usize,
    /// Distance of lines over the mean wanted length.
    pub(crate) line_spacing: f64,
    /// Ratio of lengths between neighbouring lines from which on lines are added between them.
    pub(crate) max_ratio: f64,
    /// Cosine of the angle between the normals of neighbouring lines below which lines are added: 30°.
    pub(crate) min_turn_cosine: f64,
    /// Share of the distance of lines down to which they are added where the surface turns.
    pub(crate) min_turn_spacing: f64,
    /// Largest number of rounds in which lines are added.
    pub(crate) max_rounds: usize,
    /// Share of the largest need for lines down to which a gap gets one in the same round.
    pub(crate) halved_share: f64,
    /// Ratio of needs that count as equal.
    pub(crate) alike: f64,
    /// Number of nodes up to which lines are added; a grid of more than two thirds of it may get half as many again.
    pub(crate) max_added_nodes: usize,
    /// Ratio of the lengths round a cell from which on they are lowered by one share instead of to one length.
    pub(crate) max_even_ratio: f64,
    /// Largest ratio of a length on an added line and that between the even lines beside it for which the line says nothing new.
    pub(crate) max_needless_ratio: f64,
}

pub(crate) const BACKGROUND: BackgroundSettings = BackgroundSettings {
    first_lines: 12,
    max_lines: 384,
    many_breaks: 32,
    max_lines_by_breaks: 96,
    line_spacing: 2.0,
    max_ratio: 1.5,
    min_turn_cosine: 0.866,
    min_turn_spacing: 0.125,
    max_rounds: 32,
    halved_share: 0.5,
    alike: 0.999,
    max_added_nodes: 4000,
    max_even_ratio: 2.0,
    max_needless_ratio: 1.1,
};

/// Cells between lines of constant u and v, and the triangulation of them (`isoline.rs`, `isoline_mesh.rs`).
pub(crate) struct IsolineSettings {
    /// Share of a cell about its middle in which a cut is moved to a node of a border.
    pub(crate) snap_to_node: f64,
    /// Share of that in which a cut is moved to a value that is cut elsewhere.
    pub(crate) snap_to_cut: f64,
    /// Largest distance of two border nodes that face each other, as a share of the distance to the next ones.
    pub(crate) max_facing_offset: f64,
    /// Least width of a cell that is cut, in distances that count as zero.
    pub(crate) min_cut_width: f64,
    /// Largest number of parts that a cell is cut into at a time.
    pub(crate) max_parts: f64,
    /// Width of the strips by which errors along one direction are measured, as a share of the cell.
    pub(crate) strip_width: f64,
    /// Width of a leaf over that of a triangle below which the other direction is cut.
    pub(crate) min_leaf_width: f64,
    /// Largest share of a closed direction that one cell covers: with a third, three nodes go round.
    pub(crate) max_closed_share: f64,
    /// Largest share of the way from pole to pole that one cell covers.
    pub(crate) max_pole_share: f64,
    /// Number of pieces by which the side of a cell is measured.
    pub(crate) side_pieces: usize,
    /// Work of a cell that is cut because it is too large by itself, in elements: of the first cells, and of those beyond, where a limit that
    /// cannot be kept would be cut for without end.
    pub(crate) cut_work: (u64, u64),
    /// Number of cells that count as the first.
    pub(crate) first_cells: usize,
    /// Number of curves of which a point of the surface is made for which a cell is charged as much again.
    pub(crate) curves_per_cut_work: usize,
    /// Least distance of a node from a border that it is not on, as a share of the cells round it.
    pub(crate) min_border_distance: f64,
    /// Largest side of a triangle beside a border over the largest side of a cell: its diagonal, and a margin.
    pub(crate) max_side_ratio: f64,
    /// Size of a cell, as a share of the chord error, below which cutting has no effect where nothing bounds the surface.
    pub(crate) min_cell_share: f64,
    /// Distance of the surface from a triangle without area, as a share of its longest side, from which on it wraps round.
    pub(crate) max_flat_offset: f64,
    /// Largest number of flips beside borders in one round for each triangle.
    pub(crate) max_flips: usize,
    /// Largest number of rounds of cutting.
    pub(crate) max_rounds: usize,
    /// Work of a cell in one round, in evaluations of the surface: all are sorted and traversed anew.
    pub(crate) cell_work: u64,
    /// The same of a node of a border.
    pub(crate) node_work: u64,
}

pub(crate) const ISOLINES: IsolineSettings = IsolineSettings {
    snap_to_node: 0.25,
    snap_to_cut: 0.2,
    max_facing_offset: 0.2,
    min_cut_width: 16.0,
    max_parts: 1e6,
    strip_width: 1.0 / 64.0,
    min_leaf_width: 0.6,
    max_closed_share: 0.35,
    max_pole_share: 0.6,
    side_pieces: 4,
    cut_work: (16, 2),
    first_cells: 16_000,
    curves_per_cut_work: 4,
    min_border_distance: 0.3,
    max_side_ratio: 1.5,
    min_cell_share: 0.25,
    max_flat_offset: 0.25,
    max_flips: 4,
    max_rounds: 64,
    cell_work: 20,
    node_work: 8,
};
