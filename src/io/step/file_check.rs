//! Files that are called STEP and are something else, or are written in letters of two bytes.

use crate::io::files::fault::Malformed;

/// Bytes looked at.
const HEAD: usize = 4096;

/// Fails for what is no clear text of STEP, with what it is instead.
pub fn check(bytes: &[u8]) -> Result<(), Malformed> {
    let text = bytes.trim_ascii_start();
    let head = &text[..text.len().min(HEAD)];
    let wrong = |what: &str| Err(Malformed::line(1, what));
    if text.is_empty() {
        return wrong("the file is empty");
    }
    let zeros = head.iter().filter(|c| **c == 0).count();
    if head.starts_with(b"\xFF\xFE") || head.starts_with(b"\xFE\xFF") || 3 * zeros >= head.len() {
        return wrong("the file is written in UTF-16 or UTF-32; STEP files are plain text of one byte a letter: save it as UTF-8");
    }
    if head.starts_with(b"PK\x03\x04") || head.starts_with(b"\x1F\x8B") {
        return wrong("the file is compressed; unpack it first");
    }
    if text.starts_with(b"<") {
        return wrong("the file is XML; STEP files that can be read are clear text, which begins with ISO-10303-21");
    }
    let starts = |words: &[u8]| head.windows(words.len()).any(|w| w == words);
    if !starts(b"ISO-10303-21") && !starts(b"HEADER") && !starts(b"DATA") {
        return wrong("the file does not begin with ISO-10303-21, as STEP files do");
    }
    Ok(())
}
