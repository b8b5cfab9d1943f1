//! Entities on their way into a file: numbered, laid out in 80 columns.

use std::collections::{BTreeMap, BTreeSet};
use std::io::{self, Write};

use glam::DVec3;

use crate::base::job;
use crate::base::text::push_real;
use crate::io::files::loss::{Loss, Renamed};
use crate::io::files::romanize::in_ascii;
use crate::io::iges::lines::{CONTENT, DATA};

/// Highest number of a level that a layer may have by its name.
const HIGHEST_LEVEL: u32 = 9_999_999;

/// Dependence and use of an entity, as the status field has them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Stands for itself.
    Free,
    /// A part of others.
    Part,
    /// A part of others in the (u, v) of a surface.
    InUv,
    /// A property, colour or group.
    Definition,
    /// A point that places another entity.
    Place,
    /// A direction of another entity.
    Direction,
    /// The list of the edges of a solid.
    List,
    /// A solid or shell, whose faces have levels and colours of their own.
    Body,
    /// The same as a part of a solid.
    ShellOfSolid,
}

impl Role {
    fn status(self) -> &'static str {
        match self {
            Self::Free => "00000000",
            Self::Part => "00010000",
            Self::InUv => "00010500",
            Self::Definition => "00000200",
            Self::Place => "00010400",
            Self::Direction => "00010200",
            Self::List | Self::ShellOfSolid => "00010001",
            Self::Body => "00000001",
        }
    }
}

/// Values of one entity, parted by commas.
#[derive(Clone, Debug, Default)]
pub struct EntityValues {
    texts: Vec<String>,
    /// Largest coordinate among them.
    largest: f64,
}

impl EntityValues {
    /// No values yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// A count, flag or pointer.
    pub fn int(mut self, n: impl Into<i64>) -> Self {
        self.texts.push(n.into().to_string());
        self
    }

    /// Counts or pointers.
    pub fn ints(self, list: impl IntoIterator<Item = u32>) -> Self {
        list.into_iter().fold(self, Self::int)
    }

    /// A real number with the digits that read back to the same bits.
    pub fn real(mut self, x: f64) -> Self {
        self.texts.push(real(x));
        self
    }

    /// Real numbers.
    pub fn reals(self, list: impl IntoIterator<Item = f64>) -> Self {
        list.into_iter().fold(self, Self::real)
    }

    /// Three coordinates.
    pub fn point(mut self, p: DVec3) -> Self {
        self.largest = self.largest.max(p.abs().max_element());
        self.reals(p.to_array())
    }

    /// A counted text of plain characters.
    pub fn text(mut self, text: &str) -> Self {
        self.texts.push(counted(text));
        self
    }
}

/// A real number as the format wants it: always with a point, `E` before the exponent.
pub fn real(x: f64) -> String {
    let mut out = Vec::with_capacity(24);
    push_real(&mut out, x);
    let text = String::from_utf8_lossy(&out).into_owned();
    match text.split_once('e') {
        Some((mantissa, exponent)) if mantissa.contains('.') => format!("{mantissa}E{exponent}"),
        Some((mantissa, exponent)) => format!("{mantissa}.E{exponent}"),
        None if text.contains('.') => text,
        None => text + ".",
    }
}

/// `5Hround`; empty for nothing. Characters that are not plain become `_`.
pub fn counted(text: &str) -> String {
    let plain: String = text.chars().map(|c| if is_sign(c) { c } else { '_' }).collect();
    if plain.is_empty() { plain } else { format!("{}H{plain}", plain.len()) }
}

#[derive(Clone, Debug)]
struct Entity {
    kind: u32,
    form: i32,
    role: Role,
    transform: u32,
    color: i64,
    /// Number of its level, or below 0 a pointer to a list of such.
    level: i64,
    values: EntityValues,
    properties: Vec<u32>,
}

/// Whether names of a file may have a character.
fn is_sign(c: char) -> bool {
    c.is_ascii_graphic() || c == ' '
}

fn is_written(name: &str) -> bool {
    name.chars().all(is_sign)
}

/// A file in the making.
#[derive(Clone, Debug, Default)]
pub struct IgesFile {
    entities: Vec<Entity>,
    /// Names in the file with those in the model.
    names: BTreeMap<String, String>,
    /// Lines for people at the start of the file.
    remarks: Vec<String>,
    /// Colours with the pointers to them.
    colors: Vec<([f64; 3], u32)>,
    /// Layers with the numbers of their levels.
    levels: BTreeMap<String, u32>,
    /// Several levels with the pointers to their lists.
    lists: BTreeMap<Vec<u32>, u32>,
    /// What is not in the file, in words.
    pub left_out: Vec<String>,
}

impl IgesFile {
    /// Adds a line for people, of plain characters, at most 72 of them.
    pub fn remark(&mut self, line: String) {
        self.remarks.push(line);
    }

    /// Adds an entity; gives the pointer to it.
    pub fn add(&mut self, kind: u32, form: i32, role: Role, values: EntityValues) -> u32 {
        self.entities.push(Entity { kind, form, role, transform: 0, color: 0, level: 0, values, properties: Vec::new() });
        self.entities.len() as u32 * 2 - 1
    }

    fn at(&mut self, d: u32) -> Option<&mut Entity> {
        self.entities.get_mut((d as usize).saturating_sub(1) / 2)
    }

    /// Places an entity by a matrix.
    pub fn place(&mut self, d: u32, matrix: u32) {
        if let Some(entity) = self.at(d) {
            entity.transform = matrix;
        }
    }

    /// Keeps the names of ASCII characters for those who have them.
    pub fn keep<'a>(&mut self, names: impl Iterator<Item = &'a str>) {
        self.names.extend(names.filter(|name| is_written(name)).map(|name| (name.to_owned(), name.to_owned())));
    }

    /// Gives an entity a name.
    pub fn name(&mut self, d: u32, name: &str) {
        let given = self.given(name);
        let property = self.add(406, 15, Role::Definition, EntityValues::new().int(1).text(&given));
        if let Some(entity) = self.at(d) {
            entity.properties.push(property);
        }
    }

    /// A name as the file has it.
    fn given(&mut self, name: &str) -> String {
        let ascii: String = in_ascii(name).chars().map(|c| if c.is_ascii_graphic() || c == ' ' { c } else { '_' }).collect();
        let mut given = ascii.clone();
        let mut k = 2;
        while self.names.get(&given).is_some_and(|known| known != name) {
            given = format!("{ascii}_{k}");
            k += 1;
        }
        self.names.insert(given.clone(), name.to_owned());
        given
    }

    /// Gives an entity a colour of red, green and blue from 0 to 1; equal ones stand once in the file.
    pub fn paint(&mut self, d: u32, rgb: [f64; 3]) {
        let known = self.colors.iter().find(|known| known.0 == rgb).map(|known| known.1);
        let color = known.unwrap_or_else(|| {
            let color = self.add(314, 0, Role::Definition, EntityValues::new().reals(rgb.map(|share| 100.0 * share)));
            self.colors.push((rgb, color));
            color
        });
        if let Some(entity) = self.at(d) {
            entity.color = -i64::from(color);
        }
    }

    /// Numbers all layers that things may be put on, and names their levels; a layer whose name is a number has that one.
    pub fn layers<'a>(&mut self, names: impl Iterator<Item = &'a str>) {
        let mut all: Vec<&str> = Vec::new();
        names.for_each(|name| {
            if !all.contains(&name) {
                all.push(name)
            }
        });
        let number = |name: &str| name.parse().ok().filter(|n: &u32| (1..=HIGHEST_LEVEL).contains(n) && n.to_string() == *name);
        let (numbers, words): (Vec<&str>, Vec<&str>) = all.into_iter().partition(|name| number(name).is_some());
        self.levels.extend(numbers.into_iter().filter_map(|name| Some((name.to_owned(), number(name)?))));
        let taken: BTreeSet<u32> = self.levels.values().copied().collect();
        let free = (1..).filter(|n| !taken.contains(n));
        for (name, level) in words.into_iter().zip(free) {
            let given = self.given(name);
            let property = self.add(406, 3, Role::Definition, EntityValues::new().int(2).int(0).text(&given));
            self.levels.insert(name.to_owned(), level);
            if let Some(entity) = self.at(property) {
                entity.level = i64::from(level);
            }
        }
    }

    /// Puts an entity on layers.
    pub fn put_on(&mut self, d: u32, layers: &[String]) {
        let mut levels: Vec<u32> = layers.iter().filter_map(|name| self.levels.get(name).copied()).collect();
        levels.sort_unstable();
        levels.dedup();
        let level = match levels[..] {
            [] => return,
            [one] => i64::from(one),
            _ => {
                let known = self.lists.get(&levels).copied();
                let list = known.unwrap_or_else(|| {
                    let list =
                        self.add(406, 1, Role::Definition, EntityValues::new().int(levels.len() as u32).ints(levels.iter().copied()));
                    self.lists.insert(levels, list);
                    list
                });
                -i64::from(list)
            }
        };
        if let Some(entity) = self.at(d) {
            entity.level = level;
        }
    }

    /// Names that stand otherwise in the file.
    pub fn renamed(&self) -> Vec<Loss> {
        let other = self.names.iter().filter(|(given, name)| given != name);
        other.map(|(given, name)| Loss::Renamed(Renamed { from: name.clone(), to: given.clone(), family: false })).collect()
    }

    /// Largest coordinate of all points that stand by themselves in the entities.
    pub fn largest(&self) -> f64 {
        self.entities.iter().map(|entity| entity.values.largest).fold(0.0, f64::max)
    }

    /// Writes the five sections.
    pub fn write(&self, global: &[String], out: &mut dyn Write) -> io::Result<()> {
        let mut lines = LineWriter { out, letter: 'S', n: 0 };
        lines.put("Written by loft")?;
        for remark in &self.remarks {
            lines.put(remark)?;
        }
        let starts = lines.n;
        lines.section('G');
        for line in wrapped(global, CONTENT) {
            lines.put(&line)?;
        }
        let globals = lines.n;
        let parameters: Vec<Vec<String>> = self.entities.iter().map(Entity::lines).collect();
        lines.section('D');
        let mut first = 1;
        for (entity, parameters) in self.entities.iter().zip(&parameters) {
            job::poll();
            let Entity { kind, form, transform, color, level, role, .. } = entity;
            let (n, status) = (parameters.len(), role.status());
            lines.put(&format!("{kind:>8}{first:>8}{0:>8}{0:>8}{level:>8}{0:>8}{transform:>8}{0:>8}{status}", 0))?;
            lines.put(&format!("{kind:>8}{:>8}{color:>8}{n:>8}{form:>8}{:>8}{:>8}{:>8}{:>8}", 0, "", "", "", 0))?;
            first += n;
        }
        lines.section('P');
        for (k, parameters) in parameters.iter().enumerate() {
            for line in parameters {
                lines.put(&format!("{line:<DATA$} {:>7}", 2 * k + 1))?;
            }
        }
        let written = lines.n;
        lines.section('T');
        lines.put(&format!("S{starts:07}G{globals:07}D{:07}P{written:07}", 2 * self.entities.len()))
    }
}

impl Entity {
    fn lines(&self) -> Vec<String> {
        let mut values = vec![self.kind.to_string()];
        values.extend(self.values.texts.iter().cloned());
        if !self.properties.is_empty() {
            values.extend(["0".to_owned(), self.properties.len().to_string()]);
            values.extend(self.properties.iter().map(u32::to_string));
        }
        wrapped(&values, DATA)
    }
}

/// Values with separators over lines; one longer than a line runs over, as texts may.
fn wrapped(values: &[String], width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for (k, value) in values.iter().enumerate() {
        let separator = if k + 1 == values.len() { ';' } else { ',' };
        let mut rest = format!("{value}{separator}");
        let used = lines.last().map_or(0, String::len);
        if used + rest.len() > width && used > 0 {
            lines.push(String::new());
        }
        while rest.len() > width {
            let tail = rest.split_off(width);
            if let Some(line) = lines.last_mut() {
                line.push_str(&rest);
            }
            lines.push(String::new());
            rest = tail;
        }
        if let Some(line) = lines.last_mut() {
            line.push_str(&rest);
        }
    }
    lines
}

struct LineWriter<'o> {
    out: &'o mut dyn Write,
    letter: char,
    n: usize,
}

impl LineWriter<'_> {
    fn section(&mut self, letter: char) {
        (self.letter, self.n) = (letter, 0);
    }

    fn put(&mut self, content: &str) -> io::Result<()> {
        self.n += 1;
        writeln!(self.out, "{content:<CONTENT$}{}{:>7}", self.letter, self.n)
    }
}
