//! A model beside itself at another revision, with the files that it read then.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;

use lofting::cli::view::model::{Compare, Evaluation, Model, Request};
use lofting::cli::view::shown_model::ShownModel;
use serde_json::{Value, json};

const SCRIPT: &str =
    "units m\nuse \"lower.loft\" as lower\ncurve top = line((0, 0, 1), (3, 0, 1))\nsurface wall = ruled(lower.foot, top)\n";
const LOWER: &str =
    "units m\nimport \"lengths.csv\" (header: true) as lengths\ncurve foot = line((0, 0, 0), (lengths.rows[0][0] * 1m, 0, 0))\n";

fn git(folder: &Path, words: &[&str]) {
    let who = ["-c", "user.name=someone", "-c", "user.email=someone@example.org"];
    let done = Command::new("git").arg("-C").arg(folder).args(who).args(words).output().unwrap();
    assert!(done.status.success(), "{words:?}: {}", String::from_utf8_lossy(&done.stderr));
}

fn shown(model: &mut ShownModel, text: &str, compare: Compare) -> Value {
    let mut request = Request { number: 2, text: Arc::new(text.as_bytes().to_vec()), compare: Some(compare), ..Request::default() };
    let mut evaluated = model.evaluate(&request, &Evaluation::default());
    if evaluated.more {
        // The model alone was shown first.
        let first: Value = serde_json::from_str(&evaluated.frame.unwrap().json).unwrap();
        assert!(first["compare"]["pending"] == true && first["compare"]["things"] == json!([]));
        assert!(first["things"].as_array().is_some_and(|things| !things.is_empty()));
        request.again = true;
        evaluated = model.evaluate(&request, &Evaluation::default());
    }
    assert!(!evaluated.more);
    let frame: Value = serde_json::from_str(&evaluated.frame.unwrap().json).unwrap();
    assert_eq!(frame["compare"]["pending"], false);
    frame
}

/// The area of the wall beside the model.
fn area_of_then(frame: &Value) -> Option<String> {
    let things = frame["compare"]["things"].as_array()?;
    let wall = things.iter().find(|thing| thing["name"] == "wall")?;
    let fact = wall["facts"].as_array()?.iter().find(|fact| fact[0] == "area")?;
    Some(fact[1].as_str()?.to_owned())
}

#[test]
fn another_revision_has_the_files_of_then() {
    if Command::new("git").arg("--version").output().is_err() {
        return;
    }
    let folder: PathBuf = Path::new(env!("CARGO_TARGET_TMPDIR")).join("view-compare");
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    let write = |name: &str, text: &str| fs::write(folder.join(name), text).unwrap();
    git(&folder, &["init", "-q"]);
    write("wall.loft", SCRIPT);
    write("lower.loft", LOWER);
    write("lengths.csv", "length\n3\n");
    write("wall.golden", "loft golden 1\n");
    git(&folder, &["add", "."]);
    git(&folder, &["commit", "-q", "-m", "three"]);
    write("lengths.csv", "length\n5\n");
    git(&folder, &["commit", "-q", "-a", "-m", "five"]);
    // Today the foot is in the script that is used, and not in a table.
    write("lower.loft", "units m\ncurve foot = line((0, 0, 0), (7, 0, 0))\n");
    let mut model = ShownModel::new("wall.loft", &folder.join("wall.loft"), &[], &[]);
    let of = |model: &mut ShownModel, compare: Compare| area_of_then(&shown(model, SCRIPT, compare));
    assert_eq!(of(&mut model, Compare::Revision("HEAD".to_owned())).as_deref(), Some("4 m²"));
    assert_eq!(of(&mut model, Compare::Revision("HEAD~1".to_owned())).as_deref(), Some("3 m²"));
    git(&folder, &["tag", "fix/#7+größe", "HEAD~1"]);
    assert_eq!(of(&mut model, Compare::Revision("fix/#7+größe".to_owned())).as_deref(), Some("3 m²"));
    assert_eq!(of(&mut model, Compare::Golden).as_deref(), Some("3 m²"), "of the commit that wrote the golden");
    let own = shown(&mut model, SCRIPT, Compare::Golden);
    let wall = own["things"].as_array().unwrap().iter().find(|thing| thing["name"] == "wall").unwrap();
    assert!(wall["facts"].as_array().unwrap().iter().any(|fact| fact[1] == "5 m²"), "{wall}");
    let why = shown(&mut model, SCRIPT, Compare::Revision("nothing".to_owned()));
    assert_eq!(why["compare"]["failed"], "there is no revision `nothing`");
    // A golden that is deleted is still that of the commit that wrote it.
    git(&folder, &["rm", "-q", "wall.golden"]);
    git(&folder, &["commit", "-q", "-m", "no golden"]);
    assert_eq!(of(&mut model, Compare::Golden).as_deref(), Some("3 m²"));
    let bare = ShownModel::new("bare.loft", &folder.join("bare.loft"), &[], &[]);
    write("bare.loft", "units m\n");
    let why = shown(&mut { bare }, "units m\n", Compare::Golden)["compare"]["failed"].as_str().unwrap().to_owned();
    assert!(why.contains("bare.golden") && why.contains("HEAD"), "{why}");
}
