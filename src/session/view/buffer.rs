//! Arrays of numbers as bytes: `LVB1`, the length of a header, the header as JSON, and the arrays, each on a multiple of eight bytes.

use std::sync::Arc;

use glam::DVec3;
use serde_json::{Map, Value, json};

use crate::base::bbox::Box3;
use crate::base::digest::StableHasher;

/// Bytes on which each array begins.
const ALIGNED: usize = 8;

/// What is drawn of one thing.
#[derive(Clone, Debug, PartialEq)]
pub struct Buffer {
    /// Digest of its bytes, 32 hexadecimal digits.
    pub key: String,
    /// What it shows.
    pub role: Role,
    /// Header and arrays.
    pub bytes: Arc<Vec<u8>>,
    /// The box of its positions, model units.
    pub around: Box3,
}

/// What a buffer shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Triangles of a surface, patch by patch.
    Faces,
    /// Borders of faces.
    Edges,
    /// Curves.
    Lines,
    /// Points.
    Points,
    /// Elements of a mesh.
    Mesh,
}

impl Role {
    /// The word of the frame.
    pub fn name(self) -> &'static str {
        match self {
            Self::Faces => "faces",
            Self::Edges => "edges",
            Self::Lines => "lines",
            Self::Points => "points",
            Self::Mesh => "mesh",
        }
    }
}

/// A buffer that is being filled.
pub struct Writer {
    role: Role,
    header: Map<String, Value>,
    arrays: Map<String, Value>,
    bytes: Vec<u8>,
    around: Box3,
}

impl Writer {
    /// An empty one.
    pub fn new(role: Role) -> Self {
        Self { role, header: Map::new(), arrays: Map::new(), bytes: Vec::new(), around: Box3::EMPTY }
    }

    /// Says something in the header.
    pub fn say(&mut self, name: &str, value: impl Into<Value>) {
        self.header.insert(name.to_owned(), value.into());
    }

    /// Points as 32-bit numbers relative to the middle of their box, with `origin` and `box` in the header, model units.
    pub fn positions(&mut self, points: &[DVec3]) {
        let around = Box3::of(points.iter().copied());
        self.around = around;
        let origin = if around.is_empty() { DVec3::ZERO } else { around.center() };
        let corners = if around.is_empty() { [[0.0; 3]; 2] } else { [around.min.to_array(), around.max.to_array()] };
        self.say("origin", json!(origin.to_array()));
        self.say("box", json!(corners));
        let relative = points.iter().flat_map(|p| (*p - origin).to_array()).map(|x| x as f32);
        self.reals("positions", 3, relative);
    }

    /// Unit vectors as 16-bit numbers, 32 767 for 1.
    pub fn normals(&mut self, normals: &[DVec3]) {
        let of = |x: f64| if x.is_finite() { (x * f64::from(i16::MAX)).round() as i16 } else { 0 };
        self.array("normals", "i16", 3, normals.iter().flat_map(|n| n.to_array()).map(of), i16::to_le_bytes);
    }

    /// 32-bit reals.
    pub fn reals(&mut self, name: &str, width: usize, values: impl Iterator<Item = f32>) {
        self.array(name, "f32", width, values, f32::to_le_bytes);
    }

    /// 32-bit whole numbers.
    pub fn numbers(&mut self, name: &str, width: usize, values: impl Iterator<Item = u32>) {
        self.array(name, "u32", width, values, u32::to_le_bytes);
    }

    /// Rows of places of points: differences in 16 bits where all fit, which are half as long, else the numbers themselves. The first number
    /// of a row is counted from that of the row before, the others from the first.
    pub fn corners<const N: usize>(&mut self, name: &str, rows: &[[u32; N]]) {
        let mut before = 0;
        let mut steps = Vec::with_capacity(N * rows.len());
        for row in rows {
            let from = |k: usize| i64::from(if k == 0 { before } else { row[0] });
            for (k, place) in row.iter().enumerate() {
                let Ok(step) = i16::try_from(i64::from(*place) - from(k)) else {
                    return self.numbers(name, N, rows.as_flattened().iter().copied());
                };
                steps.push(step);
            }
            before = row[0];
        }
        self.array(name, "i16", N, steps.into_iter(), i16::to_le_bytes);
        if let Some(array) = self.arrays.get_mut(name) {
            array["coding"] = "steps".into();
        }
    }

    /// Whole numbers below `count`, a byte each where that is enough.
    pub fn places(&mut self, name: &str, count: usize, values: impl Iterator<Item = u32>) {
        if count <= 256 { self.bytes(name, values.map(|k| k as u8)) } else { self.numbers(name, 1, values) }
    }

    /// Whole numbers up to 255.
    pub fn bytes(&mut self, name: &str, values: impl Iterator<Item = u8>) {
        self.array(name, "u8", 1, values, u8::to_le_bytes);
    }

    fn array<T, const N: usize>(
        &mut self,
        name: &str,
        kind: &str,
        width: usize,
        values: impl Iterator<Item = T>,
        bytes: impl Fn(T) -> [u8; N],
    ) {
        let offset = self.bytes.len();
        self.bytes.extend(values.flat_map(bytes));
        let count = (self.bytes.len() - offset) / N / width;
        self.arrays.insert(name.to_owned(), json!({"type": kind, "width": width, "count": count, "offset": offset}));
        self.bytes.resize(self.bytes.len().next_multiple_of(ALIGNED), 0);
    }

    /// The whole buffer.
    pub fn finish(mut self) -> Buffer {
        self.header.insert("role".to_owned(), self.role.name().into());
        // Offsets are counted from the first byte of the file, whose header holds them: room for their digits decides its length.
        let room = 8 + ALIGNED + self.text(0).len() + 10 * self.arrays.len();
        let start = room.next_multiple_of(ALIGNED);
        let mut header = self.text(start).into_bytes();
        header.resize(start - 8, b' ');
        let mut bytes = Vec::with_capacity(start + self.bytes.len());
        bytes.extend(b"LVB1");
        bytes.extend((header.len() as u32).to_le_bytes());
        bytes.extend(header);
        bytes.extend(self.bytes);
        let key = StableHasher::new("view").bytes(&bytes).finish();
        Buffer { key: format!("{:032x}", key.0), role: self.role, bytes: Arc::new(bytes), around: self.around }
    }

    /// The header where the arrays begin at this byte.
    fn text(&self, start: usize) -> String {
        let mut arrays = self.arrays.clone();
        for array in arrays.values_mut() {
            if let Some(offset) = array.get("offset").and_then(Value::as_u64) {
                array["offset"] = (offset + start as u64).into();
            }
        }
        let mut header = self.header.clone();
        header.insert("arrays".to_owned(), Value::Object(arrays));
        Value::Object(header).to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a reader finds under a name.
    fn found(buffer: &Buffer, name: &str) -> (Value, Vec<u8>) {
        let bytes = &buffer.bytes;
        assert_eq!(&bytes[..4], b"LVB1");
        let length = u32::from_le_bytes(bytes[4..8].try_into().unwrap()) as usize;
        let header: Value = serde_json::from_slice(&bytes[8..8 + length]).unwrap();
        let array = &header["arrays"][name];
        let size = match array["type"].as_str().unwrap() {
            "f32" | "u32" => 4,
            "i16" => 2,
            _ => 1,
        };
        let n = size * (array["count"].as_u64().unwrap() * array["width"].as_u64().unwrap()) as usize;
        let offset = array["offset"].as_u64().unwrap() as usize;
        assert_eq!(offset % ALIGNED, 0);
        (header, bytes[offset..offset + n].to_vec())
    }

    #[test]
    fn corners_are_steps_where_they_are_short() {
        let near: Vec<[u32; 3]> = (0..500).map(|k| [k + 30_000, k + 30_001, k]).collect();
        let far = [[0, 1, 2], [0, 1, 40_000]];
        let mut writer = Writer::new(Role::Mesh);
        writer.corners("triangles", &near);
        writer.corners("far", &far);
        let buffer = writer.finish();
        let (header, bytes) = found(&buffer, "triangles");
        assert_eq!((header["arrays"]["triangles"]["coding"].as_str(), bytes.len()), (Some("steps"), 6 * near.len()));
        let steps: Vec<i64> = bytes.as_chunks::<2>().0.iter().map(|b| i64::from(i16::from_le_bytes(*b))).collect();
        let mut first = 0;
        for (row, step) in near.iter().zip(steps.as_chunks::<3>().0) {
            first += step[0];
            assert_eq!(row.map(i64::from), [first, first + step[1], first + step[2]]);
        }
        assert_eq!(found(&buffer, "far").1.len(), 24);
        assert!(header["arrays"]["far"]["coding"].is_null());
    }

    #[test]
    fn arrays_are_found_where_the_header_says() {
        for many in [0, 1, 5, 1000] {
            let mut writer = Writer::new(Role::Faces);
            let points: Vec<DVec3> = (0..many).map(|k| DVec3::new(1e6 + f64::from(k), 2.0, 3.0)).collect();
            writer.positions(&points);
            writer.normals(&vec![DVec3::Z; many as usize]);
            writer.bytes("face", (0..many).map(|k| k as u8));
            writer.numbers("triangles", 3, (0..3 * many as u32).map(|k| k % 7));
            writer.say("faces", json!([{"name": "roof"}]));
            let buffer = writer.finish();
            let (header, positions) = found(&buffer, "positions");
            let origin = header["origin"][0].as_f64().unwrap();
            for k in 0..many as usize {
                let x = f32::from_le_bytes(positions[12 * k..12 * k + 4].try_into().unwrap());
                assert_eq!(origin + f64::from(x), points[k].x);
            }
            assert_eq!(found(&buffer, "face").1, (0..many).map(|k| k as u8).collect::<Vec<_>>());
            assert_eq!(found(&buffer, "triangles").1.len(), 12 * many as usize);
            assert_eq!(found(&buffer, "normals").1.len(), 6 * many as usize);
            assert_eq!(header["role"], "faces");
        }
    }
}
