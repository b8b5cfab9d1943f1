//! Family 8: files that cannot be read or written, and what a format could not hold.

use crate::base::fault::{Code, Describe, Edit, Report, Say, Subject};
use crate::base::origin::Origin;
use crate::base::text::article;

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

/// A share of the area of a file's faces, from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Share {
    /// By the area that the file states.
    Stated(f64),
    /// No less than this.
    AtLeast(f64),
}

/// What can go wrong or deserves a word about files. `of` is the import or export; paths are as written in the script.
#[derive(Clone, Debug, PartialEq)]
pub enum FileFault {
    /// E801: not there, or the system says no.
    CannotRead {
        /// The import.
        of: Origin,
        /// As written.
        path: String,
        /// Names beside it that look alike, best first.
        similar: Vec<String>,
        /// The system's words, empty when the file is just not there.
        why: String,
    },
    /// E802: outside the folders that may be read or written.
    Outside {
        /// The import or export.
        of: Origin,
        /// As written.
        path: String,
    },
    /// E803: the text stops making sense.
    Malformed {
        /// The import.
        of: Origin,
        /// As written.
        path: String,
        /// Where and why.
        at: Malformed,
    },
    /// E804: an ending that chooses no format.
    NoSuchFormat {
        /// The export or import.
        of: Origin,
        /// As written.
        path: String,
        /// Endings that would do.
        known: Vec<&'static str>,
    },
    /// E230: a format of a later version.
    LaterFormat {
        /// The export or import.
        of: Origin,
        /// The format's name.
        format: &'static str,
    },
    /// E805: the format exists but not for this.
    Unsupported {
        /// The export.
        of: Origin,
        /// What cannot be, as a sentence.
        what: String,
        /// What can be typed instead.
        help: Option<String>,
        /// The same as edits at `of`.
        edits: Vec<Edit>,
    },
    /// W806: the format has no place for something.
    LeftOut {
        /// The export.
        of: Origin,
        /// As written.
        path: String,
        /// What is missing from the file.
        what: String,
    },
    /// W807: sets have other names in the file.
    Renamed {
        /// The export.
        of: Origin,
        /// As written.
        path: String,
        /// Names in the model and in the file, at least one pair.
        names: Vec<(String, String)>,
    },
    /// E812: several outputs are one file.
    SameFile {
        /// The outputs with their paths as written, at least two. One place that says several stands once.
        outputs: Vec<(Origin, String)>,
        /// How many members of one family write it, where it is one.
        members: Option<usize>,
    },
    /// E813: an output stands where something is read from.
    OverInput {
        /// The output.
        of: Origin,
        /// As written.
        path: String,
        /// What is read there, in words.
        what: String,
    },
    /// E808: the system does not let us write.
    CannotWrite {
        /// The export.
        of: Origin,
        /// As written.
        path: String,
        /// The system's words.
        why: String,
    },
    /// E217: an output that takes more work than one may.
    TooMuchWork {
        /// The export or picture.
        of: Origin,
        /// As written.
        path: String,
    },
    /// E809: modules import each other.
    ImportCycle {
        /// The `use` that closes the ring.
        of: Origin,
        /// The files of the ring, the first one again at the end.
        ring: Vec<String>,
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
    /// E904: what is written lacks faces of a file.
    Incomplete {
        /// What is written.
        of: Origin,
        /// The output.
        output: Origin,
        /// As written.
        path: String,
        /// The part as the script names it.
        part: String,
        /// How many faces are missing.
        missing: usize,
    },
    /// E811: larger than what is read.
    TooLarge {
        /// The import.
        of: Origin,
        /// As written.
        path: String,
        /// Size, bytes.
        bytes: u64,
        /// Limit, bytes.
        limit: u64,
    },
}

impl Describe for FileFault {
    fn code(&self) -> Code {
        Code(match self {
            Self::CannotRead { .. } => "E801",
            Self::Outside { .. } => "E802",
            Self::Malformed { .. } => "E803",
            Self::NoSuchFormat { .. } => "E804",
            Self::LaterFormat { .. } => "E230",
            Self::Unsupported { .. } => "E805",
            Self::LeftOut { .. } => "W806",
            Self::Renamed { .. } => "W807",
            Self::SameFile { .. } => "E812",
            Self::OverInput { .. } => "E813",
            Self::CannotWrite { .. } => "E808",
            Self::TooMuchWork { .. } => "E217",
            Self::ImportCycle { .. } => "E809",
            Self::Repaired { .. } => "W810",
            Self::Unusable { .. } => "W726",
            Self::Incomplete { .. } => "E904",
            Self::TooLarge { .. } => "E811",
        })
    }

    fn describe(&self, _: &dyn Say) -> Report {
        match self {
            Self::CannotRead { .. }
            | Self::Outside { .. }
            | Self::Malformed { .. }
            | Self::Repaired { .. }
            | Self::Unusable { .. }
            | Self::TooLarge { .. } => self.describe_reading(),
            Self::ImportCycle { of, ring } => {
                Report::new(format!("modules import each other: {}", ring.join(" → "))).at(*of, "closes the ring")
            }
            _ => self.describe_writing(),
        }
    }
}

impl FileFault {
    fn describe_reading(&self) -> Report {
        match self {
            Self::CannotRead { of, path, similar, why } => {
                let (message, label) = match why.as_str() {
                    "" => (format!("cannot read \"{path}\""), "looked in the folder of this script"),
                    why => (format!("cannot read \"{path}\": {why}"), "named here"),
                };
                let report = Report::new(message).at(*of, label);
                let report = match similar.as_slice() {
                    [] => report,
                    [one] => report.help(format!("there is {} \"{one}\"", article(one))),
                    [first, rest @ ..] => report.help(format!("there are \"{first}\"{}", quoted_tail(rest))),
                };
                let folder = path.rfind('/').map_or("", |at| &path[..=at]);
                let named = similar.iter().map(|name| Edit::Instead { of: format!("\"{path}\""), put: format!("\"{folder}{name}\"") });
                named.fold(report, |report, edit| report.edit(Subject::Entity(*of), edit))
            }
            Self::Outside { of, path } => Report::new(format!("\"{path}\" lies outside the allowed folders"))
                .at(*of, "only the script's folder and folders below it are allowed, links resolved")
                .help("move the file there, or run with `--allow PATH`"),
            Self::Malformed { of, path, at } => Report::new(format!("\"{path}\"{}: {}", at.place(), at.what)).at(*of, "imported here"),
            Self::Repaired { of, path, at } => Report::new(format!("\"{path}\"{}: {}", at.place(), at.what)).at(*of, "imported here"),
            Self::Unusable { of, path, total, faces, share, whole } => unusable(*of, path, *total, faces, *share, *whole),
            Self::TooLarge { of, path, bytes, limit } => {
                Report::new(format!("\"{path}\" has {}, more than the limit of {}", mebibytes(*bytes), mebibytes(*limit)))
                    .at(*of, "named here")
            }
            _ => self.describe_writing(),
        }
    }

    fn describe_writing(&self) -> Report {
        match self {
            Self::NoSuchFormat { of, path, known } => {
                let ending = path.rsplit_once('.').filter(|(_, e)| !e.contains(['/', '\\'])).map(|(_, ending)| ending);
                let message = match ending {
                    Some(ending) => format!("no format has the ending `.{ending}`"),
                    None => format!("\"{path}\" has no ending to choose a format by"),
                };
                Report::new(message).at(*of, "named here").help(format!("use one of .{}", known.join(" .")))
            }
            Self::LaterFormat { of, format } => {
                Report::new(format!("the format {format} is not in this version")).at(*of, "asked for here")
            }
            Self::Unsupported { of, what, help, edits } => {
                let report = Report::new(what.clone()).at(*of, "asked for here");
                let report = edits.iter().fold(report, |report, edit| report.edit(Subject::Entity(*of), edit.clone()));
                match help {
                    Some(help) => report.help(help.clone()),
                    None => report,
                }
            }
            Self::LeftOut { of, path, what } => Report::new(format!("\"{path}\" cannot hold {what}")).at(*of, "left out of this file"),
            Self::Renamed { of, path, names } => {
                let called = names.iter().map(|(from, to)| format!("`{from}` is called `{to}`")).collect::<Vec<_>>().join(", ");
                Report::new(format!("{called} in \"{path}\"")).at(*of, "written here")
            }
            Self::SameFile { outputs, members } => same_file(outputs, *members),
            Self::OverInput { of, path, what } => Report::new(format!("\"{path}\" is {what}, which this would replace"))
                .at(*of, "written here")
                .help("give the output another name"),
            Self::TooMuchWork { of, path } => Report::new(format!("\"{path}\" exceeds its work limit"))
                .at(*of, "to be written here")
                .help("write fewer or simpler things to one file; look for points that are far off by mistake"),
            Self::Incomplete { of, output, path, part, missing } => {
                let path = format!("\"{path}\"");
                let edit = Edit::Instead { put: format!("{path} {{ incomplete: true }}"), of: path };
                let faces = if *missing == 1 { "a face".to_owned() } else { format!("{missing} faces") };
                Report::new(format!("this would be written with holes: `{part}` lacks {faces} that could not be used"))
                    .at(*of, "incomplete")
                    .help("`incomplete: true` in the export writes it anyway")
                    .edit(Subject::Entity(*output), edit)
            }
            Self::CannotWrite { of, path, why } => Report::new(format!("cannot write \"{path}\": {why}")).at(*of, "to be written here"),
            _ => Report::new("cannot read a file"),
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

/// Several outputs that are one file.
fn same_file(outputs: &[(Origin, String)], members: Option<usize>) -> Report {
    let first = outputs.first().map_or("", |(_, path)| path.as_str());
    if let Some(members) = members {
        let message = format!("{members} outputs of this family are one file, \"{first}\"");
        let place = outputs.first().map_or(Origin::NONE, |(of, _)| *of);
        return Report::new(message)
            .at(place, "the same for several members")
            .help("give each member its own name, as in \"part_{i}.inp\"");
    }
    let other = outputs.iter().map(|(_, path)| path.as_str()).find(|path| *path != first);
    let message = match other {
        Some(other) if other.to_lowercase() == first.to_lowercase() => {
            format!("\"{first}\" and \"{other}\" are one file where upper and lower case are not distinguished")
        }
        Some(other) => format!("\"{first}\" and \"{other}\" are one file"),
        None => format!("{} outputs are one file, \"{first}\"", outputs.len()),
    };
    let report = Report::new(message).help("give each output a name of its own");
    let labels = outputs.iter().rev().enumerate();
    let last = outputs.len().saturating_sub(1);
    labels.fold(report, |report, (k, (of, _))| report.at(*of, if k == last { "written here first" } else { "would replace it" }))
}

fn quoted_tail(rest: &[String]) -> String {
    rest.iter().enumerate().map(|(k, name)| format!("{} \"{name}\"", if k + 1 == rest.len() { " and" } else { "," })).collect()
}

fn mebibytes(bytes: u64) -> String {
    if bytes < 10 << 20 { format!("{bytes} bytes") } else { format!("{} MiB", bytes >> 20) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::fault::Plain;

    #[test]
    fn a_missing_file_names_its_neighbour() {
        let fault = FileFault::CannotRead {
            of: Origin(1),
            path: "bow_offsets.csv".into(),
            similar: vec!["offsets_bow.csv".into()],
            why: String::new(),
        };
        let report = fault.describe(&Plain);
        assert_eq!(report.message, "cannot read \"bow_offsets.csv\"");
        assert_eq!(report.labels[0].1, "looked in the folder of this script");
        assert_eq!(report.help.as_deref(), Some("there is an \"offsets_bow.csv\""));
    }

    #[test]
    fn a_malformed_table_has_line_and_column() {
        let at = Malformed::at(7, 3, "`1.2.3` is no number");
        let fault = FileFault::Malformed { of: Origin(1), path: "a.csv".into(), at };
        let report = fault.describe(&Plain);
        assert_eq!((fault.code().0, report.message.as_str()), ("E803", "\"a.csv\", line 7, column 3: `1.2.3` is no number"));
    }
}
