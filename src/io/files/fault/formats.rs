//! Formats that do not exist or cannot hold what is asked for.

use crate::base::fault::{Describe, Edit, Report, Say, Subject, codes};
use crate::base::origin::Origin;

/// Why a format cannot be used. Paths are as written in the script.
#[derive(Clone, Debug, PartialEq)]
pub enum FormatFault {
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
}

impl Describe for FormatFault {
    codes! { NoSuchFormat "E804", LaterFormat "E230", Unsupported "E805" }

    fn describe(&self, _: &dyn Say) -> Report {
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
        }
    }
}
