//! Curves and points as buffers.

use glam::DVec3;
use serde_json::json;

use super::buffer::{Buffer, Role, Writer};

/// A line of points with what is known of it.
pub(super) struct Polyline {
    pub name: String,
    pub points: Vec<DVec3>,
    /// Arc length, model units.
    pub length: f64,
    /// How many faces meet there.
    pub count: u8,
}

/// Lines as one buffer; `None` where there are none.
pub(super) fn buffer(role: Role, lines: &[Polyline]) -> Option<Buffer> {
    let lines: Vec<&Polyline> = lines.iter().filter(|line| line.points.len() > 1 && line.points.iter().all(|p| p.is_finite())).collect();
    if lines.is_empty() {
        return None;
    }
    let mut writer = Writer::new(role);
    let points: Vec<DVec3> = lines.iter().flat_map(|line| line.points.iter().copied()).collect();
    writer.positions(&points);
    let ends = lines.iter().scan(0, |sum, line| {
        *sum += line.points.len() as u32;
        Some(*sum)
    });
    writer.numbers("starts", 1, std::iter::once(0).chain(ends));
    writer.bytes("faces", lines.iter().map(|line| line.count));
    let about = |line: &&Polyline| json!({"name": line.name, "length": line.length, "faces": [], "curve": null});
    writer.say("edges", lines.iter().map(about).collect::<Vec<_>>());
    Some(writer.finish())
}

/// Points as one buffer.
pub(super) fn points(named: &[(String, DVec3)]) -> Option<Buffer> {
    let named: Vec<&(String, DVec3)> = named.iter().filter(|(_, p)| p.is_finite()).collect();
    if named.is_empty() {
        return None;
    }
    let mut writer = Writer::new(Role::Points);
    writer.positions(&named.iter().map(|(_, p)| *p).collect::<Vec<_>>());
    writer.say("names", named.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>());
    Some(writer.finish())
}
