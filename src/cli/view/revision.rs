//! A script and the files that it reads as they were at a revision of their repository.

use std::path::{Path, PathBuf};
use std::process::Command;

/// A commit of the repository in which a script stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Revision {
    commit: String,
}

impl Revision {
    /// The commit that a revision names, such as `HEAD~2`.
    ///
    /// Fails with what git says.
    pub fn named(script: &Path, revision: &str) -> Result<Self, String> {
        let commit = git(script, &["rev-parse", "--verify", "--quiet", "--end-of-options", &format!("{revision}^{{commit}}")])
            .map_err(|said| if said.is_empty() { format!("there is no revision `{revision}`") } else { said })?;
        Ok(Self { commit: commit.trim().to_owned() })
    }

    /// The commit in which the golden beside a script was last written: a golden says what its model measures and holds no shapes, but the
    /// script of that commit makes them.
    ///
    /// Fails where there is no such commit.
    pub fn of_golden(script: &Path) -> Result<Self, String> {
        let golden = script.with_extension("golden");
        let name = golden.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let commit = git(script, &["--literal-pathspecs", "log", "-1", "--diff-filter=AM", "--format=%H", "--", &name])?;
        match commit.trim() {
            "" => Err(format!("no commit holds {name}; compare with a revision, such as HEAD")),
            commit => Ok(Self { commit: commit.to_owned() }),
        }
    }

    /// The text of a file then.
    ///
    /// Fails with what git says where it was not there, and for what is no text.
    pub fn text(&self, file: &Path) -> Result<String, String> {
        let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
        git(file, &["show", &format!("{}:./{name}", self.commit)])
    }
}

/// What git prints in the folder of a file.
fn git(file: &Path, words: &[&str]) -> Result<String, String> {
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).map_or_else(|| PathBuf::from("."), Path::to_owned);
    let output = Command::new("git").arg("-C").arg(folder).args(words).output().map_err(|error| format!("git cannot be run: {error}"))?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).trim().to_owned());
    }
    String::from_utf8(output.stdout).map_err(|_| "it is no text".to_owned())
}
