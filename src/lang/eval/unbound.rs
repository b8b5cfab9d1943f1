//! Names that nothing binds: words, or mistakes of one kind or another.

use crate::lang::diag::span::Span;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::machine::Code;
use crate::lang::eval::misspelt::{Among, Unknown};
use crate::lang::eval::std;
use crate::lang::syntax::ast::{Arg, Expr, ExprId, Keyword};
use crate::lang::syntax::foreign::statements::{PRINTS, range};
use crate::lang::values::value::{ModuleId, Value};
use crate::lang::words::elsewhere::instead;
use crate::lang::words::names::Name;

impl Cx<'_> {
    /// A name that nothing binds: a word, `pi`, `network`, or a mistake.
    #[cold]
    pub(crate) fn unbound(&mut self, code: Code<'_>, id: ExprId, name: Name) -> Result<Value, Halt> {
        if self.machine.at(code.module).is_broken(name) {
            return Err(Halt::Broken);
        }
        match self.program.names.text(name) {
            "pi" => return Ok(Value::number(::std::f64::consts::PI)),
            "network" => return Ok(Value::Network(code.module)),
            word if is_word(word) => return Ok(Value::Word(word.into())),
            _ => {}
        }
        if self.is_param_word(code.module, name) {
            return Ok(Value::Word(self.program.names.text(name).into()));
        }
        let text = self.program.names.text(name).to_owned();
        let span = code.span(id);
        let is_function = std::builtins().any(|b| b.name == text);
        if is_function {
            let draft = self.error(code, "E201", format!("`{text}` is not defined"), span, "a function, not a value");
            return Err(draft.help(format!("call it: `{text}(…)`")).stop());
        }
        let locals = self.machine.locals[self.machine.base..].iter().map(|l| l.0).collect();
        self.note_unknown(code.module, span, Unknown { name, of: code.module, among: Among::Values(locals) });
        Err(self.error(code, "E201", format!("`{text}` is not defined"), span, "no such name").stop())
    }

    /// E201: a function that is none.
    #[cold]
    pub(crate) fn no_function(&mut self, code: Code<'_>, id: ExprId, name: Name, span: Span) -> Halt {
        let text = self.program.names.text(name).to_owned();
        if self.machine.at(code.module).is_broken(name) {
            return Halt::Broken;
        }
        if let Some(declaration) = self.machine.at(code.module).find(name) {
            let word = match self.machine.at(code.module).script.declarations.keyword(declaration as usize) {
                Keyword::Let => "value",
                keyword => keyword_word(keyword),
            };
            let message = format!("`{text}` is a {word}, not a function");
            let typed = self.not_called(code, id, &text);
            let draft = self.error(code, "E201", message, span, "cannot be called");
            return if typed.is_empty() { draft.stop() } else { draft.ways(code.span(id), &typed).stop() };
        }
        let is_word = || std::builtins().chain(std::fields()).any(|b| b.name == text);
        if PRINTS.contains(&text.as_str()) && !is_word() {
            let draft = self.error(code, "E201", format!("there is no function `{text}`"), span, "no such function");
            return draft.help("`report` puts a value into the report; in a session an expression is shown by typing it").stop();
        }
        let args = if let Expr::Call { args, of: None, .. } = code.expr(id) { args.as_slice() } else { &[] };
        let sources: Vec<String> = args.iter().map(|a: &Arg| self.source(code, a.value)).collect();
        let typed = match (text.as_str(), sources.as_slice()) {
            ("range", items) => range(&items.iter().map(String::as_str).collect::<Vec<_>>()),
            ("pow", [a, b]) => {
                let part = |text: &str| {
                    if text.bytes().all(|b| b.is_ascii_alphanumeric() || matches!(b, b'_' | b'.')) {
                        text.to_owned()
                    } else {
                        format!("({text})")
                    }
                };
                Some(format!("{} ^ {}", part(a), part(b)))
            }
            _ => None,
        };
        if let Some(typed) = typed {
            let draft = self.error(code, "E201", format!("there is no function `{text}`"), span, "no such function");
            return draft.ways(code.span(id), &[typed]).stop();
        }
        if let Some((place, typed)) = self.typed_shape(code, id).filter(|_| !is_word()) {
            let draft = self.error(code, "E201", format!("there is no function `{text}`"), span, "no such function");
            let help = if typed.contains('\n') { format!("it is made of these:\n{typed}") } else { format!("`{typed}`") };
            return draft.help(help).put(place, typed).stop();
        }
        if let Some(other) = instead(&text).filter(|_| !is_word()) {
            let draft = self.error(code, "E201", format!("there is no function `{text}`"), span, "no such function");
            return draft.help(format!("for example `{other}`")).stop();
        }
        self.note_unknown(code.module, span, Unknown { name, of: code.module, among: Among::Functions });
        self.error(code, "E201", format!("there is no function `{text}`"), span, "no such function").stop()
    }

    /// What may have been meant by calling a thing: its settings in braces, or a member of it.
    fn not_called(&self, code: Code<'_>, id: ExprId, text: &str) -> Vec<String> {
        let Expr::Call { args, .. } = code.expr(id) else { return Vec::new() };
        let keyword = self.machine.at(code.module).script.declarations.keyword(code.declaration as usize);
        let takes = matches!(keyword, Keyword::Mesh | Keyword::Shell | Keyword::Export | Keyword::Picture);
        let setting = |a: &Arg| a.name.map(|(name, _)| format!("{}: {}", self.program.names.text(name), self.source(code, a.value)));
        let settings: Vec<String> = args.iter().filter_map(setting).collect();
        match args.as_slice() {
            [one] if one.name.is_none() => vec![format!("{text}[{}]", self.source(code, one.value))],
            some if takes && settings.len() == some.len() => vec![format!("{text} {{ {} }}", settings.join("  "))],
            _ => Vec::new(),
        }
    }

    /// Whether some param of the script lists this name among its choices.
    fn is_param_word(&self, module: ModuleId, name: Name) -> bool {
        self.machine.at(module).is_choice(name)
    }
}

/// Whether a bare name is a word of some choice of the language.
fn is_word(name: &str) -> bool {
    let mut choices = std::builtins().flat_map(|b| b.params.iter().filter_map(|p| p.ty.choices()));
    choices.any(|words| words.contains(&name)) || crate::lang::values::settings::words().any(|word| word == name)
}

/// A keyword as messages say it.
pub(crate) fn keyword_word(keyword: Keyword) -> &'static str {
    if keyword == Keyword::Use { "module" } else { crate::lang::syntax::keywords::written(keyword) }
}
