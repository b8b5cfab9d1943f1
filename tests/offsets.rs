//! Tables of offsets written as csv and read again: the same to the last digit, in the model's unit and in another one.

use lofting::Script;

const SIDE: &str = "units m
let side = bezier_surface([
  [(-5, 0, -0.625), (0, 0, -0.625), (5, 0, -0.625)],
  [(-5, 0, -0.3125), (0, 1, -0.3125), (5, 0, -0.3125)],
  [(-5, 0, 0), (0, 1, 0), (5, 0, 0)],
])
let table = offsets_table(side, stations: [for k in 0..16: k * 0.7m - 5.25m], heights: [for k in 0..8: k * 0.1m - 0.65m])
";

fn written(settings: &str) -> String {
    let script = Script::from_str(&format!("{SIDE}export table to \"t.csv\"{settings}\n"));
    let model = script.run().unwrap_or_else(|e| panic!("{}", e.report()));
    model.output("t.csv").unwrap().text().unwrap().to_owned()
}

#[test]
fn a_table_reads_again_to_the_last_digit() {
    let text = written("");
    assert!(text.starts_with("# lengths in m\nz\\x,-5.25,"), "{text}");
    // Under the keel there is no hull: empty cells behind the height.
    assert!(text.lines().nth(2).unwrap().trim_end_matches(',').split(',').count() == 1, "{text}");
    let again = format!(
        "{SIDE}import \"t.csv\" (header: true, unit: m) as back
let lines = hull_lines(back, stem: false)
check \"read\": len(lines.stations) == 16 and len(lines.sections[0]) == 0
export back to \"t2.csv\"
"
    );
    let model = Script::from_str(&again).file("t.csv", text.as_bytes()).run().unwrap_or_else(|e| panic!("{}", e.report()));
    assert_eq!(model.output("t2.csv").unwrap().text().unwrap(), text);
}

#[test]
fn a_table_is_written_in_another_unit() {
    let text = written(" { units: mm }");
    assert!(text.starts_with("# lengths in mm\nz\\x,-5250,"), "{text}");
    let again = format!(
        "{SIDE}import \"t.csv\" (header: true, unit: mm) as back
check \"cells\": all([for j in 0..8 for k in 0..17 if table.rows[j][k] != none: back.rows[j][k] == table.rows[j][k] within 1e-12m])
"
    );
    let model = Script::from_str(&again).file("t.csv", text.as_bytes()).run();
    assert!(model.is_ok(), "{}", model.unwrap_err().report());
}

#[test]
fn what_is_wrong_with_a_table_is_told() {
    let cases = [
        ("let t = offsets_table(side, stations: [], heights: [0m])", "E306", "one or more"),
        ("let t = offsets_table([side, move(side, by: (0, -1.5, 0))], stations: [0m], heights: [-0.3m])", "E306", "port or starboard"),
        ("export table to \"t.json\"", "E805", "not tables"),
        ("export table to \"t.stl\"", "E805", "not tables"),
        ("export table, table to \"t.csv\"", "E805", "a file holds one table"),
    ];
    for (line, wanted, words) in cases {
        let error = Script::from_str(&format!("{SIDE}{line}\n")).run().err();
        let error = error.unwrap_or_else(|| panic!("no error: {line}"));
        assert!(error.code() == wanted && error.report().contains(words), "{line}\n{}", error.report());
    }
}
