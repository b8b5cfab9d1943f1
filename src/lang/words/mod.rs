//! Words: interned names, letters that look alike, and what other tools call the words of this language.

pub mod elsewhere;
pub mod lookalikes;
pub mod names;
pub mod plural;
