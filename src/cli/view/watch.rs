//! Watches the script and the files that the model read.
//!
//! By looking at them every few milliseconds: it works the same on every system, through links, network folders and editors that rename,
//! and a look at a file takes microseconds.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime};

use super::file_state::{FileState, Look};

/// Time between two looks.
const REST: Duration = Duration::from_millis(5);

/// Time between two looks at files that are changing.
const SHORT_REST: Duration = Duration::from_millis(3);

/// Looking takes at most this share of the time, one part in so many, where there are many files or a slow network.
const SHARE: u32 = 20;

/// Longest time between two looks.
const LONGEST_REST: Duration = Duration::from_millis(250);

/// A script and the files that it reads.
#[derive(Debug)]
pub struct Watch {
    script: FileState,
    files: Vec<FileState>,
    /// A file changed before it was watched.
    missed: bool,
    /// The script has been looked for in vain.
    announced_gone: bool,
    started: Instant,
}

/// What a round of looks found.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct News {
    /// The text of the script, where it is new.
    pub text: Option<Vec<u8>>,
    /// The script is gone.
    pub gone: bool,
    /// Another file changed.
    pub files: bool,
    /// Until the next round.
    pub rest: Duration,
}

impl Watch {
    /// Watches a script; the first rounds tell its text, or that it is not there.
    pub fn new(script: &Path) -> Self {
        let script = FileState::unknown(script);
        Self { script, files: Vec::new(), missed: false, announced_gone: false, started: Instant::now() }
    }

    /// Watches these files besides the script from now on. One that changed after `since`, when the model began to read, counts as
    /// changed.
    pub fn set_files(&mut self, paths: &[PathBuf], since: SystemTime) {
        let real = |path: &Path| path.canonicalize().unwrap_or_else(|_| path.to_owned());
        let script = real(self.script.path());
        let mut before = std::mem::take(&mut self.files);
        for path in paths {
            if self.files.iter().any(|file| file.path() == path) || *path == script || real(path) == script {
                continue;
            }
            let known = before.iter().position(|file| file.path() == path).map(|i| before.swap_remove(i));
            let file = known.unwrap_or_else(|| {
                let file = FileState::now(path);
                self.missed |= file.is_newer_than(since);
                file
            });
            self.files.push(file);
        }
    }

    /// Looks at all files.
    pub fn look(&mut self) -> News {
        let now = Instant::now();
        let mut news = News { files: std::mem::take(&mut self.missed), ..News::default() };
        let mut rest = REST;
        match self.script.look(now) {
            Look::Same => {}
            Look::Unsettled => rest = SHORT_REST,
            Look::Changed(text) => {
                self.announced_gone = text.is_none();
                news.gone = text.is_none();
                news.text = text;
            }
        }
        // There was none to begin with.
        if !self.script.is_there() && !self.announced_gone && now.duration_since(self.started) > LONGEST_REST {
            self.announced_gone = true;
            news.gone = true;
        }
        for file in &mut self.files {
            match file.look(now) {
                Look::Same => {}
                Look::Unsettled => rest = SHORT_REST,
                Look::Changed(_) => news.files = true,
            }
        }
        news.rest = rest.max(now.elapsed() * SHARE).min(LONGEST_REST);
        news
    }
}
