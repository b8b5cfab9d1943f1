//! Messages over standard input and output. A body that is no message is answered, and what follows is read.

use std::io::{self, BufRead, Read, Write};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};

use lsp_server::{Connection, ErrorCode, Message};
use serde_json::{Value, json};

/// The threads that read and write.
pub struct Wires {
    reader: JoinHandle<io::Result<()>>,
    writer: JoinHandle<io::Result<()>>,
}

impl Wires {
    /// Waits until all is read and written; the error says what broke off.
    pub fn join(self) -> Result<(), String> {
        for thread in [self.reader, self.writer] {
            thread.join().map_err(|_| "a thread failed".to_owned())?.map_err(|error| error.to_string())?;
        }
        Ok(())
    }
}

/// A connection over standard input and output.
pub fn stdio() -> (Connection, Wires) {
    let (ours, theirs) = Connection::memory();
    let Connection { sender, receiver } = theirs;
    // Answers of both threads go out whole.
    let out = Arc::new(Mutex::new(io::stdout()));
    let answers = out.clone();
    let reader = thread::spawn(move || {
        let mut input = io::stdin().lock();
        while let Some(body) = body(&mut input)? {
            let message = match message(&body) {
                Ok(message) => message,
                Err((code, words)) => {
                    write(&mut *answers.lock().unwrap_or_else(PoisonError::into_inner), &refusal(code, &words))?;
                    continue;
                }
            };
            let last = matches!(&message, Message::Notification(note) if note.method == "exit");
            // A server that is gone reads no more.
            if sender.send(message).is_err() || last {
                break;
            }
        }
        Ok(())
    });
    let writer = thread::spawn(move || {
        receiver.into_iter().try_for_each(|message| message.write(&mut *out.lock().unwrap_or_else(PoisonError::into_inner)))
    });
    (ours, Wires { reader, writer })
}

/// The next body; none at the end of the input. Without its length nothing behind it can be found either.
fn body(input: &mut impl BufRead) -> io::Result<Option<Vec<u8>>> {
    let broken = |words: String| io::Error::new(io::ErrorKind::InvalidData, words);
    let mut size = None;
    loop {
        let mut line = String::new();
        if input.read_line(&mut line)? == 0 {
            return Ok(None);
        }
        let line = line.trim_end_matches(['\r', '\n']);
        if line.is_empty() {
            break;
        }
        let (name, value) = line.split_once(':').ok_or_else(|| broken(format!("malformed header: {line:?}")))?;
        if name.trim().eq_ignore_ascii_case("Content-Length") {
            let length = value.trim().parse::<u64>();
            size = Some(length.map_err(|_| broken(format!("malformed header: {line:?}")))?);
        }
    }
    let size = size.ok_or_else(|| broken("a message without Content-Length".to_owned()))?;
    let mut body = Vec::new();
    // Read as it comes: a length alone takes no memory.
    Read::take(input, size).read_to_end(&mut body)?;
    if (body.len() as u64) < size { Err(io::ErrorKind::UnexpectedEof.into()) } else { Ok(Some(body)) }
}

/// Reads a body as a message. The error is a code of JSON-RPC and the reason in words.
fn message(body: &[u8]) -> Result<Message, (ErrorCode, String)> {
    let value: Value =
        serde_json::from_slice(body).map_err(|error| (ErrorCode::ParseError, format!("the message is not JSON: {error}")))?;
    serde_json::from_value(value).map_err(|error| (ErrorCode::InvalidRequest, format!("not a message of the protocol: {error}")))
}

/// The answer to what has no readable number of its own.
fn refusal(code: ErrorCode, words: &str) -> Value {
    json!({ "jsonrpc": "2.0", "id": null, "error": { "code": code as i32, "message": words } })
}

fn write(out: &mut impl Write, value: &Value) -> io::Result<()> {
    let text = value.to_string();
    write!(out, "Content-Length: {}\r\n\r\n{text}", text.len())?;
    out.flush()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bodies_that_are_no_messages_are_told_apart() {
        let code = |body: &[u8]| message(body).err().map(|e| e.0 as i32);
        assert_eq!(code(b"{nonsense"), Some(-32700));
        assert_eq!(code(b"\xff\xfe"), Some(-32700));
        assert_eq!(code(b"[1, 2]"), Some(-32600));
        assert_eq!(code(br#"{"jsonrpc": "2.0", "method": "exit"}"#), None);
    }

    #[test]
    fn bodies_are_cut_by_their_lengths() {
        let mut input = &b"Content-Length: 2\r\n\r\nabContent-Length: 1\r\n\r\nc"[..];
        assert_eq!(body(&mut input).unwrap().as_deref(), Some(&b"ab"[..]));
        assert_eq!(body(&mut input).unwrap().as_deref(), Some(&b"c"[..]));
        assert_eq!(body(&mut input).unwrap(), None);
        assert!(body(&mut &b"Content-Length: 9\r\n\r\nab"[..]).is_err());
    }
}
