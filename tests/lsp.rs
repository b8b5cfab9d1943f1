//! The language server as an editor talks to it: messages over standard input and output.

use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use crate::support::long::count;

/// How long a server may take on a loaded machine.
const PATIENCE: Duration = Duration::from_secs(60);

struct Editor {
    child: Child,
    to: ChildStdin,
    from: BufReader<ChildStdout>,
    next: i64,
    notes: Vec<Value>,
}

impl Editor {
    fn start() -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_loft"))
            .args(["lsp", "--stdio"])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::inherit())
            .spawn()
            .unwrap();
        let (to, from) = (child.stdin.take().unwrap(), BufReader::new(child.stdout.take().unwrap()));
        let mut editor = Self { child, to, from, next: 0, notes: Vec::new() };
        let answer = editor.ask("initialize", json!({ "capabilities": {}, "processId": null, "rootUri": null }));
        assert_eq!(answer["capabilities"]["positionEncoding"], "utf-16");
        editor.tell("initialized", json!({}));
        editor
    }

    fn send(&mut self, message: &Value) {
        let text = message.to_string();
        write!(self.to, "Content-Length: {}\r\n\r\n{text}", text.len()).unwrap();
        self.to.flush().unwrap();
    }

    fn tell(&mut self, method: &str, params: Value) {
        self.send(&json!({ "jsonrpc": "2.0", "method": method, "params": params }));
    }

    fn receive(&mut self) -> Value {
        let mut length = 0;
        loop {
            let mut line = String::new();
            assert!(self.from.read_line(&mut line).unwrap() > 0, "the server has gone");
            match line.trim() {
                "" => break,
                line => length = line.strip_prefix("Content-Length: ").unwrap().parse().unwrap(),
            }
        }
        let mut bytes = vec![0; length];
        self.from.read_exact(&mut bytes).unwrap();
        serde_json::from_slice(&bytes).unwrap()
    }

    fn whole(&mut self, method: &str, params: Value) -> Value {
        self.next += 1;
        let id = self.next;
        self.send(&json!({ "jsonrpc": "2.0", "id": id, "method": method, "params": params }));
        loop {
            let message = self.receive();
            if message["id"] == id {
                return message;
            }
            self.notes.push(message);
        }
    }

    fn ask(&mut self, method: &str, params: Value) -> Value {
        let mut answer = self.whole(method, params);
        assert!(answer.get("error").is_none(), "{method}: {answer}");
        answer["result"].take()
    }

    /// Diagnostics of a version of a file; a server that never sends them is asked something that it must answer.
    fn diagnostics(&mut self, uri: &str, version: i64) -> Vec<Value> {
        let started = Instant::now();
        loop {
            let fits = |n: &Value| {
                n["method"] == "textDocument/publishDiagnostics" && n["params"]["uri"] == uri && n["params"]["version"] == version
            };
            if let Some(found) = self.notes.iter().find(|n| fits(n)) {
                return found["params"]["diagnostics"].as_array().unwrap().clone();
            }
            assert!(started.elapsed() < PATIENCE, "no diagnostics of version {version} came");
            let _ = self.whole("textDocument/foldingRange", json!({ "textDocument": { "uri": uri } }));
            std::thread::sleep(Duration::from_millis(30));
        }
    }

    /// The newest diagnostics of a version, once they are as wanted.
    fn last_diagnostics(&mut self, uri: &str, version: i64, wanted: impl Fn(&[Value]) -> bool) -> Vec<Value> {
        let started = Instant::now();
        loop {
            let fits = |n: &&Value| {
                n["method"] == "textDocument/publishDiagnostics" && n["params"]["uri"] == uri && n["params"]["version"] == version
            };
            let newest = self.notes.iter().rev().find(fits).map(|n| n["params"]["diagnostics"].as_array().unwrap().clone());
            match newest {
                Some(said) if wanted(&said) => return said,
                other => assert!(started.elapsed() < PATIENCE, "of version {version} came {other:?}"),
            }
            let _ = self.whole("textDocument/foldingRange", json!({ "textDocument": { "uri": uri } }));
            std::thread::sleep(Duration::from_millis(30));
        }
    }

    /// What is said of a version once its meshes are made as well.
    fn settled(&mut self, uri: &str, version: i64) -> Vec<Value> {
        let started = Instant::now();
        loop {
            let fits = |n: &&Value| {
                n["method"] == "textDocument/publishDiagnostics" && n["params"]["uri"] == uri && n["params"]["version"] == version
            };
            // First values alone, then all.
            if let Some(found) = self.notes.iter().filter(fits).nth(1) {
                return found["params"]["diagnostics"].as_array().unwrap().clone();
            }
            assert!(started.elapsed() < PATIENCE, "version {version} did not settle");
            let message = self.receive();
            self.notes.push(message);
        }
    }

    fn open(&mut self, uri: &str, text: &str) {
        self.tell("textDocument/didOpen", json!({ "textDocument": { "uri": uri, "languageId": "loft", "version": 1, "text": text } }));
    }

    fn at(&mut self, method: &str, uri: &str, line: usize, character: usize) -> Value {
        self.ask(method, json!({ "textDocument": { "uri": uri }, "position": { "line": line, "character": character } }))
    }

    /// The hover at a place, asked for until it is as wanted.
    fn hover_that(&mut self, uri: &str, (line, character): (usize, usize), wanted: impl Fn(&str) -> bool) -> String {
        let started = Instant::now();
        loop {
            let said = self.at("textDocument/hover", uri, line, character);
            let text = said["contents"]["value"].as_str().unwrap_or("").to_owned();
            if wanted(&text) {
                return text;
            }
            assert!(started.elapsed() < Duration::from_secs(60), "{text}");
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    fn of(&mut self, method: &str, uri: &str) -> Value {
        self.ask(method, json!({ "textDocument": { "uri": uri } }))
    }

    fn stop(mut self) {
        self.ask("shutdown", Value::Null);
        self.tell("exit", Value::Null);
        drop(self.to);
        assert!(self.child.wait().unwrap().success());
    }
}

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("lsp-{name}"));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder.canonicalize().unwrap()
}

const MODEL: &str = "units m
/// The front edge.
curve south = line((0, 0, 0), (4, 0, 0))
curve east = line((4, 0, 0), (4, 3, 0))
curve north = line((0, 3, 0), (4, 3, 0))
curve west = line((0, 0, 0), (0, 3, 0))
surface roof = coons(south, east, north, west)
mesh fine of roof { size: 500mm }
check \"area\": area(roof) == 12m2 within 0.1%
";

#[test]
fn an_editor_is_told_what_is_wrong_while_typing() {
    let mut editor = Editor::start();
    let uri = "file:///nowhere/typed.loft";
    editor.open(uri, MODEL);
    assert_eq!(editor.diagnostics(uri, 1), Vec::<Value>::new());
    // `south` is misspelt in the surface: line 6, columns 21 to 26.
    let range = json!({ "start": { "line": 6, "character": 21 }, "end": { "line": 6, "character": 26 } });
    let change = json!({ "textDocument": { "uri": uri, "version": 2 }, "contentChanges": [{ "range": range, "text": "sotuh" }] });
    editor.tell("textDocument/didChange", change);
    let said = editor.diagnostics(uri, 2);
    assert_eq!((said.len(), &said[0]["code"], &said[0]["severity"]), (1, &json!("E201"), &json!(1)));
    assert_eq!(said[0]["range"], range);
    let actions =
        editor.ask("textDocument/codeAction", json!({ "textDocument": { "uri": uri }, "range": range, "context": { "diagnostics": [] } }));
    assert_eq!(actions[0]["edit"]["changes"][uri][0]["newText"], "south");
    let change = json!({ "textDocument": { "uri": uri, "version": 3 }, "contentChanges": [{ "range": range, "text": "south" }] });
    editor.tell("textDocument/didChange", change);
    assert_eq!(editor.diagnostics(uri, 3), Vec::<Value>::new());
    let titles = lenses(&mut editor, uri);
    assert!(titles.contains(&"1 check passes".to_owned()), "{titles:?}");
    assert!(titles.iter().any(|t| t.contains("12 m2")), "{titles:?}");
    editor.stop();
}

#[test]
fn meshes_are_told_and_checked() {
    let mut editor = Editor::start();
    let uri = "file:///nowhere/meshed.loft";
    let text = format!("{MODEL}check \"fine enough\": fine.min_angle > 50deg\n");
    editor.open(uri, &text);
    // A hover tells a mesh once it is made, and does not wait for it.
    let hover = editor.hover_that(uri, (7, 6), |text| text.contains("nodes"));
    assert!(hover.contains("mesh fine: 63 nodes, 96 triangles, quality 0.8") && hover.contains("angles 45.0° to 90.0°"), "{hover}");
    let titles: Vec<String> = lenses(&mut editor, uri);
    assert!(titles.contains(&"1 of 2 checks pass".to_owned()), "{titles:?}");
    assert!(titles.iter().any(|t| t.starts_with("63 nodes, 96 triangles, quality")), "{titles:?}");
    // A fault of the mesher shows while the text rests, and goes at once when the text is mended.
    let change =
        |version: i64, text: &str| json!({ "textDocument": { "uri": uri, "version": version }, "contentChanges": [{ "text": text }] });
    let wrong = format!("{MODEL}mesh rough of roof {{ chord_error: 1mm  on south {{ count: 3 }}  on north {{ count: 5 }} }}\n");
    editor.tell("textDocument/didChange", change(2, &wrong));
    let said = editor.last_diagnostics(uri, 2, |said| !said.is_empty());
    assert_eq!(said[0]["code"], "E702", "{said:?}");
    editor.tell("textDocument/didChange", change(3, MODEL));
    assert_eq!(editor.diagnostics(uri, 3), Vec::<Value>::new());
    editor.stop();
}

fn lenses(editor: &mut Editor, uri: &str) -> Vec<String> {
    let lenses = editor.of("textDocument/codeLens", uri);
    lenses.as_array().unwrap().iter().map(|l| l["command"]["title"].as_str().unwrap().to_owned()).collect()
}

/// A model that takes long to mesh.
const LONG: &str = "units m
curve a = spline([(0, 0, 0), (1, 0, 0.3), (2, 0, 0)])
curve c = spline([(0, 2, 0), (1, 2, 0.5), (2, 2, 0)])
surface s = ruled(a, c)
mesh huge of s { size: 0.4mm }
";

#[test]
fn requests_are_answered_while_a_model_is_meshed() {
    let mut editor = Editor::start();
    let uri = "file:///nowhere/long.loft";
    editor.open(uri, LONG);
    assert_eq!(editor.diagnostics(uri, 1), Vec::<Value>::new());
    std::thread::sleep(Duration::from_millis(500));
    let started = Instant::now();
    let hover = editor.at("textDocument/hover", uri, 4, 6)["contents"]["value"].as_str().unwrap().to_owned();
    assert!(hover.contains("mesh huge") && hover.contains("Not meshed yet"), "{hover}");
    assert!(!editor.of("textDocument/semanticTokens/full", uri)["data"].as_array().unwrap().is_empty());
    assert!(editor.at("textDocument/hover", uri, 3, 9)["contents"]["value"].as_str().unwrap().contains("surface s"));
    // What needs the model as it stands waits for it: two requests behind a change, of which one is taken back.
    let change =
        |version: i64, text: &str| json!({ "textDocument": { "uri": uri, "version": version }, "contentChanges": [{ "text": text }] });
    editor.tell("textDocument/didChange", change(2, "let a = 1\n"));
    let ask =
        |id: i64| json!({ "jsonrpc": "2.0", "id": id, "method": "textDocument/codeLens", "params": { "textDocument": { "uri": uri } } });
    editor.send(&ask(7001));
    editor.send(&ask(7002));
    editor.tell("$/cancelRequest", json!({ "id": 7001 }));
    editor.tell("textDocument/didChange", change(3, "let a = b\n"));
    assert_eq!(editor.diagnostics(uri, 3)[0]["code"], "E201");
    assert!(started.elapsed() < Duration::from_secs(20), "the mesh was waited for");
    let code = |id: i64| editor.notes.iter().find(|n| n["id"] == id).map(|n| n["error"]["code"].clone());
    // Taken back, and out of date.
    assert_eq!((code(7001), code(7002)), (Some(json!(-32800)), Some(json!(-32801))));
    editor.stop();
}

#[test]
fn scripts_that_use_each_other_are_read_as_they_stand() {
    let folder = folder("unsaved");
    for (name, text) in [("a.loft", "use \"b.loft\" as b\nlet x = b.height\n"), ("b.loft", "let height = 2\n")] {
        fs::write(folder.join(name), text).unwrap();
    }
    let uri = |name: &str| format!("file://{}", folder.join(name).display());
    let (a, b) = (uri("a.loft"), uri("b.loft"));
    let mut editor = Editor::start();
    editor.open(&a, &fs::read_to_string(folder.join("a.loft")).unwrap());
    editor.open(&b, "let height = 3\n");
    let value = |editor: &mut Editor, wanted: &str| editor.hover_that(&a, (1, 4), |text| text.contains(wanted));
    assert!(value(&mut editor, "let x: 3").contains("let x: 3"));
    // Renaming from where it is used, in the text as it stands.
    let change =
        |version: i64, text: &str| json!({ "textDocument": { "uri": b, "version": version }, "contentChanges": [{ "text": text }] });
    editor.tell("textDocument/didChange", change(2, "/* 😀 */ let height = 4\n"));
    let rename = json!({ "textDocument": { "uri": a }, "position": { "line": 1, "character": 11 }, "newName": "rise" });
    let edits = editor.ask("textDocument/rename", rename.clone());
    assert_eq!(edits["changes"][&b][0]["range"]["start"], json!({ "line": 0, "character": 13 }));
    assert_eq!(edits["changes"][&a][0]["range"]["start"], json!({ "line": 1, "character": 10 }));
    assert!(value(&mut editor, "let x: 4").contains("Type: number"));
    // Each uses the other: told, in both.
    editor.tell("textDocument/didChange", change(3, "use \"a.loft\" as a\nlet height = a.x\n"));
    assert!(editor.last_diagnostics(&a, 1, |said| !said.is_empty()).iter().any(|d| d["code"] == "E809"));
    assert!(editor.diagnostics(&b, 3).iter().any(|d| d["code"] == "E809"));
    // Closed, the file on the disk counts again; deleted, there is none.
    editor.tell("textDocument/didClose", json!({ "textDocument": { "uri": b } }));
    assert_eq!(editor.last_diagnostics(&a, 1, <[Value]>::is_empty), Vec::<Value>::new());
    assert!(value(&mut editor, "let x: 2").contains("let x: 2"));
    fs::remove_file(folder.join("b.loft")).unwrap();
    fs::remove_file(folder.join("a.loft")).unwrap();
    editor.tell("workspace/didChangeWatchedFiles", json!({ "changes": [] }));
    assert!(editor.last_diagnostics(&a, 1, |said| !said.is_empty()).iter().any(|d| d["code"] == "E801"));
    let own = json!({ "textDocument": { "uri": a }, "position": { "line": 1, "character": 4 }, "newName": "y" });
    assert_eq!(editor.ask("textDocument/rename", own)["changes"][&a].as_array().unwrap().len(), 1);
    assert!(editor.whole("textDocument/rename", rename).get("error").is_some());
    editor.stop();
}

#[test]
fn large_and_strange_texts_are_served() {
    let mut editor = Editor::start();
    let uri = "file:///nowhere/large.loft";
    let line = format!("let wide = [{}\"😀\"]", "\"a😀\", ".repeat(90_000));
    editor.open(uri, &line);
    let started = Instant::now();
    let colours = editor.of("textDocument/semanticTokens/full", uri);
    let data: Vec<u64> = colours["data"].as_array().unwrap().iter().map(|n| n.as_u64().unwrap()).collect();
    let last: u64 = data.chunks(5).map(|c| c[1]).sum();
    assert_eq!(last as usize, line.encode_utf16().count() - 1);
    for method in ["documentSymbol", "foldingRange", "formatting"] {
        editor.of(&format!("textDocument/{method}"), uri);
    }
    // Ranges out of order, beyond the end, inside a letter and inside a line end; all in one message.
    let place = |line: u64, character: u64| json!({ "line": line, "character": character });
    let put = |from: Value, to: Value, text: &str| json!({ "range": { "start": from, "end": to }, "text": text });
    let changes = [
        json!({ "text": "let a = \"😀\"\r\n\tlet b = a\rlet c = 1" }),
        put(place(2, 9), place(2, 3), "!"),
        put(place(0, 10), place(0, 10), "x"),
        put(place(0, 400), place(0, 500), " // tail"),
        put(place(77, 0), place(99, 9), "\r\nlet d = lost"),
    ];
    editor.tell("textDocument/didChange", json!({ "textDocument": { "uri": uri, "version": 2 }, "contentChanges": changes }));
    let said = editor.diagnostics(uri, 2);
    assert!(said.iter().any(|d| d["range"]["start"]["line"] == 3 && d["message"].as_str().unwrap().contains("lost")), "{said:?}");
    assert!(started.elapsed() < Duration::from_secs(40));
    editor.stop();
}

#[test]
fn a_body_that_is_no_message_is_answered() {
    let mut editor = Editor::start();
    for (body, code) in [("{nonsense", -32700), ("[1, 2]", -32600)] {
        write!(editor.to, "Content-Length: {}\r\n\r\n{body}", body.len()).unwrap();
        editor.to.flush().unwrap();
        assert_eq!(editor.receive()["error"]["code"], code, "{body}");
    }
    editor.ask("shutdown", Value::Null);
    editor.tell("exit", Value::Null);
    assert_eq!(editor.child.wait().unwrap().code(), Some(0));
}

#[test]
fn the_end_of_a_session_is_clean() {
    // Requests behind `shutdown` are refused, `exit` ends it.
    let mut editor = Editor::start();
    editor.ask("shutdown", Value::Null);
    assert_eq!(editor.whole("textDocument/hover", json!({}))["error"]["code"], -32600);
    editor.tell("textDocument/didOpen", json!({ "textDocument": { "uri": "untitled:2", "version": 1, "text": "" } }));
    editor.tell("exit", Value::Null);
    assert_eq!(editor.child.wait().unwrap().code(), Some(0));
    // `exit` without `shutdown` is an error by the protocol; a pipe that closes is the end of the session.
    let mut editor = Editor::start();
    editor.open("file:///nowhere/left.loft", LONG);
    editor.tell("exit", Value::Null);
    assert_eq!(editor.child.wait().unwrap().code(), Some(1));
    let mut editor = Editor::start();
    editor.ask("shutdown", Value::Null);
    drop(editor.to);
    assert_eq!(editor.child.wait().unwrap().code(), Some(0));
}

#[test]
fn words_are_explained_and_completed() {
    let mut editor = Editor::start();
    let uri = "file:///nowhere/words.loft";
    editor.open(uri, MODEL);
    let hover = |v: Value| v["contents"]["value"].as_str().unwrap_or_default().to_owned();
    let text = editor.hover_that(uri, (6, 22), |text| text.contains("1 link"));
    assert!(text.contains("curve south: line, 4 m, 1 link") && text.contains("The front edge."), "{text}");
    assert!(hover(editor.at("textDocument/hover", uri, 6, 17)).contains("coons(curves: curve…"));
    assert!(hover(editor.at("textDocument/hover", uri, 7, 21)).starts_with("```text\nsize: "));
    assert!(hover(editor.at("textDocument/hover", uri, 2, 2)).contains("curve"));
    assert_eq!(editor.at("textDocument/hover", uri, 2, 25), Value::Null);
    let labels = |v: Value| v.as_array().unwrap().iter().map(|i| i["label"].as_str().unwrap().to_owned()).collect::<Vec<_>>();
    assert!(labels(editor.at("textDocument/completion", uri, 6, 23)).contains(&"south".to_owned()));
    let signature = editor.at("textDocument/signatureHelp", uri, 2, 33);
    assert_eq!((&signature["activeParameter"], &signature["signatures"][0]["parameters"][1]["label"]), (&json!(1), &json!("to")));
    let names: Vec<Value> = editor.of("textDocument/documentSymbol", uri).as_array().unwrap().iter().map(|s| s["name"].clone()).collect();
    assert_eq!(&names[1..4], ["south", "east", "north"]);
    let colours = editor.of("textDocument/semanticTokens/full", uri);
    let data: Vec<u64> = colours["data"].as_array().unwrap().iter().map(|n| n.as_u64().unwrap()).collect();
    assert_eq!((&data[..5], data.len() % 5), ([0, 0, 5, 0, 0].as_slice(), 0));
    editor.stop();
}

#[test]
fn names_are_found_and_changed_across_files() {
    let folder = folder("names");
    fs::write(folder.join("ribs.loft"), "units m\ncurve arch = line((0, 0, 0), (1, 0, 0))\n").unwrap();
    fs::write(
        folder.join("hall.loft"),
        "units m\nuse \"ribs.loft\" as ribs\ncurve a = ribs.arch\nlet i = 2\nlet b = [for i in 0..3: i]\nlet c = i\n",
    )
    .unwrap();
    let uri = |name: &str| format!("file://{}", folder.join(name).display());
    let (hall, ribs) = (uri("hall.loft"), uri("ribs.loft"));
    let mut editor = Editor::start();
    for (uri, name) in [(&hall, "hall.loft"), (&ribs, "ribs.loft")] {
        editor.open(uri, &fs::read_to_string(folder.join(name)).unwrap());
        assert_eq!(editor.diagnostics(uri, 1), Vec::<Value>::new());
    }
    let found = editor.at("textDocument/definition", &hall, 2, 16);
    assert_eq!((&found["uri"], &found["range"]["start"]), (&json!(ribs), &json!({ "line": 1, "character": 6 })));
    // The outer `i` is said twice, the inner one twice.
    let uses = editor.at("textDocument/references", &hall, 5, 8);
    assert_eq!(uses.as_array().unwrap().len(), 2);
    let rename = |name: &str| json!({ "textDocument": { "uri": ribs }, "position": { "line": 1, "character": 7 }, "newName": name });
    let edits = editor.ask("textDocument/rename", rename("bow"));
    assert_eq!((edits["changes"][&ribs].as_array().unwrap().len(), edits["changes"][&hall].as_array().unwrap().len()), (1, 1));
    for bad in ["curve", "a b", "", "1a", "x) = ("] {
        assert!(editor.whole("textDocument/rename", rename(bad)).get("error").is_some(), "{bad:?} was taken");
    }
    editor.stop();
}

#[test]
fn a_param_is_renamed_in_the_scripts_that_give_it() {
    let folder = folder("params");
    fs::create_dir_all(folder.join("parts/deep")).unwrap();
    let texts = [
        ("parts/deep/rib.loft", "units m\nparam rise = 3m\nlet top = rise\n"),
        ("parts/frame.loft", "use \"deep/rib.loft\" (rise: 2m) as rib\nlet a = rib.rise\n"),
        (
            "hall.loft",
            "use \"parts/frame.loft\" as frame\nuse \"parts/deep/rib.loft\" (rise: 4m) as own\nlet b = frame.rib.rise + own.rise\nlet rise = 1m\n",
        ),
    ];
    for (name, text) in texts {
        fs::write(folder.join(name), text).unwrap();
    }
    let uri = |name: &str| format!("file://{}", folder.join(name).display());
    let mut editor = Editor::start();
    editor.open(&uri("hall.loft"), texts[2].1);
    // From the argument of `use`.
    let at = json!({ "textDocument": { "uri": uri("hall.loft") }, "position": { "line": 1, "character": 29 }, "newName": "crown" });
    let edits = editor.ask("textDocument/rename", at);
    let places = |name: &str| -> Vec<(u64, u64)> {
        let list = edits["changes"][uri(name)].as_array().unwrap();
        list.iter().map(|e| (e["range"]["start"]["line"].as_u64().unwrap(), e["range"]["start"]["character"].as_u64().unwrap())).collect()
    };
    assert_eq!(places("parts/deep/rib.loft"), [(1, 6), (2, 10)]);
    assert_eq!(places("parts/frame.loft"), [(0, 21), (1, 12)]);
    // The name of the same text in the script itself stays.
    assert_eq!(places("hall.loft"), [(1, 27), (2, 18), (2, 29)]);
    let found = editor.at("textDocument/definition", &uri("hall.loft"), 2, 19);
    assert_eq!((&found["uri"], &found["range"]["start"]["line"]), (&json!(uri("parts/deep/rib.loft")), &json!(1)));
    editor.stop();
}

#[test]
fn help_follows_the_place() {
    let mut editor = Editor::start();
    let uri = "file:///nowhere/place.loft";
    let text = format!("{MODEL}mesh m of roof {{ elements: \nlet a = roof.\n");
    editor.open(uri, &text);
    let offered = |v: Value| v.as_array().unwrap().iter().map(|i| i["label"].as_str().unwrap().to_owned()).collect::<Vec<_>>();
    let members = offered(editor.at("textDocument/completion", uri, 10, 13));
    assert!(members.contains(&"patches".to_owned()) && !members.contains(&"kinks".to_owned()), "{members:?}");
    assert_eq!(offered(editor.at("textDocument/completion", uri, 9, 27))[..3], ["mixed", "quads", "triangles"]);
    // A blank opens the list where words are asked for alone.
    let blank = |editor: &mut Editor, line: u64, character: u64| {
        let at = json!({ "textDocument": { "uri": uri }, "position": { "line": line, "character": character }, "context": { "triggerKind": 2, "triggerCharacter": " " } });
        offered(editor.ask("textDocument/completion", at)).len()
    };
    assert!(blank(&mut editor, 9, 27) >= 3 && blank(&mut editor, 6, 15) == 0);
    editor.stop();
}

#[test]
fn a_hover_tells_the_last_mesh_and_that_it_is_old() {
    let mut editor = Editor::start();
    let uri = "file:///nowhere/stale.loft";
    editor.open(uri, MODEL);
    let mesh = editor.hover_that(uri, (7, 6), |text| text.contains("63 nodes"));
    assert!(!mesh.contains("Stale"), "{mesh}");
    // With a mesh in the text that takes long the other is not made anew for long.
    let long = format!("{MODEL}{}", LONG.trim_start_matches("units m\n").replace("surface s", "surface t").replace("of s", "of t"));
    editor.tell("textDocument/didChange", json!({ "textDocument": { "uri": uri, "version": 2 }, "contentChanges": [{ "text": long }] }));
    let started = Instant::now();
    let mesh = editor.hover_that(uri, (7, 6), |text| text.contains("63 nodes"));
    assert!(mesh.contains("Stale") && started.elapsed() < Duration::from_secs(10), "{mesh}");
    editor.stop();
}

#[test]
fn scripts_are_laid_out_and_strange_requests_survived() {
    let mut editor = Editor::start();
    let uri = "untitled:1";
    editor.open(uri, "curve   a=line( (0,0,0),(1,0,0) )\n");
    let edits = editor.of("textDocument/formatting", uri);
    assert_eq!(edits[0]["newText"], "curve a = line((0, 0, 0), (1, 0, 0))\n");
    assert!(editor.whole("textDocument/hover", json!({ "textDocument": { "uri": "file:///other" } })).get("error").is_some());
    assert!(editor.whole("workspace/nothing", json!({ "textDocument": { "uri": uri } })).get("error").is_some());
    let far = json!({ "line": 4_000_000_000u64, "character": 4_000_000_000u64 });
    for method in ["hover", "definition", "references", "completion", "signatureHelp"] {
        editor.ask(&format!("textDocument/{method}"), json!({ "textDocument": { "uri": uri }, "position": far }));
    }
    let range = json!({ "start": far, "end": { "line": 0, "character": 0 } });
    let change = json!({ "textDocument": { "uri": uri, "version": 2 }, "contentChanges": [{ "range": range, "text": "지붕 (((" }, { "text": "let 지붕 = [" }] });
    editor.tell("textDocument/didChange", change);
    let said = editor.diagnostics(uri, 2);
    assert_eq!(said[0]["code"], "E101");
    editor.stop();
}

/// `LOFT_ACCEPT=1` writes the grammar for editors that colour by patterns.
#[test]
fn the_grammar_of_editors_is_current() {
    let said = Command::new(env!("CARGO_BIN_EXE_loft")).args(["doc", "--textmate"]).output().unwrap();
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("editors/vscode/syntaxes/loft.tmLanguage.json");
    if std::env::var_os("LOFT_ACCEPT").is_some() {
        fs::write(&path, &said.stdout).unwrap();
    }
    let kept = fs::read(&path).unwrap();
    assert!(said.stdout == kept, "the grammar is not current: LOFT_ACCEPT=1 cargo test the_grammar_of_editors");
    let package: Value = serde_json::from_slice(&fs::read(path.parent().unwrap().with_file_name("package.json")).unwrap()).unwrap();
    assert_eq!(package["version"], env!("CARGO_PKG_VERSION"));
}

/// Numbers that come one after another, the same in every run.
struct Dice(u64);

impl Dice {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) % n.max(1) as u64) as usize
    }
}

/// Line and UTF-16 column of a byte, counted as the protocol says, letter by letter.
fn position(text: &str, byte: usize) -> Value {
    let (mut line, mut column) = (0, 0);
    let mut letters = text[..byte].chars().peekable();
    while let Some(c) = letters.next() {
        let ends = c == '\n' || c == '\r' && letters.peek() != Some(&'\n') && !(letters.peek().is_none() && text[byte..].starts_with('\n'));
        (line, column) = if ends { (line + 1, 0) } else { (line, column + c.len_utf16()) };
    }
    json!({ "line": line, "character": column })
}

/// Codes and places of all that a run from nothing says about a text.
fn said_from_nothing(text: &str) -> Vec<(String, Value)> {
    use lofting::base::job::Job;
    use lofting::session::disk::{Disk, Outputs};
    use lofting::session::run::{Task, run};
    let disk = Disk::new(None, None, &[], Outputs::Counted).unwrap();
    let task = Task {
        name: "edited.loft",
        text: text.as_bytes(),
        shared: None,
        sets: &[],
        row: None,
        strict: false,
        keep_going: false,
        full: false,
        curves: true,
        picture: None,
        clock: &|| 0.0,
    };
    let outcome = lofting::session::guard::guarded(|| run(&task, &disk, &Job::new())).unwrap();
    let place = |d: &lofting::lang::diag::diagnostic::Diagnostic| position(text, d.labels.first().map_or(0, |l| l.span.start as usize));
    outcome.diagnostics.iter().map(|d| (d.code.0.to_owned(), place(d))).collect()
}

/// Things that are typed.
const TYPED: [&str; 24] = [
    "(",
    ")",
    "[",
    "]",
    "{",
    "}",
    "\"",
    "/*",
    "*/",
    "// ",
    "\n",
    "\r\n",
    "😀",
    "지붕",
    " = ",
    ", ",
    ": ",
    "let k = 2m\n",
    "south",
    "-",
    "3",
    "curve ",
    "check area(roof) > 1m2\n",
    "on south { count: 3 }",
];

/// Random edits in bursts, as fast as they can be sent; when the text rests, what is said of it is what a run from
/// nothing says. 300 edits, 10 000 in a long run; `LOFT_EDITS` says how many.
#[test]
fn random_edits_leave_nothing_stale() {
    let edits = count("LOFT_EDITS", 300, 10_000);
    let (mut editor, mut dice, uri) = (Editor::start(), Dice(7), "untitled:edited.loft");
    editor.open(uri, MODEL);
    let (mut text, mut version, mut sound) = (MODEL.to_owned(), 1, 0);
    for burst in 0..edits / 20 {
        for k in 0..20 {
            let mut changes = Vec::new();
            if k == 0 && burst % 3 > 0 {
                text = MODEL.to_owned();
                changes.push(json!({ "text": text }));
            }
            let at = |dice: &mut Dice, text: &str| {
                let byte = dice.below(text.len() + 1);
                (byte..=text.len()).find(|b| text.is_char_boundary(*b)).unwrap()
            };
            // The two letters of a line end are one place for editors.
            let apart =
                |text: &str, byte: usize| if text[..byte].ends_with('\r') && text[byte..].starts_with('\n') { byte - 1 } else { byte };
            let from = apart(&text, at(&mut dice, &text));
            let mut to = from;
            if dice.below(3) == 0 {
                to = (from + dice.below(12)).min(text.len());
                to = apart(&text, (to..=text.len()).find(|b| text.is_char_boundary(*b)).unwrap());
            }
            // One of three bursts undoes what it did, so that sound models are among those compared.
            let put = TYPED[dice.below(TYPED.len())];
            let range = json!({ "start": position(&text, from), "end": position(&text, to) });
            changes.push(json!({ "range": range, "text": put }));
            let before = text.clone();
            text.replace_range(from..to, put);
            if burst % 3 == 2 {
                changes.push(json!({ "text": before }));
                text = before;
            }
            version += 1;
            let params = json!({ "textDocument": { "uri": uri, "version": version }, "contentChanges": changes });
            editor.tell("textDocument/didChange", params);
            if dice.below(4) == 0 {
                let method = ["completion", "hover", "signatureHelp", "definition"][dice.below(4)];
                editor.next += 1;
                let params = json!({ "textDocument": { "uri": uri }, "position": position(&text, from) });
                let id = editor.next;
                editor.send(&json!({ "jsonrpc": "2.0", "id": id, "method": format!("textDocument/{method}"), "params": params }));
            }
        }
        let said = editor.settled(uri, version);
        let row = |d: &Value| (d["code"].as_str().unwrap().to_owned(), d["range"]["start"].clone());
        let (mut said, mut wanted) = (said.iter().map(row).collect::<Vec<_>>(), said_from_nothing(&text));
        let order = |a: &(String, Value), b: &(String, Value)| a.0.cmp(&b.0).then(a.1.to_string().cmp(&b.1.to_string()));
        said.sort_by(order);
        wanted.sort_by(order);
        assert_eq!(said, wanted, "burst {burst}:\n{text}");
        sound += usize::from(said.is_empty());
        editor.notes.clear();
    }
    assert!(sound * 10 > edits / 20, "only {sound} sound models were compared");
    editor.stop();
}
