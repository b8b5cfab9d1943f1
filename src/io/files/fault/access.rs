//! Files that cannot be opened.

use crate::base::fault::{Describe, Edit, Report, Say, Subject, codes};
use crate::base::origin::Origin;
use crate::base::text::article;

/// Why a file cannot be read or written. `of` is the import or export; paths are as written in the script.
#[derive(Clone, Debug, PartialEq)]
pub enum AccessFault {
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
    /// E808: the system does not let us write.
    CannotWrite {
        /// The export.
        of: Origin,
        /// As written.
        path: String,
        /// The system's words.
        why: String,
    },
    /// E802: outside the folders that may be read or written.
    Outside {
        /// The import or export.
        of: Origin,
        /// As written.
        path: String,
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

impl Describe for AccessFault {
    codes! { CannotRead "E801", CannotWrite "E808", Outside "E802", TooLarge "E811" }

    fn describe(&self, _: &dyn Say) -> Report {
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
            Self::CannotWrite { of, path, why } => Report::new(format!("cannot write \"{path}\": {why}")).at(*of, "to be written here"),
            Self::Outside { of, path } => Report::new(format!("\"{path}\" lies outside the allowed folders"))
                .at(*of, "only the script's folder and folders below it are allowed, links resolved")
                .help("move the file there, or run with `--allow PATH`"),
            Self::TooLarge { of, path, bytes, limit } => {
                Report::new(format!("\"{path}\" has {}, more than the limit of {}", mebibytes(*bytes), mebibytes(*limit)))
                    .at(*of, "named here")
            }
        }
    }
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
    use crate::base::fault::PlainWords;

    #[test]
    fn a_missing_file_names_its_neighbour() {
        let fault = AccessFault::CannotRead {
            of: Origin(1),
            path: "bow_offsets.csv".into(),
            similar: vec!["offsets_bow.csv".into()],
            why: String::new(),
        };
        let report = fault.describe(&PlainWords);
        assert_eq!(report.message, "cannot read \"bow_offsets.csv\"");
        assert_eq!(report.labels[0].1, "looked in the folder of this script");
        assert_eq!(report.help.as_deref(), Some("there is an \"offsets_bow.csv\""));
    }
}
