//! Models at random numbers with closed forms, each run in forms that must not change the result. Whether a model is made does not depend on
//! its digits: a refusal is a failure.

mod curved;
mod flat;
mod form;
mod outline;
mod scene;
mod solids;

use std::collections::BTreeMap;

use form::FORMS;
use lofting::base::fault::Severity;
use lofting::session::disk::{Disk, Outputs};
use lofting::session::guard::guarded;
use scene::Scene;

use crate::support::long::is_long;
use crate::support::random::Random;
use crate::support::script;

/// Cases of a family in a long and in a short run, each in all forms.
const CASES: (u64, u64) = (8, 1);

/// A family of models.
type Family = (&'static str, fn(&mut Random, &mut Scene));

const FAMILIES: [Family; 24] = [
    ("tubes", curved::tubes),
    ("ribs", flat::ribs),
    ("slices", curved::slices),
    ("webs", curved::webs),
    ("trays", curved::trays),
    ("holes", curved::holes),
    ("flat tubes", curved::flat_tubes),
    ("polygons", flat::polygons),
    ("outlines", flat::outlines),
    ("planes", flat::planes),
    ("drilled", solids::drilled),
    ("boxes", solids::boxes),
    ("rings", solids::rings),
    ("cones", solids::cones),
    ("offsets", solids::offsets),
    ("walls", solids::walls),
    ("frusta", solids::frusta),
    ("turned", solids::turned),
    ("roundings", solids::roundings),
    ("bends", solids::bends),
    ("projections", solids::projections),
    ("caps", solids::caps),
    ("saddles", solids::saddles),
    ("nets", solids::nets),
];

/// Runs a model in one form and compares what it reports; what is wrong with it, and its script.
fn failure(model: fn(&mut Random, &mut Scene), seed: u64, form: usize) -> Option<(String, String)> {
    let mut scene = Scene::new(FORMS[form].form());
    model(&mut Random(seed), &mut scene);
    let text = scene.text();
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR"));
    let disk = Disk::new(None, Some(folder), &[], Outputs::Counted).unwrap();
    let outcome = match guarded(|| script::outcome("joint.loft", text.as_bytes(), &[], &disk)) {
        Ok(outcome) => outcome,
        Err(bug) => return Some((format!("{bug:?}"), text)),
    };
    if !outcome.report.ok {
        let error = outcome.diagnostics.iter().find(|d| d.severity() == Severity::Error);
        return Some((error.map_or_else(String::new, |d| format!("{} {}", d.code.0, d.message)), text));
    }
    let report = serde_json::to_value(&outcome.report).unwrap();
    let found: BTreeMap<&str, f64> =
        report["reports"].as_array().unwrap().iter().map(|r| (r["title"].as_str().unwrap(), r["rows"][0][0].as_f64().unwrap())).collect();
    let off = scene.wanted().find(|(label, value, room)| found[label].is_nan() || (found[label] - value).abs() > room * value.abs());
    off.map(|(label, value, _)| (format!("{label} is {} for {value}", found[label]), text.clone()))
}

/// Runs each of some families at several seeds in all forms.
fn run(families: &[Family]) {
    let cases = if is_long() { CASES.0 } else { CASES.1 };
    let (mut failed, mut told) = (0, String::new());
    for (name, model) in families {
        let before = failed;
        for (seed, form) in (0..cases).flat_map(|seed| (0..FORMS.len()).map(move |form| (seed, form))) {
            let Some((what, text)) = failure(*model, seed, form) else { continue };
            failed += 1;
            told.push_str(&format!("{name} {seed}, {}: {what}\n", FORMS[form].name));
            // The first script of a family is told whole.
            if failed == before + 1 {
                told.push_str(&text);
            }
        }
    }
    assert!(failed == 0, "{failed} runs are refused or have another result:\n{told}");
}

#[test]
fn joints_of_curved_faces_have_their_closed_forms_in_all_forms() {
    run(&FAMILIES[..7]);
}

#[test]
fn joints_of_flat_faces_have_their_closed_forms_in_all_forms() {
    run(&FAMILIES[7..12]);
}

#[test]
fn bodies_have_their_closed_forms_in_all_forms() {
    run(&FAMILIES[12..18]);
}

#[test]
fn faces_have_their_closed_forms_in_all_forms() {
    run(&FAMILIES[18..]);
}
