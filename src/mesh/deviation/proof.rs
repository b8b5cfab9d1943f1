//! What is proved of a face and its chord error, and what steers the proof.

/// What steers the certification of a face.
pub(super) struct CertifySettings {
    /// Share of the box of a triangle by which it is widened: feet of its points lie a little beside their (u, v).
    pub widening: f64,
    /// Share of the box of a triangle by which feet may lie beside the middles of its sides; it keeps parts shrinking.
    pub max_stray: f64,
    /// Share of the limit that a point far from its foot may use up.
    pub max_used_share: f64,
    /// Halvings of a triangle at most.
    pub max_halvings: u32,
    /// Parts of a triangle whose bound is not enough, at most.
    pub max_open_parts: usize,
    /// Triangles of a row that are left open before the rest of it is skipped.
    pub max_open_triangles: usize,
}

pub(super) const CERTIFY_SETTINGS: CertifySettings =
    CertifySettings { widening: 0.05, max_stray: 0.2, max_used_share: 0.5, max_halvings: 12, max_open_parts: 800, max_open_triangles: 4 };

/// What is known of a face and a limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Proof {
    /// No point is farther from the surface.
    Kept,
    /// A point is: its distance over the limit, and how the surface bends there along u and along v.
    Broken(f64, [f64; 2]),
    /// Neither: the bound over the limit, and the same.
    Open(f64, [f64; 2]),
    /// Neither, and a finer mesh would not change that: the bound does not fall with the size of the parts.
    Blind,
}

impl Proof {
    /// What two parts make together.
    pub(super) fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::Kept, Self::Blind) => Self::Blind,
            (_, Self::Kept | Self::Blind) | (Self::Broken(..), Self::Open(..)) => self,
            (Self::Kept | Self::Blind, _) | (Self::Open(..), Self::Broken(..)) => other,
            (Self::Open(a, _), Self::Open(b, _)) | (Self::Broken(a, _), Self::Broken(b, _)) => {
                if a >= b {
                    self
                } else {
                    other
                }
            }
        }
    }
}
