//! Letters of other scripts that look like Latin ones.

/// A script, its letters, and the Latin ones that they look like.
const LETTERS: &[(&str, &str, &str)] = &[
    ("Cyrillic", "аеорсухіјѕԛԝһԁАВЕКМНОРСТУХІЈЅ", "aeopcyxijsqwhdABEKMHOPCTYXIJS"),
    ("Greek", "οανρυιΑΒΕΖΗΙΚΜΝΟΡΤΥΧ", "oavpuiABEZHIKMNOPTYX"),
];

/// The Latin letter that a letter looks like, and its script.
fn latin(letter: char) -> Option<(char, &'static str)> {
    if letter.is_ascii() {
        return None;
    }
    LETTERS.iter().find_map(|(script, theirs, ours)| {
        let place = theirs.chars().position(|c| c == letter)?;
        ours.chars().nth(place).map(|c| (c, *script))
    })
}

/// Whether two letters look alike and are not the same.
pub(crate) fn alike(a: char, b: char) -> bool {
    a != b && latin(a).map_or(a, |l| l.0) == latin(b).map_or(b, |l| l.0)
}

/// Where two names that look alike differ: "the 7th letter of `skin_pаnel` is the Cyrillic а (U+0430)".
pub(crate) fn difference(a: &str, b: &str) -> Option<String> {
    if a.chars().count() != b.chars().count() || !a.chars().zip(b.chars()).all(|(x, y)| x == y || alike(x, y)) {
        return None;
    }
    let place = a.chars().zip(b.chars()).position(|(x, y)| x != y)?;
    let of = |name: &str| {
        let letter = name.chars().nth(place)?;
        latin(letter).map(|(_, script)| (name.to_owned(), letter, script))
    };
    let (name, letter, script) = of(a).or_else(|| of(b))?;
    Some(format!("the {} letter of `{name}` is the {script} {letter} (U+{:04X})", ordinal(place + 1), u32::from(letter)))
}

/// `1st`, `2nd`, `11th`.
fn ordinal(n: usize) -> String {
    let ending = match (n % 10, n % 100) {
        (_, 11..=13) => "th",
        (1, _) => "st",
        (2, _) => "nd",
        (3, _) => "rd",
        _ => "th",
    };
    format!("{n}{ending}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_that_look_alike_are_told() {
        let said = "the 7th letter of `skin_p\u{430}nel` is the Cyrillic \u{430} (U+0430)";
        assert_eq!(difference("skin_p\u{430}nel", "skin_panel").as_deref(), Some(said));
        assert_eq!(difference("skin_panel", "skin_p\u{430}nel").as_deref(), Some(said));
        assert_eq!(difference("skin_panel", "skin_panes"), None);
        assert!(alike('\u{410}', 'A') && alike('\u{410}', '\u{391}') && !alike('a', 'A'));
        assert!(LETTERS.iter().all(|l| l.1.chars().count() == l.2.chars().count()));
    }
}
