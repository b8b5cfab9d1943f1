//! `:view`: the page of `loft view`, which follows the session by a file that is written after every change.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::cli::Terminal;
use crate::cli::view::command::{PAGE, open};
use crate::cli::view::model::Script;
use crate::cli::view::server::{Server, Settings};
use crate::cli::view::shown_model::ShownModel;
use crate::session::notebook::Notebook;

/// What a session that is fed by a pipe answers.
pub const WITHOUT_TERMINAL: &str = "`:view` opens a page from a session in a terminal; `loft view MODEL` opens one of a script";

/// The script of a session, which its entries alone change.
struct Session;

impl Script for Session {
    fn write(&self, name: &str, text: &str) -> Result<(), String> {
        Err(format!("the page follows a session: enter `:set {name}={text}` there"))
    }

    fn show(&self, _: &str, _: u32, _: u32) -> bool {
        false
    }
}

/// A page that shows the session.
pub struct Viewing {
    server: Server,
    /// The script that the session stands for, beside the files that it reads.
    file: PathBuf,
}

impl Viewing {
    /// Serves the page and opens it; says why where that cannot be.
    pub fn start(notebook: &Notebook, terminal: &Terminal) -> Option<Self> {
        let folder = notebook.script().and_then(Path::parent).filter(|folder| !folder.as_os_str().is_empty());
        let file = folder.unwrap_or(Path::new(".")).join(format!(".loft-session-{}.loft", std::process::id()));
        let served = fs::write(&file, notebook.saved_text()).map_err(|error| format!("cannot write {}: {error}", file.display()));
        let served = served.and_then(|()| {
            let model = ShownModel::new("session", &file, &[], &[]);
            let page = Arc::new(PAGE.as_bytes().to_vec());
            let settings = Settings { script: file.clone(), port: None, page, sets: Vec::new() };
            Server::start(settings, Box::new(model), Arc::new(Session)).map_err(|error| error.to_string())
        });
        match served {
            Ok(server) => {
                let page = Self { server, file };
                page.open(terminal);
                Some(page)
            }
            Err(why) => {
                drop(fs::remove_file(&file));
                terminal.print(&format!("{why}\n"));
                None
            }
        }
    }

    /// Opens the page once more.
    pub fn open(&self, terminal: &Terminal) {
        terminal.print(&format!("{}\n", self.server.address()));
        open(&self.server);
    }

    /// Shows the session as it is now.
    pub fn follow(&self, notebook: &Notebook) {
        let text = notebook.saved_text();
        if fs::read_to_string(&self.file).ok().as_deref() != Some(&text) {
            // A page that cannot follow says nothing wrong: it shows what it showed.
            drop(fs::write(&self.file, text));
        }
    }
}

impl Drop for Viewing {
    fn drop(&mut self) {
        drop(fs::remove_file(&self.file));
    }
}
