//! What typing a help does to a script.

/// An edit of a script at a subject of a report: the help as it would be typed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Edit {
    /// This text stands in the place of the subject.
    Put(String),
    /// Inside the subject, or else in its declaration, `put` stands in the place of `of`, where that stands once.
    Instead {
        /// As written, blanks aside: `a & b`.
        of: String,
        /// For example `meet(a, b)[0]`.
        put: String,
    },
    /// In the subject's declaration the argument or setting of this name takes this value.
    Set(&'static str, String),
    /// This text in the place of a member of the list that the subject is, counted from 0; `None`: the member goes.
    Member(usize, Option<String>),
    /// The call that the subject is takes this argument too, behind the others.
    Add(String),
    /// The argument that the subject is goes, with its name and comma.
    DropArgument,
    /// The setting whose value the subject is goes; with the last setting of a clause goes the clause.
    DropSetting,
    /// The clause of a mesh that is about the subject goes, or only the setting of this name in it.
    DropRule(Option<&'static str>),
    /// The script declares this once, for example `snap` and `0.5mm`.
    Declare(&'static str, String),
}
