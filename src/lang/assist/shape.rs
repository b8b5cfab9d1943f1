//! What is known of a value without evaluating it: its type, what a list holds, the keys of a record.

use std::sync::Arc;

use crate::lang::values::types::Ty;
use crate::lang::values::value::{Dim, Value};
use crate::lang::words::names::{Name, Names};

/// Members of a list that are looked at, and lists inside lists.
const LOOKED_AT: (usize, u32) = (8, 4);

/// The type of a value as far as it is known.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum KnownType {
    /// Nothing is known.
    #[default]
    Unknown,
    /// A value of this type, which is no list.
    Is(Ty),
    /// A list of these.
    List(Arc<Self>),
    /// A record with these keys.
    Record(Arc<[(String, Self)]>),
    /// An imported table with these names in its header.
    Table(Arc<[String]>),
    /// A script used as a module, by its place among those that were read.
    Module(usize),
}

impl KnownType {
    /// A list of these.
    pub fn list(of: Self) -> Self {
        Self::List(Arc::new(of))
    }

    /// What a type says.
    pub fn of(ty: Ty) -> Self {
        match ty {
            Ty::Any => Self::Unknown,
            Ty::List(of) | Ty::Rest(of) => Self::list(Self::of(*of)),
            Ty::Optional(of) => Self::of(*of),
            Ty::Choice(_) => Self::Is(Ty::Word),
            other => Self::Is(other),
        }
    }

    /// What an evaluated value shows.
    pub fn of_value(value: &Value, names: &Names) -> Self {
        Self::looked_at(value, names, LOOKED_AT.1)
    }

    fn looked_at(value: &Value, names: &Names, depth: u32) -> Self {
        if depth == 0 {
            return Self::Unknown;
        }
        match value {
            Value::None => Self::Unknown,
            Value::List(items) => {
                let known = items.iter().take(LOOKED_AT.0).map(|item| Self::looked_at(item, names, depth - 1));
                Self::list(known.reduce(Self::either).unwrap_or_default())
            }
            Value::Record(record) => {
                let key = |(key, value): (&Name, &Value)| (names.text(*key).to_owned(), Self::looked_at(value, names, depth - 1));
                Self::Record(record.keys.iter().zip(&record.values).map(key).collect())
            }
            Value::Table(table) => Self::Table(table.keys.iter().map(|key| names.text(*key).to_owned()).collect()),
            // A module is known from its text.
            Value::Module(_) => Self::Unknown,
            other => Self::Is(other.ty()),
        }
    }

    /// What both agree on.
    pub fn either(a: Self, b: Self) -> Self {
        if a == b { a } else { Self::Unknown }
    }

    /// This, or where nothing is known the other.
    pub fn or(self, other: impl FnOnce() -> Self) -> Self {
        match self {
            Self::Unknown => other(),
            known => known,
        }
    }

    /// What a list, range or table of this kind holds.
    pub fn member(&self) -> Self {
        match self {
            Self::List(of) => (**of).clone(),
            Self::Is(Ty::Range) => Self::Is(Ty::Count),
            Self::Table(keys) => Self::Record(keys.iter().map(|key| (key.clone(), Self::Unknown)).collect()),
            _ => Self::Unknown,
        }
    }

    /// Whether it is this type of the language, as far as is known.
    pub fn is(&self, ty: Ty) -> bool {
        *self == Self::Is(ty)
    }

    /// The dimension of a number or quantity.
    pub fn dim(&self) -> Option<Dim> {
        match self {
            Self::Is(Ty::Number | Ty::Count | Ty::Whole) => Some(Dim::NONE),
            Self::Is(Ty::Quantity(dim)) => Some(*dim),
            _ => None,
        }
    }

    /// As signatures show it; empty where nothing is known.
    pub fn signature(&self) -> String {
        match self {
            Self::Unknown => String::new(),
            Self::Is(ty) => ty.signature(),
            Self::List(of) => match of.signature() {
                inner if inner.is_empty() => "list".to_owned(),
                inner => format!("[{inner}]"),
            },
            Self::Record(keys) => {
                let keys: Vec<&str> = keys.iter().map(|(key, _)| key.as_str()).collect();
                format!("record {{{}}}", keys.join(", "))
            }
            Self::Table(keys) if keys.is_empty() => "table".to_owned(),
            Self::Table(keys) => format!("table of {}", keys.join(", ")),
            Self::Module(_) => "module".to_owned(),
        }
    }

    /// Whether a value like this has the fields that are declared for this type.
    pub fn has_fields_of(&self, ty: Ty) -> bool {
        match (ty, self) {
            (Ty::Any, _) | (_, Self::Unknown) => true,
            (Ty::OneOf(of), _) => of.iter().any(|ty| self.has_fields_of(*ty)),
            (_, Self::Is(Ty::OneOf(of))) => of.iter().any(|is| Self::of(*is).has_fields_of(ty)),
            (Ty::List(of), Self::List(is)) => is.fits(*of),
            (Ty::List(_) | Ty::Rest(_), _) => false,
            (Ty::Node, _) => self.is(Ty::Node),
            (Ty::Point | Ty::Vector | Ty::Direction, Self::Is(is)) => is_place(*is),
            (Ty::Curve, Self::Is(Ty::Curve | Ty::Link)) => true,
            (Ty::Measure | Ty::Number, Self::Is(Ty::Measure)) => true,
            (Ty::Measure, _) => self.dim().is_some(),
            (Ty::Number, _) => self.dim() == Some(Dim::NONE),
            (Ty::Part, Self::Record(keys)) => is_part(keys),
            (Ty::Record, Self::Record(_)) | (Ty::Table, Self::Table(_)) | (Ty::Module, Self::Module(_)) => true,
            (ty, _) => self.is(ty),
        }
    }

    /// Whether a value like this may stand where this type is wanted, bare numbers for lengths aside.
    pub fn fits(&self, ty: Ty) -> bool {
        match (ty, self) {
            (Ty::Any, _) | (_, Self::Unknown) => true,
            (Ty::Optional(of), _) => self.fits(*of),
            (Ty::OneOf(of), _) => of.iter().any(|ty| self.fits(*ty)),
            (_, Self::Is(Ty::OneOf(of))) => of.iter().any(|is| Self::of(*is).fits(ty)),
            (Ty::List(of) | Ty::Rest(of), Self::List(is)) => is.fits(*of) || of.is_thing() && is.fits(ty),
            (Ty::List(_), Self::Table(_)) => true,
            (Ty::List(Ty::Any | Ty::Count | Ty::Whole | Ty::Number), Self::Is(Ty::Range)) => true,
            (Ty::List(of) | Ty::Rest(of), Self::Record(keys)) if is_part(keys) => self.fits(*of) || Self::Is(Ty::Surface).fits(*of),
            (Ty::List(of) | Ty::Rest(of), _) => of.is_thing() && self.fits(*of),
            (_, Self::List(_)) => false,
            (Ty::Number | Ty::Count | Ty::Whole | Ty::Quantity(_) | Ty::Measure | Ty::Station | Ty::Size, Self::Is(Ty::Measure)) => true,
            (Ty::Number | Ty::Count | Ty::Whole, _) => self.dim() == Some(Dim::NONE),
            (Ty::Quantity(wanted), _) => self.dim() == Some(wanted),
            (Ty::Measure, _) => self.dim().is_some(),
            (Ty::Size, _) => matches!(self.dim(), Some(Dim::NONE | Dim::LENGTH)),
            (Ty::Station, _) => matches!(self.dim(), Some(Dim::NONE | Dim::LENGTH)),
            (Ty::Choice(_) | Ty::Word, _) => self.is(Ty::Word),
            (Ty::Axis, Self::Is(Ty::Curve | Ty::Link | Ty::Edge)) => true,
            (Ty::Point | Ty::Node | Ty::Vector | Ty::Direction | Ty::Axis, Self::Is(is)) => is_place(*is),
            (Ty::Curve, Self::Is(Ty::Link | Ty::Edge)) => true,
            (Ty::Part, Self::Record(keys)) => is_part(keys),
            (Ty::Record, Self::Record(_)) | (Ty::Table, Self::Table(_)) | (Ty::Module, Self::Module(_)) => true,
            (ty, _) => self.is(ty),
        }
    }
}

/// Whether a record has the keys of an imported part.
fn is_part(keys: &[(String, KnownType)]) -> bool {
    ["points", "curves", "surfaces"].iter().all(|wanted| keys.iter().any(|(key, _)| key == wanted))
}

fn is_place(ty: Ty) -> bool {
    matches!(ty, Ty::Point | Ty::Node | Ty::Vertex | Ty::Vector | Ty::Direction)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_fits_is_known() {
        let (curve, length) = (KnownType::Is(Ty::Curve), Ty::Quantity(Dim::LENGTH));
        assert!(curve.fits(Ty::Rest(&Ty::Curve)) && KnownType::list(KnownType::list(curve.clone())).fits(Ty::List(&Ty::Curve)));
        assert!(!curve.fits(Ty::Surface) && !KnownType::list(curve.clone()).fits(Ty::Curve) && curve.fits(Ty::Axis));
        assert!(KnownType::Is(Ty::Node).fits(Ty::Point) && !KnownType::Is(Ty::Point).has_fields_of(Ty::Node));
        assert!(KnownType::of(length).fits(Ty::Measure) && !KnownType::Is(Ty::Number).fits(length) && KnownType::Unknown.fits(length));
    }
}
