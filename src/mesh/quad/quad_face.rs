//! A free face of quads, or of quads and triangles.

use glam::DVec2;

use crate::base::fault::Result;
use crate::base::job::Job;
use crate::base::triangulate_points::PointsFault;
use crate::mesh::border::layout::Face;
use crate::mesh::chart::affine::Chart;
use crate::mesh::chart::face_border::FaceBorder;
use crate::mesh::chart::face_input::{FaceInput, prepared};
use crate::mesh::chart::halved::halved;
use crate::mesh::chart::halves::{Halves, NONE};
use crate::mesh::chart::outline::Outline;
use crate::mesh::data::face_geometry::Free;
use crate::mesh::data::face_mesh::{FaceMesh, FreeInside};
use crate::mesh::deviation::edge_length;
use crate::mesh::quad::level_face::LevelFace;
use crate::mesh::quad::net::Net;
use crate::mesh::quad::net_fit::{NetFit, nodes};
use crate::mesh::quad::settings::{NET_FIT, QUAD_FACE};
use crate::mesh::request::decider::Decided;
use crate::mesh::request::limits::Limits;
use crate::mesh::request::methods::Elements;
use crate::mesh::request::sources::Sources;
use crate::mesh::size::face_settings::square_spacing;
use crate::mesh::tri::background::Background;
use crate::mesh::tri::graded_size::GradedSize;
use crate::mesh::tri::longest::{LONGEST, Longest};
use crate::mesh::tri::no_mesh::{NoMesh, Outcome, fault};
use crate::mesh::tri::optimize::OptimizeSettings;
use crate::mesh::tri::triangle_fit::{FaceFit, near};
use crate::surface::Surface;

/// Makes the face.
pub(crate) fn prepare(
    face_input: &FaceInput,
    face: &Face,
    border: FaceBorder,
    chart: &Chart,
    outline: &Outline,
    job: &Job,
) -> Result<FaceMesh> {
    let surface = &face_input.input.model.surfaces[face.surface.index()].surface;
    let rules = near(face_input, face, outline);
    let level = LevelFace::of(surface, chart, outline, &rules, face_input.input.tolerance);
    let on = match &level {
        Some(level) => Ground { surface: level.chart.surface(), chart: &level.chart, outline: &level.outline, rules: &level.rules },
        None => Ground { surface, chart, outline, rules: &rules },
    };
    let halves = match face.elements {
        Elements::Quads => halved(face_input, face, &border, on.outline),
        _ => Some(Halves::whole(on.outline, &border.ids)),
    };
    let Some(halves) = halves else { return Err(fault(face_input, face, &border, NoMesh::Border(PointsFault::Same(0, 0)))) };
    let fitted = fitted_net(face_input, face, &on, level.as_ref(), &halves, job)?;
    let FittedNet { net, mut decided } =
        fitted.map_err(|reason| fault(face_input, face, &border, of_whole(&halves, level.as_ref(), reason)))?;
    let fixed = net.fixed as usize;
    let mut uv = border.uv;
    let mut points = net.p[fixed..].to_vec();
    if let Some(level) = &level {
        points.iter_mut().chain(decided.deciders.iter_mut().map(|decider| &mut decider.at)).for_each(|p| *p = level.point(*p));
        uv.extend(level.uv(chart, &net.xy[fixed..], &points));
    } else {
        uv.extend(net.xy[fixed..].iter().map(|xy| chart.uv(*xy)));
    }
    let mut free = Free { uv, border: fixed, ..Free::default() };
    for face in net.face {
        match face {
            [a, b, c, NONE] => free.triangles.push([a, b, c]),
            quad => free.quads.push(quad),
        }
    }
    Ok(prepared(
        face_input,
        face,
        free,
        border.ids,
        FreeInside { points, loops: border.edges, decided: decided.without(fixed), tally: None, slid: Vec::new() },
    ))
}

/// The reason with nodes of the whole border and places in space.
fn of_whole(halves: &Halves, level: Option<&LevelFace>, reason: NoMesh) -> NoMesh {
    let node = |n: u32| halves.of.get(n as usize).copied().unwrap_or(0);
    match reason {
        NoMesh::Border(PointsFault::Crosses(a, b)) => NoMesh::Border(PointsFault::Crosses(node(a), node(b))),
        NoMesh::Border(PointsFault::Same(a, b)) => NoMesh::Border(PointsFault::Same(node(a), node(b))),
        NoMesh::TreeTooDeep(at) => NoMesh::TreeTooDeep(level.map_or(at, |level| level.point(at))),
        other => other,
    }
}

/// A net that keeps the limits.
struct FittedNet {
    net: Net,
    /// What decided its sizes.
    decided: Decided,
}

/// What a net is made on: the face itself, or a plane face in the plane z = 0.
struct Ground<'a> {
    surface: &'a Surface,
    chart: &'a Chart,
    outline: &'a Outline,
    /// What is refined about it.
    rules: &'a Sources,
}

/// Elements that keep the limits.
fn fitted_net(
    face_input: &FaceInput,
    face: &Face,
    on: &Ground,
    level: Option<&LevelFace>,
    halves: &Halves,
    job: &Job,
) -> Outcome<FittedNet> {
    let Ground { surface, chart, outline, rules } = *on;
    let limits = Limits::of(face_input.input);
    let bent = !surface.is_in_plane() && (limits.chord.is_some() || limits.angle.is_some());
    let smoothing_rounds = face_input.input.plan.settings.smooth.map_or(QUAD_FACE.smoothing_rounds, |n| n.0 as usize);
    let spacing = square_spacing(face_input.input, face);
    let settings = OptimizeSettings { smoothing_rounds, max_length_ratio: LONGEST / spacing, ..QUAD_FACE };
    let longest = Longest::new(face.size.0, outline, rules).graded(outline, face_input.input.plan.slope());
    let fit = FaceFit { face_input, face, surface, chart, outline, limits, longest, settings, interpolated: None, sliding: None };
    let background = bent.then(|| fit.background_of_squares());
    let slope = rules.slope() / spacing;
    let sources = Sources::new([rules.items(), &fit.short_edges(background.as_ref(), spacing)].concat(), slope);
    let mut field = GradedSize { sources: &sources, range: (face.size.0, face_input.wanted.written), spacing, background };
    let net_fit = NetFit { fit: &fit, halves, level };
    Ok(net_fit.fitted(&mut field, job)?.map(|net| {
        let decided = fit.decided(&field, &nodes(&net));
        FittedNet { net, decided }
    }))
}

impl FaceFit<'_> {
    /// Distances of nodes of squares by the bends of the surface.
    fn background_of_squares(&self) -> Background {
        let whole = self.outline.xy.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), xy| (l.min(*xy), h.max(*xy)));
        let size = self.face.size.0 * square_spacing(self.face_input.input, self.face);
        let wanted =
            |xy: DVec2| (NET_FIT.square_side * edge_length::wanted(&self.chart.jet(xy), self.limits.chord, self.limits.angle)).min(size);
        Background::new(self.chart, whole, 1.0 + self.face_input.input.plan.slope(), [0; 2], &wanted)
    }
}
