//! The JSON report: its shape is the one that `docs/report.schema.json` states, for every example, and it is whole.

use std::fs;
use std::path::PathBuf;
use std::process::Command;

use lofting::lang::eval::std::fields;
use serde_json::Value;

fn schema() -> Value {
    serde_json::from_slice(&fs::read("docs/report.schema.json").unwrap()).unwrap()
}

/// What of a value a schema does not allow, with its place; the words of JSON Schema that our schema uses, and no others.
fn wrong(value: &Value, schema: &Value, root: &Value, at: &str, found: &mut Vec<String>) {
    let rules = schema.as_object().unwrap();
    for (word, rule) in rules {
        match word.as_str() {
            "$schema" | "$defs" | "title" | "description" => {}
            "$ref" => {
                let name = rule.as_str().unwrap().strip_prefix("#/$defs/").unwrap();
                wrong(value, &root["$defs"][name], root, at, found);
            }
            "anyOf" => {
                let tries = rule.as_array().unwrap().iter().map(|one| {
                    let mut inner = Vec::new();
                    wrong(value, one, root, at, &mut inner);
                    inner
                });
                found.extend(tries.min_by_key(Vec::len).unwrap());
            }
            "const" => check(value == rule, &format!("is not {rule}"), at, found),
            "enum" => check(rule.as_array().unwrap().contains(value), &format!("is none of {rule}"), at, found),
            "type" => check(is(value, rule), &format!("{value} is no {rule}"), at, found),
            "minimum" => check(value.as_f64().is_none_or(|x| x >= rule.as_f64().unwrap()), "is too small", at, found),
            "pattern" => {
                assert_eq!(rule, "^[EWN][0-9]{3}$");
                let code = value.as_str().unwrap_or("").as_bytes();
                let digits = code.len() == 4 && code[1..].iter().all(u8::is_ascii_digit);
                check(digits && matches!(code[0], b'E' | b'W' | b'N'), "is no code", at, found);
            }
            "items" => {
                for (k, item) in value.as_array().into_iter().flatten().enumerate() {
                    wrong(item, rule, root, &format!("{at}[{k}]"), found);
                }
            }
            "properties" => {
                for (key, inner) in value.as_object().into_iter().flatten() {
                    match rule.get(key) {
                        Some(rule) => wrong(inner, rule, root, &format!("{at}.{key}"), found),
                        None => check(rules["additionalProperties"] != false, "is not in the schema", &format!("{at}.{key}"), found),
                    }
                }
            }
            "required" => {
                for key in rule.as_array().unwrap() {
                    check(value.get(key.as_str().unwrap()).is_some(), "is missing", &format!("{at}.{key}"), found);
                }
            }
            "additionalProperties" => assert_eq!(rule, false),
            other => panic!("the schema uses `{other}`, which this test does not know"),
        }
    }
}

fn check(holds: bool, what: &str, at: &str, found: &mut Vec<String>) {
    if !holds {
        found.push(format!("{at} {what}"));
    }
}

fn is(value: &Value, kinds: &Value) -> bool {
    let one = |kind: &Value| match kind.as_str().unwrap() {
        "null" => value.is_null(),
        "boolean" => value.is_boolean(),
        "number" => value.is_number(),
        "integer" => value.as_f64().is_some_and(|x| x.trunc() == x),
        "string" => value.is_string(),
        "array" => value.is_array(),
        "object" => value.is_object(),
        other => panic!("{other}"),
    };
    kinds.as_array().map_or_else(|| one(kinds), |kinds| kinds.iter().any(one))
}

fn mistakes(report: &Value) -> Vec<String> {
    let (schema, mut found) = (schema(), Vec::new());
    wrong(report, &schema, &schema, "report", &mut found);
    found
}

fn loft(arguments: &[&str]) -> Value {
    let out = Command::new(env!("CARGO_BIN_EXE_loft")).args(arguments).output().unwrap();
    serde_json::from_slice(&out.stdout).unwrap_or_else(|e| panic!("{e} {arguments:?}\n{}", String::from_utf8_lossy(&out.stderr)))
}

/// A script in a folder of its own, which goes when the test ends.
struct Script(PathBuf);

impl Script {
    fn new(name: &str, text: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("loft-report-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        fs::write(folder.join("model.loft"), text).unwrap();
        Self(folder)
    }
    fn run(&self, arguments: &[&str]) -> Value {
        let model = self.0.join("model.loft").display().to_string();
        loft(&[&[arguments[0], model.as_str(), "--json"], &arguments[1..]].concat())
    }
}

impl Drop for Script {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

#[test]
fn the_report_of_every_example_has_the_shape_that_is_stated() {
    let mut models: Vec<PathBuf> = fs::read_dir("examples").unwrap().map(|entry| entry.unwrap().path()).collect();
    models.retain(|path| path.extension().is_some_and(|ending| ending == "loft"));
    models.sort();
    let names: Vec<String> = models.iter().map(|path| path.display().to_string()).collect();
    assert!(names.len() > 8);
    let all = loft(&[&["check"], names.iter().map(String::as_str).collect::<Vec<_>>().as_slice(), &["--json"]].concat());
    assert_eq!(mistakes(&all), Vec::<String>::new());
    let cases = all["cases"].as_array().unwrap();
    assert_eq!(cases.len(), names.len());
    // Every list of the schema has at least one row among the examples, but for diagnostics and renamings.
    for list in ["modeling", "curves", "surfaces", "shells", "meshes", "checks", "reports"] {
        assert!(cases.iter().any(|case| case[list].as_array().is_some_and(|rows| !rows.is_empty())), "{list}");
    }
}

#[test]
fn the_shape_is_told_from_others() {
    let script = Script::new("shape", "units m\ncurve a = line((0, 0), (1, 0))\ncheck a.length == 2m within 1mm\n");
    let report = script.run(&["run"]);
    assert_eq!(mistakes(&report), Vec::<String>::new());
    for (path, value) in
        [("/loft", "2"), ("/ok", "\"yes\""), ("/curves/0/links", "-1"), ("/diagnostics/0/code", "\"X1\""), ("/checks/0/line", "1.5")]
    {
        let mut other = report.clone();
        *other.pointer_mut(path).unwrap() = serde_json::from_str(value).unwrap();
        assert!(!mistakes(&other).is_empty(), "{path}");
    }
    let mut other = report.clone();
    other.as_object_mut().unwrap().insert("further".into(), Value::Null);
    assert!(!mistakes(&other).is_empty());
    other = report;
    other.as_object_mut().unwrap().remove("renamed");
    assert!(!mistakes(&other).is_empty());
}

#[test]
fn what_waits_for_a_mesh_that_failed_names_it() {
    let text = "units mm\nsurface bow = ruled(line((0, 0, 0), (10, 0, 0)), line((0, 10, 0), (10, -100, 0)))\n\
        mesh m of bow { size: 50mm  method: isoline }\ncheck len(m.triangles) > 0\nreport \"nodes\": len(m.nodes)\n";
    let report = Script::new("waits", text).run(&["check"]);
    let row = |row: &Value| (row["what"].as_str().unwrap().to_owned(), row["because"].as_str().map(str::to_owned));
    let unmade: Vec<_> = report["unmade"].as_array().unwrap().iter().map(row).collect();
    let waits = |what: &str| (what.to_owned(), Some("m".to_owned()));
    assert_eq!(unmade, [("mesh".to_owned(), None), waits("check"), waits("report")]);
}

const KOREAN: &str = r#"units m
curve s = line((0, 0), (2, 0))
curve n = line((0, 1), (2, 1))
surface 지붕 = ruled(s, n)
surface 벽 = ruled(n, move(n, by: (0, 0, 1)))
group 모서리 of s
mesh m of 지붕, 벽 { size: 500mm }
export m to "roof.inp"
export m to "roof.vtu"
"#;

#[test]
fn names_that_a_format_changes_stand_in_a_table() {
    let script = Script::new("renamed", KOREAN);
    let report = script.run(&["run"]);
    assert_eq!(mistakes(&report), Vec::<String>::new());
    let row = |from: &str, to: &str| serde_json::json!({ "path": "roof.inp", "from": from, "to": to });
    let expected = [row("지붕", "jibung"), row("벽", "byeok"), row("모서리", "moseori")];
    assert_eq!(report["renamed"].as_array().unwrap(), &expected);
    let deck = fs::read_to_string(script.0.join("roof.inp")).unwrap();
    assert!(deck.contains("** set jibung: 지붕\n") && deck.contains("ELSET=byeok\n"), "{deck}");
}

/// What a screen tells as one report "and 39 more like this one" stands in the report in its own words.
#[test]
fn reports_that_a_screen_folds_are_all_there() {
    let pairs = "curve a for i in 0..40 = line((i, 0), (i, 1))\ncurve b for i in 0..40 = line((i, 1.002 + i * 1e-5), (i, 2))\n";
    let script = Script::new("folded", &format!("units m\ntolerance 1mm\n{pairs}"));
    let report = script.run(&["check"]);
    assert_eq!(mistakes(&report), Vec::<String>::new());
    let said = report["diagnostics"].as_array().unwrap();
    assert!(said.iter().all(|row| !row["message"].as_str().unwrap().contains("more like this")));
    assert_eq!(said.iter().map(|row| row["count"].as_u64().unwrap()).sum::<u64>(), 40);
    let mut messages: Vec<&str> = said.iter().map(|row| row["message"].as_str().unwrap()).collect();
    messages.sort_unstable();
    messages.dedup();
    assert_eq!(messages.len(), 40);
}

/// Every member that the reference lists for a kind stands in the report of a thing of that kind, with its unit; the sides of a surface,
/// which are curves, do not.
#[test]
fn an_entity_tells_all_of_its_members() {
    let base = "units m\ncurve south = line((0, 0, 0), (4, 0, 0))\nsurface wall = extrude(south, by: (0, 0, 3))\n\
        surface side = extrude(line((0, 0, 0), (0, 2, 0)), by: (0, 0, 3))\nshell hall of wall, side\nmesh fine of hall { size: 1m }\n";
    let things = [
        ("curve", "south"),
        ("surface", "wall"),
        ("edge", "wall.edge(south.start)"),
        ("patch", "wall.patches[0]"),
        ("vertex", "wall.vertices[0]"),
        ("shell", "hall"),
        ("mesh", "fine"),
        ("network", "network"),
        ("vector", "south.mid"),
    ];
    for (kind, thing) in things {
        let script = Script::new(&format!("told-{kind}"), &format!("{base}report {thing}\nreport [{thing}, south]\n"));
        let report = script.run(&["check"]);
        assert_eq!(mistakes(&report), Vec::<String>::new());
        let rows = report["reports"][0]["rows"].as_array().unwrap();
        let columns = report["reports"][1]["columns"].as_array().unwrap();
        let is_side = |returns: &str| kind == "surface" && returns == "curve";
        let members: Vec<_> = fields().filter(|f| f.params[0].ty.signature() == kind && !is_side(&f.returns.signature())).collect();
        assert!(!members.is_empty(), "{kind}");
        for member in members {
            let named = |text: &Value| {
                let text = text.as_str().unwrap();
                text == member.name || text.starts_with(&format!("{}.", member.name))
            };
            let row = rows.iter().find(|row| named(&row[0])).unwrap_or_else(|| panic!("{kind} does not tell `{}`", member.name));
            assert!(columns.iter().any(|column| named(&column["name"])), "{kind} in a list does not tell `{}`", member.name);
            // What a thing does not have is without a unit.
            if row[1].is_null() || row[1] == "none" {
                continue;
            }
            let unit = match member.returns.signature().as_str() {
                "length" | "point" | "node" => "m",
                "area" => "m2",
                "angle" => "deg",
                _ => continue,
            };
            assert_eq!(row[2], unit, "{kind}.{}", member.name);
        }
    }
}
