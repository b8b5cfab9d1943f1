//! Forms of a model that must not change its result.

use glam::{DMat3, DVec3};

/// How a model is written.
#[derive(Clone, Debug)]
pub struct Form {
    /// Turns and mirrors.
    pub turn: DMat3,
    pub scale: f64,
    /// Millimetres before the scale.
    pub by: DVec3,
    /// The model unit and its millimetres.
    pub unit: (&'static str, f64),
    /// Curves run the other way.
    pub reversed: bool,
    /// Arguments, corners and parameters come in another order.
    pub permuted: bool,
    /// Curves are put together of two runs.
    pub split: bool,
    /// Sides of polygons have a further point.
    pub collinear: bool,
    /// Something stands beside the model.
    pub unrelated: bool,
    /// The last declaration comes first.
    pub shuffled: bool,
    /// The text is laid out.
    pub formatted: bool,
}

const PLAIN: Form = Form {
    turn: DMat3::IDENTITY,
    scale: 1.0,
    by: DVec3::ZERO,
    unit: ("mm", 1.0),
    reversed: false,
    permuted: false,
    split: false,
    collinear: false,
    unrelated: false,
    shuffled: false,
    formatted: false,
};

/// A form and its name.
pub struct Named {
    pub name: &'static str,
    change: fn(&mut Form),
}

impl Named {
    pub fn form(&self) -> Form {
        let mut form = PLAIN;
        (self.change)(&mut form);
        form
    }
}

fn turned(axis: DVec3, degrees: f64) -> DMat3 {
    DMat3::from_axis_angle(axis.normalize(), degrees.to_radians())
}

/// All forms.
pub const FORMS: &[Named] = &[
    Named { name: "plain", change: |_| {} },
    Named { name: "turned about z", change: |f| f.turn = turned(DVec3::Z, 90.0) },
    Named { name: "turned", change: |f| f.turn = turned(DVec3::new(0.3, -0.8, 0.5), 77.0) },
    Named { name: "moved", change: |f| f.by = DVec3::new(123.4, -56.7, 8.9) },
    Named { name: "moved far", change: |f| f.by = DVec3::new(-40000.0, 25000.0, 1000.0) },
    Named { name: "a thousandth", change: |f| f.scale = 1e-3 },
    Named { name: "a thousandfold", change: |f| f.scale = 1e3 },
    Named { name: "scaled by 0.37", change: |f| f.scale = 0.37 },
    Named { name: "mirrored", change: |f| f.turn = DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0)) },
    Named { name: "in metres", change: |f| f.unit = ("m", 1e3) },
    Named { name: "in inches", change: |f| f.unit = ("in", 25.4) },
    Named { name: "reversed", change: |f| f.reversed = true },
    Named { name: "permuted", change: |f| f.permuted = true },
    Named { name: "curves of two runs", change: |f| f.split = true },
    Named { name: "collinear points", change: |f| f.collinear = true },
    Named { name: "something beside it", change: |f| f.unrelated = true },
    Named { name: "shuffled", change: |f| f.shuffled = true },
    Named { name: "formatted", change: |f| f.formatted = true },
];
