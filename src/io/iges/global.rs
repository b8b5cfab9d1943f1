//! The global section: separators, unit, scale.

use crate::io::files::fault::Malformed;
use crate::io::iges::lines::{CONTENT, Line, Sections};
use crate::io::iges::params::{ParameterSpan, Separators, real, shown, tokens};

/// What the global section says that matters here.
#[derive(Clone, Debug, PartialEq)]
pub struct Global {
    /// Between values and after lists.
    pub separators: Separators,
    /// Name of the part for who gets the file.
    pub product: String,
    /// Millimetres in one unit of the file, model scale included.
    pub millimetres: f64,
    /// Name of the unit as messages say it.
    pub unit: &'static str,
    /// Smallest distance that means something, in units of the file; 0 when it is not said.
    pub resolution: f64,
}

/// Flag, names and millimetres of the units.
const UNITS: &[(i64, &[&str], f64)] = &[
    (1, &["IN", "INCH", "INCHES"], 25.4),
    (2, &["MM", "MILLIMETER", "MILLIMETRE"], 1.0),
    (4, &["FT", "FEET", "FOOT"], 304.8),
    (5, &["MI", "MILE"], 1_609_344.0),
    (6, &["M", "METER", "METRE"], 1_000.0),
    (7, &["KM", "KILOMETER", "KILOMETRE"], 1_000_000.0),
    (8, &["MIL"], 0.025_4),
    (9, &["UM", "MICRON"], 0.001),
    (10, &["CM", "CENTIMETER", "CENTIMETRE"], 10.0),
    (11, &["UIN"], 0.000_025_4),
];

/// Flag of units that only the name says.
const NAMED: i64 = 3;
/// What the standard takes where nothing is said: inches.
const DEFAULT_UNIT: usize = 0;

/// Reads the global section; what cannot be read gets its default and a warning.
pub fn read(sections: &Sections, warnings: &mut Vec<Malformed>) -> Global {
    let line = sections.global.first().map_or(1, |l| l.line);
    let mut warn = |what: String| warnings.push(Malformed::line(line, what));
    if sections.global.is_empty() {
        warn("there is no global section: values are separated by commas, and the unit is the inch".to_owned());
    }
    let mut text = joined(&sections.global, CONTENT);
    let separators = separators(&text).unwrap_or_else(|| {
        if !sections.global.is_empty() {
            warn("the separators cannot be read; comma and semicolon are assumed".to_owned());
        }
        Separators::default()
    });
    blank_separators(&mut text, separators);
    let list = tokens(&text, separators);
    for k in &list.miscounted {
        let read = value(&text, &list.tokens, *k);
        warn(format!("the text in field {} of the global section is not as long as stated; it is read as `{read}`", k + 1));
    }
    let (place, unit_factor) = unit(&text, &list.tokens, &mut warn);
    let scale = match number(&text, &list.tokens, 12) {
        None => 1.0,
        Some(scale) if scale > 0.0 => scale,
        Some(scale) => {
            warn(format!("the model scale {scale} is not above 0; 1 is used"));
            1.0
        }
    };
    let millimetres = unit_factor / scale;
    Global {
        separators,
        product: value(&text, &list.tokens, 2),
        millimetres: if millimetres.is_normal() { millimetres } else { unit_factor },
        unit: UNITS[place].1[0],
        resolution: number(&text, &list.tokens, 18).filter(|r| *r > 0.0).unwrap_or(0.0),
    }
}

/// Contents of lines in a row, each filled up to its columns.
fn joined(lines: &[Line], columns: usize) -> Vec<u8> {
    let mut text = Vec::with_capacity(lines.len() * columns);
    for line in lines {
        let end = text.len() + columns;
        text.extend_from_slice(&line.content[..line.content.len().min(columns)]);
        text.resize(end, b' ');
    }
    text
}

/// The first two fields: `1H,` and `1H;`, or nothing for comma and semicolon.
fn separators(text: &[u8]) -> Option<Separators> {
    let fits = |c: u8| c.is_ascii_graphic() && !c.is_ascii_alphanumeric() && !matches!(c, b'+' | b'-' | b'.');
    let mut rest = text.trim_ascii_start();
    let mut found = Separators::default();
    if let [b'1', b'H', c, after, ..] = *rest {
        if !fits(c) || after != c {
            return None;
        }
        found.value = c;
        rest = &rest[4..];
    } else {
        rest = rest.strip_prefix(b",")?;
    }
    let rest = rest.trim_ascii_start();
    match *rest {
        [b'1', b'H', c, ..] if fits(c) && c != found.value => found.record = c,
        [c, ..] if c == found.value => {}
        _ => return None,
    }
    Some(found)
}

/// Takes the separators out of their own definition, which would end the list at once.
fn blank_separators(text: &mut [u8], separators: Separators) {
    let start = text.len() - text.trim_ascii_start().len();
    let mut at = start;
    for c in [separators.value, separators.record] {
        if text[at.min(text.len())..].starts_with(&[b'1', b'H', c]) {
            text[at..at + 3].fill(b' ');
            at += 3;
        }
        at += 1;
        while text.get(at).is_some_and(u8::is_ascii_whitespace) {
            at += 1;
        }
    }
}

fn value(text: &[u8], tokens: &[ParameterSpan], k: usize) -> String {
    match tokens.get(k) {
        Some(ParameterSpan::Bare(from, to) | ParameterSpan::Text(from, to)) => shown(&text[*from..*to]),
        _ => String::new(),
    }
}

fn number(text: &[u8], tokens: &[ParameterSpan], k: usize) -> Option<f64> {
    match tokens.get(k) {
        Some(ParameterSpan::Bare(from, to)) => real(&text[*from..*to]),
        _ => None,
    }
}

/// Index of the unit and its millimetres: by flag, else by name, else the inch.
fn unit(text: &[u8], tokens: &[ParameterSpan], warn: &mut impl FnMut(String)) -> (usize, f64) {
    let flag = number(text, tokens, 13);
    let name = value(text, tokens, 14).to_ascii_uppercase();
    let by_name = UNITS.iter().position(|u| u.1.contains(&name.as_str()));
    let by_flag = flag.and_then(|f| UNITS.iter().position(|u| u.0 as f64 == f));
    let place = match (by_flag, by_name) {
        (Some(a), Some(b)) if a != b => {
            warn(format!("the unit is {} by its number and {} by its name; the number is used", UNITS[a].1[0], UNITS[b].1[0]));
            a
        }
        (Some(a), _) => a,
        (None, Some(b)) => {
            if flag != Some(NAMED as f64) {
                warn(format!("the unit's number cannot be read; its name {} is used", UNITS[b].1[0]));
            }
            b
        }
        (None, None) => {
            warn("the file names no unit; by the standard it is the inch (set `unit:` if that is wrong)".to_owned());
            DEFAULT_UNIT
        }
    };
    (place, UNITS[place].2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::iges::lines;

    fn global(text: &str) -> (Global, Vec<String>) {
        let mut file = String::new();
        for (k, chunk) in text.as_bytes().chunks(72).enumerate() {
            file.push_str(&format!("{:72}G{:7}\n", String::from_utf8_lossy(chunk), k + 1));
        }
        let mut warnings = Vec::new();
        let sections = lines::sections(file.as_bytes(), &mut Vec::new()).expect("lines");
        let global = read(&sections, &mut warnings);
        (global, warnings.into_iter().map(|w| w.what).collect())
    }

    #[test]
    fn units_scale_and_separators() {
        let tail = "4HPART,5Ha.igs,2Hme,2Hme,32,38,6,308,15,,";
        let cases = [
            (format!("1H,,1H;,{tail}1.0D0,2,2HMM,1,0.2,4Hdate,1.0E-3,9.;"), 1.0, "MM", 1e-3, 0),
            (format!(",,{tail}1.,1,4HINCH;"), 25.4, "IN", 0.0, 0),
            (format!("1H,,1H;,{tail}0.5,6,1HM;"), 2000.0, "M", 0.0, 0),
            (format!("1H,,1H;,{tail}1,3,2HCM;"), 10.0, "CM", 0.0, 0),
            (format!("1H,,1H;,{tail}1,2,2HIN;"), 1.0, "MM", 0.0, 1),
            (format!("1H,,1H;,{tail}-1,99,2HMM;"), 1.0, "MM", 0.0, 2),
            (format!("1H,,1H;,{tail};"), 25.4, "IN", 0.0, 1),
            (format!("1H/,1H;,{tail}1,2;"), 1.0, "MM", 0.0, 1),
            (format!("1H/ /1H#/{}1.0/2/2HMM#", tail.replace(',', "/")).replace("1H/ /", "1H//"), 1.0, "MM", 0.0, 0),
        ];
        for (text, millimetres, unit, resolution, warnings) in cases {
            let (global, said) = global(&text);
            let found = (global.millimetres, global.unit, global.resolution, said.len());
            assert_eq!(found, (millimetres, unit, resolution, warnings), "{text}: {said:?}");
        }
    }

    #[test]
    fn a_text_with_a_wrong_count_shifts_nothing() {
        let (found, said) = global("1H,,1H;,4HPART,9Ha.igs,   2Hme,2Hme,32,38,6,308,15,,1.,2,2HMM;");
        assert_eq!((found.millimetres, said.len()), (1.0, 1), "{said:?}");
        let (found, said) = global("1H,,1H;,4HPART,3Ha.igs,2Hme,2Hme,32,38,6,308,15,,1.,2,2HMM;");
        assert_eq!((found.millimetres, said.len()), (1.0, 1), "{said:?}");
    }
}
