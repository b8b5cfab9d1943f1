//! What each address answers.

use std::collections::BTreeSet;
use std::sync::Arc;

use serde_json::{Value, json};

use super::answer::{Answer, Keep};
use super::compress::Packed;
use super::events::Kind;
use super::http::{Connection, Failure, Head};
use super::model::Compare;
use super::server::Shared;

/// Buffers that one request may ask for.
pub const MOST_BUFFERS: usize = 128;

/// Bytes that several buffers may have together; one may have any number.
const MOST_TOGETHER: usize = 4 << 20;

/// Letters of a buffer's key.
const KEY: usize = 32;

/// Letters that a name of a tab may have.
const LONGEST_TAB: usize = 64;

/// Answers one request; gives the connection back when another may follow.
pub fn answer(shared: &Shared, mut connection: Connection) -> Option<Connection> {
    let head = match connection.head() {
        Ok(head) => head,
        Err(failure) => {
            refuse(connection, failure);
            return None;
        }
    };
    let path = match shared.gate.admit(&head) {
        Ok(path) => path,
        Err(answer) => {
            connection.refuse(&answer);
            return None;
        }
    };
    let Some(method) = method_of(path) else {
        connection.refuse(&Answer::refusal(404, "nothing is here"));
        return None;
    };
    if head.method != method {
        connection.refuse(&Answer::refusal(405, &format!("only {method} is answered here")).allowing(method));
        return None;
    }
    let body = match connection.body(&head) {
        Ok(body) => body,
        Err(failure) => {
            refuse(connection, failure);
            return None;
        }
    };
    if path == "events" {
        if !stream(shared, &connection, &head) {
            connection.refuse(&wrong("the name of the tab has letters, digits, `-` and `_` only"));
        }
        return None;
    }
    let answer = if method == "GET" { get(shared, path, &head) } else { post(shared, path, &body) };
    connection.send(&answer, &head).then_some(connection)
}

/// The one method of a path that is known.
fn method_of(path: &str) -> Option<&'static str> {
    match path {
        "" | "events" | "frame" => Some("GET"),
        "set" | "write" | "stop" | "show" | "refine" | "compare" | "cursor" => Some("POST"),
        _ => path.strip_prefix("buffers/").map(|_| "GET"),
    }
}

fn refuse(connection: Connection, failure: Failure) {
    let Failure::Refused(status) = failure else { return };
    let words = match status {
        408 => "the request took too long to arrive",
        411 => "the length of the body is missing",
        413 => "the body is longer than 64 kB",
        431 => "the headers are longer than 16 kB",
        505 => "only HTTP/1.1 is spoken here",
        _ => "this is no request",
    };
    connection.refuse(&Answer::refusal(status, words));
}

fn get(shared: &Shared, path: &str, head: &Head) -> Answer {
    match path {
        "" => Answer::packed("text/html; charset=utf-8", &shared.page, head.takes_gzip()),
        "frame" => match shared.frames.newest() {
            Some(json) => Answer::packed("application/json", &json, head.takes_gzip()),
            None => Answer::nothing(),
        },
        _ => buffers(shared, path.strip_prefix("buffers/").unwrap_or_default(), head),
    }
}

/// The buffers of some keys with `+` between them: one as it is, or compressed; several one after the other, where one that no recent frame
/// has is left out and has `-` for its length.
fn buffers(shared: &Shared, keys: &str, head: &Head) -> Answer {
    let media = "application/octet-stream";
    let keys: Vec<&str> = keys.split('+').collect();
    let is_key = |key: &&str| key.len() == KEY && key.bytes().all(|b| b.is_ascii_digit() || (b'a'..=b'f').contains(&b));
    if keys.len() > MOST_BUFFERS || !keys.iter().all(is_key) || keys.iter().collect::<BTreeSet<_>>().len() < keys.len() {
        return Answer::refusal(400, &format!("buffers are asked for by different keys of {KEY} hex digits, {MOST_BUFFERS} at most"));
    }
    let found: Vec<Option<Arc<Packed>>> = keys.iter().map(|key| shared.frames.buffer(key)).collect();
    match &found[..] {
        [Some(buffer)] => Answer::packed(media, buffer, head.takes_gzip()).kept(Keep::Forever),
        [None] => Answer::refusal(404, "no recent frame has this buffer"),
        _ if found.iter().flatten().map(|buffer| buffer.plain().len()).sum::<usize>() > MOST_TOGETHER => {
            Answer::refusal(413, "these buffers are too many bytes for one answer; ask for some of them")
        }
        _ => Answer::several(media, &found),
    }
}

/// Hands the connection over to the events. The browser names what it was told last when it asks again by itself; the address has what
/// the page knew when it asked first. `false` where the request is not understood.
fn stream(shared: &Shared, connection: &Connection, head: &Head) -> bool {
    let tab = head.query_value("tab").unwrap_or_default();
    let sound = (1..=LONGEST_TAB).contains(&tab.len()) && tab.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'-' || b == b'_');
    if sound {
        let number = |text: Option<&str>| text.and_then(|text| text.parse().ok()).unwrap_or(0);
        let last = number(head.query_value("last")).max(number(head.header("last-event-id")));
        // A page that is gone already asks again.
        let _ = shared.events.open(tab, last, connection.stream().clone());
    }
    sound
}

fn post(shared: &Shared, path: &str, body: &[u8]) -> Answer {
    let asked: Value = match path {
        "stop" => Value::Null,
        _ => match serde_json::from_slice(body) {
            Ok(asked) => asked,
            Err(error) => return wrong(&format!("the body is no JSON: {error}")),
        },
    };
    let done = match path {
        "set" => set(shared, &asked),
        "write" => write(shared, &asked),
        "show" => show(shared, &asked),
        "refine" => refine(shared, &asked),
        "compare" => return compare(shared, &asked),
        "cursor" => cursor(shared, &asked),
        _ => {
            shared.work.stop();
            Some(Ok(()))
        }
    };
    match done {
        Some(Ok(())) => Answer::json(&json!({ "ok": true })),
        Some(Err(message)) => Answer::json(&json!({ "ok": false, "message": message })),
        None => wrong(&format!("`{path}` does not understand this")),
    }
}

fn wrong(message: &str) -> Answer {
    Answer::json(&json!({ "ok": false, "message": message })).with_status(400)
}

/// What came of a request that was understood.
type Done = Option<Result<(), String>>;

fn set(shared: &Shared, asked: &Value) -> Done {
    let name = asked["name"].as_str()?;
    let text = match asked.get("text")? {
        Value::Null => None,
        text => Some(text.as_str()?),
    };
    Some(shared.work.set(name, text))
}

fn write(shared: &Shared, asked: &Value) -> Done {
    let (name, text) = (asked["name"].as_str()?, asked["text"].as_str()?);
    let written = shared.script.write(name, text);
    if written.is_ok() {
        shared.work.forget(name);
    }
    Some(written)
}

fn show(shared: &Shared, asked: &Value) -> Done {
    let number = |name: &str| asked.get(name).map_or(Some(1), |n| u32::try_from(n.as_u64()?).ok().filter(|n| *n > 0));
    let shown = shared.script.show(asked["file"].as_str()?, number("line")?, number("column")?);
    Some(if shown { Ok(()) } else { Err("no editor is attached".to_owned()) })
}

fn refine(shared: &Shared, asked: &Value) -> Done {
    let error = asked["error"].as_f64().filter(|error| error.is_finite() && *error > 0.0)?;
    shared.work.refine(error);
    Some(Ok(()))
}

/// The answer has the number of the first frame that knows of it, so that a page can tell it from frames of before.
fn compare(shared: &Shared, asked: &Value) -> Answer {
    let with = match asked.get("with").map(|with| (with, with.as_str().unwrap_or_default())) {
        Some((Value::Null, _)) => None,
        Some((_, "golden")) => Some(Compare::Golden),
        Some((_, text)) => match text.strip_prefix("revision:") {
            Some(name) if is_revision(name) => Some(Compare::Revision(name.to_owned())),
            Some(_) => return Answer::json(&json!({ "ok": false, "message": NO_REVISION })),
            None => return wrong("`compare` does not understand this"),
        },
        None => return wrong("`compare` does not understand this"),
    };
    Answer::json(&json!({ "ok": true, "from": shared.work.compare(with) }))
}

const NO_REVISION: &str = "a revision is named by a branch, a tag or a commit, in 200 characters at most and without `-` before it";

/// It becomes an argument of another program, never one of its options.
fn is_revision(name: &str) -> bool {
    (1..=200).contains(&name.chars().count()) && !name.starts_with('-') && !name.chars().any(char::is_control)
}

fn cursor(shared: &Shared, asked: &Value) -> Done {
    let (file, line) = (asked["file"].as_str()?, asked["line"].as_u64()?);
    shared.events.tell(Kind::Cursor, &json!({ "file": file, "line": line }));
    Some(Ok(()))
}
