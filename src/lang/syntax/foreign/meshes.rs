//! Meshes made by a call, and settings and arguments with the signs of other languages.

use crate::lang::syntax::foreign::{Meant, Refusal, opens};
use crate::lang::syntax::token::Kind;
use crate::lang::words::elsewhere::ours;
use crate::mesh::{MeshSettings, Settings};

/// What other tools call making a mesh.
const CALLED: [&str; 5] = ["mesh", "Mesh", "generate_mesh", "make_mesh", "triangulate"];

impl Refusal<'_> {
    /// `mesh m = mesh(s, size=0.1)`, `mesh m = s.mesh(0.1)`, `m = mesh(s)`, `mesh(s, size: 0.1)`.
    pub(crate) fn mesh_called(&self) -> Option<Meant> {
        let (name, from) = match (self.kind(self.base)?, self.kind(self.base + 1)?) {
            (Kind::Mesh | Kind::Let, Kind::Name) if matches!(self.kind(self.base + 2), Some(Kind::Equals | Kind::Of)) => {
                (Some(self.base + 1), self.base + 3)
            }
            (Kind::Name, Kind::Equals) => (Some(self.base), self.base + 2),
            (Kind::Mesh | Kind::Name, Kind::OpenRound | Kind::Dot) => (None, self.base),
            _ => return None,
        };
        let close = self.end - 1;
        let open = (from..close).find(|&t| self.closer(t) == Some(close)).filter(|t| self.kind(*t) == Some(Kind::OpenRound))?;
        let word = open.checked_sub(1).filter(|t| *t >= from && CALLED.contains(&self.text(*t, t + 1)))?;
        let given = self.arguments(open, close);
        let mut unnamed = given.iter().filter(|a| a.0.is_none()).map(|a| a.1.as_str());
        let of = if word >= from + 2 { self.text(from, word - 1) } else { unnamed.next()? };
        let mut settings: Vec<String> = unnamed.map(|size| format!("size: {size}")).collect();
        for (key, value) in given.iter().filter_map(|(name, value)| name.as_deref().map(|n| (n, value))) {
            settings.push(format!("{}: {value}", ours(key, MeshSettings::DECLARED.iter().map(|setting| setting.word)).unwrap_or(key)));
        }
        let name = match name {
            Some(at) => self.text(at, at + 1).to_owned(),
            None => self.fresh.next(self.source, "mesh"),
        };
        let braces = if settings.is_empty() { String::new() } else { format!(" {{ {} }}", settings.join("  ")) };
        self.replaced("what is meshed follows `of`, settings follow in braces", format!("mesh {name} of {of}{braces}"))
    }

    /// `circle(center=A, radius=5)`: every `=` of the declaration that stands behind a name in brackets.
    pub(crate) fn equals_for_colons(&self) -> Option<Meant> {
        if self.kind(self.at) != Some(Kind::Equals) || self.depth(self.at) == 0 {
            return None;
        }
        let named = |at: usize| {
            self.tokens.kinds[at] == Kind::Equals
                && self.depth(at) > 0
                && self.kind(at.wrapping_sub(1)) == Some(Kind::Name)
                && self.kind(at.wrapping_sub(2)).is_some_and(|k| k == Kind::Comma || opens(k) > 0)
        };
        let mut typed = String::new();
        let mut from = self.base;
        for at in (self.base..self.end).filter(|at| named(*at)) {
            typed.push_str(self.text(from, at).trim_end());
            typed.push_str(": ");
            from = at + 1;
        }
        typed.push_str(self.text(from, self.end));
        self.replaced("the name of an argument is followed by a colon", typed)
    }
}
