//! The tree of a script: one small arena per declaration.

use crate::lang::diag::span::Span;
use crate::lang::syntax::declarations::Declarations;
use crate::lang::words::names::Name;

crate::ids! {
    /// An expression of a declaration's arena.
    ExprId,
}

/// One expression with its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// Where it stands.
    pub span: Span,
    /// What it is.
    pub expr: Expr,
}

/// Prefix operators.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Unary {
    Minus,
    Not,
}

/// Infix operators; `Meet` is `&`, `Run` is `..` (a range of numbers, or a run of links inside an index).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Binary {
    Power,
    Meet,
    Times,
    Divide,
    Plus,
    Minus,
    Run,
    Equal,
    NotEqual,
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    And,
    Or,
}

/// An expression.
#[derive(Clone, Debug, PartialEq)]
pub enum Expr {
    /// A bare number.
    Number(f64),
    /// A number with a unit glued to it; `unit` is its text (`mm2`, `kg/m3`, `%`).
    Quantity(f64, Box<str>),
    /// A string: literal stretches and interpolated expressions.
    Text(Vec<TextPart>),
    /// `true` or `false`.
    Bool(bool),
    /// `none`.
    None,
    /// A name used as a value.
    Name(Name),
    /// `name(args)`; or `of.name(args)` with `of` as first argument.
    Call {
        /// Function.
        name: Name,
        /// Where its name stands.
        name_span: Span,
        /// What stands before the dot.
        of: Option<ExprId>,
        /// Arguments.
        args: Vec<Arg>,
    },
    /// `of.name` without brackets.
    Field {
        /// Of what.
        of: ExprId,
        /// Field or function.
        name: Name,
        /// Where the name stands.
        name_span: Span,
    },
    /// `of[index]`; a slice when `index` is a [`Expr::Slice`].
    Index {
        /// Of what.
        of: ExprId,
        /// Which.
        index: ExprId,
    },
    /// `from..to` inside an index with either end left out, or both present.
    Slice {
        /// Where it begins.
        from: Option<ExprId>,
        /// Where it ends.
        to: Option<ExprId>,
    },
    /// `(a, b)` or `(a, b, c)`.
    Tuple(Vec<ExprId>),
    /// `[a, b]`.
    List(Vec<ExprId>),
    /// `[for i in list if c: body]`.
    Comprehension {
        /// `for`s and `if`s in order.
        clauses: Vec<Clause>,
        /// What is collected.
        body: ExprId,
    },
    /// `{a: 1, b: 2}`.
    Record(Vec<(Name, ExprId)>),
    /// `-x`, `not x`.
    Unary(Unary, ExprId),
    /// `a op b`.
    Binary {
        /// Operator.
        op: Binary,
        /// Where it stands.
        op_span: Span,
        /// Left side.
        a: ExprId,
        /// Right side.
        b: ExprId,
    },
    /// `comparison within t`; `of` is the `==` or `!=` before it.
    Within {
        /// The comparison.
        of: ExprId,
        /// Tolerance.
        tolerance: ExprId,
    },
    /// `if c then a else b`.
    If {
        /// Condition.
        condition: ExprId,
        /// When true.
        then: ExprId,
        /// When false.
        otherwise: ExprId,
    },
    /// `let name = value in body`.
    Let {
        /// Local name.
        name: Name,
        /// Where it stands.
        name_span: Span,
        /// Its value.
        value: ExprId,
        /// Where it holds.
        body: ExprId,
    },
}

/// A stretch of a string.
#[derive(Clone, Debug, PartialEq)]
pub enum TextPart {
    /// As it is, escapes resolved.
    Literal(Box<str>),
    /// `{expr}`.
    Value(ExprId),
}

/// One argument of a call.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arg {
    /// `name:` when given.
    pub name: Option<(Name, Span)>,
    /// Its value.
    pub value: ExprId,
}

/// A clause of a comprehension.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Clause {
    /// `for name in list`.
    For(For),
    /// `if condition`.
    If(ExprId),
}

/// `for name in list`, also after the name of a family.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct For {
    /// Loop name.
    pub name: Name,
    /// Where it stands.
    pub name_span: Span,
    /// What it runs over.
    pub list: ExprId,
}

/// A declaration keyword.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[allow(missing_docs)]
pub enum Keyword {
    Units,
    Tolerance,
    Snap,
    Use,
    Import,
    Param,
    Let,
    Fn,
    Point,
    Curve,
    ModelingCurve,
    Surface,
    Shell,
    Group,
    Mesh,
    Check,
    Report,
    Export,
    Picture,
}

/// A name that a declaration binds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bound {
    /// The name.
    pub name: Name,
    /// Where it stands.
    pub span: Span,
}

/// `key: value` of a settings block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SettingEntry {
    /// The key.
    pub key: Name,
    /// Where it stands.
    pub key_span: Span,
    /// Its value.
    pub value: ExprId,
}

/// `on things { … }`, `near things { … }`, `in box { … }` inside a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshClause {
    /// `on`, `near` or `in`.
    pub word: ClauseWord,
    /// The whole clause.
    pub span: Span,
    /// What it speaks of.
    pub things: Vec<ExprId>,
    /// Its settings.
    pub settings: Vec<SettingEntry>,
}

/// First word of a mesh clause.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum ClauseWord {
    On,
    Near,
    In,
}

/// `in a to b` or `in [a, b]` of a param.
#[derive(Clone, Debug, PartialEq)]
pub enum Allowed {
    /// Both ends included.
    Range(ExprId, ExprId),
    /// One of these.
    Choices(Vec<ExprId>),
}

/// A type as written: `length`, `[length]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TypeName {
    /// The word.
    pub name: Name,
    /// How many brackets stand around it.
    pub lists: u8,
    /// Where it stands.
    pub span: Span,
}

/// A parameter of an `fn`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FnParam {
    /// Its name.
    pub bound: Bound,
    /// Its type when written.
    pub ty: Option<TypeName>,
    /// Its default when written.
    pub default: Option<ExprId>,
}

/// What a declaration says.
#[derive(Clone, Debug, PartialEq)]
pub enum DeclarationKind {
    /// `units mm`.
    Units(Bound),
    /// `tolerance 0.001mm, 0.5deg`.
    Tolerance(Vec<ExprId>),
    /// `snap 4mm`.
    Snap(ExprId),
    /// `use "ribs.loft" (height: 3m) as ribs`; `import "x.csv" (unit: m) as x` (the keyword tells).
    Load {
        /// The path, a [`Expr::Text`].
        path: ExprId,
        /// What stands in brackets.
        args: Vec<Arg>,
        /// The name it gets.
        bound: Bound,
    },
    /// `param name: type = value in allowed`.
    Param {
        /// Its name.
        bound: Bound,
        /// Its type when written.
        ty: Option<TypeName>,
        /// Its default.
        value: ExprId,
        /// What is allowed.
        allowed: Option<Allowed>,
    },
    /// `fn name(params) = body`.
    Fn {
        /// Its name.
        bound: Bound,
        /// Parameters.
        params: Vec<FnParam>,
        /// Result type when written.
        returns: Option<TypeName>,
        /// Body.
        body: ExprId,
    },
    /// `let`, `point`, `curve`, `modeling curve`, `surface`: `keyword name for … = value`.
    Value {
        /// Its name.
        bound: Bound,
        /// `for`s after the name.
        family: Vec<For>,
        /// Right side.
        value: ExprId,
    },
    /// `shell`, `group`, `mesh`: `keyword name for … of things { … }`.
    Collection {
        /// Its name.
        bound: Bound,
        /// `for`s after the name.
        family: Vec<For>,
        /// What it holds.
        things: Vec<ExprId>,
        /// `key: value` pairs.
        settings: Vec<SettingEntry>,
        /// Clauses (`mesh` only).
        clauses: Vec<MeshClause>,
    },
    /// `check`, `report`, `export`, `picture`.
    Output {
        /// `"label":` of a check or report, an [`Expr::Text`].
        label: Option<ExprId>,
        /// What is checked, reported, exported.
        things: Vec<ExprId>,
        /// `for`s after the things.
        family: Vec<For>,
        /// `to "path"`.
        to: Option<ExprId>,
        /// `{ settings }`.
        settings: Vec<SettingEntry>,
    },
}

/// One declaration.
#[derive(Clone, Debug, PartialEq)]
pub struct Declaration {
    /// Which keyword it starts with.
    pub keyword: Keyword,
    /// From its keyword to its last token.
    pub span: Span,
    /// Where the keyword stands.
    pub keyword_span: Span,
    /// Text of the `///` lines before it.
    pub doc: Option<Box<str>>,
    /// What it says.
    pub kind: DeclarationKind,
    /// Its expressions; children come before parents.
    pub nodes: Vec<Node>,
}

/// A parsed file.
#[derive(Clone, Debug, Default)]
pub struct Script {
    /// The declarations that parsed, in order of writing.
    pub declarations: Declarations,
    /// Names that broken declarations would have bound: what uses them is skipped without a message.
    pub broken: Vec<Bound>,
}
