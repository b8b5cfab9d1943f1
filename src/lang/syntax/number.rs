//! Numbers and the units glued to them.

use unicode_ident::{is_xid_continue, is_xid_start};

/// Length units, smallest first.
pub const LENGTHS: [&str; 7] = ["um", "mm", "cm", "in", "ft", "m", "km"];
/// Angle units.
pub const ANGLES: [&str; 2] = ["deg", "rad"];
/// Mass units.
pub const MASSES: [&str; 2] = ["kg", "t"];

/// What is wrong with a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Fault {
    /// `.5`
    LeadingDot,
    /// `5.`
    TrailingDot,
    /// `1_`, `1__0`
    Underscore,
    /// `1.2.3`
    SecondDot,
    /// No such unit.
    Unit,
    /// `1e999`
    TooLarge,
}

/// A number read from the text.
pub(crate) struct ReadNumber {
    /// Byte after its last one.
    pub end: usize,
    /// Where its unit begins; `end` when it has none.
    pub unit_start: usize,
    /// What is wrong with it.
    pub fault: Option<Fault>,
}

/// Whether a text is a unit: `mm`, `m2`, `kg/m3`, `%`.
pub fn is_unit(text: &str) -> bool {
    match text.split_once('/') {
        Some((above, below)) => is_plain_unit(above) && is_plain_unit(below),
        None => text == "%" || is_plain_unit(text),
    }
}

fn is_plain_unit(text: &str) -> bool {
    let length = text.strip_suffix(['2', '3']).unwrap_or(text);
    LENGTHS.contains(&length) || ANGLES.contains(&text) || MASSES.contains(&text)
}

/// All units without powers and quotients.
pub fn unit_words() -> impl Iterator<Item = &'static str> {
    LENGTHS.iter().chain(&ANGLES).chain(&MASSES).copied().chain(["%"])
}

/// Value of the digits of a number, `_` left out; the text comes from the scanner and is well formed.
pub(crate) fn value(digits: &str) -> f64 {
    if let Some(value) = short(digits.as_bytes()) {
        return value;
    }
    let parsed = if digits.contains('_') { digits.replace('_', "").parse() } else { digits.parse() };
    parsed.unwrap_or(f64::NAN)
}

/// Value of at most 15 digits with or without a point: a whole number over a power of ten. Both are exact, so the quotient is the
/// number nearest to what is written.
fn short(text: &[u8]) -> Option<f64> {
    const POWERS: [f64; 16] = [1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15];
    let (mut whole, mut digits, mut point) = (0_u64, 0, None);
    if text.len() > POWERS.len() {
        return None;
    }
    for byte in text {
        match byte {
            b'0'..=b'9' => (whole, digits) = (10 * whole + u64::from(byte - b'0'), digits + 1),
            b'.' if point.is_none() => point = Some(digits),
            _ => return None,
        }
    }
    let behind = digits - point.unwrap_or(digits);
    (0 < digits && digits < POWERS.len()).then(|| whole as f64 / POWERS[behind])
}

/// Splits the text of a quantity into digits and unit.
pub(crate) fn split_unit(text: &str) -> (&str, &str) {
    let bytes = text.as_bytes();
    let mut at = digits(bytes, 0);
    if bytes.get(at) == Some(&b'.') {
        at = digits(bytes, at + 1);
    }
    text.split_at(exponent(bytes, at))
}

/// Byte after a run of digits with single `_` between them.
fn digits(bytes: &[u8], mut at: usize) -> usize {
    let is_digit = |at: usize| bytes.get(at).is_some_and(u8::is_ascii_digit);
    while is_digit(at) || (bytes.get(at) == Some(&b'_') && is_digit(at + 1)) {
        at += 1;
    }
    at
}

/// Byte after `e-3`, or `at` when none follows.
fn exponent(bytes: &[u8], at: usize) -> usize {
    let is_digit = |at: usize| bytes.get(at).is_some_and(u8::is_ascii_digit);
    if !matches!(bytes.get(at), Some(b'e' | b'E')) {
        return at;
    }
    let first = if matches!(bytes.get(at + 1), Some(b'+' | b'-')) { at + 2 } else { at + 1 };
    if is_digit(first) { digits(bytes, first) } else { at }
}

/// Byte after a word; `at` when none begins there.
fn word(source: &str, at: usize) -> usize {
    let rest = &source[at..];
    match rest.chars().next() {
        Some(c) if is_xid_start(c) || c == '_' => {
            at + rest.char_indices().find(|&(_, c)| !is_xid_continue(c)).map_or(rest.len(), |(n, _)| n)
        }
        _ => at,
    }
}

/// Reads the number that begins with a digit at `start`, its unit included.
pub(crate) fn read(source: &str, start: usize) -> ReadNumber {
    let bytes = source.as_bytes();
    let byte = |at: usize| bytes.get(at).copied().unwrap_or(0);
    let mut at = digits(bytes, start);
    let mut fault = None;
    if byte(at) == b'.' && byte(at + 1).is_ascii_digit() {
        at = digits(bytes, at + 1);
    } else if byte(at) == b'.' && byte(at + 1) != b'.' && word(source, at + 1) == at + 1 {
        at += 1;
        fault = Some(Fault::TrailingDot);
    }
    let mantissa = at;
    at = exponent(bytes, at);
    if (at > mantissa || at - start > 300) && !value(&source[start..at]).is_finite() {
        fault = fault.or(Some(Fault::TooLarge));
    }
    let unit_start = at;
    if byte(at) == b'%' {
        at += 1;
    } else if byte(at).is_ascii_alphabetic() || byte(at) == b'_' || !byte(at).is_ascii() {
        at = unit(source, at, &mut fault);
    }
    if fault.is_none() && byte(at) == b'.' && byte(at + 1).is_ascii_digit() {
        at = digits(bytes, at + 1);
        fault = Some(Fault::SecondDot);
        return ReadNumber { end: at, unit_start: at, fault };
    }
    ReadNumber { end: at, unit_start, fault }
}

/// Byte after the unit that begins at `at`. What follows `/` belongs to it only when it is a unit and is not used like a
/// name: `5m/t` has the unit `m/t`, `5m/t.x` divides.
fn unit(source: &str, at: usize, fault: &mut Option<Fault>) -> usize {
    let mut end = word(source, at);
    // `3m²`, `30°`
    if let Some(sign) = source[end..].chars().next().filter(|c| matches!(c, '²' | '³' | '°')) {
        end += sign.len_utf8();
    }
    if end == at {
        return at;
    }
    let text = &source[at..end];
    if text.starts_with('_') {
        *fault = fault.or(Some(Fault::Underscore));
        return end;
    }
    if !is_plain_unit(text) {
        *fault = fault.or(Some(Fault::Unit));
        return end;
    }
    if source.as_bytes().get(end) != Some(&b'/') {
        return end;
    }
    let below = word(source, end + 1);
    let rest = &source.as_bytes()[below..];
    let in_use = matches!(rest.first(), Some(b'(' | b'[')) || (rest.first() == Some(&b'.') && rest.get(1) != Some(&b'.'));
    if is_plain_unit(&source[end + 1..below]) && !in_use { below } else { end }
}

/// A number with single `_` between digits only, for help: `1__0_` → `1_0`, `5_mm` → `5mm`.
pub(crate) fn repaired(text: &str) -> String {
    let mut parts = text.split('_').filter(|part| !part.is_empty());
    let mut repaired = parts.next().unwrap_or("0").to_owned();
    for part in parts {
        if part.starts_with(|c: char| c.is_ascii_digit()) {
            repaired.push('_');
        }
        repaired.push_str(part);
    }
    repaired
}

/// The unit that was meant by a word that is none.
pub(crate) fn meant(unit: &str) -> Option<String> {
    let lower = unit.to_lowercase().replace('²', "2").replace('³', "3");
    let known = match lower.as_str() {
        "meter" | "metre" | "meters" | "metres" => "m",
        "millimeter" | "millimetre" | "millimeters" | "millimetres" => "mm",
        "µm" | "μm" | "micron" | "microns" => "um",
        "inch" | "inches" => "in",
        "foot" | "feet" => "ft",
        "degree" | "degrees" | "°" => "deg",
        "radian" | "radians" => "rad",
        "sqm" => "m2",
        "ton" | "tonne" | "tons" | "tonnes" => "t",
        "kgs" => "kg",
        _ => "",
    };
    if !known.is_empty() {
        return Some(known.to_owned());
    }
    if is_unit(&lower) {
        return Some(lower);
    }
    let powers = LENGTHS.iter().flat_map(|l| ["", "2", "3"].map(|p| format!("{l}{p}")));
    let all: Vec<String> = powers.chain(ANGLES.iter().chain(&MASSES).map(|u| (*u).to_owned())).collect();
    crate::lang::words::names::nearest(&lower, all.iter().map(String::as_str)).map(str::to_owned)
}
