//! Interned names, compared in normal form C.

crate::ids! {
    /// A name; equal names have equal ids.
    Name,
}

/// All names of a run.
#[derive(Clone, Debug, Default)]
pub struct Names {
    texts: Vec<Box<str>>,
    index: std::collections::BTreeMap<Box<str>, Name>,
}

impl Names {
    /// The id of a name, new or known; the text is brought to normal form C.
    pub fn intern(&mut self, text: &str) -> Name {
        use unicode_normalization::{UnicodeNormalization, is_nfc};
        let text: Box<str> = if text.is_ascii() || is_nfc(text) { text.into() } else { text.nfc().collect::<String>().into() };
        if let Some(&name) = self.index.get(&text) {
            return name;
        }
        let name = Name::at(self.texts.len());
        self.texts.push(text.clone());
        self.index.insert(text, name);
        name
    }

    /// The id of a name that is known already.
    pub fn find(&self, text: &str) -> Option<Name> {
        self.index.get(text).copied()
    }

    /// Text of a name.
    pub fn text(&self, name: Name) -> &str {
        &self.texts[name.index()]
    }
}
