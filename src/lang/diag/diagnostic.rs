//! Diagnostics: what is said about a script, with places in it.

use std::cell::RefCell;
use std::sync::{Arc, OnceLock};

use glam::DVec3;

use crate::base::fault::{Code, Edit, Fault, Report, Say, Severity, Subject};
use crate::base::limits::REPORTS_TOLD;
use crate::base::origin::Origin;
use crate::lang::diag::span::Span;

crate::ids! {
    /// A file of the run: the main script is 0, modules follow.
    FileId,
}

/// A place in a file with a few words.
#[derive(Clone, Debug, PartialEq)]
pub struct Label {
    /// The file.
    pub file: FileId,
    /// The narrowest stretch the user can change.
    pub span: Span,
    /// A few words.
    pub text: String,
}

/// One report: an error, a warning or a note.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnostic {
    /// Code of the table in [`crate::lang::diag::codes`]; its letter is the severity.
    pub code: Code,
    /// One sentence without final dot.
    pub message: String,
    /// Places, the foremost first.
    pub labels: Vec<Label>,
    /// Something that can be typed.
    pub help: Option<String>,
    /// Further lines: call chain, what was not built.
    pub notes: Vec<String>,
    /// The help as edits; several are other ways.
    pub fixes: Vec<Fix>,
    /// How many further reports like it this one stands for.
    pub more: usize,
    /// Those of them that say something else, where all are wanted; equal ones and what is beyond the limit are only counted.
    pub folded: Vec<Diagnostic>,
    /// Where in space it is, and the first length that it speaks of (the width of a gap), model units; for pictures.
    pub spot: Spot,
}

/// What a report says of space.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Spot {
    /// Points that its words name.
    pub points: Vec<DVec3>,
    /// The first length that they name.
    pub length: Option<f64>,
}

/// Speaks as another one does and keeps what it was asked to say of space.
struct SpotRecorder<'s> {
    say: &'s dyn Say,
    spot: RefCell<Spot>,
}

impl Say for SpotRecorder<'_> {
    fn name(&self, origin: Origin) -> String {
        self.say.name(origin)
    }

    fn length(&self, length: f64) -> String {
        self.spot.borrow_mut().length.get_or_insert(length);
        self.say.length(length)
    }

    fn points(&self, places: &[DVec3]) -> Vec<String> {
        self.spot.borrow_mut().points.extend(places);
        self.say.points(places)
    }

    fn angle(&self, radians: f64) -> String {
        self.say.angle(radians)
    }
}

impl Diagnostic {
    /// A report with one label.
    pub fn new(code: &'static str, message: impl Into<String>, file: FileId, span: Span, label: impl Into<String>) -> Self {
        Self {
            code: Code(code),
            message: message.into(),
            labels: vec![Label { file, span, text: label.into() }],
            help: None,
            notes: Vec::new(),
            fixes: Vec::new(),
            more: 0,
            folded: Vec::new(),
            spot: Spot::default(),
        }
    }

    /// A report that no place in a script belongs to.
    pub fn without_place(code: &'static str, message: impl Into<String>) -> Self {
        Self {
            code: Code(code),
            message: message.into(),
            labels: Vec::new(),
            help: None,
            notes: Vec::new(),
            fixes: Vec::new(),
            more: 0,
            folded: Vec::new(),
            spot: Spot::default(),
        }
    }

    /// The one bridge from the kernel: `find` turns subjects into places, `say` speaks of entities and quantities as
    /// the user does. With no subject found, the label falls back to the call. Labels on one place are joined.
    pub fn from_fault(fault: &Fault, find: impl Fn(Subject) -> Option<(FileId, Span)>, say: &dyn Say) -> Self {
        let say = SpotRecorder { say, spot: RefCell::default() };
        let Report { message, labels: subjects, help, notes, edits } = fault.describe(&say);
        let fix = |(subject, edit)| find(subject).map(|(file, span)| Fix { file, span, edit });
        let fixes = edits.into_iter().filter_map(fix).collect();
        let mut labels: Vec<Label> = Vec::with_capacity(subjects.len());
        for (subject, text) in subjects {
            let Some((file, span)) = find(subject) else { continue };
            match labels.iter_mut().find(|l| l.file == file && l.span == span) {
                Some(label) if label.text == text => {}
                Some(label) => label.text = format!("{}; {text}", label.text),
                None => labels.push(Label { file, span, text }),
            }
        }
        if labels.is_empty() {
            labels.extend(find(Subject::Call).map(|(file, span)| Label { file, span, text: "here".to_owned() }));
        }
        let spot = say.spot.into_inner();
        Self { code: fault.code(), message, labels, help, notes, fixes, more: 0, folded: Vec::new(), spot }
    }

    /// With one more label.
    pub fn label(mut self, file: FileId, span: Span, text: impl Into<String>) -> Self {
        self.labels.push(Label { file, span, text: text.into() });
        self
    }

    /// With help that can be typed.
    pub fn help(mut self, text: impl Into<String>) -> Self {
        self.help = Some(text.into());
        self
    }

    /// With an edit in the file of its first label.
    pub fn fix(mut self, span: Span, edit: Edit) -> Self {
        let file = self.labels.first().map_or(FileId(0), |l| l.file);
        self.fixes.push(Fix { file, span, edit });
        self
    }

    /// With help that is this text in the place of that stretch.
    pub fn put(self, span: Span, text: impl Into<String>) -> Self {
        self.fix(span, Edit::Put(text.into()))
    }

    /// The same with all its places moved.
    pub fn moved(&self, place: impl Fn(FileId, Span) -> (FileId, Span)) -> Self {
        self.moved_by(&place)
    }

    fn moved_by(&self, place: &dyn Fn(FileId, Span) -> (FileId, Span)) -> Self {
        let mut moved = self.clone();
        for label in &mut moved.labels {
            (label.file, label.span) = place(label.file, label.span);
        }
        for fix in &mut moved.fixes {
            (fix.file, fix.span) = place(fix.file, fix.span);
        }
        moved.folded = self.folded.iter().map(|d| d.moved_by(place)).collect();
        moved
    }

    /// Stands for another report as well; `whole`: keeps its words where they differ.
    pub fn fold(&mut self, mut other: Self, whole: bool) {
        self.more += 1 + other.more;
        if !whole {
            return;
        }
        let inner = std::mem::take(&mut other.folded);
        other.more -= inner.iter().map(|d| 1 + d.more).sum::<usize>().min(other.more);
        for report in std::iter::once(other).chain(inner) {
            let again = self.folded.last().map_or_else(|| self.says_the_same(&report), |last| last.says_the_same(&report));
            if !again && self.folded.len() < REPORTS_TOLD {
                self.folded.push(report);
            } else if let Some(last) = self.folded.last_mut().filter(|_| again) {
                last.more += 1 + report.more;
            }
        }
    }

    fn says_the_same(&self, other: &Self) -> bool {
        self.is_like(other) && self.message == other.message && self.help == other.help && self.notes == other.notes
    }

    /// With a further line.
    pub fn note(mut self, text: impl Into<String>) -> Self {
        self.notes.push(text.into());
        self
    }

    /// Whether it says the same as another: one code, one set of places. Numbers in the words may differ.
    pub fn is_like(&self, other: &Self) -> bool {
        self.code == other.code && self.labels == other.labels
    }

    /// How bad it is.
    pub fn severity(&self) -> Severity {
        self.code.severity()
    }

    /// Where it belongs among others: file, then byte; reports without a place come last.
    pub fn place(&self) -> (FileId, u32) {
        self.labels.first().map_or((FileId(u32::MAX), 0), |l| (l.file, l.span.start))
    }
}

/// Sorts reports by place; of two at one place the earlier found stays first.
pub fn sort(found: &mut [Diagnostic]) {
    found.sort_by_key(Diagnostic::place);
}

/// The source files of a run, by [`FileId`].
#[derive(Clone, Debug, Default)]
pub struct Sources {
    files: Vec<SourceFile>,
}

/// One source file.
#[derive(Clone, Debug)]
pub struct SourceFile {
    /// As the user knows it: `hall.loft`, `parts/ribs.loft`, `<stdin>`.
    pub name: String,
    /// Its text.
    pub text: Arc<str>,
    lines: OnceLock<Vec<u32>>,
}

/// A place as editors count: lines and characters from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// Line.
    pub line: usize,
    /// Column in characters.
    pub column: usize,
}

impl Sources {
    /// Adds a file; the first one is the main script.
    pub fn add(&mut self, name: impl Into<String>, text: impl Into<Arc<str>>) -> FileId {
        self.files.push(SourceFile { name: name.into(), text: text.into(), lines: OnceLock::new() });
        FileId::at(self.files.len() - 1)
    }

    /// The file; none when it was never added.
    pub fn get(&self, file: FileId) -> Option<&SourceFile> {
        self.files.get(file.index())
    }

    /// The text of a stretch; empty when there is none.
    pub fn text(&self, file: FileId, span: Span) -> &str {
        self.get(file).and_then(|f| f.text.get(span.start as usize..span.end as usize)).unwrap_or("")
    }

    /// Line and column of a byte.
    pub fn place(&self, file: FileId, byte: u32) -> Option<Place> {
        self.get(file).map(|f| f.place(byte))
    }
}

impl SourceFile {
    /// First byte of each line.
    fn lines(&self) -> &[u32] {
        self.lines.get_or_init(|| {
            let ends = self.text.bytes().enumerate().filter(|&(_, b)| b == b'\n');
            std::iter::once(0).chain(ends.map(|(at, _)| at as u32 + 1)).collect()
        })
    }

    /// Line and column of a byte; bytes beyond the end stand at the end.
    pub fn place(&self, byte: u32) -> Place {
        let byte = self.boundary(byte);
        let line = self.lines().partition_point(|&start| start <= byte).saturating_sub(1);
        let start = self.lines()[line] as usize;
        Place { line: line + 1, column: self.text[start..byte as usize].chars().count() + 1 }
    }

    /// First and last byte of a line counted from 0, without its end.
    pub(crate) fn line(&self, index: usize) -> (usize, &str) {
        let start = self.lines().get(index).copied().unwrap_or(self.text.len() as u32) as usize;
        let end = self.lines().get(index + 1).map_or(self.text.len(), |&next| next as usize - 1);
        (start, self.text[start..end.max(start)].trim_end_matches('\r'))
    }

    /// The byte, or the last character start before it.
    pub(crate) fn boundary(&self, byte: u32) -> u32 {
        let mut at = (byte as usize).min(self.text.len());
        while !self.text.is_char_boundary(at) {
            at -= 1;
        }
        at as u32
    }
}

/// An edit at a place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fix {
    /// The file.
    pub file: FileId,
    /// The subject of the edit.
    pub span: Span,
    /// What is done.
    pub edit: Edit,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::fault::{PlainWords, ValueFault};

    #[test]
    fn columns_count_characters() {
        let mut sources = Sources::default();
        let file = sources.add("a.loft", "let 지붕 = x\r\n\nlet b = y");
        let place = |byte| sources.place(file, byte).map(|p| (p.line, p.column));
        assert_eq!((place(0), place(13), place(14)), (Some((1, 1)), Some((1, 10)), Some((1, 11))));
        assert_eq!((place(16), place(17), place(18), place(999)), (Some((2, 1)), Some((3, 1)), Some((3, 2)), Some((3, 10))));
        assert_eq!(sources.place(FileId(1), 0), None);
    }

    #[test]
    fn a_fault_finds_its_places() {
        let fault: Fault = ValueFault::OutsideRange { argument: "rho", found: "2".into(), range: "between 0 and 1".into() }.into();
        let argument = |subject| (subject == Subject::Argument("rho")).then_some((FileId(0), Span { start: 3, end: 4 }));
        let found = Diagnostic::from_fault(&fault, argument, &PlainWords);
        assert_eq!((found.code.0, found.labels[0].span.start, found.message.as_str()), ("E306", 3, "`rho` must be between 0 and 1, got 2"));
        let call = |subject| (subject == Subject::Call).then_some((FileId(0), Span { start: 7, end: 9 }));
        assert_eq!(Diagnostic::from_fault(&fault, call, &PlainWords).labels[0].span.start, 7);
    }
}
