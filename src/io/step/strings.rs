//! Texts of STEP files: quotes twice, and letters beyond ASCII by their codes.

/// The text that stands between quotes in a file. What cannot be decoded is left as it is.
///
/// `\X2\…\X0\` and `\X4\…\X0\` hold letters of UTF-16 and UTF-32, `\X\hh` one of ISO 8859-1, `\S\c` the letter 128 above `c` in the
/// alphabet that `\PA\` to `\PI\` name (ISO 8859-1 to -9). Bytes above 127 are UTF-8, else ISO 8859-1.
pub fn decoded(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(bytes.len());
    let mut page = b'A';
    let mut rest = bytes;
    while let Some((first, after)) = rest.split_first() {
        rest = match (first, rest) {
            (b'\'', [_, b'\'', ..]) => push(&mut text, '\'', &rest[2..]),
            (b'\\', [_, b'\\', ..]) => push(&mut text, '\\', &rest[2..]),
            (b'\\', [_, b'P', named, b'\\', ..]) => {
                page = *named;
                &rest[4..]
            }
            (b'\\', [_, b'S', b'\\', c, ..]) => push(&mut text, high(page, *c), &rest[4..]),
            (b'\\', [_, b'X', b'\\', a, b, ..]) if a.is_ascii_hexdigit() && b.is_ascii_hexdigit() => {
                push(&mut text, number(&[*a, *b]).and_then(char::from_u32).unwrap_or(char::REPLACEMENT_CHARACTER), &rest[5..])
            }
            (b'\\', [_, b'X', width @ (b'2' | b'4'), b'\\', ..]) => match wide(&rest[4..], if *width == b'2' { 4 } else { 8 }) {
                Some((letters, after)) => {
                    text.push_str(&letters);
                    after
                }
                None => push(&mut text, '\\', after),
            },
            (b'\\', [_, b'N' | b'F', b'\\', ..]) => &rest[3..],
            (b'\r' | b'\n', _) => after,
            (c, _) if c.is_ascii() => push(&mut text, char::from(*c), after),
            _ => raw(&mut text, rest),
        };
    }
    text
}

fn push<'r>(text: &mut String, letter: char, rest: &'r [u8]) -> &'r [u8] {
    text.push(letter);
    rest
}

fn number(digits: &[u8]) -> Option<u32> {
    u32::from_str_radix(std::str::from_utf8(digits).ok()?, 16).ok()
}

/// Letters of so many digits up to `\X0\`.
fn wide(bytes: &[u8], digits: usize) -> Option<(String, &[u8])> {
    let end = bytes.windows(4).position(|w| w == b"\\X0\\")?;
    let codes: Vec<u8> = bytes[..end].iter().copied().filter(|c| !c.is_ascii_whitespace()).collect();
    let codes = codes.chunks(digits).map(|c| if c.len() == digits { number(c) } else { None }).collect::<Option<Vec<u32>>>()?;
    let text = if digits == 4 {
        let units: Vec<u16> = codes.iter().map(|c| *c as u16).collect();
        String::from_utf16_lossy(&units)
    } else {
        codes.into_iter().map(|c| char::from_u32(c).unwrap_or(char::REPLACEMENT_CHARACTER)).collect()
    };
    Some((text, &bytes[end + 4..]))
}

/// Bytes above 127 up to the next plain one.
fn raw<'r>(text: &mut String, bytes: &'r [u8]) -> &'r [u8] {
    let (these, rest) = bytes.split_at(bytes.iter().position(u8::is_ascii).unwrap_or(bytes.len()));
    match std::str::from_utf8(these) {
        Ok(letters) => text.push_str(letters),
        Err(_) => text.extend(these.iter().map(|c| char::from(*c))),
    }
    rest
}

/// The letter 128 above one, in ISO 8859-1 or another part of ISO 8859 as far as it has one block of letters.
fn high(page: u8, c: u8) -> char {
    let code = u32::from(c) + 128;
    let mapped = match (page, code) {
        // Cyrillic, Arabic, Greek and Hebrew stand in their order.
        (b'E', 0xA1..=0xAC | 0xAE..=0xEF | 0xF1..=0xFC | 0xFE..=0xFF) => code - 0xA0 + 0x400,
        (b'F', 0xAC | 0xBB | 0xBF | 0xC1..=0xDA | 0xE0..=0xF2) => code - 0xA0 + 0x600,
        (b'G', 0xB4 | 0xB6 | 0xB8..=0xBA | 0xBC | 0xBE..=0xFE) => code - 0xA0 + 0x370,
        (b'H', 0xE0..=0xFA) => code - 0xE0 + 0x5D0,
        (b'I', 0xD0) => 0x11E,
        (b'I', 0xDD) => 0x130,
        (b'I', 0xDE) => 0x15E,
        (b'I', 0xF0) => 0x11F,
        (b'I', 0xFD) => 0x131,
        (b'I', 0xFE) => 0x15F,
        (b'B', _) => LATIN_2.chars().nth((code as usize).wrapping_sub(0xA0)).map_or(code, u32::from),
        _ => code,
    };
    char::from_u32(mapped).unwrap_or(char::REPLACEMENT_CHARACTER)
}

/// ISO 8859-2 from 0xA0.
const LATIN_2: &str = "\u{A0}Ą˘Ł¤ĽŚ§¨ŠŞŤŹ\u{AD}ŽŻ°ą˛ł´ľśˇ¸šşťź˝žżŔÁÂĂÄĹĆÇČÉĘËĚÍÎĎĐŃŇÓÔŐÖ×ŘŮÚŰÜÝŢßŕáâăäĺćçčéęëěíîďđńňóôőö÷řůúűüýţ˙";

#[cfg(test)]
mod tests {
    use super::decoded;

    #[test]
    fn letters_are_decoded_from_all_their_forms() {
        let same = |written: &str, read: &str| assert_eq!(decoded(written.as_bytes()), read, "{written}");
        same("plain", "plain");
        same("it''s", "it's");
        same("a\\\\b", "a\\b");
        same("\\X\\FCber", "über");
        same("\\S\\|ber", "über");
        same("\\PB\\\\S\\1\\PA\\\\S\\1", "ą±");
        same("\\PE\\\\S\\0", "А");
        same("\\PG\\\\S\\a", "α");
        same("\\X2\\00DC\\X0\\ber", "Über");
        same("\\X2\\D83DDE00\\X0\\", "😀");
        same("\\X4\\0001F600\\X0\\!", "😀!");
        same("\\X2\\00D", "\\X2\\00D");
        same("über", "über");
        assert_eq!(decoded(b"\xFCber"), "über");
        assert_eq!(decoded(b"one\r\nline"), "oneline");
    }
}
