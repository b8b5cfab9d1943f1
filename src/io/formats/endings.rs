//! Endings of files: what sorts of things each one holds, and what to say where something does not go into it.

use crate::base::origin::Origin;
use crate::io::files::fault::FormatFault;
use crate::io::formats::list::{CURVE_FORMATS, FORMATS};

/// What a script may put into a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sort {
    /// Nodes and elements.
    Meshes,
    /// Curves.
    Curves,
    /// Surfaces.
    Surfaces,
    /// Shells.
    Shells,
    /// Points.
    Points,
    /// Lists of records.
    Records,
    /// Tables with a header.
    Tables,
    /// Pictures.
    Pictures,
}

/// All sorts.
const SORTS: [Sort; 8] =
    [Sort::Meshes, Sort::Curves, Sort::Surfaces, Sort::Shells, Sort::Points, Sort::Records, Sort::Tables, Sort::Pictures];
/// Endings of CAD files.
const CAD: [&str; 4] = [IGES[0], IGES[1], STEP[0], STEP[1]];
/// Endings of IGES files.
pub const IGES: [&str; 2] = ["igs", "iges"];
/// Endings of STEP files.
pub const STEP: [&str; 2] = ["step", "stp"];
/// Endings of lists of records.
const RECORDS: [&str; 2] = ["csv", "json"];
/// Endings of tables.
const TABLES: [&str; 1] = ["csv"];
/// Endings of pictures.
const PICTURES: [&str; 2] = ["png", "svg"];
/// Formats of a later version, by ending.
const LATER: &[(&str, &str)] = &[("gltf", "glTF as text"), ("html", "HTML")];

impl Sort {
    /// Its plural.
    pub fn words(self) -> &'static str {
        match self {
            Self::Meshes => "meshes",
            Self::Curves => "curves",
            Self::Surfaces => "surfaces",
            Self::Shells => "shells",
            Self::Points => "points",
            Self::Records => "lists of records",
            Self::Tables => "tables",
            Self::Pictures => "pictures",
        }
    }

    /// The endings that take it.
    pub fn endings(self) -> Vec<&'static str> {
        match self {
            Self::Meshes => FORMATS.iter().flat_map(|format| format.extensions.iter().copied()).collect(),
            Self::Curves => CURVE_FORMATS.iter().map(|format| format.name).chain(CAD).collect(),
            Self::Surfaces | Self::Shells | Self::Points => CAD.to_vec(),
            Self::Records => RECORDS.to_vec(),
            Self::Tables => TABLES.to_vec(),
            Self::Pictures => PICTURES.to_vec(),
        }
    }

    /// How else it gets into a file, as something to type.
    fn help(self) -> String {
        let dotted = |endings: Vec<&str>| endings.iter().map(|ending| format!(".{ending}")).collect::<Vec<_>>().join(" ");
        match self {
            Self::Surfaces | Self::Shells => {
                "export a mesh of it (`mesh fine of …`), or write the surface itself as STEP or IGES: \"….step\", \"….igs\"".to_owned()
            }
            _ => format!("{} go into {}", self.words(), dotted(self.endings())),
        }
    }
}

/// The ending of a path when it takes things of this sort; else E804, E805 or E230 says what it takes instead.
pub fn ending_for(of: Origin, path: &str, sort: Sort) -> Result<String, FormatFault> {
    let ending = extension(path);
    if sort.endings().contains(&ending.as_str()) { Ok(ending) } else { Err(misfit(of, path, sort)) }
}

/// Why things of this sort do not go to a path: E805 for an ending that holds others, E230 for one of a later version, else E804.
pub fn misfit(of: Origin, path: &str, sort: Sort) -> FormatFault {
    let ending = extension(path);
    if let Some((_, format)) = LATER.iter().find(|(name, _)| *name == ending) {
        return FormatFault::LaterFormat { of, format };
    }
    let held: Vec<&str> = SORTS.into_iter().filter(|other| other.endings().contains(&ending.as_str())).map(Sort::words).collect();
    if held.is_empty() {
        return FormatFault::NoSuchFormat { of, path: path.to_owned(), known: sort.endings() };
    }
    let held = match held.as_slice() {
        [all @ .., last] if !all.is_empty() => format!("{} and {last}", all.join(", ")),
        held => held.join(""),
    };
    let what = format!("{ending} holds {held}, not {}", sort.words());
    FormatFault::Unsupported { of, what, help: Some(sort.help()), edits: Vec::new() }
}

/// The ending of a path in lower case, without its dot.
pub fn extension(path: &str) -> String {
    let name = path.rsplit(['/', '\\']).next().unwrap_or(path);
    name.rsplit_once('.').map(|(_, ending)| ending.to_lowercase()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::fault::Fault;

    #[test]
    fn an_ending_says_what_it_holds() {
        let said = |path: &str, sort| Fault::from(ending_for(Origin::NONE, path, sort).unwrap_err()).to_string();
        assert_eq!(said("x.inp", Sort::Curves), "inp holds meshes, not curves");
        assert_eq!(said("x.nas", Sort::Records), "nas holds meshes, not lists of records");
        assert_eq!(said("x.STL", Sort::Surfaces), "stl holds meshes, not surfaces");
        assert_eq!(said("x.png", Sort::Meshes), "png holds pictures, not meshes");
        assert_eq!(said("x.obj", Sort::Points), "obj holds meshes and curves, not points");
        assert_eq!(said("x.igs", Sort::Meshes), "igs holds curves, surfaces, shells and points, not meshes");
        assert_eq!(said("x.json", Sort::Pictures), "json holds lists of records, not pictures");
        assert_eq!(said("x.step", Sort::Meshes), "step holds curves, surfaces, shells and points, not meshes");
        assert_eq!(said("x.glb", Sort::Surfaces), "glb holds meshes, not surfaces");
        assert_eq!(said("x.3mf", Sort::Curves), "3mf holds meshes, not curves");
        assert!(said("x.gltf", Sort::Surfaces).contains("not in this version"));
        assert!(said("x.xyz", Sort::Curves).contains("no format has the ending"));
        assert_eq!(ending_for(Origin::NONE, "a/b.SVG", Sort::Pictures).as_deref(), Ok("svg"));
    }
}
