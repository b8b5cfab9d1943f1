//! Reasons for dividing a mesh anew.

use crate::mesh::border::layout::Uneven;
use crate::mesh::face::coincident::Demand;
use crate::mesh::size::proximity::Narrow;

/// Why a mesh is divided anew.
pub(crate) enum Retry {
    /// Mapped faces have pieces of border as short as a row would be, or lie beside free faces with such: they become free.
    UnevenBorders(Vec<(usize, Uneven)>),
    /// Borders of free faces come nearer to each other than their steps: these become shorter there.
    NearBorders(Vec<Narrow>),
    /// Faces whose maps are predicted to be worse than free meshes: with the reason and the predicted number of elements.
    BetterFree(Vec<(usize, Uneven, u64)>),
    /// Free faces that turned out worse than their maps.
    BetterMapped(Vec<usize>),
    /// Steps of segments break a limit that fewer keep: these are the next counts that do.
    BrokenSteps(Vec<(usize, u32)>),
    /// A face breaks a limit: its rows demand more steps.
    BrokenLimits,
    /// Uneven rows of faces lean, or limits demand more of them than of even ones: these become even.
    UnfitRows(Vec<usize>),
    /// Faces have elements or edges between the same nodes.
    Coincident(Demand),
    /// Elements of a face from one of its sides to another are the same ones: the steps of its border are halved.
    ClosesOnItself(usize),
}
