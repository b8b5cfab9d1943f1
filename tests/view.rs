//! The server of the page, as a browser and whoever else on the machine talk to it, with a model that only repeats what it is given.

use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

use lofting::cli::view;
use lofting::cli::view::model::{Buffer, Evaluated, Evaluation, Frame, Model, Progress, Request, Script, Watched};
use lofting::cli::view::server::{Server, Settings};
use serde_json::{Value, json};

/// How long anything may take on a loaded machine.
const PATIENCE: Duration = Duration::from_secs(20);

/// Says what it is given. Lines of the script tell what it does: `reads FILE`, `takes MILLISECONDS`, `buffer BYTES`, `panics`, `more`: what
/// it is compared with takes until it is asked again.
struct Echo {
    folder: PathBuf,
    stopped: Arc<AtomicUsize>,
}

#[derive(Default)]
struct Stop(AtomicBool, AtomicU64);

impl Watched for Stop {
    fn stop(&self) {
        self.0.store(true, Ordering::SeqCst);
    }
    fn progress(&self) -> Progress {
        Progress { phase: "waiting".to_owned(), done: self.1.load(Ordering::SeqCst), of: 100 }
    }
}

impl Model for Echo {
    fn evaluate(&mut self, request: &Request, evaluation: &Evaluation) -> Evaluated {
        let text = String::from_utf8_lossy(&request.text).into_owned();
        let (mut files, mut read, mut buffers) = (Vec::new(), Vec::new(), Vec::new());
        for line in text.lines() {
            match line.split_once(' ') {
                Some(("reads", name)) => {
                    let path = self.folder.join(name);
                    read.push(fs::read_to_string(&path).unwrap_or_else(|_| "missing".to_owned()));
                    files.push(path);
                }
                Some(("takes", time)) => {
                    let (stop, began) = (Arc::new(Stop::default()), Instant::now());
                    evaluation.watch(stop.clone());
                    while began.elapsed() < Duration::from_millis(time.parse().unwrap()) {
                        if stop.0.load(Ordering::SeqCst) {
                            assert!(evaluation.is_stopped());
                            self.stopped.fetch_add(1, Ordering::SeqCst);
                            return Evaluated::default();
                        }
                        stop.1.fetch_add(1, Ordering::SeqCst);
                        thread::sleep(Duration::from_millis(1));
                    }
                }
                Some(("buffer", size)) => {
                    let size: usize = size.parse().unwrap();
                    let bytes = (0..size).map(|i| (i.wrapping_mul(2_654_435_761) >> 13) as u8).collect();
                    buffers.push(Buffer { key: format!("{:032x}", size), bytes: Arc::new(bytes) });
                }
                // Whatever the server wants.
                Some(("ignores", time)) => thread::sleep(Duration::from_millis(time.parse().unwrap())),
                Some(("shows", part)) => {
                    let json = json!({ "loft": 1, "number": request.number - 1, "partial": true, "text": part });
                    evaluation.show_partial(Frame { json: json.to_string(), buffers: Vec::new() });
                }
                _ if line == "panics" => panic!("as it was told"),
                _ => {}
            }
        }
        let json = json!({ "loft": 1, "number": request.number, "text": text, "sets": request.sets, "read": read,
            "chord_error": request.chord_error, "compare": format!("{:?}", request.compare), "again": request.again, "diagnostics": [] });
        let more = text.contains("more") && request.compare.is_some() && !request.again;
        Evaluated { frame: Some(Frame { json: json.to_string(), buffers }), files: Some(files), more }
    }
}

struct Pen(PathBuf);

impl Script for Pen {
    fn write(&self, name: &str, text: &str) -> Result<(), String> {
        if name == "nothing" {
            return Err("there is no param `nothing`".to_owned());
        }
        fs::write(&self.0, format!("param {name} = {text}\n")).map_err(|error| error.to_string())
    }
    fn show(&self, file: &str, line: u32, column: u32) -> bool {
        file == "model.loft" && line == 3 && column == 1
    }
}

struct View {
    server: Option<Server>,
    folder: PathBuf,
    script: PathBuf,
    port: u16,
    base: String,
    stopped: Arc<AtomicUsize>,
}

struct Got {
    status: u16,
    headers: String,
    body: Vec<u8>,
}

impl Got {
    fn json(&self) -> Value {
        serde_json::from_slice(&self.body).unwrap()
    }
}

impl View {
    fn new(name: &str, text: Option<&str>) -> Self {
        let folder = std::env::temp_dir().join(format!("loft-view-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        let script = folder.join("model.loft");
        if let Some(text) = text {
            fs::write(&script, text).unwrap();
        }
        let stopped = Arc::new(AtomicUsize::new(0));
        let model = Box::new(Echo { folder: folder.clone(), stopped: stopped.clone() });
        let page = Arc::new(format!("<!doctype html><!--MODEL-->{}", "<p>page</p>".repeat(1000)).into_bytes());
        let settings = Settings { script: script.clone(), port: Some(0), page, sets: Vec::new() };
        let server = Server::start(settings, model, Arc::new(Pen(script.clone()))).unwrap();
        let (port, address) = (server.port(), server.address());
        let base = address.strip_prefix(&format!("http://127.0.0.1:{port}")).unwrap().to_owned();
        Self { server: Some(server), folder, script, port, base, stopped }
    }

    fn server(&self) -> &Server {
        self.server.as_ref().unwrap()
    }

    fn connect(&self) -> TcpStream {
        let stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        stream
    }

    /// Sends a request as it is and reads the one answer.
    fn raw(&self, request: &str) -> Got {
        let mut stream = self.connect();
        stream.write_all(request.as_bytes()).unwrap();
        read_answer(&mut BufReader::new(stream))
    }

    fn ask(&self, method: &str, path: &str, headers: &str, body: &str) -> Got {
        let length = body.len();
        self.raw(&format!(
            "{method} {}{path} HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nContent-Length: {length}\r\nConnection: close\r\n{headers}\r\n{body}",
            self.base, self.port
        ))
    }

    fn get(&self, path: &str) -> Got {
        self.ask("GET", path, "", "")
    }

    fn post(&self, path: &str, body: &Value) -> Got {
        self.ask("POST", path, "", &body.to_string())
    }

    fn tab(&self, name: &str, last: u64) -> Tab {
        self.tab_with(name, last, "")
    }

    fn tab_with(&self, name: &str, last: u64, headers: &str) -> Tab {
        let mut stream = self.connect();
        let path = format!("{}events?tab={name}&last={last}", self.base);
        write!(stream, "GET {path} HTTP/1.1\r\nHost: localhost:{}\r\nAccept: text/event-stream\r\n{headers}\r\n", self.port).unwrap();
        let mut tab = Tab { stream: BufReader::new(stream) };
        assert!(tab.line().unwrap().starts_with("HTTP/1.1 200"));
        while !tab.line().unwrap().is_empty() {}
        assert!(tab.line().unwrap().starts_with("retry: "));
        assert_eq!(tab.line().unwrap(), "");
        tab
    }

    /// Saves as many editors do: the file has either the old text or the new one.
    fn replace(&self, text: &str) {
        fs::write(self.folder.join("saved~"), text).unwrap();
        fs::rename(self.folder.join("saved~"), &self.script).unwrap();
    }

    fn save(&self, text: &str) {
        fs::write(&self.script, text).unwrap();
    }

    /// The frame once it satisfies the condition.
    fn frame_with(&self, right: impl Fn(&Value) -> bool) -> Value {
        let began = Instant::now();
        loop {
            let got = self.get("frame");
            let frame = if got.status == 200 { got.json() } else { Value::Null };
            if right(&frame) {
                return frame;
            }
            assert!(began.elapsed() < PATIENCE, "there is no such frame; the newest is {frame}");
            thread::sleep(Duration::from_millis(5));
        }
    }

    fn frame_of(&self, text: &str) -> Value {
        self.frame_with(|frame| frame["text"] == text)
    }
}

impl Drop for View {
    fn drop(&mut self) {
        drop(self.server.take());
        let _ = fs::remove_dir_all(&self.folder);
    }
}

struct Tab {
    stream: BufReader<TcpStream>,
}

impl Tab {
    fn line(&mut self) -> Option<String> {
        let mut line = String::new();
        let n = self.stream.read_line(&mut line).unwrap_or(0);
        (n > 0).then(|| line.trim_end_matches(['\r', '\n']).to_owned())
    }

    /// The next event; `None` when the stream ended.
    fn event(&mut self) -> Option<(String, Value)> {
        let mut name = String::new();
        loop {
            let line = self.line()?;
            if let Some(event) = line.strip_prefix("event: ") {
                event.clone_into(&mut name);
            } else if let Some(data) = line.strip_prefix("data: ") {
                return Some((name, serde_json::from_str(data).unwrap()));
            }
        }
    }

    fn frame(&mut self) -> u64 {
        loop {
            let (name, data) = self.event().expect("the stream goes on");
            if name == "frame" {
                return data["number"].as_u64().unwrap();
            }
        }
    }

    fn wait_for(&mut self, wanted: &str) -> Value {
        loop {
            let (name, data) = self.event().expect("the stream goes on");
            if name == wanted {
                return data;
            }
        }
    }
}

fn read_answer(stream: &mut impl BufRead) -> Got {
    let mut headers = String::new();
    while !headers.ends_with("\r\n\r\n") {
        assert!(stream.read_line(&mut headers).unwrap() > 0, "an answer is missing: {headers}");
    }
    let status = headers.split(' ').nth(1).unwrap().parse().unwrap();
    let length = headers.lines().find_map(|line| line.strip_prefix("Content-Length: "));
    let mut body = vec![0; length.map_or(0, |n| n.trim().parse().unwrap())];
    stream.read_exact(&mut body).unwrap();
    Got { status, headers, body }
}

/// A number that the system tells about this process.
fn of_process(name: &str) -> u64 {
    let Ok(status) = fs::read_to_string("/proc/self/status") else { return 0 };
    let line = status.lines().find_map(|line| line.strip_prefix(name)).unwrap_or_default();
    line.trim_matches([':', ' ', '\t', 'k', 'B']).parse().unwrap_or(0)
}

fn open_files() -> usize {
    fs::read_dir("/proc/self/fd").map_or(0, Iterator::count)
}

/// What is measured of a whole process is measured in one that does nothing else: the test starts itself there. `false` where it has
/// done so, and nothing is left to do.
fn alone(test: &str) -> bool {
    const MARK: &str = "LOFT_VIEW_TEST_ALONE";
    if std::env::var_os(MARK).is_some() {
        return true;
    }
    let module = module_path!().split_once("::").map_or(String::new(), |(_, module)| format!("{module}::"));
    let program = std::env::current_exe().unwrap();
    let run =
        std::process::Command::new(program).args([&format!("{module}{test}"), "--exact", "--nocapture"]).env(MARK, "1").output().unwrap();
    let told = String::from_utf8_lossy(&run.stdout);
    assert!(run.status.success() && told.contains("1 passed"), "{told}{}", String::from_utf8_lossy(&run.stderr));
    told.lines().filter(|line| line.contains(" -> ")).for_each(|line| println!("{line}"));
    false
}

#[test]
fn the_page_and_the_frame_are_served() {
    let view = View::new("serve", Some("hello\n"));
    let page = view.get("");
    assert_eq!(page.status, 200);
    assert!(page.body.starts_with(b"<!doctype html>"));
    for header in ["Content-Security-Policy: default-src 'none'", "nosniff", "no-referrer", "Resource-Policy: same-origin", "no-store"] {
        assert!(page.headers.contains(header), "{header}: {}", page.headers);
    }
    let packed = view.ask("GET", "", "Accept-Encoding: br, gzip;q=0.5\r\n", "");
    assert!(packed.headers.contains("Content-Encoding: gzip") && packed.body.len() < page.body.len() / 10);
    assert!(!view.ask("GET", "", "Accept-Encoding: gzip;q=0\r\n", "").headers.contains("Content-Encoding"));
    let frame = view.frame_of("hello\n");
    assert_eq!((frame["number"].as_u64(), frame["sets"].as_array().map(Vec::len)), (Some(2), Some(0)));
}

#[test]
fn one_connection_serves_many_requests() {
    let view = View::new("keep", Some("hello\n"));
    view.frame_of("hello\n");
    let mut stream = BufReader::new(view.connect());
    for _ in 0..100 {
        let request = format!("GET {}frame HTTP/1.1\r\nHost: 127.0.0.1:{}\r\n\r\n", view.base, view.port);
        // Two at once, as a program may send them.
        stream.get_mut().write_all(request.repeat(2).as_bytes()).unwrap();
        assert_eq!(read_answer(&mut stream).json()["text"], "hello\n");
        assert_eq!(read_answer(&mut stream).json()["text"], "hello\n");
    }
}

#[test]
fn who_does_not_belong_here_is_refused() {
    let view = View::new("refuse", Some("hello\n"));
    let (base, port) = (&view.base, view.port);
    let check = |line: &str, headers: &str, expected: u16| {
        let got = view.raw(&format!("{line} HTTP/1.1\r\n{headers}\r\n"));
        assert_eq!(got.status, expected, "{line} {headers}");
        assert!(!got.headers.contains("Access-Control"), "no other page may read an answer");
    };
    let host = format!("Host: localhost:{port}\r\n");
    check(&format!("GET {base}frame"), &format!("Host: evil.example:{port}\r\n"), 403);
    check(&format!("GET {base}frame"), "", 403);
    check(&format!("GET {base}frame"), &format!("{host}Host: evil.example\r\n"), 400);
    check(&format!("POST {base}stop"), &format!("{host}Origin: http://evil.example\r\n"), 403);
    check(&format!("POST {base}stop"), &format!("{host}Origin: null\r\n"), 403);
    check(&format!("POST {base}stop"), &format!("{host}Origin: http://localhost:{port}\r\n"), 200);
    check(&format!("GET {base}events?tab=a"), &format!("{host}Sec-Fetch-Site: cross-site\r\n"), 403);
    check(&format!("GET {base}frame"), &format!("{host}Sec-Fetch-Site: same-site\r\nSec-Fetch-Mode: navigate\r\n"), 403);
    check("GET /", &host, 403);
    check("GET /00112233445566778899aabbccddeeff/", &host, 403);
    check(&format!("OPTIONS {base}set"), &host, 405);
    check(&format!("GET {base}set"), &host, 405);
    check(&format!("DELETE {base}frame"), &host, 405);
    check(&format!("HEAD {base}"), &host, 405);
    for path in
        ["../../etc/passwd", "..%2f..%2fetc/passwd", "%2e%2e/%2e%2e/etc/passwd", "frame/", "Frame", "buffers", "model.loft", "./frame"]
    {
        check(&format!("GET {base}{path}"), &host, 404);
    }
    check(&format!("GET {base}buffers/../../../etc/passwd"), &host, 400);
    check(&format!("GET {base}buffer/{:032x}", 1), &host, 404);
    check(&format!("GET {base}events?tab=%0d%0aX"), &host, 400);
    check("GET http://localhost/", &host, 400);
    check("GET /../../etc/passwd", &host, 403);
    check(&format!("GET {base}frame"), &format!("{host}X: a\r\n b\r\n"), 400);
    check(&format!("GET {base}frame"), &format!("{host}X: {}\r\n", "a".repeat(17_000)), 431);
    check("nonsense", &host, 400);
    assert_eq!(view.raw(&format!("GET {base} HTTP/2.0\r\n{host}\r\n")).status, 505);
    view.frame_of("hello\n");
}

#[test]
fn long_bodies_are_refused_unread() {
    if !alone("long_bodies_are_refused_unread") {
        return;
    }
    let view = View::new("long", Some("hello\n"));
    let before = of_process("VmRSS");
    let refused = |length: &str| {
        let mut stream = view.connect();
        let head = format!("POST {}set HTTP/1.1\r\nHost: 127.0.0.1:{}\r\n{length}\r\n\r\n", view.base, view.port);
        stream.write_all(head.as_bytes()).unwrap();
        // Some of it may be on its way already.
        let _ = stream.write_all(&vec![b' '; 300_000]);
        read_answer(&mut BufReader::new(stream)).status
    };
    assert_eq!(refused("Content-Length: 1073741824"), 413);
    assert_eq!(refused("Content-Length: 65537"), 413);
    assert_eq!(refused("Content-Length: 99999999999999999999999999"), 413);
    assert_eq!(refused("Content-Length: -1"), 400);
    assert_eq!(refused("Content-Length: 5\r\nContent-Length: 6"), 400);
    assert_eq!(refused("Transfer-Encoding: chunked"), 411);
    // A client that sends all of it in spite of the answer.
    let mut stream = view.connect();
    write!(stream, "POST {}set HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nContent-Length: 1073741824\r\n\r\n", view.base, view.port).unwrap();
    let (piece, mut sent) = (vec![b'x'; 1 << 20], 0_u64);
    while sent < 1 << 30 && stream.write_all(&piece).is_ok() {
        sent += piece.len() as u64;
    }
    assert!(sent < 100 << 20, "the connection ended after {sent} bytes");
    println!("a body of 1 GB: memory {before} -> {} kB", of_process("VmRSS"));
    assert!(of_process("VmRSS") < before + 8 * 1024, "memory stays flat");
    let body = format!("{{\"name\":\"w\",\"text\":\"{}\"}}", "1".repeat(65_000));
    assert_eq!(view.ask("POST", "set", "", &body).status, 200);
    assert_eq!(view.ask("POST", "set", "Expect: 100-continue\r\n", "{\"name\":\"w\",\"text\":\"2\"}").status, 200);
}

#[test]
fn slow_clients_are_ended_and_do_not_keep_out_others() {
    if !alone("slow_clients_are_ended_and_do_not_keep_out_others") {
        return;
    }
    let view = View::new("slow", Some("hello\n"));
    view.frame_of("hello\n");
    // A client that sends a byte now and then is ended all the same.
    let mut slow = view.connect();
    slow.set_read_timeout(Some(Duration::from_millis(100))).unwrap();
    let began = Instant::now();
    let mut sent = 0;
    for byte in b"GET / HTTP/1.1\r\nHost: ".iter().chain(std::iter::repeat_n(&b'a', 1000)) {
        if slow.write_all(&[*byte]).is_err() || slow.peek(&mut [0]).is_ok() {
            break;
        }
        sent += 1;
    }
    println!("a client of ten bytes a second: ended after {sent} bytes -> {:?}", began.elapsed());
    assert!((3..500).contains(&sent) && began.elapsed() < 2 * PATIENCE, "{sent} bytes");
    let memory = of_process("VmRSS");
    let idle: Vec<TcpStream> = (0..500).map(|_| view.connect()).collect();
    println!("500 idle connections: memory {memory} -> {} kB", of_process("VmRSS"));
    assert!(of_process("VmRSS") < memory + 8 * 1024, "memory stays flat");
    let worst = (0..50).map(|_| {
        let began = Instant::now();
        assert_eq!(view.get("frame").status, 200);
        began.elapsed()
    });
    let worst = worst.max().unwrap();
    println!("500 idle connections: the worst of 50 requests among them -> {worst:?}");
    assert!(worst < PATIENCE);
    assert!(view.server().shared().connections.count() <= view::connections::MOST);
    drop(idle);
}

#[test]
fn ten_thousand_connections_leave_nothing_behind() {
    if !alone("ten_thousand_connections_leave_nothing_behind") {
        return;
    }
    let view = View::new("many", Some("hello\n"));
    view.frame_of("hello\n");
    let mut tab = view.tab("watching", 0);
    assert_eq!(tab.frame(), 2);
    let (files, memory) = (open_files(), of_process("VmRSS"));
    for i in 0..10_000 {
        let mut stream = view.connect();
        match i % 4 {
            0 => drop(stream),
            1 => stream.write_all(b"GET / HT").unwrap(),
            2 => {
                let _ = stream.write_all(b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\r\n\r\n");
                let _ = stream.shutdown(Shutdown::Write);
                let _ = stream.read_to_end(&mut Vec::new());
            }
            _ => {
                write!(stream, "GET {}frame HTTP/1.1\r\nHost: localhost:{}\r\nConnection: close\r\n\r\n", view.base, view.port).unwrap();
                assert_eq!(read_answer(&mut BufReader::new(stream)).status, 200);
            }
        }
    }
    let began = Instant::now();
    while view.server().shared().connections.count() > 0 && began.elapsed() < PATIENCE {
        thread::sleep(Duration::from_millis(10));
    }
    assert_eq!(view.server().shared().connections.count(), 0);
    println!("10 000 connections: files {files} -> {}, memory {memory} -> {} kB", open_files(), of_process("VmRSS"));
    assert!(open_files() <= files + 1);
    assert!(of_process("VmRSS") < memory + 8 * 1024);
    view.save("again\n");
    assert!(tab.frame() > 1);
}

#[test]
fn tabs_are_told_of_every_frame_and_catch_up() {
    let view = View::new("tabs", Some("one\n"));
    let (mut a, mut b) = (view.tab("a", 0), view.tab("b", 0));
    assert_eq!((a.frame(), b.frame()), (2, 2));
    view.save("two\n");
    assert_eq!((a.frame(), b.frame()), (4, 4));
    drop(b);
    view.save("three\n");
    assert_eq!(a.frame(), 6);
    assert_eq!(view.tab("b", 4).frame(), 6);
    assert_eq!(view.tab_with("b", 2, "Last-Event-ID: 4\r\n").frame(), 6);
    // Who knows the newest hears of the next one only.
    let mut c = view.tab("c", 6);
    view.save("four\n");
    assert_eq!((a.frame(), c.frame()), (8, 8));
    // A new stream takes the place of the tab's old one.
    let _again = view.tab("a", 8);
    assert_eq!(a.event(), None);
    // Many tabs take turns.
    let mut tabs: Vec<Tab> = (0..10).map(|i| view.tab(&format!("t{i}"), 0)).collect();
    assert_eq!(view.server().shared().events.count(), view::events::MOST);
    assert_eq!(tabs.last_mut().unwrap().frame(), 8);
    drop(tabs);
    let began = Instant::now();
    while view.server().shared().events.count() > 0 && began.elapsed() < PATIENCE {
        thread::sleep(Duration::from_millis(10));
    }
    assert_eq!(view.server().shared().events.count(), 0, "who left is forgotten");
}

#[test]
fn a_tab_that_takes_nothing_costs_nothing() {
    let view = View::new("deaf", Some("one\n"));
    let mut deaf = view.tab("deaf", 0);
    let data = json!({ "file": "f".repeat(20_000), "line": 1 });
    for _ in 0..500 {
        assert_eq!(view.post("cursor", &data).status, 200);
    }
    view.save("two\n");
    view.frame_of("two\n");
    let mut last = 0;
    while last < 4 {
        let number = deaf.frame();
        assert!(number > last);
        last = number;
    }
}

#[test]
fn saves_are_seen_however_they_are_made() {
    let view = View::new("saves", Some("one\n"));
    let mut tab = view.tab("a", 0);
    assert_eq!(tab.frame(), 2);
    // Renamed over it.
    fs::write(view.folder.join("new"), "two\n").unwrap();
    fs::rename(view.folder.join("new"), &view.script).unwrap();
    assert_eq!(tab.frame(), 4);
    view.frame_of("two\n");
    // Moved away and written anew.
    fs::rename(&view.script, view.folder.join("model.loft~")).unwrap();
    thread::sleep(Duration::from_millis(20));
    view.save("three\n");
    // A machine that is busy may find the file gone in between.
    tab.wait_for("frame");
    view.frame_of("three\n");
    // Emptied, then filled in pieces.
    let mut file = fs::File::create(&view.script).unwrap();
    thread::sleep(Duration::from_millis(20));
    for _ in 0..20 {
        file.write_all(b"four\n").unwrap();
    }
    drop(file);
    assert_eq!(tab.frame(), 8);
    view.frame_of(&"four\n".repeat(20));
    // Of the same length, at once after another.
    view.save("abc\n");
    view.save("abd\n");
    view.frame_of("abd\n");
    thread::sleep(Duration::from_millis(50));
    view.save("abe\n");
    view.frame_of("abe\n");
    // Touched without a change, then emptied for good.
    let number = view.frame_of("abe\n")["number"].clone();
    view.save("abe\n");
    thread::sleep(Duration::from_millis(200));
    assert_eq!(view.frame_of("abe\n")["number"], number);
    view.save("");
    view.frame_of("");
}

#[cfg(unix)]
#[test]
fn links_are_followed() {
    let view = View::new("links", None);
    fs::create_dir_all(view.folder.join("a")).unwrap();
    fs::create_dir_all(view.folder.join("b")).unwrap();
    fs::write(view.folder.join("a/m.loft"), "one\n").unwrap();
    fs::write(view.folder.join("b/m.loft"), "two\n").unwrap();
    std::os::unix::fs::symlink("a/m.loft", &view.script).unwrap();
    view.frame_of("one\n");
    fs::write(view.folder.join("a/m.loft"), "three\n").unwrap();
    view.frame_of("three\n");
    fs::remove_file(&view.script).unwrap();
    std::os::unix::fs::symlink("b/m.loft", &view.script).unwrap();
    view.frame_of("two\n");
}

#[test]
fn a_script_that_goes_away_and_comes_back() {
    let view = View::new("gone", None);
    let mut tab = view.tab("a", 0);
    assert_eq!(tab.event().unwrap(), ("gone".to_owned(), json!({ "file": "model.loft" })));
    assert_eq!(view.get("frame").status, 204);
    view.save("one\n");
    let told = tab.wait_for("frame");
    assert_eq!((&told["number"], &told["frame"]["text"]), (&json!(2), &json!("one\n")));
    fs::remove_file(&view.script).unwrap();
    tab.wait_for("gone");
    // Who comes now is told as well; nothing is evaluated.
    view.post("set", &json!({ "name": "w", "text": "3 m" }));
    let mut late = view.tab("b", 0);
    assert_eq!((late.event().unwrap().0.as_str(), late.event().unwrap().0.as_str()), ("frame", "gone"));
    view.save("one\n");
    assert_eq!((tab.frame(), late.frame()), (4, 4));
    assert_eq!(view.frame_of("one\n")["sets"], json!([["w", "3 m"]]));
}

#[test]
fn files_that_the_model_reads_are_watched() {
    let view = View::new("files", Some("reads a.csv\nreads b.csv\n"));
    fs::write(view.folder.join("a.csv"), "1").unwrap();
    let read = |a: &str, b: &str| view.frame_with(|frame| frame["read"] == json!([a, b]));
    read("1", "missing");
    fs::write(view.folder.join("b.csv"), "2").unwrap();
    read("1", "2");
    fs::write(view.folder.join("new"), "3").unwrap();
    fs::rename(view.folder.join("new"), view.folder.join("a.csv")).unwrap();
    read("3", "2");
    fs::remove_file(view.folder.join("b.csv")).unwrap();
    read("3", "missing");
    // What is no longer read is no longer watched.
    view.save("reads a.csv\n");
    let number = view.frame_with(|frame| frame["read"] == json!(["3"]))["number"].clone();
    fs::write(view.folder.join("b.csv"), "4").unwrap();
    thread::sleep(Duration::from_millis(100));
    assert_eq!(view.frame_of("reads a.csv\n")["number"], number);
}

#[test]
fn a_file_that_changes_while_it_is_first_read_is_read_again() {
    let view = View::new("race", Some("reads a.csv\ntakes 100\n"));
    fs::write(view.folder.join("a.csv"), "1").unwrap();
    thread::sleep(Duration::from_millis(70));
    fs::write(view.folder.join("a.csv"), "2").unwrap();
    view.frame_with(|frame| frame["read"] == json!(["2"]));
}

#[test]
fn two_hundred_saves_in_ten_seconds() {
    let view = View::new("storm", Some("save 0\n"));
    let mut tab = view.tab("a", 0);
    let numbers = thread::spawn(move || {
        let mut numbers = Vec::new();
        while let Some((name, data)) = tab.event() {
            if name == "frame" {
                numbers.push(data["number"].as_u64().unwrap());
            }
        }
        numbers
    });
    for i in 1..=200 {
        let began = Instant::now();
        view.save(&format!("save {i}\ntakes {}\n", [0, 10, 70][i % 3]));
        thread::sleep(Duration::from_millis(50).saturating_sub(began.elapsed()));
    }
    let frame = view.frame_of("save 200\ntakes 70\n");
    thread::sleep(Duration::from_millis(300));
    assert_eq!(view.frame_of("save 200\ntakes 70\n")["number"], frame["number"], "nothing comes after it");
    println!("stopped {} of 200", view.stopped.load(Ordering::SeqCst));
    drop(view);
    let numbers = numbers.join().unwrap();
    assert!(numbers.is_sorted_by(|a, b| a < b));
    assert!(numbers.len() > 3, "{} frames", numbers.len());
}

#[test]
fn a_model_is_shown_before_what_it_is_compared_with() {
    let view = View::new("more", Some("more\n"));
    let mut tab = view.tab("a", 0);
    assert_eq!(tab.frame(), 2);
    view.post("compare", &json!({ "with": "golden" }));
    assert_eq!([tab.frame(), tab.frame()], [4, 6]);
    let frame = view.get("frame").json();
    assert_eq!((frame["number"].as_u64(), frame["again"].as_bool()), (Some(6), Some(true)));
    // A save between is shown first as well.
    view.save("more of it\n");
    assert_eq!([tab.frame(), tab.frame()], [8, 10]);
    let frame = view.frame_of("more of it\n");
    assert_eq!((frame["number"].as_u64(), frame["again"].as_bool()), (Some(10), Some(true)));
    thread::sleep(Duration::from_millis(200));
    assert_eq!(view.get("frame").json()["number"].as_u64(), Some(10), "nothing comes after it");
}

#[test]
fn a_newer_save_stops_the_evaluation() {
    let view = View::new("newer", Some("takes 60000\n"));
    let mut tab = view.tab("a", 0);
    let work = tab.wait_for("work");
    assert_eq!((work["number"].as_u64(), work["phase"].as_str(), work["of"].as_u64()), (Some(2), Some("waiting"), Some(100)));
    view.replace("quick\n");
    let began = Instant::now();
    assert_eq!(tab.frame(), 4);
    assert!(began.elapsed() < PATIENCE, "an evaluation of a minute was not stopped");
    assert_eq!(view.stopped.load(Ordering::SeqCst), 1);
    // A moved param lets a short evaluation end, and stops a long one.
    view.save("takes 50\n");
    while view.get("frame").json()["text"] != "takes 50\n" {
        assert_eq!(view.post("set", &json!({ "name": "w", "text": "1" })).status, 200);
        thread::sleep(Duration::from_millis(10));
    }
    let (stopped, number) = (view.stopped.load(Ordering::SeqCst), view.get("frame").json()["number"].as_u64());
    view.save("takes 60000\n");
    while tab.wait_for("work")["number"].as_u64() <= number {}
    view.post("set", &json!({ "name": "w", "text": "2" }));
    let began = Instant::now();
    while view.stopped.load(Ordering::SeqCst) <= stopped {
        assert!(began.elapsed() < PATIENCE);
        thread::sleep(Duration::from_millis(5));
    }
}

#[test]
fn the_user_stops_an_evaluation() {
    let view = View::new("stop", Some("one\n"));
    let mut tab = view.tab("a", 0);
    assert_eq!(tab.frame(), 2);
    view.save("takes 60000\n");
    tab.wait_for("work");
    assert_eq!(view.post("stop", &json!({})).json(), json!({ "ok": true }));
    loop {
        let work = tab.wait_for("work");
        if work["phase"].is_null() {
            break;
        }
    }
    assert_eq!(view.frame_of("one\n")["number"], 2);
    view.save("two\n");
    view.frame_of("two\n");
}

#[test]
fn what_the_page_asks_reaches_the_model() {
    let view = View::new("ask", Some("one\n"));
    let mut tab = view.tab("a", 0);
    let check = |path: &str, body: Value, expected: Value| {
        let got = view.post(path, &body);
        assert_eq!((got.status, got.json()), (200, expected), "{path} {body}");
    };
    let ok = json!({ "ok": true });
    check("set", json!({ "name": "w", "text": "3 m" }), ok.clone());
    view.frame_with(|frame| frame["sets"] == json!([["w", "3 m"]]));
    check("set", json!({ "name": "n", "text": "4" }), ok.clone());
    check("set", json!({ "name": "w", "text": "5 m" }), ok.clone());
    view.frame_with(|frame| frame["sets"] == json!([["w", "5 m"], ["n", "4"]]));
    check("set", json!({ "name": "n", "text": null }), ok.clone());
    view.frame_with(|frame| frame["sets"] == json!([["w", "5 m"]]));
    check("refine", json!({ "error": 0.01 }), ok.clone());
    view.frame_with(|frame| frame["chord_error"] == 0.01);
    for (with, told) in [
        (json!("revision:HEAD~1"), "Some(Revision(\"HEAD~1\"))"),
        (json!("revision:fix/#7+größe"), "Some(Revision(\"fix/#7+größe\"))"),
        (json!("golden"), "Some(Golden)"),
        (json!(null), "None"),
    ] {
        let got = view.post("compare", &json!({ "with": with })).json();
        let frame = view.frame_with(|frame| frame["compare"] == told);
        assert_eq!(got, json!({ "ok": true, "from": frame["number"] }));
    }
    for name in ["--output=x", "", "a\nb", &"é".repeat(201)] {
        let got = view.post("compare", &json!({ "with": format!("revision:{name}") }));
        assert!(got.status == 200 && got.json()["ok"] == false, "{name}");
        assert!(got.json()["message"].as_str().unwrap().starts_with("a revision is named by"));
    }
    check("show", json!({ "file": "model.loft", "line": 3 }), ok.clone());
    check("show", json!({ "file": "other.loft", "line": 3 }), json!({ "ok": false, "message": "no editor is attached" }));
    check("cursor", json!({ "file": "model.loft", "line": 7 }), ok.clone());
    assert_eq!(tab.wait_for("cursor"), json!({ "file": "model.loft", "line": 7 }));
    check("write", json!({ "name": "nothing", "text": "1" }), json!({ "ok": false, "message": "there is no param `nothing`" }));
    check("write", json!({ "name": "w", "text": "6 m" }), ok);
    assert_eq!(view.frame_of("param w = 6 m\n")["sets"], json!([]), "the script says it now");
    for (path, body) in [
        ("set", json!({ "name": "w" })),
        ("set", json!({ "text": "1" })),
        ("set", json!([1])),
        ("refine", json!({ "error": 0 })),
        ("refine", json!({ "error": "x" })),
        ("compare", json!({ "with": "HEAD" })),
        ("compare", json!({ "with": 3 })),
        ("compare", json!({})),
        ("show", json!({ "file": "model.loft", "line": -3 })),
        ("cursor", json!(null)),
    ] {
        assert_eq!(view.post(path, &body).status, 400, "{path} {body}");
    }
    assert_eq!(view.ask("POST", "set", "", &"[".repeat(60_000)).status, 400);
    assert_eq!(view.ask("POST", "set", "", "").status, 400);
    // As many as anyone can want, and no more.
    for i in 0..1100 {
        let got = view.post("set", &json!({ "name": format!("p{i}"), "text": "1" })).json();
        assert_eq!(got["ok"], i < 1000);
    }
}

#[test]
fn buffers_stay_for_two_frames_and_for_who_may_be_fetching_them() {
    let view = View::new("buffers", Some("buffer 100\nbuffer 20000\n"));
    view.frame_of("buffer 100\nbuffer 20000\n");
    let path = |size: usize| format!("buffers/{size:032x}");
    let got = view.get(&path(20_000));
    assert_eq!((got.status, got.body.len()), (200, 20_000));
    assert!(got.headers.contains("immutable"));
    assert_eq!(view.get(&path(100)).body.len(), 100);
    let shared = view.server().shared();
    let mut tab = view.tab("a", 2);
    for i in 2..7 {
        view.replace(&format!("buffer {i}\n"));
        assert_eq!(tab.frame(), 2 * i);
    }
    // The first was fetched just now, the others were told in their events.
    for size in [20_000, 2, 5, 6] {
        assert_eq!(view.get(&path(size)).status, 200);
    }
    thread::sleep(Duration::from_millis(5100));
    view.replace("buffer 7\n");
    assert_eq!(tab.frame(), 14);
    assert_eq!((view.get(&path(20_000)).status, shared.frames.size()), (404, (2, 13)));
    assert_eq!((view.get(&path(2)).status, view.get(&path(6)).status), (404, 200));
}

#[test]
fn a_large_frame_is_not_told_in_its_event() {
    let text = "x".repeat(70_000) + "\nbuffer 3\n";
    let view = View::new("large-frame", Some(&text));
    let mut tab = view.tab("a", 0);
    assert_eq!(tab.wait_for("frame"), json!({ "number": 2 }));
    for i in 2..6 {
        view.replace(&format!("{text}buffer {i}\n"));
        assert_eq!(tab.frame(), 2 * i);
    }
    // Nobody fetched the frames between.
    let status = |size: usize| view.get(&format!("buffers/{size:032x}")).status;
    assert_eq!([status(2), status(4), status(5)], [404, 200, 200]);
}

#[test]
fn one_answer_has_many_buffers() {
    let text = "buffer 100\nbuffer 5000\nbuffer 0\nbuffer 3000000\nbuffer 3000001\n";
    let view = View::new("together", Some(text));
    view.frame_of(text);
    let ask = |sizes: &[usize]| {
        let keys: Vec<String> = sizes.iter().map(|size| format!("{size:032x}")).collect();
        view.ask("GET", &format!("buffers/{}", keys.join("+")), "Accept-Encoding: gzip\r\n", "")
    };
    let alone = |size: usize| view.get(&format!("buffers/{size:032x}")).body;
    let got = ask(&[5000, 7, 100, 0]);
    assert_eq!((got.status, got.body), (200, [alone(5000), alone(100)].concat()));
    assert!(got.headers.contains("\r\nPart-Lengths: 5000,-,100,0\r\n") && got.headers.contains("no-store"), "{}", got.headers);
    let nothing = ask(&[7, 8]);
    assert!(nothing.status == 200 && nothing.body.is_empty() && nothing.headers.contains("Part-Lengths: -,-\r\n"));
    assert!(!ask(&[100]).headers.contains("Part-Lengths"));
    assert_eq!(ask(&[7]).status, 404);
    // Too many bytes, keys or signs; keys that are none, or that are named twice.
    assert_eq!([ask(&[3_000_000, 100]).status, ask(&[3_000_000, 3_000_001]).status], [200, 413]);
    let many: Vec<usize> = (1..=view::routes::MOST_BUFFERS + 1).collect();
    assert_eq!([ask(&many[1..]).status, ask(&many).status, ask(&[100, 100]).status], [200, 400, 400]);
    let key = format!("{:032x}", 100);
    for keys in
        ["", "+", &format!("{key}+"), &format!("+{key}"), &key[1..], &format!("{key}%2b{key}"), &"G".repeat(32), &key.replace('6', "A")]
    {
        assert_eq!(view.get(&format!("buffers/{keys}")).status, 400, "{keys}");
    }
    assert_eq!(view.get(&format!("buffers/{}", vec![key.as_str(); 600].join("+"))).status, 431);
}

#[test]
fn an_old_frame_never_overwrites_a_new_one() {
    let frames = view::frames::Frames::default();
    let frame = |text: &str| Frame { json: format!("\"{text}\""), buffers: Vec::new() };
    assert!(frames.publish(2, frame("two")));
    assert!(!frames.publish(1, frame("one")) && !frames.publish(2, frame("again")));
    assert_eq!((frames.number(), frames.newest().unwrap().plain().as_slice()), (2, b"\"two\"".as_slice()));
    assert!(frames.publish(3, frame("three")));
    assert_eq!(frames.newest().unwrap().plain().as_slice(), b"\"three\"");
}

#[test]
fn a_partial_frame_comes_before_the_whole_one_and_not_after_a_stop() {
    let view = View::new("partial", Some("one\n"));
    view.frame_of("one\n");
    let mut tab = view.tab("t", 2);
    view.replace("shows part\ntakes 400\n");
    let early = view.frame_with(|frame| frame["partial"] == true);
    assert_eq!((early["number"].as_u64(), early["text"].as_str()), (Some(3), Some("part")));
    assert_eq!(view.frame_of("shows part\ntakes 400\n")["number"], 4);
    assert_eq!([tab.frame(), tab.frame()], [3, 4]);
    // A stop leaves no partial frame behind.
    view.replace("shows part\ntakes 60000\n");
    assert_eq!(view.frame_with(|frame| frame["partial"] == true)["number"], 5);
    assert_eq!(view.post("stop", &json!({})).status, 200);
    let stopped = view.frame_with(|frame| frame["partial"] != true);
    assert_eq!(
        (stopped["number"].as_u64(), &stopped["text"], &stopped["diagnostics"][0]["code"]),
        (Some(6), &json!("part"), &json!("stopped"))
    );
    assert_eq!([tab.frame(), tab.frame()], [5, 6]);
    // A script that goes away leaves none either.
    view.replace("shows part\ntakes 60000\n\n");
    assert_eq!(view.frame_with(|frame| frame["partial"] == true)["number"], 7);
    fs::remove_file(&view.script).unwrap();
    assert_eq!(view.frame_with(|frame| frame["partial"] != true)["number"], 8);
    view.replace("one\n");
    assert_eq!(view.frame_of("one\n")["number"], 10);
    // A stopped evaluation shows no part of it any more.
    view.replace("ignores 600\nshows late\nignores 300\n");
    while tab.wait_for("work")["number"] != 12 {}
    view.replace("ignores 200\ntwo\n");
    loop {
        let frame = view.get("frame").json();
        assert_ne!(frame["text"], "late");
        if frame["number"] == 14 {
            break;
        }
        thread::sleep(Duration::from_millis(5));
    }
}

#[test]
fn a_bug_in_the_model_is_told_and_survived() {
    let view = View::new("bug", Some("one\nbuffer 9\n"));
    view.frame_of("one\nbuffer 9\n");
    view.replace("panics\n");
    let frame = view.frame_with(|frame| frame["number"] == 4);
    assert_eq!((frame["text"].as_str(), frame["stale"].as_bool()), (Some("one\nbuffer 9\n"), Some(true)));
    assert_eq!(frame["diagnostics"][0]["severity"], "error");
    view.save("two\n");
    view.frame_of("two\n");
    assert_eq!(view.get(&format!("buffers/{:032x}", 9)).status, 200);
}

#[test]
fn it_ends_while_it_evaluates() {
    let mut view = View::new("end", Some("takes 60000\n"));
    let mut tab = view.tab("a", 0);
    tab.wait_for("work");
    let idle: Vec<TcpStream> = (0..70).map(|_| view.connect()).collect();
    let began = Instant::now();
    drop(view.server.take());
    assert!(began.elapsed() < PATIENCE, "{:?}", began.elapsed());
    println!("ended in {:?}", began.elapsed());
    while tab.event().is_some() {}
    drop(idle);
    assert!(TcpStream::connect(("127.0.0.1", view.port)).is_err());
}

#[test]
fn a_model_that_does_not_stop_is_left_behind() {
    struct Deaf;
    impl Model for Deaf {
        fn evaluate(&mut self, _: &Request, _: &Evaluation) -> Evaluated {
            thread::sleep(Duration::from_secs(60));
            Evaluated::default()
        }
    }
    let folder = std::env::temp_dir().join(format!("loft-view-deaf-model-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    let script = folder.join("model.loft");
    fs::write(&script, "one\n").unwrap();
    let settings = Settings { script: script.clone(), port: Some(0), page: Arc::default(), sets: Vec::new() };
    let server = Server::start(settings, Box::new(Deaf), Arc::new(Pen(script))).unwrap();
    thread::sleep(Duration::from_millis(200));
    let began = Instant::now();
    let rounds = Mutex::new(0);
    server.run(|| {
        *rounds.lock().unwrap() += 1;
        *rounds.lock().unwrap() > 2
    });
    assert!(began.elapsed() < PATIENCE);
    fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn ports() {
    let taken = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port();
    let error = view::listen::listen(Some(port)).unwrap_err();
    assert_eq!(error.to_string(), format!("port {port} is in use by another program; `--port 0` takes any that is free"));
    drop(taken);
    assert_eq!(view::listen::listen(Some(port)).unwrap().local_addr().unwrap().port(), port);
    let (a, b) = (view::listen::listen(None).unwrap(), view::listen::listen(None).unwrap());
    assert_ne!(a.local_addr().unwrap(), b.local_addr().unwrap());
    assert!(a.local_addr().unwrap().ip().is_loopback());
}

#[test]
fn tokens_are_long_and_differ() {
    let gate = || view::gate::Gate::new(1).unwrap().address();
    let (a, b) = (gate(), gate());
    assert_ne!(a, b);
    let token = a.trim_start_matches("http://127.0.0.1:1/").trim_end_matches('/');
    assert!(token.len() == 32 && token.bytes().all(|b| b.is_ascii_hexdigit()));
}

#[test]
fn every_save_is_told() {
    let view = View::new("latency", Some("0\n"));
    let mut tab = view.tab("a", 0);
    tab.frame();
    let mut times = Vec::new();
    for i in 0..20 {
        thread::sleep(Duration::from_millis(37));
        let began = Instant::now();
        view.save(&format!("text {i}\n"));
        tab.frame();
        times.push(began.elapsed());
    }
    view.frame_of("text 19\n");
    times.sort();
    println!("save to event: median {:?}, worst {:?}", times[10], times[19]);
}

#[test]
fn large_buffers_come_whole() {
    let size = 24 << 20;
    let text = format!("buffer {size}\n");
    let view = View::new("large", Some(&text));
    view.frame_of(&text);
    for headers in ["", "Accept-Encoding: gzip\r\n", "Accept-Encoding: gzip\r\n"] {
        let began = Instant::now();
        let got = view.ask("GET", &format!("buffers/{size:032x}"), headers, "");
        assert_eq!(got.status, 200);
        println!("24 MB, {headers:?}: {} bytes in {:?}", got.body.len(), began.elapsed());
    }
}

#[test]
fn addresses_are_paths_below_the_token() {
    let view = View::new("address", Some("one\n"));
    assert!(Path::new(&view.base).components().count() == 2 && view.base.ends_with('/'));
}
