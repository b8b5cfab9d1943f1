//! Declarations of one shape in a row share one tree, which is filled anew for each: what they say is theirs all the same.

use std::path::Path;

use lofting::session::disk::{Disk, Outputs};

use crate::support::script;

/// Forms of a declaration, by a number; each value is compared with what it must be.
const FORMS: &[(&str, &str)] = &[
    ("NAME = K + 2 * K", "3 * K"),
    ("NAME = sum([K, 2 * K, K + 1])", "4 * K + 1"),
    ("NAME = Kmm / 1mm", "K"),
    ("NAME = len(\"KxK\") + K", "len(\"KxK\") + K"),
    ("NAME = \"aKb{base_K}\"", "\"aKb{K + 1}\""),
    ("NAME = max(K, base_K)", "K + 1"),
    ("NAME = if K > 2 then base_K else -K", "if K > 2 then K + 1 else 0 - K"),
    ("NAME = sum([for i in 0..K: i + K])", "K * (K - 1) / 2 + K * K"),
    ("NAME = [K, base_K][1]", "K + 1"),
    ("NAME = { at: K, size: base_K }.size", "K + 1"),
];

/// All forms with the numbers 1 to 5: one form after the other, or one number after the other.
fn text(by_form: bool) -> String {
    let mut order: Vec<(usize, usize)> = (0..FORMS.len()).flat_map(|form| (1..6).map(move |k| (form, k))).collect();
    if !by_form {
        order.sort_by_key(|(form, k)| (*k, *form));
    }
    let mut text = String::from("units mm\n");
    (1..6).for_each(|k| text.push_str(&format!("let base_{k} = {k} + 1\n")));
    for (form, k) in &order {
        text.push_str(&format!("let {}\n", FORMS[*form].0.replace("NAME", &format!("v{form}_{k}")).replace('K', &k.to_string())));
    }
    for (form, k) in order {
        text.push_str(&format!("check v{form}_{k} == {}\n", FORMS[form].1.replace('K', &k.to_string())));
    }
    text
}

#[test]
fn declarations_of_one_shape_keep_their_own_values() {
    for by_form in [true, false] {
        let text = text(by_form);
        let disk = Disk::new(None, Some(Path::new(env!("CARGO_TARGET_TMPDIR"))), &[], Outputs::Counted).unwrap();
        let outcome = script::outcome("shapes.loft", text.as_bytes(), &[], &disk);
        assert!(outcome.report.ok, "{}", outcome.drawn(false, false));
        let checks = serde_json::to_value(&outcome.report).unwrap()["checks"].as_array().map_or(0, Vec::len);
        assert_eq!(checks, 5 * FORMS.len());
    }
}
