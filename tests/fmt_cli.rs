//! `loft fmt` as a user runs it.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// A folder that goes when the test ends.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str, files: &[(&str, &str)]) -> Self {
        let folder = std::env::temp_dir().join(format!("loft-fmt-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        for (name, text) in files {
            let path = folder.join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        }
        Self(folder)
    }

    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.0.join(name)).unwrap()
    }

    fn loft(&self, arguments: &[&str], input: &str) -> (i32, String, String) {
        run(&self.0, arguments, input)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn run(folder: &Path, arguments: &[&str], input: &str) -> (i32, String, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_loft"));
    command.arg("fmt").args(arguments).current_dir(folder);
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let _ = child.stdin.take().unwrap().write_all(input.as_bytes());
    let done = child.wait_with_output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (done.status.code().unwrap_or(-1), text(done.stdout), text(done.stderr))
}

#[test]
fn files_and_folders_are_rewritten_and_named_when_they_change() {
    let files = [
        ("a.loft", "let   a=1\n"),
        ("b.loft", "let b = 1\n"),
        ("in/c.loft", "let c=1"),
        ("in/d.txt", "let   d=1"),
        (".x/e.loft", "let   e=1"),
    ];
    let folder = Folder::new("folders", &files);
    let (status, out, err) = folder.loft(&["."], "");
    assert_eq!((status, out.as_str(), err.as_str()), (0, "./a.loft\n./in/c.loft\n", ""));
    assert_eq!(folder.read("a.loft"), "let a = 1\n");
    assert_eq!(folder.read("in/c.loft"), "let c = 1\n");
    assert_eq!((folder.read("in/d.txt"), folder.read(".x/e.loft")), ("let   d=1".into(), "let   e=1".into()));
    assert_eq!(folder.loft(&["a.loft", "b.loft", "in"], ""), (0, String::new(), String::new()));
    assert_eq!(fs::read_dir(&folder.0).unwrap().count(), 4, "nothing is left behind");
}

#[test]
fn check_lists_and_shows_and_writes_nothing() {
    let folder =
        Folder::new("check", &[("a.loft", "let a = 1\nlet   b=1 \nlet c = 2\n"), ("b.loft", "let b = 1\n"), ("c.loft", "let c = 1\r\n")]);
    let (status, out, err) = folder.loft(&["--check", "a.loft", "b.loft", "c.loft"], "");
    assert_eq!(out, "a.loft\n  line 2\n- let   b=1·\n+ let b = 1\nc.loft\n  line 1\n- let c = 1␍\n+ let c = 1\n");
    assert_eq!((status, err.as_str()), (1, ""));
    assert!(folder.read("a.loft").contains("let   b=1 "));
    assert_eq!(folder.loft(&["--check", "b.loft"], "").0, 0);
}

#[test]
fn standard_input_goes_to_standard_output() {
    let folder = Folder::new("stream", &[("keep", "")]);
    assert_eq!(folder.loft(&["-"], "let   a=1 // b"), (0, "let a = 1  // b\n".into(), String::new()));
    assert_eq!(folder.loft(&["--check", "-"], "let a = 1\n").0, 0);
    assert_eq!(folder.loft(&["-"], ""), (0, String::new(), String::new()));
}

#[test]
fn a_mistake_is_told_and_the_rest_is_laid_out() {
    let folder = Folder::new("mistake", &[("a.loft", "let   a=1\nlet  b= (1\nlet   c=3\n")]);
    let (status, out, err) = folder.loft(&["a.loft"], "");
    assert_eq!((status, out.as_str()), (1, "a.loft\n"));
    assert!(err.contains("E101") && err.contains("a.loft:2"), "{err}");
    assert_eq!(folder.read("a.loft"), "let a = 1\nlet  b= (1\nlet c = 3\n");
}

#[test]
fn what_cannot_be_read_is_wrong_usage() {
    let folder = Folder::new("usage", &[("a.loft", "let a = 1\n")]);
    fs::write(folder.0.join("bytes.loft"), [0xff, 0xfe]).unwrap();
    for (arguments, words) in [(&["no.loft"][..], "there is no such file"), (&["bytes.loft"], "not UTF-8"), (&[], "required")] {
        let (status, _, err) = folder.loft(arguments, "");
        assert_eq!(status, 2, "{arguments:?}");
        assert!(err.contains(words), "{err}");
    }
}

#[cfg(unix)]
#[test]
fn permissions_and_links_are_kept() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let folder = Folder::new("links", &[("real/a.loft", "let   a=1\n"), ("sealed.loft", "let   a=1\n")]);
    let real = folder.0.join("real/a.loft");
    fs::set_permissions(&real, fs::Permissions::from_mode(0o754)).unwrap();
    symlink("real/a.loft", folder.0.join("link.loft")).unwrap();
    assert_eq!(folder.loft(&["link.loft"], "").0, 0);
    assert!(fs::symlink_metadata(folder.0.join("link.loft")).unwrap().is_symlink());
    assert_eq!(folder.read("real/a.loft"), "let a = 1\n");
    assert_eq!(fs::metadata(&real).unwrap().permissions().mode() & 0o777, 0o754);

    let sealed = folder.0.join("sealed.loft");
    fs::set_permissions(&sealed, fs::Permissions::from_mode(0o444)).unwrap();
    let (status, _, err) = folder.loft(&["sealed.loft"], "");
    assert_eq!(status, 1);
    assert!(err.contains("cannot write"), "{err}");
    assert_eq!(folder.read("sealed.loft"), "let   a=1\n");
}

#[test]
fn the_starter_is_laid_out() {
    let script = lofting::session::starter::SCRIPT;
    assert_eq!(lofting::lang::fmt::format(script).text, script);
}
