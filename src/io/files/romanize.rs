//! Names in Latin letters, for files that take ASCII only.
//!
//! Hangul goes by the Revised Romanisation of Korean, syllable by syllable: a final consonant is written as it sounds at the
//! end of a word (`벽` byeok), and as an initial one before a syllable that begins with a vowel (`지붕은` jibungeun, `벽이`
//! byeogi). Further changes of sound between syllables are not written, so that the letters of a name can still be told.
//! Other scripts go by the table of `any_ascii`.

use any_ascii::any_ascii_char;

const INITIALS: [&str; 19] = ["g", "kk", "n", "d", "tt", "r", "m", "b", "pp", "s", "ss", "", "j", "jj", "ch", "k", "t", "p", "h"];
const VOWELS: [&str; 21] =
    ["a", "ae", "ya", "yae", "eo", "e", "yeo", "ye", "o", "wa", "wae", "oe", "yo", "u", "wo", "we", "wi", "yu", "eu", "ui", "i"];
/// Finals at the end of a word or before a consonant.
const FINALS: [&str; 28] = [
    "", "k", "k", "k", "n", "n", "n", "t", "l", "k", "m", "l", "l", "l", "p", "l", "m", "p", "p", "t", "t", "ng", "t", "t", "k", "t", "p",
    "t",
];
/// Finals before a vowel: the last of two goes over to the next syllable.
const CARRIED: [&str; 28] = [
    "", "g", "kk", "ks", "n", "nj", "n", "d", "r", "lg", "lm", "lb", "ls", "lt", "lp", "r", "m", "b", "ps", "s", "ss", "ng", "j", "ch",
    "k", "t", "p", "",
];
/// The first syllable of Unicode and their number.
const FIRST: u32 = 0xAC00;
const SYLLABLES: u32 = 11_172;
/// Place of the initial that is not heard.
const SILENT: usize = 11;

/// Initial, vowel and final of a syllable of Hangul, as places in the tables.
fn syllable(c: char) -> Option<[usize; 3]> {
    let k = (c as u32).checked_sub(FIRST).filter(|k| *k < SYLLABLES)? as usize;
    Some([k / 588, k % 588 / 28, k % 28])
}

/// A text in ASCII: what has no letters of its own there is written by its sound or meaning, nothing is left out silently.
pub fn in_ascii(text: &str) -> String {
    if text.is_ascii() {
        return text.to_owned();
    }
    let mut out = String::with_capacity(2 * text.len());
    let mut letters = text.chars().peekable();
    while let Some(c) = letters.next() {
        let Some([initial, vowel, last]) = syllable(c) else {
            let ascii = any_ascii_char(c);
            out.push_str(if ascii.is_empty() { "_" } else { ascii });
            continue;
        };
        let open = letters.peek().and_then(|next| syllable(*next)).is_some_and(|next| next[0] == SILENT);
        let last = if open { CARRIED[last] } else { FINALS[last] };
        [INITIALS[initial], VOWELS[vowel], last].into_iter().for_each(|part| out.push_str(part));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_in_latin_letters() {
        for (name, expected) in [
            ("지붕", "jibung"),
            ("벽체", "byeokche"),
            ("한글 이름", "hangeul ireum"),
            ("서울", "seoul"),
            ("좋아", "joa"),
            ("밖", "bak"),
            ("값이", "gapsi"),
            ("뒷판_3", "dwitpan_3"),
            ("Dächer", "Dacher"),
            ("крыша", "krysha"),
            ("στέγη", "stegi"),
            ("屋根", "WuGen"),
            ("plain_1", "plain_1"),
        ] {
            assert_eq!(in_ascii(name), expected);
        }
        assert!((FIRST..FIRST + SYLLABLES).filter_map(char::from_u32).all(|c| in_ascii(&c.to_string()).is_ascii()));
    }
}
