//! A question to the terminal, and the keys that are typed while its answer is waited for.

use crate::session::notebook::Notebook;

/// What was typed while the terminal was asked, still to be entered.
#[derive(Debug, Default)]
pub struct Typed {
    text: String,
}

impl Typed {
    /// The attributes by which the terminal answers `ESC [ c`; none where it does not answer soon.
    pub fn attributes(&mut self) -> Vec<u16> {
        let (attributes, typed) = asked();
        self.text.push_str(&String::from_utf8_lossy(&typed).replace('\r', "\n"));
        // A key that is no letter has nothing to do in a line that is not there yet.
        self.text.retain(|c| c == '\n' || !c.is_control());
        attributes
    }

    /// The next entry that was typed whole.
    pub fn entry(&mut self) -> Option<String> {
        let mut ends = self.text.match_indices('\n').map(|(at, _)| at);
        let end = ends.find(|end| !Notebook::is_unfinished(&self.text[..*end]))?;
        let entry = self.text[..end].to_owned();
        self.text.drain(..=end);
        Some(entry)
    }

    /// What is left: the beginning of an entry.
    pub fn rest(&mut self) -> String {
        std::mem::take(&mut self.text)
    }
}

/// Finds the answer of a terminal among what is typed.
#[cfg(any(unix, test))]
#[derive(Default)]
struct Answer {
    typed: Vec<u8>,
    /// What may be the beginning of the answer.
    begun: Vec<u8>,
}

#[cfg(any(unix, test))]
impl Answer {
    /// How an answer begins.
    const HEAD: &[u8] = b"\x1b[?";

    /// One byte more; the attributes when the answer is whole.
    fn take(&mut self, byte: u8) -> Option<Vec<u16>> {
        self.begun.push(byte);
        let inside = self.begun.len() > Self::HEAD.len() && self.begun.starts_with(Self::HEAD);
        if inside && byte == b'c' {
            let numbers = String::from_utf8_lossy(&self.begun[Self::HEAD.len()..self.begun.len() - 1]).into_owned();
            self.begun.clear();
            return Some(numbers.split(';').filter_map(|n| n.parse().ok()).collect());
        }
        let fits = if inside { byte.is_ascii_digit() || byte == b';' } else { Self::HEAD.starts_with(&self.begun) };
        if !fits {
            // The byte itself may begin the answer.
            let from = if byte == Self::HEAD[0] { self.begun.len() - 1 } else { self.begun.len() };
            self.typed.extend(self.begun.drain(..from));
        }
        None
    }

    /// All that was no answer.
    fn end(mut self) -> Vec<u8> {
        self.typed.append(&mut self.begun);
        self.typed
    }
}

/// Pixels of a row of the terminal, where it says so.
#[cfg(unix)]
pub fn pixels_of_row() -> Option<usize> {
    let size = rustix::termios::tcgetwinsize(rustix::stdio::stdout()).ok()?;
    (size.ws_xpixel > 0).then_some(usize::from(size.ws_xpixel))
}

#[cfg(not(unix))]
pub fn pixels_of_row() -> Option<usize> {
    None
}

/// The attributes that the terminal answers, and what was typed before its answer.
#[cfg(unix)]
fn asked() -> (Vec<u16>, Vec<u8>) {
    use rustix::termios::{LocalModes, OptionalActions, SpecialCodeIndex, tcgetattr, tcsetattr};
    let input = rustix::stdio::stdin();
    let Ok(before) = tcgetattr(input) else { return Default::default() };
    let mut raw = before.clone();
    raw.local_modes.remove(LocalModes::ICANON | LocalModes::ECHO);
    raw.special_codes[SpecialCodeIndex::VMIN] = 1;
    raw.special_codes[SpecialCodeIndex::VTIME] = 0;
    // What was typed before stays to be read.
    if tcsetattr(input, OptionalActions::Now, &raw).is_err() {
        return Default::default();
    }
    let found = answered();
    // A terminal that is gone needs no settings.
    let _ = tcsetattr(input, OptionalActions::Now, &before);
    found
}

#[cfg(not(unix))]
fn asked() -> (Vec<u16>, Vec<u8>) {
    Default::default()
}

/// Asks, and reads byte by byte to the end of the answer: what is typed behind it is left to be read.
#[cfg(unix)]
fn answered() -> (Vec<u16>, Vec<u8>) {
    use rustix::event::{PollFd, PollFlags, Timespec, poll};
    use std::io::Write;
    use std::time::{Duration, Instant};
    /// Terminals answer within milliseconds, far ones a little later.
    const PATIENCE: Duration = Duration::from_millis(400);
    let input = rustix::stdio::stdin();
    let mut answer = Answer::default();
    let mut out = std::io::stdout().lock();
    if out.write_all(b"\x1b[c").and_then(|()| out.flush()).is_err() {
        return Default::default();
    }
    let end = Instant::now() + PATIENCE;
    loop {
        let left = end.saturating_duration_since(Instant::now());
        let wait = Timespec { tv_sec: 0, tv_nsec: i64::from(left.subsec_nanos()) };
        let ready = !left.is_zero() && poll(&mut [PollFd::new(&input, PollFlags::IN)], Some(&wait)).is_ok_and(|n| n > 0);
        let mut byte = [0];
        if !ready || !rustix::io::read(input, &mut byte).is_ok_and(|n| n == 1) {
            return (Vec::new(), answer.end());
        }
        if let Some(attributes) = answer.take(byte[0]) {
            return (attributes, answer.end());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The attributes in some bytes and what else was in them up to there.
    fn heard(bytes: &[u8]) -> (Option<Vec<u16>>, String) {
        let mut answer = Answer::default();
        let found = bytes.iter().find_map(|byte| answer.take(*byte));
        (found, String::from_utf8(answer.end()).unwrap())
    }

    #[test]
    fn the_answer_is_told_from_what_is_typed() {
        let words = |text: &str| text.to_owned();
        assert_eq!(heard(b"\x1b[?62;4;22c"), (Some(vec![62, 4, 22]), words("")));
        assert_eq!(heard(b"1 + 1\r\x1b[?1;2c"), (Some(vec![1, 2]), words("1 + 1\r")));
        // An arrow key, an escape alone before the answer, and none at all.
        assert_eq!(heard(b"a\x1b[Ab\x1b\x1b[?4c"), (Some(vec![4]), words("a\x1b[Ab\x1b")));
        assert_eq!(heard(b"cc\x1b[?6"), (None, words("cc\x1b[?6")));
        assert_eq!(heard(b"\x1b[?4;x\x1b[?1c"), (Some(vec![1]), words("\x1b[?4;x")));
    }

    #[test]
    fn what_is_typed_is_entered_as_it_is_whole() {
        let mut typed = Typed { text: "1 + 1\nlet x = (1,\n2, 3)\ncurve a".to_owned() };
        assert_eq!(typed.entry().as_deref(), Some("1 + 1"));
        assert_eq!(typed.entry().as_deref(), Some("let x = (1,\n2, 3)"));
        assert_eq!((typed.entry(), typed.rest()), (None, "curve a".to_owned()));
        assert_eq!(typed.rest(), "");
    }
}
