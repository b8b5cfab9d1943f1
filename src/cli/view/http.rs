//! Requests of HTTP/1.1 over one connection, read within limits of size and time.

use std::io::{self, Read, Write};
use std::net::{Shutdown, TcpStream};
use std::sync::Arc;
use std::time::{Duration, Instant};

use super::answer::Answer;
use super::connections::Place;

/// Bytes that the request line and the headers may have.
pub const MOST_HEAD: usize = 16 * 1024;

/// Bytes that a body may have.
pub const MOST_BODY: usize = 64 * 1024;

/// How long a connection may stay without a request.
const IDLE: Duration = Duration::from_secs(10);

/// How long a request may take to arrive once it has begun.
const ARRIVAL: Duration = Duration::from_secs(5);

/// How long an answer may stay without the other side taking any of it.
const TAKING: Duration = Duration::from_secs(10);

/// What is read of a body that was refused, so that the refusal arrives before the connection ends.
const MOST_REFUSED: usize = 1024 * 1024;

/// Bytes that are sent before the connection counts as waiting anew.
const PIECE: usize = 256 * 1024;

/// Why there is no request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Failure {
    /// The other side is gone, or was silent for too long.
    Over,
    /// The request is refused with this status.
    Refused(u16),
}

/// The request line and the headers.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Head {
    /// In capitals, such as `GET`.
    pub method: String,
    /// As it was sent; nothing is decoded.
    pub path: String,
    /// What stands behind the first `?`.
    pub query: String,
    /// Names in lower case.
    headers: Vec<(String, String)>,
    /// The connection ends after the answer.
    close: bool,
}

impl Head {
    /// The first header of a name, which is in lower case.
    pub fn header(&self, name: &str) -> Option<&str> {
        self.headers.iter().find(|(n, _)| n == name).map(|(_, value)| value.as_str())
    }

    /// The browser takes compressed answers.
    pub fn takes_gzip(&self) -> bool {
        let mut codings = self.header("accept-encoding").unwrap_or_default().split(',');
        codings.any(|coding| {
            let mut parts = coding.split(';').map(str::trim);
            let named = parts.next().is_some_and(|name| name.eq_ignore_ascii_case("gzip"));
            named && !parts.any(|part| part.strip_prefix("q=").is_some_and(|q| q.parse() == Ok(0.0)))
        })
    }

    /// One value of the query; nothing is decoded.
    pub fn query_value(&self, name: &str) -> Option<&str> {
        self.query.split('&').find_map(|pair| pair.split_once('=').filter(|(n, _)| *n == name)).map(|(_, value)| value)
    }

    /// Length of the body.
    ///
    /// Fails with the status of the refusal: 400 where it is no number, 411 where the body says its length piece by piece, 413 where it is
    /// too long.
    pub fn length(&self) -> Result<usize, Failure> {
        if self.header("transfer-encoding").is_some() {
            return Err(Failure::Refused(411));
        }
        let Some(text) = self.header("content-length") else { return Ok(0) };
        if text.is_empty() || !text.bytes().all(|b| b.is_ascii_digit()) {
            return Err(Failure::Refused(400));
        }
        // A number too large to be read is too large in any case.
        text.parse().ok().filter(|n| *n <= MOST_BODY).ok_or(Failure::Refused(413))
    }
}

/// Reads the request line and the headers, without the empty line behind them.
///
/// Fails with the status of the refusal.
pub fn parse_head(bytes: &[u8]) -> Result<Head, Failure> {
    let bad = || Failure::Refused(400);
    let text = std::str::from_utf8(bytes).map_err(|_| bad())?;
    let mut lines = text.split("\r\n");
    if text.bytes().any(|b| b.is_ascii_control() && !matches!(b, b'\r' | b'\n' | b'\t')) {
        return Err(bad());
    }
    let mut first = lines.next().unwrap_or_default().split(' ');
    let (Some(method), Some(target), Some(version), None) = (first.next(), first.next(), first.next(), first.next()) else {
        return Err(bad());
    };
    if !target.starts_with('/') || method.is_empty() || !method.bytes().all(|b| b.is_ascii_uppercase()) {
        return Err(bad());
    }
    let (path, query) = target.split_once('?').unwrap_or((target, ""));
    let mut head = Head { method: method.to_owned(), path: path.to_owned(), query: query.to_owned(), ..Head::default() };
    for line in lines {
        let (name, value) = line.split_once(':').ok_or_else(bad)?;
        let sound = !name.is_empty() && name.bytes().all(|b| b.is_ascii_alphanumeric() || b"!#$%&'*+-.^_`|~".contains(&b));
        if !sound || value.contains(['\r', '\n']) {
            return Err(bad());
        }
        let name = name.to_ascii_lowercase();
        // Two of these could be understood in two ways.
        let single = ["host", "origin", "content-length", "transfer-encoding", "sec-fetch-site"].contains(&name.as_str());
        if single && head.header(&name).is_some() {
            return Err(bad());
        }
        head.headers.push((name, value.trim_matches([' ', '\t']).to_owned()));
    }
    let connection = head.header("connection").unwrap_or_default().to_ascii_lowercase();
    head.close = match version {
        "HTTP/1.1" => connection.contains("close"),
        "HTTP/1.0" => true,
        _ => return Err(Failure::Refused(505)),
    };
    Ok(head)
}

/// One connection: requests and answers in turn.
#[derive(Debug)]
pub struct Connection {
    stream: Arc<TcpStream>,
    place: Place,
    /// What was read beyond the last request.
    read: Vec<u8>,
}

impl Connection {
    /// A connection with its place among the open ones.
    ///
    /// Fails when the connection is gone already.
    pub fn new(stream: Arc<TcpStream>, place: Place) -> io::Result<Self> {
        stream.set_nodelay(true)?;
        stream.set_write_timeout(Some(TAKING))?;
        Ok(Self { stream, place, read: Vec::new() })
    }

    /// The connection itself, for answers that go on.
    pub fn stream(&self) -> &Arc<TcpStream> {
        &self.stream
    }

    /// Reads the next request up to its body.
    ///
    /// Fails when none arrives in time or it is refused: 408 too slow, 431 too long, 400 not HTTP.
    pub fn head(&mut self) -> Result<Head, Failure> {
        self.place.waits();
        let mut deadline = Instant::now() + if self.read.is_empty() { IDLE } else { ARRIVAL };
        let mut looked = 0;
        let end = loop {
            if let Some(end) = self.read[looked..].windows(4).position(|w| w == b"\r\n\r\n") {
                break looked + end;
            }
            looked = self.read.len().saturating_sub(3);
            if self.read.len() >= MOST_HEAD {
                return Err(Failure::Refused(431));
            }
            let begun = !self.read.is_empty();
            self.fill(MOST_HEAD, deadline).map_err(|failure| if begun { failure } else { Failure::Over })?;
            if !begun {
                deadline = Instant::now() + ARRIVAL;
            }
        };
        self.place.works();
        let head = parse_head(&self.read[..end]);
        self.read.drain(..end + 4);
        head
    }

    /// Reads the body of a request.
    ///
    /// Fails as [`Head::length`] before anything of it is read, and when it does not arrive in time.
    pub fn body(&mut self, head: &Head) -> Result<Vec<u8>, Failure> {
        let length = head.length()?;
        if head.header("expect").is_some() && self.read.len() < length {
            (&*self.stream).write_all(b"HTTP/1.1 100 Continue\r\n\r\n").map_err(|_| Failure::Over)?;
        }
        self.place.waits();
        let deadline = Instant::now() + ARRIVAL;
        while self.read.len() < length {
            self.fill(length, deadline)?;
        }
        self.place.works();
        Ok(self.read.drain(..length).collect())
    }

    /// Sends an answer; `false` when the connection is over then.
    pub fn send(&mut self, answer: &Answer, head: &Head) -> bool {
        self.write(answer, head.close).is_ok() && !head.close
    }

    /// Sends an answer to a request whose body may not have been read, and ends the connection.
    pub fn refuse(mut self, answer: &Answer) {
        if self.write(answer, true).is_err() || self.stream.shutdown(Shutdown::Write).is_err() {
            return;
        }
        // What arrives after the end would make the system take back the answer. Others may have the place meanwhile.
        self.place.waits();
        let deadline = Instant::now() + Duration::from_secs(1);
        let mut left = MOST_REFUSED;
        while left > 0 {
            self.read.clear();
            if self.fill(MOST_HEAD, deadline).is_err() {
                return;
            }
            left = left.saturating_sub(self.read.len());
        }
    }

    fn write(&mut self, answer: &Answer, close: bool) -> io::Result<()> {
        self.place.waits();
        let (first, rest) = answer.body().split_at(answer.body().len().min(PIECE));
        // Head and body in one piece: fewer packets.
        let mut bytes = answer.head(close).into_bytes();
        bytes.extend_from_slice(first);
        (&*self.stream).write_all(&bytes)?;
        for piece in rest.chunks(PIECE) {
            self.place.waits();
            (&*self.stream).write_all(piece)?;
        }
        self.place.works();
        Ok(())
    }

    /// Reads what is there, so that no more than `most` bytes are held.
    fn fill(&mut self, most: usize, deadline: Instant) -> Result<(), Failure> {
        let left = deadline.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return Err(Failure::Refused(408));
        }
        self.stream.set_read_timeout(Some(left)).map_err(|_| Failure::Over)?;
        let mut piece = [0; 4096];
        let wanted = piece.len().min(most.saturating_sub(self.read.len()).max(1));
        match (&*self.stream).read(&mut piece[..wanted]) {
            Ok(0) => Err(Failure::Over),
            Ok(n) => {
                self.read.extend_from_slice(&piece[..n]);
                Ok(())
            }
            Err(error) if error.kind() == io::ErrorKind::Interrupted => Ok(()),
            Err(error) if matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut) => Err(Failure::Refused(408)),
            Err(_) => Err(Failure::Over),
        }
    }
}
