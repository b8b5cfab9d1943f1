//! Who may ask: the page of this server and whoever was given its address, nobody else.
//!
//! A page from elsewhere that the browser shows can send requests to the loopback interface. It is told apart by the name it calls the
//! server by (`Host`, which also refuses names that were made to point here), by where it comes from (`Origin`, `Sec-Fetch-Site`) and by
//! the token in the address, which it cannot know.
//!
//! The arguments of a program can be read by all users of the machine, so a browser is not given the token but a key that opens the page
//! once, within a minute. Whoever asks second is refused, so the user notices that somebody else asked first.

use std::fmt::Write;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use super::answer::Answer;
use super::http::Head;

/// What a request must have to be let in.
#[derive(Debug)]
pub struct Gate {
    port: u16,
    token: String,
    /// Keys that were not used, and when they were made.
    keys: Mutex<Vec<(String, Instant)>>,
}

/// Where keys are used, in place of a token.
const OPEN: &str = "open";

/// How long a key opens the page.
const KEY_LIFE: Duration = Duration::from_secs(60);

impl Gate {
    /// A gate with a token from the system's random source.
    ///
    /// Fails when the system has none.
    pub fn new(port: u16) -> Result<Self, getrandom::Error> {
        Ok(Self { port, token: random()?, keys: Mutex::default() })
    }

    /// The address of the page.
    pub fn address(&self) -> String {
        format!("http://127.0.0.1:{}/{}/", self.port, self.token)
    }

    /// An address that leads to the page, for the first who asks.
    ///
    /// Fails when the system has no random numbers.
    pub fn address_for_once(&self) -> Result<String, getrandom::Error> {
        let key = random()?;
        let address = format!("http://127.0.0.1:{}/{OPEN}/{key}", self.port);
        self.keys.lock().unwrap_or_else(PoisonError::into_inner).push((key, Instant::now()));
        Ok(address)
    }

    /// The rest of the path behind the token.
    ///
    /// Fails with the answer to a request that is not let in: a refusal, or for a key the way to the page.
    pub fn admit<'a>(&self, head: &'a Head) -> Result<&'a str, Answer> {
        let host = head.header("host").unwrap_or_default().to_ascii_lowercase();
        if ![format!("127.0.0.1:{}", self.port), format!("localhost:{}", self.port), format!("[::1]:{}", self.port)].contains(&host) {
            return Err(Answer::refusal(403, "this server answers to 127.0.0.1 and localhost with its own port only"));
        }
        if head.header("origin").is_some_and(|origin| origin.to_ascii_lowercase() != format!("http://{host}")) {
            return Err(Answer::refusal(403, "other pages may not ask this server"));
        }
        let mut parts = head.path.strip_prefix('/').unwrap_or_default().splitn(2, '/');
        let (token, rest) = (parts.next().unwrap_or_default(), parts.next());
        if let (OPEN, Some(key)) = (token, rest)
            && head.method == "GET"
            && (from_here(head) || opened(head))
        {
            return Err(self.use_key(key));
        }
        if !same(token.as_bytes(), self.token.as_bytes()) {
            return Err(Answer::refusal(403, "the address lacks the token; open the one that `loft view` printed last"));
        }
        let allowed = from_here(head) || opened(head) && rest == Some("");
        if !allowed {
            return Err(Answer::refusal(403, "other pages may not ask this server"));
        }
        rest.ok_or_else(|| Answer::refusal(404, "nothing is here; the address of the page ends in `/`"))
    }

    /// The way to the page for a key, which is then forgotten.
    fn use_key(&self, key: &str) -> Answer {
        let mut keys = self.keys.lock().unwrap_or_else(PoisonError::into_inner);
        keys.retain(|(_, made)| made.elapsed() < KEY_LIFE);
        match keys.iter().position(|(known, _)| same(known.as_bytes(), key.as_bytes())) {
            Some(k) => {
                keys.swap_remove(k);
                Answer::redirect(format!("/{}/", self.token))
            }
            None => Answer::refusal(403, "this address opens the page once, within a minute; open the one that `loft view` printed last"),
        }
    }
}

/// 128 bits of the system's random source as letters.
fn random() -> Result<String, getrandom::Error> {
    let mut bytes = [0; 16];
    getrandom::fill(&mut bytes)?;
    let mut letters = String::new();
    for byte in bytes {
        let _ = write!(letters, "{byte:02x}");
    }
    Ok(letters)
}

/// The request comes from the page itself, from the user, or from a program that is no browser.
fn from_here(head: &Head) -> bool {
    head.header("sec-fetch-site").is_none_or(|site| matches!(site, "same-origin" | "none"))
}

/// Somebody follows a link to the page, or an editor shows it in a frame; which frames may is said by the page's own policy.
fn opened(head: &Head) -> bool {
    head.method == "GET" && head.header("sec-fetch-mode") == Some("navigate") && head.header("origin").is_none()
}

/// Compares in a time that does not depend on where two texts differ.
fn same(a: &[u8], b: &[u8]) -> bool {
    a.len() == b.len() && a.iter().zip(b).fold(0, |different, (x, y)| different | (x ^ y)) == 0
}

#[cfg(test)]
mod tests {
    use super::super::http::parse_head;
    use super::*;

    const TOKEN: &str = "00112233445566778899aabbccddeeff";

    fn check(request: &str, expected: Result<&str, u16>) {
        let gate = Gate { port: 7357, token: TOKEN.to_owned(), keys: Mutex::default() };
        let head = parse_head(request.replace("TOKEN", TOKEN).replace('\n', "\r\n").as_bytes()).unwrap();
        assert_eq!(gate.admit(&head).map_err(|answer| answer.status), expected, "{request}");
    }

    #[test]
    fn only_who_knows_the_address_is_let_in() {
        check("GET /TOKEN/ HTTP/1.1\nHost: 127.0.0.1:7357", Ok(""));
        check("GET /TOKEN/frame HTTP/1.1\nHost: LocalHost:7357", Ok("frame"));
        check("GET /TOKEN/frame HTTP/1.1\nHost: [::1]:7357\nOrigin: http://[::1]:7357", Ok("frame"));
        check("GET /TOKEN HTTP/1.1\nHost: localhost:7357", Err(404));
        check("GET /TOKEN0/frame HTTP/1.1\nHost: localhost:7357", Err(403));
        check("GET /00112233445566778899aabbccddeefe/frame HTTP/1.1\nHost: localhost:7357", Err(403));
        check("GET / HTTP/1.1\nHost: localhost:7357", Err(403));
        check("GET //TOKEN/ HTTP/1.1\nHost: localhost:7357", Err(403));
    }

    #[test]
    fn other_names_and_pages_are_refused() {
        for host in ["evil.example:7357", "127.0.0.1:7358", "127.0.0.1", "localhost.:7357", "127.0.0.1:7357.evil.example", ""] {
            check(&format!("GET /TOKEN/ HTTP/1.1\nHost: {host}"), Err(403));
        }
        check("GET /TOKEN/ HTTP/1.1", Err(403));
        for origin in ["null", "http://evil.example", "https://localhost:7357", "http://localhost:7358", "http://127.0.0.1:7357"] {
            check(&format!("POST /TOKEN/set HTTP/1.1\nHost: localhost:7357\nOrigin: {origin}"), Err(403));
        }
        check("GET /TOKEN/frame HTTP/1.1\nHost: localhost:7357\nSec-Fetch-Site: cross-site", Err(403));
        check("GET /TOKEN/frame HTTP/1.1\nHost: localhost:7357\nSec-Fetch-Site: same-site", Err(403));
        check("GET /TOKEN/frame HTTP/1.1\nHost: localhost:7357\nSec-Fetch-Site: same-origin", Ok("frame"));
    }

    #[test]
    fn the_page_itself_is_opened_by_links() {
        let from = "HTTP/1.1\nHost: localhost:7357\nSec-Fetch-Site: cross-site\nSec-Fetch-Mode";
        check(&format!("GET /TOKEN/ {from}: navigate"), Ok(""));
        check(&format!("GET /TOKEN/frame {from}: navigate"), Err(403));
        check(&format!("GET /TOKEN/ {from}: no-cors"), Err(403));
        check(&format!("POST /TOKEN/ {from}: navigate"), Err(403));
    }

    #[test]
    fn a_key_leads_to_the_page_once() {
        let gate = Gate::new(7357).unwrap();
        let (one, other) = (gate.address_for_once().unwrap(), gate.address_for_once().unwrap());
        let status = |address: &str, rest: &str| {
            let path = address.strip_prefix("http://127.0.0.1:7357").unwrap();
            let head = parse_head(format!("GET {path} HTTP/1.1\r\n{rest}").as_bytes()).unwrap();
            gate.admit(&head).map_err(|answer| (answer.status, answer.head(true))).unwrap_err()
        };
        let here = "Host: 127.0.0.1:7357";
        assert_eq!(status(&one, "Host: evil.example:7357").0, 403);
        assert_eq!(status(&one, &format!("{here}\r\nSec-Fetch-Site: cross-site\r\nSec-Fetch-Mode: no-cors")).0, 403);
        assert_eq!(status(&format!("{one}0"), here).0, 403);
        let (code, head) = status(&one, here);
        assert!(code == 303 && head.contains(&format!("\r\nLocation: /{}/\r\n", gate.token)), "{head}");
        assert_eq!([status(&one, here).0, status(&other, here).0, status(&other, here).0], [403, 303, 403]);
        assert!(!one.contains(&gate.token));
    }
}
