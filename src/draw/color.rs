//! Colours of pictures: of surfaces, of lines by what they show, and ramps for values.

/// Red, green, blue, 0…255 as screens take them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rgb(pub u8, pub u8, pub u8);

/// Paper.
pub const WHITE: Rgb = Rgb(255, 255, 255);
/// Text and frames.
pub const INK: Rgb = Rgb(34, 38, 46);
/// Words of less weight.
pub const GREY: Rgb = Rgb(96, 104, 116);
/// Faces that no value colours.
pub const FACE: Rgb = Rgb(182, 206, 232);
/// The other side of faces, where sides are told apart.
pub const BACK: Rgb = Rgb(240, 164, 84);
/// The side the normal points to, where sides are told apart.
pub const FRONT: Rgb = Rgb(108, 164, 226);
/// Edges of elements.
pub const ELEMENT: Rgb = Rgb(44, 58, 78);
/// Where two surfaces or patches meet.
pub const BORDER: Rgb = Rgb(20, 30, 52);
/// Curves of the network.
pub const CURVE: Rgb = Rgb(20, 74, 160);
/// Lines along which a surface is bent.
pub const KINK: Rgb = Rgb(226, 116, 0);
/// Edges of one face only.
pub const FREE: Rgb = Rgb(214, 18, 30);
/// Edges of three faces or more.
pub const CROWDED: Rgb = Rgb(176, 0, 176);
/// Curvature combs.
pub const COMB: Rgb = Rgb(150, 40, 150);
/// Where nothing is known of a value.
pub const UNKNOWN: Rgb = Rgb(190, 190, 190);

/// Colours of things told apart by name, in order.
pub const NAMES: &[Rgb] = &[
    Rgb(132, 178, 222),
    Rgb(244, 182, 110),
    Rgb(150, 206, 146),
    Rgb(232, 150, 150),
    Rgb(190, 170, 222),
    Rgb(206, 174, 150),
    Rgb(240, 186, 214),
    Rgb(214, 214, 120),
    Rgb(134, 210, 214),
    Rgb(186, 190, 196),
];

impl Rgb {
    /// `#rrggbb`.
    pub fn hex(self) -> String {
        format!("#{:02x}{:02x}{:02x}", self.0, self.1, self.2)
    }

    /// This colour, `share` of the way to another.
    pub fn toward(self, other: Self, share: f64) -> Self {
        let mix = |a: u8, b: u8| (f64::from(a) + (f64::from(b) - f64::from(a)) * share).round() as u8;
        Self(mix(self.0, other.0), mix(self.1, other.1), mix(self.2, other.2))
    }

    /// As three shares of one.
    pub(super) fn shares(self) -> [f32; 3] {
        [self.0, self.1, self.2].map(|c| f32::from(c) / 255.0)
    }
}

/// Colours from low to high, evenly spaced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ramp(&'static [Rgb]);

/// From bad (red) to good (blue); also told apart by who sees no difference between red and green.
pub const BAD_TO_GOOD: Ramp =
    Ramp(&[Rgb(178, 18, 36), Rgb(236, 104, 60), Rgb(252, 206, 120), Rgb(226, 240, 214), Rgb(134, 190, 222), Rgb(84, 146, 210)]);
/// From little (dark) to much (light).
pub const LITTLE_TO_MUCH: Ramp =
    Ramp(&[Rgb(124, 88, 172), Rgb(92, 122, 192), Rgb(64, 156, 180), Rgb(72, 186, 148), Rgb(150, 212, 98), Rgb(248, 230, 70)]);
/// From below zero (blue) over zero (white) to above (red).
pub const BELOW_TO_ABOVE: Ramp = Ramp(&[Rgb(36, 88, 168), Rgb(132, 178, 220), Rgb(240, 240, 236), Rgb(240, 160, 124), Rgb(184, 28, 44)]);

impl Ramp {
    /// The colour at a share of the way from low to high; outside 0…1 that of the nearer end.
    pub fn at(self, share: f64) -> Rgb {
        let last = self.0.len() - 1;
        let x = share.clamp(0.0, 1.0) * last as f64;
        let k = (x as usize).min(last.saturating_sub(1));
        self.0[k].toward(self.0[(k + 1).min(last)], x - k as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ramps_meet_their_ends_and_stay_inside() {
        for ramp in [BAD_TO_GOOD, LITTLE_TO_MUCH, BELOW_TO_ABOVE] {
            assert_eq!(ramp.at(0.0), ramp.0[0]);
            assert_eq!(ramp.at(1.0), ramp.0[ramp.0.len() - 1]);
            assert_eq!(ramp.at(-3.0), ramp.at(0.0));
            assert_eq!(ramp.at(f64::INFINITY), ramp.at(1.0));
        }
        assert_eq!(WHITE.toward(Rgb(0, 0, 0), 0.5), Rgb(128, 128, 128));
        assert_eq!(Rgb(1, 16, 255).hex(), "#0110ff");
    }
}
