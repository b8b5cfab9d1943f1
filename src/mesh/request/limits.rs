//! Limits along a line: chord error and angle, with the room that moved ends need.

use crate::base::tolerance::WHOLE_NUMBER;
use crate::mesh::request::input::Input;

/// Limits along a line, model units and radians.
#[derive(Clone, Copy, Debug, Default)]
pub struct Limits {
    /// `chord_error`: largest distance of a step's chord from the curve.
    pub chord: Option<f64>,
    /// `angle_error`: largest turn of the tangent across a step.
    pub angle: Option<f64>,
    /// What ends may move by without a change of any count.
    pub near: f64,
}

impl Limits {
    /// Of a plan.
    pub fn of(input: &Input) -> Self {
        let plan = input.plan;
        Self { chord: plan.settings.chord_error.map(|c| c.0), angle: plan.settings.angle_error.map(|a| a.0), near: input.tolerance.point }
    }

    /// The same where no step turns by more than this, radians.
    pub fn turning(self, most: f64) -> Self {
        Self { angle: Some(self.angle.map_or(most, |angle| angle.min(most))), ..self }
    }

    /// Share of the angle that a turn may be over it, along a curve of this length that turns by `whole` in all: what the
    /// length changes by where an end moves by the tolerance, and the tangents at both ends where a point between moves.
    pub fn turn_room(&self, length: f64, whole: f64) -> f64 {
        WHOLE_NUMBER + (self.near / length * (1.0 + END_TURN / whole)).min(MAX_ROOM)
    }

    /// Share of the chord error that a step may be over it: distances from a chord go with the square of its length.
    pub(crate) fn chord_room(&self, length: f64) -> f64 {
        WHOLE_NUMBER + (2.0 * self.near / length).min(MAX_ROOM)
    }
}

/// Turn between the tangents at the ends of a curve whose middle moves, over that way as a share of its length.
const END_TURN: f64 = 4.0;

/// Share of a limit that room for moved ends is at most.
const MAX_ROOM: f64 = 0.001;
