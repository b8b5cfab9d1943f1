//! What `loft new` writes.

use std::fs::{self, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::golden;
use crate::base::job::Job;

/// A first model: a vault over four curves, meshed, checked and written for a solver.
pub const SCRIPT: &str = r#"// A barrel vault: change `span`, run it again, or say `loft run model.loft --set span=12m`.

units m

param span = 8m in 4m to 40m  // across the vault
param rise = span / 4
param bays = 3 in 1 to 20

let length = bays * 4m

curve south = arc((0, 0, 0), (span, 0, 0), through: (span / 2, 0, rise))
curve north = move(south, by: (0, length, 0))
curve west  = line(south.start, north.start)
curve east  = line(south.end, north.end)

surface vault = coons(south, east, north, west)

mesh fine of vault {
  size: 500mm
  elements: quads
}

group eaves of west, east

check "no slivers": fine.min_angle >= 60deg
check "nothing lost": fine.area == vault.area within 0.5%

export fine to "model.inp"
export fine to "model.vtu"
"#;

/// Name of the script in its folder.
const NAME: &str = "model.loft";

/// Makes the folder where needed and writes the script, never over an existing one; gives its path.
pub fn write(folder: &Path) -> io::Result<PathBuf> {
    fs::create_dir_all(folder)?;
    let script = folder.join(NAME);
    let mut file = OpenOptions::new().write(true).create_new(true).open(&script).map_err(|error| match error.kind() {
        io::ErrorKind::AlreadyExists => io::Error::new(error.kind(), format!("there is a {NAME} already")),
        _ => error,
    })?;
    file.write_all(SCRIPT.as_bytes())?;
    Ok(script)
}

/// Runs the script and writes what it finds as its golden; gives the golden's path. The error is a sentence.
pub fn write_golden(script: &Path, clock: &(dyn Fn() -> f64 + Sync), job: &Job) -> Result<PathBuf, String> {
    let tests = golden::discover(&[script.to_owned()])?;
    let settings = golden::Settings { accept: true, filter: None, jobs: 1, clock, job };
    for test in &tests {
        if let Some(bad) = golden::run_one(test, &settings).into_iter().find(|result| !result.verdict.is_good()) {
            return Err(bad.message);
        }
    }
    Ok(script.with_extension("golden"))
}
