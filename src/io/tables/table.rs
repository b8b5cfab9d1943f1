//! Tables: csv (comma, semicolon or tab), dat and txt (blanks), in and out.
//!
//! `#` starts a comment outside quotes. A cell is a number, a quantity (`50m`), text, or nothing. A csv's first line is
//! its header when no cell of it is a number; in dat and txt the lines above the first one all of numbers are the title.
//! A line without any value is no row.

/// What stands in a cell.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// A bare number, finite.
    Number(f64),
    /// A number with a unit glued to it or in the column's header, for example `(50.0, "m")`.
    Quantity(f64, String),
    /// Anything else.
    Text(String),
    /// Empty.
    None,
}

impl Cell {
    /// The number of a number or quantity, in the unit it is written in.
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Number(x) | Self::Quantity(x, _) => Some(*x),
            Self::Text(_) | Self::None => None,
        }
    }
}

/// A table as it stands in a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// Lines above the numbers (dat and txt); a csv is written with them as comments.
    pub title: Vec<String>,
    /// Names of the columns, without the unit in brackets.
    pub header: Option<Vec<String>>,
    /// Cells; all rows of a csv have the same length.
    pub rows: Vec<Vec<Cell>>,
    /// Line of each row in the file, from 1.
    pub lines: Vec<u64>,
}

/// How cells are told apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// csv: comma, semicolon or tab, whichever the file has; quotes.
    Separated,
    /// dat, txt: blanks.
    Blanks,
}

impl Layout {
    /// By a path's ending, or `None` when it is no table's.
    pub fn of_extension(extension: &str) -> Option<Self> {
        match extension {
            "csv" => Some(Self::Separated),
            "dat" | "txt" => Some(Self::Blanks),
            _ => None,
        }
    }
}

/// What the language says about an import.
pub struct Reading<'a> {
    /// How cells are told apart.
    pub layout: Layout,
    /// `header: true` or `false`; `None` finds out.
    pub header: Option<bool>,
    /// Whether a word is a unit of the language (`mm`, `kg/m3`).
    pub is_unit: &'a dyn Fn(&str) -> bool,
}
