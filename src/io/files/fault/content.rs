//! What is wrong inside a file that is read.

use crate::base::fault::{Describe, Report, Say, codes};
use crate::base::origin::Origin;

/// A place in a data file where it stops making sense.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Malformed {
    /// Line of the file, from 1; 0 in a binary file.
    pub line: u64,
    /// Character of the line or cell of the row, from 1, where one is to blame.
    pub column: Option<u64>,
    /// What is wrong, in words.
    pub what: String,
}

/// A share of the area of a file's faces, from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Share {
    /// By the area that the file states.
    Stated(f64),
    /// No less than this.
    AtLeast(f64),
}

/// What is wrong inside a file, or deserves a word. `of` is the import; paths are as written in the script.
#[derive(Clone, Debug, PartialEq)]
pub enum ContentFault {
    /// E803: the text stops making sense.
    Malformed {
        /// The import.
        of: Origin,
        /// As written.
        path: String,
        /// Where and why.
        at: Malformed,
    },
    /// W810: something in a file was skipped or repaired.
    Repaired {
        /// The import.
        of: Origin,
        /// As written.
        path: String,
        /// Where and what.
        at: Malformed,
    },
    /// W726: faces of a file are missing.
    Unusable {
        /// The import.
        of: Origin,
        /// As written.
        path: String,
        /// How many faces the file has.
        total: usize,
        /// Each that could not be used, with the cause.
        faces: Vec<Malformed>,
        /// Their share of the area, where it is known.
        share: Option<Share>,
        /// All are listed.
        whole: bool,
    },
    /// E815: nothing of a file, or less than half, could be read.
    Little {
        /// The import.
        of: Origin,
        /// As written.
        path: String,
        /// How many faces came in, of how many that the file has.
        faces: (usize, usize),
        /// Entities that were not read, each with the cause.
        unread: Vec<Malformed>,
    },
    /// W814: bodies of a file that stand where the same one stands already.
    Doubled {
        /// The import.
        of: Origin,
        /// As written.
        path: String,
        /// Names of the first one and of that which stands in its place, for each.
        pairs: Vec<(String, String)>,
    },
    /// E809: modules import each other.
    ImportCycle {
        /// The `use` that closes the ring.
        of: Origin,
        /// The files of the ring, the first one again at the end.
        ring: Vec<String>,
    },
}

impl Malformed {
    /// A whole line is wrong.
    pub fn line(line: u64, what: impl Into<String>) -> Self {
        Self { line, column: None, what: what.into() }
    }

    /// One place of a line is wrong.
    pub fn at(line: u64, column: u64, what: impl Into<String>) -> Self {
        Self { line, column: Some(column), what: what.into() }
    }

    /// The place in words.
    fn place(&self) -> String {
        match (self.line, self.column) {
            (0, None) => String::new(),
            (0, Some(byte)) => format!(", byte {byte}"),
            (line, None) => format!(", line {line}"),
            (line, Some(column)) => format!(", line {line}, column {column}"),
        }
    }
}

impl Describe for ContentFault {
    codes! { Malformed "E803", Repaired "W810", Unusable "W726", Little "E815", Doubled "W814", ImportCycle "E809" }

    fn describe(&self, _: &dyn Say) -> Report {
        match self {
            Self::Malformed { of, path, at } => Report::new(format!("\"{path}\"{}: {}", at.place(), at.what)).at(*of, "imported here"),
            Self::Repaired { of, path, at } => Report::new(format!("\"{path}\"{}: {}", at.place(), at.what)).at(*of, "imported here"),
            Self::Unusable { of, path, total, faces, share, whole } => unusable(*of, path, *total, faces, *share, *whole),
            Self::Little { of, path, faces, unread } => little(*of, path, *faces, unread),
            Self::Doubled { of, path, pairs } => doubled(*of, path, pairs),
            Self::ImportCycle { of, ring } => {
                Report::new(format!("modules import each other: {}", ring.join(" → "))).at(*of, "closes the cycle")
            }
        }
    }
}

/// Unusable faces that are named on a screen.
const FACES_LISTED: usize = 10;

/// W726: how many faces are missing, how much that is, and a line for each.
fn unusable(of: Origin, path: &str, total: usize, faces: &[Malformed], share: Option<Share>, whole: bool) -> Report {
    let count = if total == 1 { "the only face".to_owned() } else { format!("{} of {total} faces", faces.len()) };
    let share = match share {
        Some(Share::Stated(share)) => format!("{:.0} % of the area", 100.0 * share),
        Some(Share::AtLeast(share)) => format!("at least {:.0} % of the area, by their loops", 100.0 * share),
        None => "their share of the area is unknown".to_owned(),
    };
    let report = Report::new(format!("{count} of \"{path}\" could not be used ({share})")).at(of, "imported here");
    let listed = if whole { faces.len() } else { faces.len().min(FACES_LISTED) };
    let report = faces.iter().take(listed).fold(report, |r, face| r.note(format!("line {}: {}", face.line, face.what)));
    match faces.len() - listed {
        0 => report,
        more => report.note(format!("and {more} more, which `loft explain` lists with the name of the part")),
    }
}

/// E815: how little of a file was read, and why.
fn little(of: Origin, path: &str, (came, total): (usize, usize), unread: &[Malformed]) -> Report {
    let what = match (came, total) {
        (0, 0) => "nothing".to_owned(),
        (0, _) => "no face".to_owned(),
        _ => format!("only {came} of {total} faces"),
    };
    let report = Report::new(format!("{what} of \"{path}\" could be read")).at(of, "imported here");
    let report = unread.iter().take(FACES_LISTED).fold(report, |r, at| r.note(format!("line {}: {}", at.line, at.what)));
    report.help("`incomplete: true` in brackets behind the path takes what there is")
}

/// W814, with the names of each pair of bodies in one place.
fn doubled(of: Origin, path: &str, pairs: &[(String, String)]) -> Report {
    let count = if pairs.len() == 1 { "a body stands".to_owned() } else { format!("{} bodies stand", pairs.len()) };
    let report = Report::new(format!("{count} twice in the same place in \"{path}\"")).at(of, "imported here");
    let listed = pairs.iter().take(FACES_LISTED);
    let report = listed.fold(report, |r, (first, second)| r.note(format!("`{second}` is where `{first}` is")));
    report.help("volumes and areas count both; take one of them, as `.solids[0]`")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::fault::PlainWords;

    #[test]
    fn a_malformed_table_has_line_and_column() {
        let at = Malformed::at(7, 3, "`1.2.3` is no number");
        let fault = ContentFault::Malformed { of: Origin(1), path: "a.csv".into(), at };
        let report = fault.describe(&PlainWords);
        assert_eq!((fault.code().0, report.message.as_str()), ("E803", "\"a.csv\", line 7, column 3: `1.2.3` is no number"));
    }
}
