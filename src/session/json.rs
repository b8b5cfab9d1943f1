//! The report as JSON text: one line a row, numbers with the fewest digits that read back to the same bits.

use std::io::{self, Write};

use serde::Serialize;
use serde_json::ser::{Formatter, Serializer};

use super::report::{Cases, Report};

/// The text of one report, ending in a line break.
pub fn report_text(report: &Report) -> String {
    text_of(report, 2)
}

/// The text of the reports of a table of variants, ending in a line break.
pub fn cases_text(cases: &Cases) -> String {
    text_of(cases, 4)
}

/// JSON with lines broken inside the outermost `levels` brackets: keys of a report, rows of its lists.
fn text_of(value: &impl Serialize, levels: usize) -> String {
    let mut bytes = Vec::new();
    let mut serializer = Serializer::with_formatter(&mut bytes, Layout { levels, depth: 0, empty: true });
    // Writing plain data into memory cannot fail; an empty text would show if it did.
    if value.serialize(&mut serializer).is_err() {
        bytes.clear();
    }
    bytes.push(b'\n');
    String::from_utf8_lossy(&bytes).into_owned()
}

struct Layout {
    levels: usize,
    depth: usize,
    empty: bool,
}

impl Layout {
    /// Whether the items of the innermost open bracket stand on lines of their own: reports and lists take turns.
    fn broken(&self, list: bool) -> bool {
        self.depth <= self.levels && self.depth.is_multiple_of(2) == list
    }

    fn open(&mut self, out: &mut (impl Write + ?Sized), bracket: &[u8]) -> io::Result<()> {
        self.depth += 1;
        self.empty = true;
        out.write_all(bracket)
    }

    fn close(&mut self, out: &mut (impl Write + ?Sized), bracket: &[u8]) -> io::Result<()> {
        let list = bracket == b"]";
        let broken = self.broken(list) && !self.empty;
        self.depth -= 1;
        if broken {
            self.new_line(out)?;
        } else if !list && !self.empty {
            out.write_all(b" ")?;
        }
        self.empty = false;
        out.write_all(bracket)
    }

    fn item(&mut self, out: &mut (impl Write + ?Sized), first: bool, list: bool) -> io::Result<()> {
        if !first {
            out.write_all(b",")?;
        }
        self.empty = false;
        if self.broken(list) {
            self.new_line(out)
        } else if !first || !list {
            out.write_all(b" ")
        } else {
            Ok(())
        }
    }

    fn new_line(&self, out: &mut (impl Write + ?Sized)) -> io::Result<()> {
        out.write_all(b"\n")?;
        (0..self.depth).try_for_each(|_| out.write_all(b"  "))
    }
}

impl Formatter for Layout {
    fn write_f64<W: ?Sized + Write>(&mut self, out: &mut W, value: f64) -> io::Result<()> {
        if value == 0.0 {
            return out.write_all(b"0");
        }
        let text = format!("{value:?}");
        out.write_all(text.strip_suffix(".0").unwrap_or(&text).as_bytes())
    }
    fn begin_array<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.open(out, b"[")
    }
    fn end_array<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.close(out, b"]")
    }
    fn begin_array_value<W: ?Sized + Write>(&mut self, out: &mut W, first: bool) -> io::Result<()> {
        self.item(out, first, true)
    }
    fn begin_object<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.open(out, b"{")
    }
    fn end_object<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.close(out, b"}")
    }
    fn begin_object_key<W: ?Sized + Write>(&mut self, out: &mut W, first: bool) -> io::Result<()> {
        self.item(out, first, false)
    }
    fn begin_object_value<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        out.write_all(b": ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Serialize)]
    struct Sample {
        units: &'static str,
        counts: Counts,
        rows: Vec<Row>,
        none: Vec<u8>,
    }
    #[derive(Serialize)]
    struct Counts {
        links: f64,
        nodes: f64,
    }
    #[derive(Serialize)]
    struct Row {
        name: &'static str,
        area: Option<f64>,
        at: [f64; 2],
    }

    #[test]
    fn rows_stand_on_lines_and_numbers_are_short() {
        let rows = vec![Row { name: "roof", area: None, at: [0.1, -0.0] }];
        let text = text_of(&Sample { units: "mm", counts: Counts { links: 9.0, nodes: 1e-7 }, rows, none: Vec::new() }, 2);
        let expected = "{\n  \"units\": \"mm\",\n  \"counts\": { \"links\": 9, \"nodes\": 1e-7 },\n  \"rows\": [\n    \
                        { \"name\": \"roof\", \"area\": null, \"at\": [0.1, 0] }\n  ],\n  \"none\": []\n}\n";
        assert_eq!(text, expected);
        assert!(serde_json::from_str::<serde_json::Value>(&text).is_ok());
    }
}
