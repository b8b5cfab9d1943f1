//! Outputs: what a file leaves out, files written twice, incomplete parts.

use crate::base::fault::{Describe, Edit, Report, Say, Subject, codes};
use crate::base::origin::Origin;

/// What can go wrong with an output, or deserves a word. `of` is the export; paths are as written in the script.
#[derive(Clone, Debug, PartialEq)]
pub enum OutputFault {
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
    /// E217: an output that takes more work than one may.
    TooMuchWork {
        /// The export or picture.
        of: Origin,
        /// As written.
        path: String,
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
}

impl Describe for OutputFault {
    codes! { LeftOut "W806", Renamed "W807", SameFile "E812", OverInput "E813", TooMuchWork "E217", Incomplete "E904" }

    fn describe(&self, _: &dyn Say) -> Report {
        match self {
            Self::LeftOut { of, path, what } => Report::new(format!("\"{path}\" cannot hold {what}")).at(*of, "left out of this file"),
            Self::Renamed { of, path, names } => {
                let called = names.iter().map(|(from, to)| format!("`{from}` is called `{to}`")).collect::<Vec<_>>().join(", ");
                Report::new(format!("{called} in \"{path}\"")).at(*of, "written here")
            }
            Self::SameFile { outputs, members } => same_file(outputs, *members),
            Self::OverInput { of, path, what } => {
                Report::new(format!("this would overwrite \"{path}\", {what}")).at(*of, "written here").help("give the output another name")
            }
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
        }
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
