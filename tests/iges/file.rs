//! IGES files made in tests: entities in, 80-column text out.

/// Fields of a directory entry that matter here.
#[derive(Clone, Copy, Default)]
pub struct Fields {
    pub transform: u32,
    pub status: u32,
    pub label: &'static str,
    pub subscript: u32,
    pub color: i32,
}

/// Part of its parents only.
pub const DEPENDENT: Fields = Fields { transform: 0, status: 10_000, label: "", subscript: 0, color: 0 };
/// A curve in (u, v).
pub const IN_UV: Fields = Fields { status: 10_500, ..DEPENDENT };

#[derive(Default)]
pub struct File {
    entities: Vec<(u32, i32, Fields, String)>,
}

impl File {
    /// Adds an entity; gives the pointer to it.
    pub fn add(&mut self, kind: u32, form: i32, fields: Fields, parameters: &str) -> u32 {
        self.entities.push((kind, form, fields, parameters.to_owned()));
        self.entities.len() as u32 * 2 - 1
    }

    /// An independent entity.
    pub fn free(&mut self, kind: u32, form: i32, parameters: &str) -> u32 {
        self.add(kind, form, Fields::default(), parameters)
    }

    /// A part of others.
    pub fn part(&mut self, kind: u32, form: i32, parameters: &str) -> u32 {
        self.add(kind, form, DEPENDENT, parameters)
    }

    /// The pointer that the next entity will have.
    pub fn next(&self) -> u32 {
        self.entities.len() as u32 * 2 + 1
    }

    pub fn text(&self) -> String {
        let mut directory = String::new();
        let mut parameters = String::new();
        let mut p = 0;
        for (k, (kind, form, f, values)) in self.entities.iter().enumerate() {
            let d = 2 * k + 1;
            let lines = wrapped(&format!("{kind},{values};"));
            let (first, n) = (p + 1, lines.len());
            for line in lines {
                p += 1;
                parameters.push_str(&format!("{line:<64} {d:>7}P{p:>7}\n"));
            }
            directory.push_str(&format!(
                "{kind:>8}{first:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:08}D{d:>7}\n",
                0, 0, 0, 0, f.transform, 0, f.status
            ));
            let (label, subscript) = (f.label, f.subscript);
            directory.push_str(&format!(
                "{kind:>8}{:>8}{:>8}{n:>8}{form:>8}{:>8}{:>8}{label:>8}{subscript:>8}D{:>7}\n",
                0,
                f.color,
                "",
                "",
                d + 1
            ));
        }
        let global = "1H,,1H;,4HPART,8Hpart.igs,4Htest,4Htest,32,38,6,308,15,,1.0,2,2HMM,1,0.01,15H20260101.000000,1.0E-6,100.0,,,11,0,;";
        let mut text = format!("{:<72}S{:>7}\n", "made in a test", 1);
        let globals = global.as_bytes().chunks(72).map(|c| std::str::from_utf8(c).unwrap()).collect::<Vec<_>>();
        for (k, line) in globals.iter().enumerate() {
            text.push_str(&format!("{line:<72}G{:>7}\n", k + 1));
        }
        text.push_str(&directory);
        text.push_str(&parameters);
        text.push_str(&format!("S{:>7}G{:>7}D{:>7}P{p:>7}{:40}T{:>7}\n", 1, globals.len(), 2 * self.entities.len(), "", 1));
        text
    }
}

/// Parameters over lines of 64 columns, broken after separators.
fn wrapped(text: &str) -> Vec<String> {
    let mut lines = vec![String::new()];
    for value in text.split_inclusive([',', ';']) {
        if lines.last().is_some_and(|line| line.len() + value.len() > 64) {
            lines.push(String::new());
        }
        lines.last_mut().unwrap().push_str(value);
    }
    lines
}
