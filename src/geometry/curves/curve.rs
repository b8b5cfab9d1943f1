//! One curve of any kind: what every caller above this floor works with.

use std::sync::{Arc, OnceLock};

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::digest::{StableHash, StableHasher};
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::base::work;
use crate::geometry::curves::arclength::Lengths;
use crate::geometry::curves::composite::Composite;
use crate::geometry::curves::offset::Offset;
use crate::geometry::curves::pieces::Pieces;
use crate::geometry::data::jet::Jet;
use crate::geometry::data::kind::Kind;
use crate::geometry::data::motion::Motion;
use crate::geometry::shapes::arc::EllipticArc;
use crate::geometry::shapes::helix::Helix;
use crate::geometry::shapes::nurbs::Nurbs;

/// The exact shape of a curve, with its own parameter.
#[derive(Clone, Debug)]
pub enum Shape {
    /// From a (parameter 0) to b (parameter 1).
    Line(DVec3, DVec3),
    /// Arc of a circle or an ellipse; the parameter is its angle from 0.
    Arc(Box<EllipticArc>),
    /// Rational B-spline.
    Nurbs(Arc<Nurbs>),
    /// Helix; the parameter is its angle from 0.
    Helix(Box<Helix>),
    /// Offset of a plane curve, with the parameter of that curve.
    Offset(Box<Offset>),
    /// Curves in a row.
    Composite(Arc<Composite>),
}

/// A curve: exact shape, kind and origin. Cheap to clone.
///
/// Parameters `t` are the shape's own, inside [`Curve::domain`]; lengths `s` run from 0 to [`Curve::length`], and
/// fractions `f` are `s / length`. Length tables are made on first use and shared by clones.
#[derive(Clone, Debug)]
pub struct Curve(Arc<Inner>);

#[derive(Debug)]
struct Inner {
    shape: Shape,
    kind: Kind,
    origin: Origin,
    /// The inner point that the user gave: an arc through three points is built anew from it.
    through: Option<Box<DVec3>>,
    lengths: OnceLock<Arc<Lengths>>,
    pieces: OnceLock<Arc<Pieces>>,
}

crate::content!(Inner { shape, kind, through } but { origin, lengths, pieces });

impl StableHash for Shape {
    fn hash_into(&self, to: &mut StableHasher) {
        match self {
            Self::Line(a, b) => (0u8, *a, *b).hash_into(to),
            Self::Arc(arc) => (1u8, arc).hash_into(to),
            Self::Nurbs(nurbs) => (2u8, nurbs).hash_into(to),
            Self::Helix(helix) => (3u8, helix).hash_into(to),
            Self::Offset(offset) => (4u8, offset).hash_into(to),
            Self::Composite(composite) => (5u8, composite).hash_into(to),
        }
    }
}

impl StableHash for Curve {
    fn hash_into(&self, to: &mut StableHasher) {
        self.0.hash_into(to);
    }
}

impl Curve {
    /// A curve of this shape.
    pub fn new(shape: Shape, kind: Kind, origin: Origin) -> Self {
        Self(Arc::new(Inner { shape, kind, origin, through: None, lengths: OnceLock::new(), pieces: OnceLock::new() }))
    }

    /// The same curve, known to be built through a point between its ends.
    pub(crate) fn built_through(&self, through: Option<DVec3>) -> Self {
        let Inner { shape, kind, origin, .. } = &*self.0;
        Self(Arc::new(Inner {
            shape: shape.clone(),
            kind: *kind,
            origin: *origin,
            through: through.map(Box::new),
            lengths: OnceLock::new(),
            pieces: OnceLock::new(),
        }))
    }

    /// The point between its ends through which it was built.
    pub(crate) fn through(&self) -> Option<DVec3> {
        self.0.through.as_deref().copied()
    }

    /// The same curve, made by another expression.
    pub fn with_origin(&self, origin: Origin) -> Self {
        let Inner { shape, kind, through, lengths, pieces, .. } = &*self.0;
        let (shape, lengths, pieces) = (shape.clone(), lengths.clone(), pieces.clone());
        Self(Arc::new(Inner { shape, kind: *kind, origin, through: through.clone(), lengths, pieces }))
    }

    /// The same shape, as if made with another word.
    pub(crate) fn of_kind(&self, kind: Kind) -> Self {
        Self::new(self.0.shape.clone(), kind, self.0.origin)
    }

    fn with_shape(&self, shape: Shape) -> Self {
        Self::new(shape, self.0.kind, self.0.origin)
    }

    /// The word it was made with.
    pub fn kind(&self) -> Kind {
        self.0.kind
    }

    /// The exact shape.
    pub fn shape(&self) -> &Shape {
        &self.0.shape
    }

    /// Whether two values are one and the same: made once and copied, not only alike.
    pub fn is(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }

    /// The expression that made it.
    pub fn origin(&self) -> Origin {
        self.0.origin
    }

    /// Its pieces, when it is made of several curves.
    pub fn composite(&self) -> Option<&Composite> {
        match &self.0.shape {
            Shape::Composite(c) => Some(c),
            _ => None,
        }
    }

    /// First and last parameter.
    pub fn domain(&self) -> (f64, f64) {
        match &self.0.shape {
            Shape::Line(..) => (0.0, 1.0),
            Shape::Arc(arc) => (0.0, arc.sweep),
            Shape::Nurbs(c) => c.domain(),
            Shape::Helix(helix) => (0.0, helix.sweep),
            Shape::Offset(offset) => offset.base.domain(),
            Shape::Composite(c) => (0.0, c.breaks[c.pieces.len()]),
        }
    }

    /// Point and derivatives at a parameter of the domain; at a corner those of the piece that follows.
    #[inline]
    pub fn jet(&self, t: f64) -> Jet {
        work::spend(1);
        // Straight lines, which are many, need no call.
        if let Shape::Line(a, b) = &self.0.shape { line_jet(*a, *b, t) } else { self.jet_of_shape(t) }
    }

    fn jet_of_shape(&self, t: f64) -> Jet {
        match &self.0.shape {
            Shape::Line(a, b) => line_jet(*a, *b, t),
            Shape::Arc(arc) => arc.jet(t),
            Shape::Nurbs(c) => c.jet(t),
            Shape::Helix(helix) => helix.jet(t),
            Shape::Offset(offset) => offset.jet_of(offset.base.jet(t), offset.base.third(t)),
            Shape::Composite(c) => {
                let (i, own) = c.locate(t);
                c.pieces[i].jet(own)
            }
        }
    }

    /// Like [`Curve::jet`], at a corner with the derivatives of the piece before it.
    pub fn jet_before(&self, t: f64) -> Jet {
        work::spend(1);
        match &self.0.shape {
            Shape::Nurbs(c) => c.jet_in(c.span_before(t), t),
            Shape::Composite(c) => {
                let (i, own) = c.locate_before(t);
                c.pieces[i].jet_before(own)
            }
            // Everything else is smooth.
            _ => self.jet(t),
        }
    }

    /// Third derivative, for shapes that follow another one.
    fn third(&self, t: f64) -> DVec3 {
        match &self.0.shape {
            Shape::Arc(arc) => -arc.jet(t).d1,
            Shape::Nurbs(c) => c.third(t),
            _ => DVec3::ZERO,
        }
    }

    /// Point at a parameter of the domain.
    pub fn point(&self, t: f64) -> DVec3 {
        self.jet(t).p
    }

    /// First point.
    pub fn start(&self) -> DVec3 {
        match &self.0.shape {
            Shape::Line(a, _) => *a,
            _ => self.point(self.domain().0),
        }
    }

    /// Last point.
    pub fn end(&self) -> DVec3 {
        match &self.0.shape {
            Shape::Line(_, b) => *b,
            _ => self.point(self.domain().1),
        }
    }

    /// Whether start and end are one point.
    pub fn is_closed(&self, tolerance: &Tolerance) -> bool {
        tolerance.same_point(self.start(), self.end())
    }

    /// The table of lengths, made on first use.
    pub(crate) fn lengths(&self) -> &Lengths {
        // Made once for everyone, whoever comes first.
        self.0.lengths.get_or_init(|| Arc::new(work::uncharged(|| Lengths::of(self))))
    }

    /// Its smooth pieces with bounds, made on first use.
    pub(crate) fn pieces(&self) -> &Pieces {
        self.0.pieces.get_or_init(|| Arc::new(work::uncharged(|| Pieces::of(self))))
    }

    /// Its pieces, in `own` when it is a straight line that does not have them already: they are made in no time, and of very many lines
    /// not worth keeping.
    pub(crate) fn passing_pieces<'a>(&'a self, own: &'a mut Option<Pieces>) -> &'a Pieces {
        match self.0.pieces.get() {
            Some(pieces) => pieces,
            None if matches!(self.0.shape, Shape::Line(..)) => own.insert(work::uncharged(|| Pieces::of(self))),
            None => self.pieces(),
        }
    }

    /// Parameters between which the curve is one analytic piece, ends included.
    pub fn knots(&self) -> Vec<f64> {
        match &self.0.shape {
            Shape::Nurbs(c) => c.breaks().into_iter().map(|(t, _)| t).collect(),
            Shape::Offset(offset) => offset.base.knots(),
            Shape::Composite(c) => {
                let mut knots = vec![0.0];
                for (i, piece) in c.pieces.iter().enumerate() {
                    knots.extend(piece.knots()[1..].iter().map(|t| c.common(i, *t)));
                }
                knots
            }
            _ => vec![self.domain().0, self.domain().1],
        }
    }

    /// The run backwards, kind and origin kept.
    pub fn reversed(&self) -> Self {
        let reversed = self.with_shape(match &self.0.shape {
            Shape::Line(a, b) => Shape::Line(*b, *a),
            Shape::Arc(arc) => Shape::Arc(Box::new(arc.reversed())),
            Shape::Nurbs(c) => Shape::Nurbs(Arc::new(c.reversed())),
            Shape::Helix(helix) => Shape::Helix(Box::new(helix.reversed())),
            Shape::Offset(offset) => Shape::Offset(Box::new(offset.reversed())),
            Shape::Composite(c) => Shape::Composite(Arc::new(Composite::new(c.pieces.iter().rev().map(Self::reversed)))),
        });
        if self.0.through.is_none() { reversed } else { reversed.built_through(self.through()) }
    }

    /// The exact piece between two parameters of the domain, `t0 < t1`; a whole circle's part is an arc.
    pub fn part(&self, t0: f64, t1: f64) -> Self {
        let (a, b) = self.domain();
        let (t0, t1) = (t0.max(a), t1.min(b));
        if (t0, t1) == (a, b) {
            return self.clone();
        }
        let kind = if self.kind() == Kind::Circle { Kind::Arc } else { self.kind() };
        let shape = match &self.0.shape {
            Shape::Line(a, b) => {
                let at = |t: f64| if t == 1.0 { *b } else { line_jet(*a, *b, t).p };
                Shape::Line(at(t0), at(t1))
            }
            Shape::Arc(arc) => Shape::Arc(Box::new(arc.part(t0, t1))),
            Shape::Nurbs(c) => Shape::Nurbs(Arc::new(c.part(t0, t1))),
            Shape::Helix(helix) => Shape::Helix(Box::new(helix.part(t0, t1))),
            Shape::Offset(offset) => Shape::Offset(Box::new(offset.part(t0, t1))),
            Shape::Composite(c) => {
                let mut pieces = c.part(t0, t1);
                if pieces.len() == 1 {
                    return pieces.remove(0).with_origin(self.origin());
                }
                Shape::Composite(Arc::new(Composite::new(pieces)))
            }
        };
        Self::new(shape, kind, self.origin())
    }

    /// The image under a motion, exactly.
    pub fn moved(&self, motion: &Motion) -> Self {
        let moved = self.with_shape(match &self.0.shape {
            Shape::Line(a, b) => Shape::Line(motion.point(*a), motion.point(*b)),
            Shape::Arc(arc) => Shape::Arc(Box::new(arc.moved(motion))),
            Shape::Nurbs(c) => Shape::Nurbs(Arc::new(c.moved(motion))),
            Shape::Helix(helix) => Shape::Helix(Box::new(helix.moved(motion))),
            Shape::Offset(offset) => Shape::Offset(Box::new(offset.moved(motion))),
            Shape::Composite(c) => Shape::Composite(Arc::new(Composite::new(c.pieces.iter().map(|p| p.moved(motion))))),
        });
        if self.0.through.is_none() { moved } else { moved.built_through(self.through().map(|p| motion.point(p))) }
    }

    /// A box that holds the curve (of control points where the exact one costs more).
    pub fn bbox(&self) -> Box3 {
        match &self.0.shape {
            Shape::Line(a, b) => Box3::of([*a, *b]),
            Shape::Arc(arc) => arc.bbox(),
            Shape::Nurbs(c) => c.bbox(),
            Shape::Helix(helix) => helix.bbox(),
            Shape::Offset(offset) => {
                let (inner, reach) = (offset.base.bbox(), DVec3::splat(offset.distance.abs()));
                Box3 { min: inner.min - reach, max: inner.max + reach }
            }
            Shape::Composite(c) => c.pieces.iter().map(Self::bbox).fold(Box3::EMPTY, Box3::union),
        }
    }
}

#[inline]
fn line_jet(a: DVec3, b: DVec3, t: f64) -> Jet {
    Jet { p: if t == 1.0 { b } else { a + (b - a) * t }, d1: b - a, d2: DVec3::ZERO }
}
