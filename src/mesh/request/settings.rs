//! The settings of a mesh, each declared once: its word, its type, what it takes, its range, its default and its documentation.
//!
//! From a declaration come the field that holds what is written, with the expression in which it is written, how it is read, its part in the key of
//! a kept mesh, and all that the language, its editors, the reference and goldens show of it. A new setting is a new line here, and the code
//! that acts on it, to which the line has a link.

use super::methods::{Elements, Method};
use crate::base::digest::{StableHash, StableHasher};
use crate::base::origin::Origin;

/// A setting with the expression in which it is written; `None` where it is not written.
pub type Located<T> = Option<(T, Origin)>;

/// What a setting takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Takes {
    /// A length, model units, or a share of the diagonal of what is meshed.
    Size,
    /// An angle, radians.
    Angle,
    /// A number without unit.
    Ratio,
    /// A whole number.
    Count,
    /// True or false.
    Flag,
    /// One of some words.
    Word(&'static [&'static str]),
}

/// A condition of a number, and its words after "must be".
pub type Bound = (fn(f64) -> bool, &'static str);

/// What is said of a setting where it is declared.
#[derive(Clone, Copy, Debug)]
pub struct Declared {
    /// As written before the colon.
    pub word: &'static str,
    /// What it means.
    pub docs: &'static str,
    /// What holds where it is not written, in words; empty where nothing does.
    pub default: &'static str,
    /// What it takes.
    pub takes: Takes,
    /// What its numbers must be.
    pub range: &'static [Bound],
}

/// A value of a setting, whatever it is of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Given<'a> {
    /// A number: model units, radians, a ratio or a count.
    Number(f64),
    /// True or false.
    Flag(bool),
    /// A word.
    Word(&'a str),
}

/// A type that a setting may have.
trait SettingValue: Copy {
    /// The value, where it is one of this type.
    fn of(given: Given<'_>) -> Option<Self>;
    /// The same as written.
    fn given(self) -> Given<'static>;
}

/// Types of settings that are one kind of [`Given`].
macro_rules! setting_values {
    ($($kind:ident: $ty:ty, |$x:ident| $of:expr, |$y:ident| $given:expr;)*) => {$(
        impl SettingValue for $ty {
            fn of(given: Given<'_>) -> Option<Self> {
                if let Given::$kind($x) = given { $of } else { None }
            }

            fn given(self) -> Given<'static> {
                let $y = self;
                Given::$kind($given)
            }
        }
    )*};
}

setting_values! {
    Number: f64, |x| Some(x), |x| x;
    Number: u32, |x| Some(x as u32), |n| f64::from(n);
    Number: u8, |x| Some(x as u8), |n| f64::from(n);
    Flag: bool, |x| Some(x), |x| x;
    Word: Elements, |word| Self::of_word(word), |x| x.word();
    Word: Method, |word| Self::of_word(word), |x| x.word();
}

/// A block of settings.
pub trait Settings: Default {
    /// Its settings in the order in which they are listed.
    const DECLARED: &'static [Declared];

    /// Takes what is written; whether there is such a setting of such a type.
    fn set(&mut self, word: &str, given: Given<'_>, written_at: Origin) -> bool;

    /// What is written, in the order of [`Settings::DECLARED`].
    fn written(&self) -> impl Iterator<Item = (&'static Declared, Given<'static>, Origin)>;
}

/// The comment of a declaration without the blank it starts with.
const fn trimmed(docs: &'static str) -> &'static str {
    let [b' ', rest @ ..] = docs.as_bytes() else { return docs };
    match std::str::from_utf8(rest) {
        Ok(text) => text,
        Err(_) => docs,
    }
}

/// Declares blocks of settings: `word: type, what it takes, range, default in words => default as a value, [what acts on it];`, the value
/// where there is one. What acts on a setting is a path below the crate; it becomes a link in the documentation of its field.
macro_rules! mesh_settings {
    ($($(#[$meta:meta])* $name:ident {
        $($(#[doc = $docs:literal])+ $word:ident: $ty:ty, $takes:expr, $range:expr, $default:literal $(=> $value:expr)?, [$($acting:literal),+];)*
    })*) => {$(
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, Default, PartialEq)]
        pub struct $name {
            $(
                $(#[doc = $docs])+
                #[doc = ""]
                $(#[doc = concat!("- acted on by [`", $acting, "`](crate::", $acting, ")")])+
                pub $word: Located<$ty>,
            )*
        }

        impl $name {
            $($(
                #[doc = concat!("`", stringify!($word), "`, or its default.")]
                pub fn $word(&self) -> $ty {
                    self.$word.map_or($value, |written| written.0)
                }
            )?)*
        }

        impl Settings for $name {
            const DECLARED: &'static [Declared] = &[
                $(Declared {
                    word: stringify!($word),
                    docs: trimmed(concat!($($docs),+)),
                    default: $default,
                    takes: $takes,
                    range: $range,
                },)*
            ];

            fn set(&mut self, word: &str, given: Given<'_>, written_at: Origin) -> bool {
                match word {
                    $(stringify!($word) => {
                        self.$word = SettingValue::of(given).map(|value| (value, written_at));
                        self.$word.is_some()
                    })*
                    _ => false,
                }
            }

            fn written(&self) -> impl Iterator<Item = (&'static Declared, Given<'static>, Origin)> {
                let all = [$(self.$word.map(|(value, written_at)| (value.given(), written_at)),)*];
                Self::DECLARED.iter().zip(all).filter_map(|(declared, written)| written.map(|(given, written_at)| (declared, given, written_at)))
            }
        }

        impl StableHash for $name {
            fn hash_into(&self, to: &mut StableHasher) {
                $(self.$word.map(|written| written.0).hash_into(to);)*
            }
        }
    )*};
}

const ANY: &[Bound] = &[];
/// More than 0.
pub const POSITIVE: &[Bound] = &[(|x| x > 0.0, "more than 0")];
const NOT_NEGATIVE: &[Bound] = &[(|x| x >= 0.0, "0 or more")];
const ABOVE_ONE: &[Bound] = &[(|x| x > 1.0, "more than 1")];
const RATIO: &[Bound] = &[(|x| x > 0.0, "more than 0"), (|x| x * 1e100 >= 1.0, "at least 10^-100"), (|x| x <= 1e100, "at most 10^100")];
const STEPS: &[Bound] = &[(|x| x >= 1.0, "at least 1"), (|x| x <= 1e8, "at most 10^8")];
const ORDERS: &[Bound] = &[(|x| x == 1.0 || x == 2.0, "1 or 2")];

mesh_settings! {
    /// Settings of a whole mesh: `mesh m of things { … }`.
    MeshSettings {
        /// Target edge length: never exceeded on borders, by at most 5 % inside free faces. Nodes of free faces, and of borders that
        /// only free faces share, are 0.8 of it apart, of quads 0.85.
        size: f64, Takes::Size, POSITIVE, "a 20th of the diagonal of what is meshed", ["mesh::size::sizing::Sizing::new"];
        /// Largest distance between mesh and surface; like all lengths of a mesh it may be a percentage of the diagonal of the box
        /// around what is meshed: `0.01%`.
        chord_error: f64, Takes::Size, POSITIVE, "",
            [
                "mesh::deviation::curve::least_steps", "mesh::divide::verdict::check", "mesh::deviation::edge_length::wanted",
                "mesh::tri::triangle_fit"
            ];
        /// Largest turn of the normal across an element.
        angle_error: f64, Takes::Angle, POSITIVE, "",
            [
                "mesh::deviation::curve::least_steps", "mesh::divide::verdict::check", "mesh::deviation::edge_length::wanted",
                "mesh::tri::triangle_fit"
            ];
        /// Smallest edge length, also within `chord_error` and `angle_error`. A written one that prevents these, or is above a written
        /// size, is an error. Written counts and short edges of the model may go below it.
        min_size: f64, Takes::Size, POSITIVE, "a hundredth of the size; written sizes and limits may go below it",
            ["mesh::request::size_requests::SizeRequests::new"];
        /// Ratio of neighbouring sizes on free faces and their borders: away from a place with small steps the size grows by
        /// `growth - 1` of the distance. Rows of mapped faces grow like that where they are uneven.
        growth: f64, Takes::Ratio, ABOVE_ONE, "1.3" => GROWTH,
            ["mesh::request::sources", "mesh::size::spacing_solver", "mesh::size::row_spacing", "mesh::tri::longest"];
        /// Largest number of smoothing rounds on free faces; a node that no longer moves is done earlier. 0 does not smooth.
        smooth: u32, Takes::Count, ANY,
            "5; 4 within `chord_error` or `angle_error`; 8 for quads and where lengths grow from short pieces; 30 with `quadtree`",
            ["mesh::tri", "mesh::quad"];
        /// Fewer irregular nodes, those inside with other than four quads, in plane faces that are meshed freely with quads: more holes are fitted
        /// into the rows of the others, and rows are searched that need no such node. Takes several times as long.
        regular: bool, Takes::Flag, ANY, "false" => false,
            ["mesh::quad::regular", "mesh::tri::build::NodePlacement"];
        /// Kind of elements.
        elements: Elements, Takes::Word(Elements::WORDS), ANY, "triangles" => Elements::Triangles, ["mesh::size::face_settings::apply_rules"];
        /// 1, or 2 with mid nodes.
        order: u8, Takes::Count, ORDERS, "1" => 1, ["mesh::output::second_order"];
        /// How faces are meshed: `auto` (`mapped` where it fits and its elements are well shaped, else `delaunay`), `mapped`,
        /// `delaunay`, `quadtree` (right-angled triangles in rows, finer where a border asks for it), `isoline` (cells between lines of
        /// constant u and v, as large as `chord_error` and `size` allow) or `display` (few and long triangles within `chord_error`).
        method: Method, Takes::Word(Method::WORDS), ANY, "auto" => Method::Auto,
            ["mesh::size::face_settings::apply_rules", "mesh::size::choose::choose"];
        /// Neighbouring faces share nodes.
        conforming: bool, Takes::Flag, ANY, "true" => true, ["mesh::pipeline::build::build"];
        /// Faces that touch without a shared border share nodes there: edges that lie on a face, and the curves in which faces cross,
        /// are lines of the faces' meshes. A curve of the mesh that lies on a face is cut where it leaves it, at a hole too. Faces that
        /// overlap are E666.
        imprint: bool, Takes::Flag, ANY, "false", ["model::imprint", "mesh::border::layout::Layout::new"];
        /// Reverses the normals of faces. Without it faces that close point outwards; a list of faces that stays open keeps the
        /// normals it was given.
        flip: bool, Takes::Flag, ANY, "false" => false, ["mesh::request::plan::Plan::surfaces"];
    }

    /// Settings of a part of a mesh: `on things { … }`.
    RuleSettings {
        /// Steps over the whole length of a curve.
        count: u32, Takes::Count, STEPS, "", ["mesh::size::segment_rules::SegmentRules"];
        /// Target edge length here.
        size: f64, Takes::Size, POSITIVE, "", ["mesh::size::segment_rules::SegmentRules", "mesh::size::face_settings::apply_rules"];
        /// Last step over first step along the curve.
        bias: f64, Takes::Ratio, RATIO, "", ["mesh::size::segment_rules::SegmentRules"];
        /// Kind of elements of these faces.
        elements: Elements, Takes::Word(Elements::WORDS), ANY, "", ["mesh::size::face_settings::apply_rules"];
        /// How these faces are meshed, by the words of the mesh's own `method`.
        method: Method, Takes::Word(Method::WORDS), ANY, "", ["mesh::size::face_settings::apply_rules"];
    }

    /// Settings of places with smaller elements: `near points and curves { … }`.
    NearSettings {
        /// Target edge length up to the radius; further out it grows as `growth` says. It only refines: of several sizes the
        /// smallest applies. A mapped face takes the least size on it for all its rows, and a written `count` stays.
        size: f64, Takes::Size, POSITIVE, "", ["mesh::request::size_requests::SizeRequests::new"];
        /// Distance up to which the size applies.
        radius: f64, Takes::Size, NOT_NEGATIVE, "0" => 0.0, ["mesh::request::size_requests::SizeRequests::new"];
    }

    /// Settings of boxes with smaller elements: `in box(a, b) { … }`.
    BoxSettings {
        /// Target edge length in the box, as with `near`.
        size: f64, Takes::Size, POSITIVE, "", ["mesh::request::size_requests::SizeRequests::new"];
    }
}

/// Ratio of neighbouring sizes where none is written.
pub const GROWTH: f64 = 1.3;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_listed_and_keyed() {
        let mut settings = MeshSettings::default();
        let written_at = Origin(7);
        assert!(settings.set("size", Given::Number(2.5), written_at) && settings.set("method", Given::Word("isoline"), written_at));
        assert!(settings.set("order", Given::Number(2.0), written_at) && settings.set("flip", Given::Flag(true), written_at));
        assert!(!settings.set("sise", Given::Number(1.0), written_at) && !settings.set("elements", Given::Word("hexahedra"), written_at));
        let written: Vec<_> = settings.written().map(|(declared, given, _)| (declared.word, given)).collect();
        let wanted = [("size", Given::Number(2.5)), ("order", Given::Number(2.0)), ("method", Given::Word("isoline"))];
        assert_eq!(written[..3], wanted);
        assert_eq!(settings.order(), 2);
        let key = |settings: &MeshSettings| StableHasher::new("test").with(settings).finish();
        // Every setting that is written changes the key.
        let plain = key(&MeshSettings::default());
        for declared in MeshSettings::DECLARED {
            let mut one = MeshSettings::default();
            let given = match declared.takes {
                Takes::Flag => Given::Flag(true),
                Takes::Word(words) => Given::Word(words[0]),
                _ => Given::Number(2.0),
            };
            assert!(one.set(declared.word, given, written_at), "{}", declared.word);
            assert_ne!(key(&one), plain, "{}", declared.word);
        }
    }

    #[test]
    fn declarations_are_whole() {
        for declared in
            MeshSettings::DECLARED.iter().chain(RuleSettings::DECLARED).chain(NearSettings::DECLARED).chain(BoxSettings::DECLARED)
        {
            assert!(!declared.docs.starts_with(' ') && declared.docs.ends_with('.'), "{}", declared.word);
            let is_bounded = declared.range.iter().all(|bound| !(bound.0)(f64::NAN));
            assert!(is_bounded, "{}: not a number is within its range", declared.word);
        }
    }
}
