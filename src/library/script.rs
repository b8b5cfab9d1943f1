//! A script that is run from Rust.

use std::path::{Path, PathBuf};

use super::error::Error;
use super::files::Place;
use super::loaded::Loaded;
use super::mesh::Mesh;
use super::model::Model;
use super::output::Output;
use crate::base::job::Job;
use crate::base::limits::SOURCE_BYTES;
use crate::io::Memory;
use crate::lang::eval::context::Cx;
use crate::lang::values::value::ModuleId;
use crate::session::disk::{Disk, Outputs, read_limited, words};
use crate::session::guard::guarded;
use crate::session::run::{Outcome, Task, run_seen};

/// A script with the files that it may read, the params that are set, and where its outputs go.
///
/// Without a folder it reads the files given by [`Script::file`] alone; without [`Script::out`] its outputs stay in memory. It touches
/// nothing else.
///
/// ```
/// use lofting::Script;
///
/// let script = "units m\nimport \"posts.csv\" as posts\nparam height = 3m\n\
///               curve post for p in posts = line((p.x * 1m, 0, 0), (p.x * 1m, 0, height))";
/// let model = Script::from_str(script).file("posts.csv", "x\n0\n2.5\n5\n").set("height", "4m").run()?;
/// assert_eq!(model.curves().len(), 3);
/// assert_eq!(model.curve("post[2]").map(|post| post.end()), Some([5.0, 0.0, 4.0]));
/// # Ok::<(), lofting::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Script {
    name: String,
    text: Vec<u8>,
    sets: Vec<(String, String)>,
    files: Vec<(String, Vec<u8>)>,
    folder: Option<PathBuf>,
    allow: Vec<PathBuf>,
    out: Option<PathBuf>,
    strict: bool,
}

impl Script {
    /// The script of a text, called `model.loft` in messages.
    #[allow(clippy::should_implement_trait)] // It cannot fail: mistakes are reported by `run`.
    pub fn from_str(text: &str) -> Self {
        Self {
            name: "model.loft".to_owned(),
            text: text.as_bytes().to_vec(),
            sets: Vec::new(),
            files: Vec::new(),
            folder: None,
            allow: Vec::new(),
            out: None,
            strict: false,
        }
    }

    /// The script of a file, which reads what lies in the file's folder and below.
    ///
    /// Fails with E801 where the file cannot be read.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        let name = path.to_string_lossy().into_owned();
        let text =
            read_limited(path, SOURCE_BYTES).map_err(|error| Error::new("E801", format!("cannot read \"{name}\": {}", words(&error))))?;
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        Ok(Self { name, text, folder: Some(folder.to_owned()), ..Self::from_str("") })
    }

    /// Called by another name in messages.
    pub fn named(self, name: &str) -> Self {
        Self { name: name.to_owned(), ..self }
    }

    /// Sets a param by the text of a literal, as `--set` does: `"50m"`, `"quads"`, `"0.5"`.
    pub fn set(mut self, param: &str, value: &str) -> Self {
        self.sets.push((param.to_owned(), value.to_owned()));
        self
    }

    /// A file in memory that the script may import, by its path beside the script; it hides a file of the folder.
    pub fn file(mut self, path: &str, bytes: impl Into<Vec<u8>>) -> Self {
        self.files.push((path.to_owned(), bytes.into()));
        self
    }

    /// The folder that the script lies in: it imports what is in it and below.
    pub fn folder(self, path: impl Into<PathBuf>) -> Self {
        Self { folder: Some(path.into()), ..self }
    }

    /// A further folder or file that may be imported.
    pub fn allow(mut self, path: impl Into<PathBuf>) -> Self {
        self.allow.push(path.into());
        self
    }

    /// The folder that outputs are written to, all of them when everything is well, else none.
    pub fn out(self, folder: impl Into<PathBuf>) -> Self {
        Self { out: Some(folder.into()), ..self }
    }

    /// Whether warnings are errors.
    pub fn strict(self, strict: bool) -> Self {
        Self { strict, ..self }
    }

    /// Runs it: curves, surfaces, meshes, checks and outputs.
    ///
    /// Fails where the script has errors or a check does not hold: the [`Error`] has the code and place of the first one, all diagnostics,
    /// and what is sound. Then nothing is written.
    pub fn run(&self) -> Result<Model, Error> {
        let place = self.place()?;
        let clock = || 0.0;
        let task = Task { strict: self.strict, full: true, ..Task::new(&self.name, &self.text, &self.sets, &clock) };
        let (mut loaded, mut groups) = (None, Vec::new());
        let mut look = |cx: &mut Cx<'_>| {
            loaded = Loaded::of(cx);
            groups = cx.groups(ModuleId::MAIN).unwrap_or_default().iter().map(|group| group.name.to_string()).collect();
        };
        let outcome = guarded(|| run_seen(&task, &place, &Job::new(), &mut look)).map_err(|bug| Error::bug(&bug))?;
        let drawn = outcome.drawn(false, false);
        let (ok, diagnostics) = (outcome.report.ok, outcome.report.diagnostics.clone());
        let model = loaded.map(|loaded| finished(loaded, groups, outcome, place));
        match model {
            Some(model) if ok => Ok(model),
            model => Err(Error::of_run(diagnostics, drawn, model)),
        }
    }

    /// Where its files come from and go to.
    fn place(&self) -> Result<Place, Error> {
        let memory = self.files.iter().fold(Memory::new(), |memory, (path, bytes)| memory.with(path, bytes.clone()));
        let disk = |script: Option<&Path>, out: Option<&Path>| {
            Disk::new(script, out, &self.allow, Outputs::Written)
                .map_err(|error| Error::new("E801", format!("cannot use the folders of {}: {error}", self.name)))
        };
        let file = Path::new(&self.name).file_name().unwrap_or(self.name.as_ref());
        let folder = self.folder.as_ref().map(|folder| disk(Some(&folder.join(file)), None)).transpose()?;
        let out = self.out.as_ref().map(|out| disk(None, Some(out))).transpose()?;
        Ok(Place::new(memory, folder.map(Disk::seen_from_home), out))
    }
}

/// The model of a run.
fn finished(loaded: Loaded, groups: Vec<String>, outcome: Outcome, place: Place) -> Model {
    let Loaded { scene, tolerance, unit, names, curves, surfaces, shells } = loaded;
    let on_disk = place.out.is_some();
    let mut written = place.into_written();
    let report = outcome.report;
    let meshes = outcome.meshes.into_iter().map(|(_, mesh)| Mesh::new(mesh, tolerance, unit, groups.clone(), Vec::new())).collect();
    let output = |row: &crate::session::report::OutputRow| Output {
        path: row.path.clone(),
        size: row.bytes,
        bytes: written.remove(&row.path),
        file: on_disk.then(|| PathBuf::from(&row.place)),
    };
    let outputs = report.outputs.iter().map(output).collect();
    Model { scene, tolerance, unit, names, curves, surfaces, shells, meshes, report, outputs }
}
