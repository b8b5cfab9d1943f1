//! Stretches of the run's texts as pages and editors count them.

use super::frame::{Place, Source};
use crate::lang::diag::diagnostic::{FileId, Sources};
use crate::lang::diag::span::Span;

/// A stretch as lines and columns of UTF-16 code units from 1; `None` where its file is not there.
pub(super) fn place(sources: &Sources, file: FileId, span: Span, label: Option<&str>) -> Option<Place> {
    let text = &*sources.get(file)?.text;
    let position = |byte: u32| Some((sources.place(file, byte)?.line, column(text, byte)));
    let (line, column) = position(span.start)?;
    let (end_line, end_column) = position(span.end.max(span.start))?;
    let label = label.filter(|words| !words.is_empty()).map(str::to_owned);
    Some(Place { file: file.index(), line, column, end_line, end_column, label })
}

/// Column of a byte in its line; bytes inside a character stand at its start.
fn column(text: &str, byte: u32) -> usize {
    let mut at = (byte as usize).min(text.len());
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    let before = &text[..at];
    let start = before.rfind('\n').map_or(0, |end| end + 1);
    before[start..].encode_utf16().count() + 1
}

/// The texts of a run up to that of the last script (behind them stand texts of options); `path` says where a file of this name stands.
pub(super) fn sources(sources: &Sources, scripts: &[FileId], path: &dyn Fn(&str) -> String) -> Vec<Source> {
    let count = scripts.iter().map(|file| file.index() + 1).max().unwrap_or(1);
    let source = |k: usize| {
        let file = sources.get(FileId::at(k))?;
        let text = if k == 0 || scripts.contains(&FileId::at(k)) { file.text.to_string() } else { String::new() };
        Some(Source { file: file.name.clone(), path: path(&file.name), text })
    };
    (0..count).map_while(source).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_utf16_and_lines_from_one() {
        let mut sources = Sources::default();
        let file = sources.add("a.loft", "curve a\n  🛶 = b\n");
        let at = |start: u32, end: u32| place(&sources, file, Span { start, end }, Some("here")).unwrap();
        let whole = at(0, 7);
        assert_eq!((whole.line, whole.column, whole.end_line, whole.end_column), (1, 1, 1, 8));
        // The boat is four bytes and two code units; its second byte stands at its start.
        let boat = at(11, 14);
        assert_eq!((boat.line, boat.column, boat.end_column), (2, 3, 5));
        assert_eq!(at(14, 900).end_line, 3);
        assert_eq!(boat.label.as_deref(), Some("here"));
    }
}
