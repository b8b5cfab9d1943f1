//! The declarations of a script: of those that share a shape, places and names are kept, and the tree is made when it is asked for.
//!
//! Data written as a script (`point p17 = (1.0, 2.0, 0)`, 10^5 times) has a handful of shapes. A tree of its own for each line takes
//! six times the memory of what sets the lines apart, and each is looked at once.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};

use crate::lang::diag::span::Span;
use crate::lang::syntax::ast::{Bound, Declaration, DeclarationKind, Expr, Keyword};
use crate::lang::syntax::scan::Tokens;
use crate::lang::syntax::scopes::bound;
use crate::lang::syntax::shape::{Filler, NameSource, Places, Shape};
use crate::lang::words::names::{Name, Names};

/// The declarations of a file that parsed, in order of writing.
#[derive(Clone, Default)]
pub struct Declarations {
    entries: Vec<DeclarationSource>,
    text: Arc<str>,
    tokens: TokenPlaces,
    shapes: Vec<Arc<Shape>>,
    /// Names of the declarations of shared shapes, in the order in which their shapes ask for them.
    names: Vec<Name>,
    /// `///` lines before declarations of shared shapes.
    docs: BTreeMap<u32, Box<str>>,
    wholes: Vec<Arc<Declaration>>,
    last: LastWhole,
}

/// The tree that was made last, with the places of its declaration and of its shape: one is often asked for several times in a row.
#[derive(Default)]
struct LastWhole(Mutex<Option<(usize, u32, Arc<Declaration>)>>);

impl Clone for LastWhole {
    fn clone(&self) -> Self {
        Self::default()
    }
}

/// Those with their trees, whichever way they are kept.
impl fmt::Debug for Declarations {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.debug_list().entries(self.iter()).finish()
    }
}

#[derive(Clone, Copy)]
enum DeclarationSource {
    /// Place of the shape, of the first token, and of the first name.
    Shared { shape: u32, token: u32, name: u32 },
    /// Place among those kept whole.
    Whole(u32),
}

/// Where the tokens of a file stand: five bytes each.
#[derive(Clone, Default)]
pub(crate) struct TokenPlaces {
    starts: Vec<u32>,
    /// Bytes of each; 0 of those that are longer than a byte can say.
    lengths: Vec<u8>,
    long_ends: BTreeMap<u32, u32>,
}

impl TokenPlaces {
    fn of(tokens: &mut Tokens) -> Self {
        let (starts, ends) = (std::mem::take(&mut tokens.starts), std::mem::take(&mut tokens.ends));
        let lengths: Vec<u8> = starts.iter().zip(&ends).map(|(start, end)| u8::try_from(end - start).unwrap_or(0)).collect();
        let mut long_ends = BTreeMap::new();
        if lengths.contains(&0) {
            long_ends.extend((0..).zip(&lengths).zip(&ends).filter(|((_, length), _)| **length == 0).map(|((at, _), end)| (at, *end)));
        }
        let mut places = Self { starts, lengths, long_ends };
        places.starts.shrink_to_fit();
        places
    }

    /// From the first to the last of two tokens.
    #[inline]
    pub fn stretch(&self, first: usize, last: usize) -> Option<Span> {
        let end = match *self.lengths.get(last)? {
            0 => *self.long_ends.get(&(last as u32))?,
            length => self.starts[last] + u32::from(length),
        };
        Some(Span { start: *self.starts.get(first)?, end })
    }
}

impl Declarations {
    /// Room for so many.
    pub(crate) fn reserve(&mut self, n: usize) {
        self.entries.reserve(n);
    }

    /// Keeps a shape that declarations share; its place.
    pub(crate) fn add_shape(&mut self, shape: &Arc<Shape>) -> u32 {
        self.shapes.push(Arc::clone(shape));
        self.shapes.len() as u32 - 1
    }

    /// Adds a declaration of a shared shape whose first token is `token`.
    pub(crate) fn add_shared(
        &mut self,
        shape: u32,
        token: usize,
        (source, tokens): (&str, &Tokens),
        names: &mut Names,
        doc: Option<Box<str>>,
    ) {
        let name = self.names.len() as u32;
        for at in &self.shapes[shape as usize].names {
            let Span { start, end } = tokens.span(token + *at as usize);
            self.names.push(names.intern(&source[start as usize..end as usize]));
        }
        if let Some(doc) = doc {
            self.docs.insert(self.entries.len() as u32, doc);
        }
        self.entries.push(DeclarationSource::Shared { shape, token: token as u32, name });
    }

    /// Adds a declaration with its tree.
    pub(crate) fn add_whole(&mut self, declaration: Declaration) {
        self.entries.push(DeclarationSource::Whole(self.wholes.len() as u32));
        self.wholes.push(Arc::new(declaration));
    }

    /// Takes over the text and the places of its tokens; to be called when all are added.
    pub(crate) fn complete(&mut self, text: impl FnOnce() -> Arc<str>, tokens: &mut Tokens) {
        if !self.shapes.is_empty() {
            self.text = text();
            self.tokens = TokenPlaces::of(tokens);
        }
        self.names.shrink_to_fit();
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// One with its tree.
    pub fn whole(&self, at: usize) -> Arc<Declaration> {
        match self.entries[at] {
            DeclarationSource::Whole(at) => Arc::clone(&self.wholes[at as usize]),
            DeclarationSource::Shared { shape, token, name } => {
                let mut last = self.last.0.lock().unwrap_or_else(PoisonError::into_inner);
                if let Some((_, _, whole)) = last.as_ref().filter(|last| last.0 == at) {
                    return Arc::clone(whole);
                }
                let place = shape;
                let shape = &self.shapes[shape as usize];
                let own = &self.names[name as usize..name as usize + shape.names.len()];
                let places = Places::Kept(&self.tokens);
                let mut filler = Filler { source: &self.text, places, base: token as usize, names: NameSource::Listed(own.iter()) };
                let doc = self.docs.get(&(at as u32)).cloned();
                if let Some((of, _, whole)) = last.as_mut().filter(|last| last.1 == place)
                    && let Some(used) = Arc::get_mut(whole)
                {
                    filler.fill_again(shape, used, doc);
                    *of = at;
                    return Arc::clone(whole);
                }
                let whole = Arc::new(filler.fill(shape, doc));
                *last = Some((at, place, Arc::clone(&whole)));
                whole
            }
        }
    }

    /// The same; `None` where there are not so many.
    pub fn get(&self, at: usize) -> Option<Arc<Declaration>> {
        (at < self.len()).then(|| self.whole(at))
    }

    /// All with their trees, in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = Arc<Declaration>> + DoubleEndedIterator + '_ {
        (0..self.len()).map(|at| self.whole(at))
    }

    /// Which keyword one starts with.
    pub fn keyword(&self, at: usize) -> Keyword {
        match self.entries[at] {
            DeclarationSource::Whole(at) => self.wholes[at as usize].keyword,
            DeclarationSource::Shared { shape, .. } => self.shapes[shape as usize].declaration.keyword,
        }
    }

    /// The keywords of all, in order.
    pub fn keywords(&self) -> impl ExactSizeIterator<Item = Keyword> + DoubleEndedIterator + '_ {
        (0..self.len()).map(|at| self.keyword(at))
    }

    /// The places of those with a keyword, in order.
    pub fn with_keyword(&self, keyword: Keyword) -> impl Iterator<Item = usize> + '_ {
        (0..self.len()).filter(move |at| self.keyword(*at) == keyword)
    }

    /// Bytes of the tokens from one to another, counted from the first token of a declaration.
    fn stretch(&self, token: u32, tokens: Span) -> Span {
        self.tokens.stretch((token + tokens.start) as usize, (token + tokens.end) as usize).unwrap_or_default()
    }

    /// From its keyword to its last token.
    pub fn span(&self, at: usize) -> Span {
        match self.entries[at] {
            DeclarationSource::Whole(at) => self.wholes[at as usize].span,
            DeclarationSource::Shared { shape, token, .. } => self.stretch(token, self.shapes[shape as usize].declaration.span),
        }
    }

    /// Where its keyword stands.
    pub fn keyword_span(&self, at: usize) -> Span {
        match self.entries[at] {
            DeclarationSource::Whole(at) => self.wholes[at as usize].keyword_span,
            DeclarationSource::Shared { shape, token, .. } => self.stretch(token, self.shapes[shape as usize].declaration.keyword_span),
        }
    }

    /// The name that it binds.
    pub fn bound(&self, at: usize) -> Option<Bound> {
        match self.entries[at] {
            DeclarationSource::Whole(at) => bound(&self.wholes[at as usize]),
            DeclarationSource::Shared { shape, token, name } => {
                let shape = &self.shapes[shape as usize];
                let span = self.stretch(token, bound(&shape.declaration)?.span);
                Some(Bound { name: self.names[(name + shape.bound?) as usize], span })
            }
        }
    }

    /// How many lists its family runs over.
    pub fn family_size(&self, at: usize) -> usize {
        let kind = match self.entries[at] {
            DeclarationSource::Whole(at) => &self.wholes[at as usize].kind,
            DeclarationSource::Shared { shape, .. } => &self.shapes[shape as usize].declaration.kind,
        };
        match kind {
            DeclarationKind::Value { family, .. } | DeclarationKind::Collection { family, .. } => family.len(),
            _ => 0,
        }
    }

    /// The first of the names that it uses as values or calls, from the `from`-th place on, for which `wanted` gives something,
    /// with that and the place behind it.
    pub fn find_use<T>(&self, at: usize, from: usize, mut wanted: impl FnMut(Name) -> Option<T>) -> Option<(usize, T)> {
        match self.entries[at] {
            DeclarationSource::Whole(at) => {
                let nodes = &self.wholes[at as usize].nodes;
                (from..nodes.len()).find_map(|k| match &nodes[k].expr {
                    Expr::Name(name) | Expr::Call { name, .. } => wanted(*name).map(|found| (k + 1, found)),
                    _ => None,
                })
            }
            DeclarationSource::Shared { shape, name, .. } => {
                let uses = &self.shapes[shape as usize].uses;
                (from..uses.len()).find_map(|k| wanted(self.names[(name + uses[k]) as usize]).map(|found| (k + 1, found)))
            }
        }
    }
}
