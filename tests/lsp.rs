//! The language server as an editor talks to it: messages over standard input and output.

#![allow(clippy::unwrap_used, clippy::panic, missing_docs)]

use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

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

    fn open(&mut self, uri: &str, text: &str) {
        self.tell("textDocument/didOpen", json!({ "textDocument": { "uri": uri, "languageId": "loft", "version": 1, "text": text } }));
    }

    fn at(&mut self, method: &str, uri: &str, line: usize, character: usize) -> Value {
        self.ask(method, json!({ "textDocument": { "uri": uri }, "position": { "line": line, "character": character } }))
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
    let lenses = editor.of("textDocument/codeLens", uri);
    let titles: Vec<&str> = lenses.as_array().unwrap().iter().map(|l| l["command"]["title"].as_str().unwrap()).collect();
    assert!(titles.contains(&"1 check passes"), "{titles:?}");
    assert!(titles.iter().any(|t| t.contains("12 m2")), "{titles:?}");
    editor.stop();
}

#[test]
fn words_are_explained_and_completed() {
    let mut editor = Editor::start();
    let uri = "file:///nowhere/words.loft";
    editor.open(uri, MODEL);
    let hover = |v: Value| v["contents"]["value"].as_str().unwrap_or_default().to_owned();
    let text = hover(editor.at("textDocument/hover", uri, 6, 22));
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
    assert!(said.stdout == kept, "the grammar is not current: LOFT_ACCEPT=1 cargo test --test lsp grammar");
    let package: Value = serde_json::from_slice(&fs::read(path.parent().unwrap().with_file_name("package.json")).unwrap()).unwrap();
    assert_eq!(package["version"], env!("CARGO_PKG_VERSION"));
}
