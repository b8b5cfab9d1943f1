//! Keys of declarations: their own tokens, the keys of what they name, and the bytes of the files they load.

use std::collections::{BTreeMap, BTreeSet};

use crate::base::digest::{Digest, StableHasher};
use crate::base::limits;
use crate::lang::diag::diagnostic::FileId;
use crate::lang::eval::context::Cx;
use crate::lang::eval::memory::Keys;
use crate::lang::eval::module::Given;
use crate::lang::syntax;
use crate::lang::syntax::ast::{Declaration, DeclarationKind, Expr, ExprId, Keyword, TextPart};
use crate::lang::syntax::declarations::Declarations;
use crate::lang::values::origins::Home;
use crate::lang::values::value::{ModuleId, Value};
use crate::lang::words::names::Name;

/// What the stages of a script are made from.
const WORLD: &[Keyword] =
    &[Keyword::Point, Keyword::Curve, Keyword::ModelingCurve, Keyword::Surface, Keyword::Shell, Keyword::Group, Keyword::Mesh];
/// Scripts that load each other, deep.
const LOADS: usize = 64;

/// What a name of an expression leads to.
enum Lead {
    Declaration(u32),
    Broken,
    Free,
}

/// The tokens of each declaration as a digest; comments, blanks and places do not matter.
pub(crate) fn token_keys(text: &str, declarations: &Declarations) -> Vec<Digest> {
    let tokens = syntax::token_spans(text);
    let key = |at: usize| {
        let span = declarations.span(at);
        let first = tokens.partition_point(|t| t.start < span.start);
        let own = tokens[first..].iter().take_while(|t| t.end <= span.end);
        own.fold(StableHasher::new("tokens"), |digester, t| digester.text(&text[t.start as usize..t.end as usize])).finish()
    };
    (0..declarations.len()).map(key).collect()
}

impl Cx<'_> {
    /// Gives each declaration of a new script its home: the one it had in the run before.
    pub(crate) fn settle_in(&mut self, module: ModuleId, label: &str) {
        let script = self.machine.at(module).script.clone();
        let Some(mut memory) = self.memory.take() else {
            let homes: Vec<Home> = script.declarations.keywords().map(|_| self.program.origins.new_home()).collect();
            return self.program.origins.enter(module, homes);
        };
        memory.enter(module, label);
        let file = self.machine.at(module).file;
        let text = self.program.sources.get(file).map_or("", |s| &s.text);
        let tokens = token_keys(text, &script.declarations);
        let mut nameless: BTreeMap<Digest, u64> = BTreeMap::new();
        let homes = tokens.iter().enumerate().map(|(at, tokens)| {
            let identity = StableHasher::new("home").text(label);
            let identity = match script.declarations.bound(at) {
                Some(b) => identity.text(self.program.names.text(b.name)),
                None => {
                    let nth = nameless.entry(*tokens).or_default();
                    *nth += 1;
                    identity.digest(*tokens).number(*nth)
                }
            };
            memory.home(identity.finish(), &mut self.program.origins)
        });
        let mut homes: Vec<Home> = homes.collect();
        // Of two declarations of one name the second failed; it must not pass for the first.
        let mut taken: Vec<Home> = homes.clone();
        taken.sort_unstable();
        if taken.windows(2).any(|w| w[0] == w[1]) {
            let mut seen = BTreeSet::new();
            homes.iter_mut().for_each(|home| {
                if !seen.insert(*home) {
                    *home = self.program.origins.new_home();
                }
            });
        }
        self.program.origins.enter(module, homes);
        self.machine.at_mut(module).tokens = tokens;
        self.memory = Some(memory);
    }

    /// The keys of a script.
    pub(crate) fn keys(&mut self, module: ModuleId) -> Keys {
        if let Some(keys) = &self.machine.at(module).keys {
            return keys.clone();
        }
        let n = self.machine.at(module).script.declarations.len();
        let own: Vec<Option<Digest>> = (0..n as u32).map(|i| self.own_key(module, i)).collect();
        let keys = self.joined_keys(module, &own, &vec![false; n]);
        self.machine.at_mut(module).keys = Some(keys.clone());
        keys
    }

    /// Keys of declarations from what each one is by itself and the keys of what it names; of `fixed` ones what they
    /// are by themselves is the key.
    pub(crate) fn joined_keys(&self, module: ModuleId, own: &[Option<Digest>], fixed: &[bool]) -> Keys {
        let script = self.machine.at(module).script.clone();
        let n = script.declarations.len();
        let names = |i: usize| if fixed[i] { Vec::new() } else { self.leads(module, &script.declarations.whole(i)) };
        let leads: Vec<Vec<Lead>> = (0..n).map(names).collect();
        let mut of: Vec<Option<Digest>> = vec![None; n];
        // 0: not met yet, 1: below on the stack, 2: done.
        let mut met = vec![0u8; n];
        let mut stack: Vec<(usize, usize)> = Vec::new();
        for root in 0..n {
            stack.push((root, 0));
            while let Some((at, from)) = stack.pop() {
                if met[at] == 2 {
                    continue;
                }
                met[at] = 1;
                let next = leads[at][from..].iter().enumerate().find_map(|(k, lead)| match lead {
                    Lead::Declaration(d) if met[*d as usize] == 0 => Some((from + k + 1, *d as usize)),
                    _ => None,
                });
                if let Some((resume, below)) = next {
                    stack.push((at, resume));
                    stack.push((below, 0));
                    continue;
                }
                of[at] = match fixed[at] {
                    true => own[at],
                    false => own[at].and_then(|own| joined(own, &leads[at], &of, &met)).map(|key| self.with_text(module, at, key)),
                };
                met[at] = 2;
            }
        }
        let world = script.declarations.keywords().zip(&of).filter(|(keyword, _)| WORLD.contains(keyword));
        let start = Some(StableHasher::new("world").number(script.broken.len() as u64));
        let world = world.fold(start, |all, (_, key)| Some(all?.digest((*key)?))).map(|d| d.finish());
        Keys { of: of.into(), world }
    }

    /// The digest of a declaration's text.
    pub(crate) fn text_key(&self, module: ModuleId, index: u32) -> Digest {
        let m = self.machine.at(module);
        StableHasher::new("text").text(self.program.sources.text(m.file, m.script.declarations.span(index as usize))).finish()
    }

    /// The key, or one with the text in it where what is kept under the key depends on another text.
    fn with_text(&self, module: ModuleId, at: usize, key: Digest) -> Digest {
        match self.memory.as_ref().and_then(|memory| memory.text_of(key)) {
            Some(text) => match self.text_key(module, at as u32) {
                now if now == text => key,
                now => StableHasher::new("spoken").digest(key).digest(now).finish(),
            },
            None => key,
        }
    }

    /// What a declaration says by itself, and what is given to it from outside.
    fn own_key(&mut self, module: ModuleId, index: u32) -> Option<Digest> {
        let m = self.machine.at(module);
        let script = m.script.clone();
        let declaration = script.declarations.whole(index as usize);
        let own = StableHasher::new(env!("CARGO_PKG_VERSION")).text(self.program.unit.name).text(m.unit.name).text(&m.label);
        let own = own.digest(*m.tokens.get(index as usize)?);
        Some(match &declaration.kind {
            DeclarationKind::Param { bound, .. } => match m.given.iter().rev().find(|g| g.0 == bound.name) {
                Some((_, Given::Text(text, _))) => own.text("given").text(text),
                Some((_, Given::Value(value, ..))) => own.digest(plain_key(value)?),
                None => own,
            },
            DeclarationKind::Load { path, .. } => {
                let from = m.path.clone();
                let is_script = declaration.keyword == Keyword::Use;
                own.digest(self.file_key(&from, literal(&declaration, *path)?, is_script, 0)?)
            }
            _ => own,
        })
        .map(|digester| digester.finish())
    }

    /// The bytes of a file and, of a script, of all that it loads.
    fn file_key(&mut self, from: &str, path: &str, is_script: bool, depth: usize) -> Option<Digest> {
        let resolved = self.files.resolve(from, path).ok()?;
        let bytes = self.files.read(&resolved, if is_script { limits::SOURCE_BYTES } else { limits::DATA_BYTES }).ok()?;
        let digester = StableHasher::new("file").text(path).bytes(&bytes);
        if !is_script {
            return Some(digester.finish());
        }
        if depth > LOADS {
            return None;
        }
        let text = String::from_utf8(bytes).ok()?;
        let (script, _) = syntax::parse(&text, FileId(u32::MAX), &mut self.program.names);
        script
            .declarations
            .iter()
            .try_fold(digester, |digester, declaration| match &declaration.kind {
                DeclarationKind::Load { path, .. } => {
                    let is_script = declaration.keyword == Keyword::Use;
                    Some(digester.digest(self.file_key(&resolved, literal(&declaration, *path)?, is_script, depth + 1)?))
                }
                _ => Some(digester),
            })
            .map(|digester| digester.finish())
    }

    /// The declarations of its own script that a declaration names.
    pub(crate) fn needs(&self, module: ModuleId, declaration: &Declaration) -> Vec<usize> {
        let leads = self.leads(module, declaration).into_iter();
        leads.filter_map(|lead| if let Lead::Declaration(d) = lead { Some(d as usize) } else { None }).collect()
    }

    /// What the names of a declaration lead to, in order, each once.
    fn leads(&self, module: ModuleId, declaration: &Declaration) -> Vec<Lead> {
        let m = self.machine.at(module);
        let (mut names, mut seen) = (Vec::new(), BTreeSet::new());
        for node in &declaration.nodes {
            let found = match &node.expr {
                Expr::Name(name) => (*name, true),
                Expr::Call { name, .. } | Expr::Field { name, .. } => (*name, false),
                _ => continue,
            };
            if seen.insert(found) {
                names.push(found);
            }
        }
        let lead = |(name, any): (Name, bool)| match m.find(name) {
            // What is called is a function, whatever else has its name.
            Some(found) if any || m.script.declarations.keyword(found as usize) == Keyword::Fn => Lead::Declaration(found),
            None if m.is_broken(name) => Lead::Broken,
            _ => Lead::Free,
        };
        names.into_iter().map(lead).collect()
    }
}

/// A key together with the keys of what it leads to; `None` in a cycle and above one.
fn joined(own: Digest, leads: &[Lead], of: &[Option<Digest>], met: &[u8]) -> Option<Digest> {
    let start = StableHasher::new("joined").digest(own);
    let all = leads.iter().try_fold(start, |digester, lead| match lead {
        Lead::Declaration(d) if met[*d as usize] == 2 => Some(digester.digest(of[*d as usize]?)),
        Lead::Declaration(_) => None,
        Lead::Broken => Some(digester.number(1)),
        Lead::Free => Some(digester.number(0)),
    });
    all.map(|digester| digester.finish())
}

/// A path without interpolation.
fn literal(declaration: &Declaration, path: ExprId) -> Option<&str> {
    match &declaration.nodes.get(path.index())?.expr {
        Expr::Text(parts) => match parts.as_slice() {
            [TextPart::Literal(text)] => Some(text),
            _ => None,
        },
        _ => None,
    }
}

/// The digest of a value without geometry.
fn plain_key(value: &Value) -> Option<Digest> {
    let digester = StableHasher::new("value");
    Some(match value {
        Value::Number(q) => {
            let dim = [q.dim.length, q.dim.angle, q.dim.mass].map(|e| e as u8);
            digester.real(q.value).bytes(&dim).number(u64::from(q.percent))
        }
        Value::Bool(b) => digester.number(u64::from(*b)),
        Value::Text(text) => digester.text("text").text(text),
        Value::Word(text) => digester.text("word").text(text),
        _ => return None,
    })
    .map(|digester| digester.finish())
}
