//! Answers of HTTP/1.1 and the headers that every one of them has.

use std::sync::Arc;

use super::compress::Packed;

/// What the page may do: run what stands in it and workers that it makes itself, ask this server, and nothing else. Editors show it in a
/// frame of their own.
const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline' blob:; worker-src blob:; style-src 'unsafe-inline'; \
    img-src data: blob:; font-src data:; connect-src 'self'; base-uri 'none'; form-action 'none'; \
    frame-ancestors 'self' vscode-webview: vscode-file:";

/// How long a browser may keep an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Keep {
    /// Not at all.
    Never,
    /// For ever: what stands at the address never changes.
    Forever,
}

/// An answer with its whole body.
#[derive(Clone, Debug)]
pub struct Answer {
    /// Three digits.
    pub status: u16,
    media: &'static str,
    body: Arc<Vec<u8>>,
    gzip: bool,
    keep: Keep,
    allow: Option<&'static str>,
    location: Option<String>,
    lengths: Option<String>,
}

impl Answer {
    /// An answer with a body of some media type.
    pub fn new(media: &'static str, body: Vec<u8>) -> Self {
        Self { status: 200, media, body: Arc::new(body), gzip: false, keep: Keep::Never, allow: None, location: None, lengths: None }
    }

    /// A JSON value.
    pub fn json(value: &serde_json::Value) -> Self {
        Self::new("application/json", value.to_string().into_bytes())
    }

    /// Bytes that may have been compressed, in the form that the browser takes.
    pub fn packed(media: &'static str, packed: &Packed, takes_gzip: bool) -> Self {
        let compressed = if takes_gzip { packed.gzip() } else { None };
        let body = compressed.unwrap_or(packed.plain()).clone();
        Self { body, gzip: compressed.is_some(), ..Self::new(media, Vec::new()) }
    }

    /// Several bodies one after the other, with the length of each in a header of its own; `None` where one is missing.
    pub fn several(media: &'static str, parts: &[Option<Arc<Packed>>]) -> Self {
        let length = |part: &Option<Arc<Packed>>| part.as_ref().map_or("-".to_owned(), |part| part.plain().len().to_string());
        let lengths = parts.iter().map(length).collect::<Vec<_>>().join(",");
        let body: Vec<&[u8]> = parts.iter().flatten().map(|part| part.plain().as_slice()).collect();
        Self { lengths: Some(lengths), ..Self::new(media, body.concat()) }
    }

    /// The same answer with another status.
    pub fn with_status(self, status: u16) -> Self {
        Self { status, ..self }
    }

    /// A refusal, with a sentence for whoever reads it.
    pub fn refusal(status: u16, words: &str) -> Self {
        Self::new("text/plain; charset=utf-8", format!("{words}\n").into_bytes()).with_status(status)
    }

    /// What was asked for is at another path.
    pub fn redirect(path: String) -> Self {
        Self { status: 303, location: Some(path), ..Self::new("text/plain; charset=utf-8", Vec::new()) }
    }

    /// There is nothing to send.
    pub fn nothing() -> Self {
        Self::new("", Vec::new()).with_status(204)
    }

    /// The same answer, which a browser may keep.
    pub fn kept(self, keep: Keep) -> Self {
        Self { keep, ..self }
    }

    /// The same answer, naming the methods that are allowed.
    pub fn allowing(self, methods: &'static str) -> Self {
        Self { allow: Some(methods), ..self }
    }

    /// The body as it is sent.
    pub fn body(&self) -> &[u8] {
        &self.body
    }

    /// Status line and headers, with the empty line behind them.
    pub fn head(&self, close: bool) -> String {
        let mut head = start(self.status, self.keep);
        if self.status != 204 {
            head += &format!("Content-Type: {}\r\nContent-Length: {}\r\n", self.media, self.body.len());
        }
        if self.gzip {
            head += "Content-Encoding: gzip\r\n";
        }
        if let Some(lengths) = &self.lengths {
            head += &format!("Part-Lengths: {lengths}\r\n");
        }
        if let Some(methods) = self.allow {
            head += &format!("Allow: {methods}\r\n");
        }
        if let Some(path) = &self.location {
            head += &format!("Location: {path}\r\n");
        }
        head += if close { "Connection: close\r\n\r\n" } else { "Connection: keep-alive\r\n\r\n" };
        head
    }
}

/// The head of an answer whose body goes on until one side ends it.
pub fn stream_head(media: &str) -> String {
    format!("{}Content-Type: {media}\r\nConnection: close\r\n\r\n", start(200, Keep::Never))
}

fn start(status: u16, keep: Keep) -> String {
    let reason = match status {
        100 => "Continue",
        200 => "OK",
        204 => "No Content",
        303 => "See Other",
        400 => "Bad Request",
        403 => "Forbidden",
        404 => "Not Found",
        405 => "Method Not Allowed",
        408 => "Request Timeout",
        411 => "Length Required",
        413 => "Content Too Large",
        431 => "Request Header Fields Too Large",
        505 => "HTTP Version Not Supported",
        _ => "Error",
    };
    let keep = match keep {
        Keep::Never => "no-store",
        Keep::Forever => "private, max-age=31536000, immutable",
    };
    format!(
        "HTTP/1.1 {status} {reason}\r\nCache-Control: {keep}\r\nContent-Security-Policy: {POLICY}\r\nX-Content-Type-Options: nosniff\r\n\
         Referrer-Policy: no-referrer\r\nCross-Origin-Resource-Policy: same-origin\r\nCross-Origin-Opener-Policy: same-origin\r\n\
         Vary: Accept-Encoding, Origin\r\n"
    )
}
