//! Who may ask: the page of this server and whoever was given its address, nobody else.
//!
//! A page from elsewhere that the browser shows can send requests to the loopback interface. It is told apart by the name it calls the
//! server by (`Host`, which also refuses names that were made to point here), by where it comes from (`Origin`, `Sec-Fetch-Site`) and by
//! the token in the address, which it cannot know.

use std::fmt::Write;

use super::answer::Answer;
use super::http::Head;

/// What a request must have to be let in.
#[derive(Clone, Debug)]
pub struct Gate {
    port: u16,
    token: String,
}

impl Gate {
    /// A gate with a token from the system's random source.
    ///
    /// Fails when the system has none.
    pub fn new(port: u16) -> Result<Self, getrandom::Error> {
        let mut bytes = [0; 16];
        getrandom::fill(&mut bytes)?;
        let mut token = String::new();
        for byte in bytes {
            let _ = write!(token, "{byte:02x}");
        }
        Ok(Self { port, token })
    }

    /// The address of the page.
    pub fn address(&self) -> String {
        format!("http://127.0.0.1:{}/{}/", self.port, self.token)
    }

    /// The rest of the path behind the token.
    ///
    /// Fails with the refusal of a request that is not let in.
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
        if !same(token.as_bytes(), self.token.as_bytes()) {
            return Err(Answer::refusal(403, "the address lacks the token; open the one that `loft view` printed last"));
        }
        let allowed = from_here(head) || opened(head) && rest == Some("");
        if !allowed {
            return Err(Answer::refusal(403, "other pages may not ask this server"));
        }
        rest.ok_or_else(|| Answer::refusal(404, "nothing is here; the address of the page ends in `/`"))
    }
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
        let gate = Gate { port: 7357, token: TOKEN.to_owned() };
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
}
