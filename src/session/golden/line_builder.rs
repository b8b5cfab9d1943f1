//! Lines that are put together word by word.

use super::line::Line;
use super::values::Value;

/// A line that is put together word by word.
pub struct LineBuilder(pub Line);

/// A line without words.
pub fn line(kind: &str, name: &str) -> LineBuilder {
    LineBuilder(Line { kind: kind.to_owned(), name: name.to_owned(), ..Line::default() })
}

impl LineBuilder {
    /// With this word.
    pub fn put(mut self, word: &'static str, value: Value) -> Self {
        self.0.pairs.push((word, value));
        self
    }
    /// With this number.
    pub fn count(self, word: &'static str, n: usize) -> Self {
        self.put(word, Value::Count(n as u64))
    }
    /// With this phrase.
    pub fn word(self, word: &'static str, text: &str) -> Self {
        self.put(word, Value::Word(text.to_owned()))
    }
    /// With this word where there is a value.
    pub fn maybe(self, word: &'static str, value: Option<Value>) -> Self {
        match value {
            Some(value) => self.put(word, value),
            None => self,
        }
    }
    /// With these words.
    pub fn all(mut self, pairs: Vec<(&'static str, Value)>) -> Self {
        self.0.pairs.extend(pairs);
        self
    }
    /// Without a name, if that is so: its name is how the script says it.
    pub fn unnamed(mut self, is: bool) -> Self {
        if is {
            let name = super::line::on_one_line(&self.0.name);
            self.0.name = if name.is_empty() { "…".to_owned() } else { name };
            self.0.unnamed = true;
        }
        self
    }
}

/// `yes` or `no`.
pub fn yes(is: bool) -> &'static str {
    if is { "yes" } else { "no" }
}
