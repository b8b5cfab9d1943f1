//! Numbers in and out of text: shortest digits that read back to the same bits, and the same cut to a field's width.
//!
//! Exponents are written outside 1e-5…1e16, negative zero is written as zero.

/// Digits of an `f64` need at most this many characters.
const DIGITS: usize = 17;

/// Columns a text of one line takes on a screen.
#[must_use]
pub fn columns(text: &str) -> usize {
    unicode_width::UnicodeWidthStr::width(text)
}

/// Whether a character leaves no mark of its own, or turns the order of what stands around it: two names that differ by it look alike.
#[must_use]
pub fn is_unseen(c: char) -> bool {
    matches!(
        c,
        '\u{ad}' | '\u{34f}' | '\u{61c}' | '\u{115f}' | '\u{1160}' | '\u{17b4}' | '\u{17b5}' | '\u{180b}'..='\u{180f}'
            | '\u{200b}'..='\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{3164}' | '\u{fe00}'..='\u{fe0f}'
            | '\u{feff}' | '\u{ffa0}' | '\u{fff0}'..='\u{fff8}' | '\u{1bca0}'..='\u{1bca3}' | '\u{1d173}'..='\u{1d17a}'
            | '\u{e0000}'..='\u{e0fff}'
    )
}

/// Appends `x` with the fewest digits that read back to the same bits (`12.5`, `3`, `1e-7`).
pub fn push_real(out: &mut Vec<u8>, x: f64) {
    let mut buffer = ryu::Buffer::new();
    let text = buffer.format(x + 0.0).as_bytes();
    out.extend_from_slice(text.strip_suffix(b".0").unwrap_or(text));
}

/// [`push_real`] in single precision: as many digits as an `f32` has.
pub fn push_single(out: &mut Vec<u8>, x: f32) {
    let mut buffer = ryu::Buffer::new();
    let text = buffer.format(x + 0.0).as_bytes();
    out.extend_from_slice(text.strip_suffix(b".0").unwrap_or(text));
}

/// [`push_real`] as a string.
pub fn real(x: f64) -> String {
    let mut out = Vec::with_capacity(24);
    push_real(&mut out, x);
    String::from_utf8_lossy(&out).into_owned()
}

/// A number with at most so many decimals, zeros at its end left out (`0.5`, `12`).
#[must_use]
pub fn decimals(x: f64, most: usize) -> String {
    let text = format!("{:.most$}", x + 0.0);
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

const PAIRS: &[u8; 200] = b"0001020304050607080910111213141516171819202122232425262728293031323334353637383940414243444546474849\
5051525354555657585960616263646566676869707172737475767778798081828384858687888990919293949596979899";

/// Appends a whole number.
pub fn push_count(out: &mut Vec<u8>, mut n: u64) {
    let mut digits = [0_u8; 20];
    let mut at = digits.len();
    while n >= 100 {
        let pair = (n % 100) as usize * 2;
        n /= 100;
        at -= 2;
        digits[at..at + 2].copy_from_slice(&PAIRS[pair..pair + 2]);
    }
    if n >= 10 {
        at -= 2;
        digits[at..at + 2].copy_from_slice(&PAIRS[n as usize * 2..n as usize * 2 + 2]);
    } else {
        at -= 1;
        digits[at] = b'0' + n as u8;
    }
    out.extend_from_slice(&digits[at..]);
}

/// Appends a whole number, filled up with blanks on the right to `width` characters.
pub fn push_count_padded(out: &mut Vec<u8>, n: u64, width: usize) {
    let end = out.len() + width;
    push_count(out, n);
    out.resize(end.max(out.len()), b' ');
}

/// How a number that must fit a field is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Field {
    /// At most this many characters; exponent as `e-7`.
    Free(usize),
    /// Exactly this many, blanks on the right; always with a point, exponent without letter (`1.5-7`), as Nastran reads.
    Nastran(usize),
}

impl Field {
    fn width(self) -> usize {
        match self {
            Self::Free(width) | Self::Nastran(width) => width,
        }
    }
}

/// Appends a finite `x` so that it fits the field: with all its digits when they fit, else with as many as there is room for.
///
/// The field must be at least 10 wide. The last digit kept is rounded from the shortest text of `x`.
pub fn push_field(out: &mut Vec<u8>, x: f64, field: Field) {
    let mut buffer = ryu::Buffer::new();
    let text = buffer.format(x + 0.0).as_bytes();
    let width = field.width();
    match field {
        Field::Free(_) => {
            let short = text.strip_suffix(b".0").unwrap_or(text);
            if short.len() <= width {
                return out.extend_from_slice(short);
            }
            Decimal::of(text).push(out, width, field);
        }
        Field::Nastran(_) => {
            let end = out.len() + width;
            if text.len() <= width && text.contains(&b'.') && !text.contains(&b'e') {
                out.extend_from_slice(text);
            } else {
                Decimal::of(text).push(out, width, field);
            }
            out.resize(end.max(out.len()), b' ');
        }
    }
}

/// A number as digits: `0.d₁d₂… × 10^exponent` with `d₁ ≠ 0`.
#[derive(Clone, Copy, Debug)]
struct Decimal {
    negative: bool,
    digits: [u8; DIGITS],
    len: usize,
    exponent: i32,
}

impl Decimal {
    /// Takes apart what `ryu` wrote for a finite number.
    fn of(text: &[u8]) -> Self {
        let mut decimal = Self { negative: text.first() == Some(&b'-'), digits: [b'0'; DIGITS], len: 0, exponent: 0 };
        let (mut seen_point, mut read_exponent, mut exponent, mut exponent_negative) = (false, false, 0_i32, false);
        for &c in text {
            match c {
                b'.' => seen_point = true,
                b'e' => read_exponent = true,
                b'-' if read_exponent => exponent_negative = true,
                b'0'..=b'9' if read_exponent => exponent = exponent * 10 + i32::from(c - b'0'),
                b'0' if decimal.len == 0 => decimal.exponent -= i32::from(seen_point),
                b'0'..=b'9' => {
                    if decimal.len < DIGITS {
                        decimal.digits[decimal.len] = c;
                        decimal.len += 1;
                    }
                    decimal.exponent += i32::from(!seen_point);
                }
                _ => {}
            }
        }
        decimal.exponent += if exponent_negative { -exponent } else { exponent };
        decimal.without_zeros()
    }

    /// Drops zeros at the end.
    fn without_zeros(mut self) -> Self {
        while self.len > 1 && self.digits[self.len - 1] == b'0' {
            self.len -= 1;
        }
        if self.len == 0 { Self { len: 1, exponent: 1, ..self } } else { self }
    }

    /// The same with at most `n` digits, rounded half up.
    fn rounded(mut self, n: usize) -> Self {
        if n >= self.len {
            return self;
        }
        let up = self.digits[n] >= b'5';
        self.len = n;
        if up {
            let mut k = n;
            loop {
                if k == 0 {
                    self.digits[0] = b'1';
                    self.exponent += 1;
                    self.len = 1;
                    break;
                }
                k -= 1;
                if self.digits[k] == b'9' {
                    self.digits[k] = b'0';
                } else {
                    self.digits[k] += 1;
                    break;
                }
            }
        }
        self.without_zeros()
    }

    /// Digits that fit `room` characters in fixed and in exponent form; negative when the form cannot be used.
    fn room(&self, room: usize, field: Field) -> (i32, i32) {
        let room = room as i32 - i32::from(self.negative);
        let fixed = if self.exponent > 0 { if room > self.exponent { room - 1 } else { -1 } } else { room - 1 + self.exponent };
        (fixed, room - 1 - self.exponent_width(field))
    }

    /// Characters of the exponent with its letter or sign.
    fn exponent_width(&self, field: Field) -> i32 {
        let power = self.exponent - 1;
        let digits = if power.abs() >= 100 {
            3
        } else if power.abs() >= 10 {
            2
        } else {
            1
        };
        match field {
            Field::Free(_) => digits + 1 + i32::from(power < 0),
            Field::Nastran(_) => digits + 1,
        }
    }

    fn push(self, out: &mut Vec<u8>, width: usize, field: Field) {
        let (fixed, scientific) = self.room(width, field);
        let all = self.len as i32;
        let rounded = self.rounded(fixed.max(scientific).clamp(1, all) as usize);
        // Rounding 9.99 up to 10.0 may have changed the room by one place, but then few digits are left.
        let (fixed, scientific) = rounded.room(width, field);
        if rounded.negative {
            out.push(b'-');
        }
        // The form that holds more digits; of two that hold all, the shorter.
        let all = rounded.len as i32;
        let fixed_length = if rounded.exponent > 0 { rounded.exponent.max(all) } else { all - rounded.exponent } + 1;
        let shorter = fixed_length <= all + 1 + rounded.exponent_width(field);
        if fixed >= all && (shorter || scientific < all) || fixed > scientific {
            rounded.push_fixed(out);
        } else {
            rounded.push_scientific(out, field);
        }
    }

    fn push_fixed(&self, out: &mut Vec<u8>) {
        let digits = &self.digits[..self.len];
        if self.exponent <= 0 {
            out.push(b'.');
            out.resize(out.len() + self.exponent.unsigned_abs() as usize, b'0');
            out.extend_from_slice(digits);
        } else {
            let whole = self.exponent as usize;
            out.extend_from_slice(&digits[..whole.min(self.len)]);
            out.resize(out.len() + whole.saturating_sub(self.len), b'0');
            out.push(b'.');
            out.extend_from_slice(digits.get(whole..).unwrap_or(&[]));
        }
    }

    fn push_scientific(&self, out: &mut Vec<u8>, field: Field) {
        out.push(self.digits[0]);
        out.push(b'.');
        out.extend_from_slice(&self.digits[1..self.len]);
        let power = self.exponent - 1;
        match field {
            Field::Free(_) => out.push(b'e'),
            Field::Nastran(_) if power >= 0 => out.push(b'+'),
            Field::Nastran(_) => {}
        }
        if power < 0 {
            out.push(b'-');
        }
        push_count(out, u64::from(power.unsigned_abs()));
    }
}

/// The value of a decimal number (`-1.5`, `.5`, `5.`, `1e-3`), or `None` when the text is anything else.
///
/// Words like `nan` and `inf` are no numbers. A number too large for an `f64` reads as infinite: the caller says so.
pub fn parse_real(text: &str) -> Option<f64> {
    let first = *text.as_bytes().iter().find(|c| !matches!(c, b'+' | b'-'))?;
    if !(first.is_ascii_digit() || first == b'.') {
        return None;
    }
    text.parse().ok()
}

/// The article before a word.
pub fn article(word: &str) -> &'static str {
    if word.starts_with(['a', 'e', 'i', 'o', 'u', 'A', 'E', 'I', 'O', 'U']) { "an" } else { "a" }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shortest_text() {
        let cases = [(0.0, "0"), (-0.0, "0"), (1.0, "1"), (-12.5, "-12.5"), (0.1 + 0.2, "0.30000000000000004"), (1e-5, "0.00001")];
        for (x, text) in cases {
            assert_eq!(real(x), text);
        }
        for (x, text) in [(9e-6, "9e-6"), (1e15, "1000000000000000"), (1e16, "1e16"), (1.5e300, "1.5e300"), (5e-324, "5e-324")] {
            assert_eq!(real(x), text);
        }
    }

    #[test]
    fn decimals_that_say_nothing_are_left_out() {
        let cases = [
            (0.5, 3, "0.5"),
            (12.0, 1, "12"),
            (100.0, 0, "100"),
            (-1e-9, 3, "0"),
            (2.0 / 3.0, 3, "0.667"),
            (1e20, 2, "100000000000000000000"),
        ];
        for (x, most, text) in cases {
            assert_eq!(decimals(x, most), text);
        }
    }

    #[test]
    fn counts() {
        for n in [0, 7, 10, 99, 100, 101, 12_345, 999_999, 1_000_000, u64::MAX] {
            let mut out = Vec::new();
            push_count(&mut out, n);
            assert_eq!(String::from_utf8(out).unwrap(), n.to_string());
        }
    }

    fn fit(x: f64, field: Field) -> String {
        let mut out = Vec::new();
        push_field(&mut out, x, field);
        String::from_utf8(out).unwrap()
    }

    fn nastran(text: &str) -> f64 {
        let text = text.trim();
        let cut = text.char_indices().skip(1).find(|(_, c)| matches!(c, '+' | '-')).map(|(k, _)| k);
        cut.map_or_else(|| text.to_owned(), |k| format!("{}e{}", &text[..k], &text[k..])).parse().unwrap()
    }

    #[test]
    fn numbers_cut_to_a_field() {
        assert_eq!(fit(-0.001_234_567_890_123_456_7, Field::Free(20)), "-.001234567890123457");
        assert_eq!(fit(0.25, Field::Free(20)), "0.25");
        assert_eq!(fit(1.0, Field::Nastran(16)), "1.0             ");
        assert_eq!(fit(1e20, Field::Nastran(16)), "1.+20           ");
        assert_eq!(fit(-1.5e-7, Field::Nastran(16)), "-1.5-7          ");
        assert_eq!(fit(99_999_999_999_999.99, Field::Nastran(16)), "100000000000000.");
    }

    #[test]
    fn cut_numbers_keep_what_fits() {
        let mut x = 1.234_567_890_123_456_7_f64;
        for k in 0..2_000 {
            x = (x * 1.618_033_988_749_895).rem_euclid(1.0) + 0.01;
            let y = x * format!("1e{}", k % 61 - 30).parse::<f64>().unwrap() * if k % 2 == 0 { 1.0 } else { -1.0 };
            let free = fit(y, Field::Free(20));
            assert!(free.len() <= 20, "{free}");
            assert!((free.parse::<f64>().unwrap() - y).abs() <= 1e-12 * y.abs(), "{y:?} {free}");
            let field = fit(y, Field::Nastran(16));
            assert!(field.len() == 16 && field.contains('.'), "{field}");
            assert!((nastran(&field) - y).abs() <= 1e-10 * y.abs(), "{y:?} {field}");
        }
    }

    #[test]
    fn numbers_read() {
        for (text, x) in [("1", Some(1.0)), ("-.5", Some(-0.5)), ("5.", Some(5.0)), ("+1e3", Some(1000.0))] {
            assert_eq!(parse_real(text), x, "{text}");
        }
        for text in ["", "nan", "-inf", "1_000", "0x10", "--1", "1 ", "infinity", "."] {
            assert_eq!(parse_real(text), None, "{text}");
        }
    }
}
