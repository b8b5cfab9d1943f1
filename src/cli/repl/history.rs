//! Where the history of sessions is kept: the user's data folder.

use std::path::PathBuf;

/// The file, its folder made; `None` where there is no such place.
pub fn path() -> Option<PathBuf> {
    let variable = |name: &str| std::env::var_os(name).map(PathBuf::from).filter(|path| path.is_absolute());
    let folder = if cfg!(windows) {
        variable("APPDATA")?
    } else if cfg!(target_os = "macos") {
        variable("HOME")?.join("Library/Application Support")
    } else {
        variable("XDG_DATA_HOME").or_else(|| Some(variable("HOME")?.join(".local/share")))?
    };
    let folder = folder.join("loft");
    std::fs::create_dir_all(&folder).ok()?;
    Some(folder.join("history"))
}
