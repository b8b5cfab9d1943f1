//! Records of a STEP file on their way into text: numbered in the order in which they are made.

use glam::DVec3;

use crate::base::text::{push_count, push_real};
use crate::geometry::Motion;

/// The number of a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Id(u32);

/// Records of a data section.
#[derive(Clone, Debug, Default)]
pub struct SectionRecords {
    text: Vec<u8>,
    count: u32,
    /// What transforms points and directions, lengths in units of the file.
    frame: Option<Motion>,
}

impl SectionRecords {
    /// Adds a record of one type; `fill` writes its values.
    pub fn put(&mut self, name: &str, fill: impl FnOnce(&mut RecordValues)) -> Id {
        let id = self.begin();
        RecordValues { text: &mut self.text, first: true }.part(name, fill);
        self.text.extend_from_slice(b";\n");
        id
    }

    /// Adds a record of several types; `fill` writes each as a part.
    pub fn put_complex(&mut self, fill: impl FnOnce(&mut RecordValues)) -> Id {
        let id = self.begin();
        self.text.push(b'(');
        fill(&mut RecordValues { text: &mut self.text, first: true });
        self.text.extend_from_slice(b");\n");
        id
    }

    fn begin(&mut self) -> Id {
        self.count += 1;
        self.text.push(b'#');
        push_count(&mut self.text, u64::from(self.count));
        self.text.push(b'=');
        Id(self.count)
    }

    /// A point by its coordinates in units of the file.
    pub fn point(&mut self, p: DVec3) -> Id {
        let p = self.frame.map_or(p, |frame| frame.point(p));
        self.put("CARTESIAN_POINT", |v| v.text("").point(p))
    }

    /// A direction of length 1.
    pub fn direction(&mut self, d: DVec3) -> Id {
        let d = self.frame.map_or(d, |frame| frame.vector(d));
        self.put("DIRECTION", |v| v.text("").point(d))
    }

    /// Points and directions from here on are transformed: into the frame of a product, or not at all.
    pub fn set_frame(&mut self, frame: Option<Motion>) {
        self.frame = frame;
    }

    /// A frame: its origin, its z and its x direction.
    pub fn frame(&mut self, at: DVec3, axis: DVec3, reference: DVec3) -> Id {
        let (at, axis, reference) = (self.point(at), self.direction(axis), self.direction(reference));
        self.put("AXIS2_PLACEMENT_3D", |v| {
            v.text("").id(at).id(axis).id(reference);
        })
    }

    /// The lines of all records.
    pub fn text(&self) -> &[u8] {
        &self.text
    }
}

/// Values of a record, parted by commas.
pub struct RecordValues<'t> {
    text: &'t mut Vec<u8>,
    first: bool,
}

impl RecordValues<'_> {
    fn next(&mut self) {
        if !std::mem::take(&mut self.first) {
            self.text.push(b',');
        }
    }

    /// A type with its values, within a record of several types.
    pub fn part(&mut self, name: &str, fill: impl FnOnce(&mut RecordValues)) {
        self.text.extend_from_slice(name.as_bytes());
        self.text.push(b'(');
        fill(&mut RecordValues { text: self.text, first: true });
        self.text.push(b')');
    }

    /// A list of values.
    pub fn list(&mut self, fill: impl FnOnce(&mut RecordValues)) -> &mut Self {
        self.next();
        self.text.push(b'(');
        fill(&mut RecordValues { text: self.text, first: true });
        self.text.push(b')');
        self
    }

    /// A value of a named type, as `LENGTH_MEASURE(25.4)`.
    pub fn typed(&mut self, name: &str, x: f64) -> &mut Self {
        self.next();
        self.part(name, |v| {
            v.real(x);
        });
        self
    }

    /// A reference.
    pub fn id(&mut self, id: Id) -> &mut Self {
        self.next();
        self.text.push(b'#');
        push_count(self.text, u64::from(id.0));
        self
    }

    /// References.
    pub fn ids(&mut self, list: &[Id]) -> &mut Self {
        self.list(|v| {
            list.iter().for_each(|id| {
                v.id(*id);
            });
        })
    }

    /// A whole number.
    pub fn int(&mut self, n: usize) -> &mut Self {
        self.next();
        push_count(self.text, n as u64);
        self
    }

    /// Whole numbers.
    pub fn ints(&mut self, list: impl IntoIterator<Item = usize>) -> &mut Self {
        self.list(|v| {
            list.into_iter().for_each(|n| {
                v.int(n);
            });
        })
    }

    /// A real number with the digits that read back to the same bits.
    pub fn real(&mut self, x: f64) -> &mut Self {
        self.next();
        push_number(self.text, x);
        self
    }

    /// Real numbers.
    pub fn reals(&mut self, list: impl IntoIterator<Item = f64>) -> &mut Self {
        self.list(|v| {
            list.into_iter().for_each(|x| {
                v.real(x);
            });
        })
    }

    /// Three coordinates.
    pub fn point(&mut self, p: DVec3) {
        self.reals(p.to_array());
    }

    /// A word, `*` or `$`, as it stands: `.T.`.
    pub fn word(&mut self, word: &str) -> &mut Self {
        self.next();
        self.text.extend_from_slice(word.as_bytes());
        self
    }

    /// `.T.` or `.F.`.
    pub fn flag(&mut self, is: bool) -> &mut Self {
        self.word(if is { ".T." } else { ".F." })
    }

    /// A text.
    pub fn text(&mut self, text: &str) -> &mut Self {
        self.next();
        push_text(self.text, text);
        self
    }
}

/// A real number as the format wants it: always with a point, `E` before the exponent.
fn push_number(out: &mut Vec<u8>, x: f64) {
    let start = out.len();
    push_real(out, x);
    let number = &out[start..];
    let exponent = number.iter().position(|c| *c == b'e');
    let has_point = number.contains(&b'.');
    match exponent {
        Some(e) => {
            out[start + e] = b'E';
            if !has_point {
                out.insert(start + e, b'.');
            }
        }
        None if !has_point => out.push(b'.'),
        None => {}
    }
}

/// A text between quotes: quotes and backslashes doubled, what is not ASCII by its code.
pub fn push_text(out: &mut Vec<u8>, text: &str) {
    out.push(b'\'');
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        let plain = |c: char| (' '..='~').contains(&c);
        let run = rest.find(|other: char| plain(other) != plain(c) || (other > '\u{FFFF}') != (c > '\u{FFFF}')).unwrap_or(rest.len());
        let (now, later) = rest.split_at(run);
        rest = later;
        if plain(c) {
            for b in now.bytes() {
                if b == b'\'' || b == b'\\' {
                    out.push(b);
                }
                out.push(b);
            }
            continue;
        }
        let (open, width) = if c > '\u{FFFF}' { ("\\X4\\", 8) } else { ("\\X2\\", 4) };
        out.extend_from_slice(open.as_bytes());
        for c in now.chars() {
            out.extend_from_slice(format!("{:0width$X}", c as u32).as_bytes());
        }
        out.extend_from_slice(b"\\X0\\");
    }
    out.push(b'\'');
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_a_point() {
        let shown = |x: f64| {
            let mut out = Vec::new();
            push_number(&mut out, x);
            String::from_utf8(out).unwrap_or_default()
        };
        for x in [0.0, -3.0, 1.25, 1e-7, -2.5e300, 1e21, 0.1 + 0.2] {
            let text = shown(x);
            assert!(text.contains('.') && !text.contains('e'), "{text}");
            assert_eq!(text.parse::<f64>(), Ok(x), "{text}");
        }
        assert_eq!(shown(1e-7), "1.E-7");
    }

    #[test]
    fn texts_are_ascii() {
        let shown = |text: &str| {
            let mut out = Vec::new();
            push_text(&mut out, text);
            String::from_utf8(out).unwrap_or_default()
        };
        assert_eq!(shown("it's a \\"), "'it''s a \\\\'");
        assert_eq!(shown("벽 1"), "'\\X2\\BCBD\\X0\\ 1'");
        assert_eq!(shown("a😀é"), "'a\\X4\\0001F600\\X0\\\\X2\\00E9\\X0\\'");
    }
}
