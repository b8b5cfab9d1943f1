//! What a layout is written in: texts, places where a line may end, and groups of such places.

/// One step of a layout.
///
/// The [`Cmd::Break`]s of a group end the line all together, or none of them does when the group fits on its line. The
/// next line begins at the indentation that holds when something is written on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Cmd {
    /// An atom.
    Text(u32),
    /// The comments above an atom.
    Own(u32),
    /// One blank.
    Blank,
    /// Ends the line, or is so many blanks; `keep` keeps a blank line that stood here.
    Break {
        flat: u8,
        keep: bool,
    },
    /// Ends the line where the source did or where the next piece does not fit, else is a blank.
    Fill {
        fresh: bool,
    },
    /// Begins a group; with `force` its lines end in any case.
    Open {
        force: bool,
    },
    Close,
    In,
    Out,
    /// A column that neighbouring lines of the same `kind` may share; `wide` tells that the author made one.
    Mark {
        kind: u8,
        wide: bool,
    },
    /// The line that holds the last mark must end behind this place for the mark to count.
    MarkEnd,
    Nothing,
}
