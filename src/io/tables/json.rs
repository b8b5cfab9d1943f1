//! JSON data in and out, as a plain tree.

use std::cell::Cell;
use std::collections::BTreeSet;
use std::fmt;
use std::io::{self, Write};

use serde::de::{self, DeserializeSeed, Deserializer, MapAccess, SeqAccess, Visitor};

use crate::base::limits;
use crate::base::text::push_real;
use crate::io::files::fault::Malformed;
use crate::io::tables::text::decode;

/// A JSON value.
#[derive(Clone, Debug, PartialEq)]
pub enum Json {
    /// `null`.
    Null,
    /// `true` or `false`.
    Bool(bool),
    /// A finite number.
    Number(f64),
    /// A string.
    Text(String),
    /// An array.
    List(Vec<Json>),
    /// An object; keys in file order, each once.
    Record(Vec<(String, Json)>),
}

/// Reads one JSON value. Errors: syntax, a key given twice, a number beyond an `f64`, deeper than 128, too many values.
pub fn read(bytes: &[u8]) -> Result<Json, Malformed> {
    let text = decode(bytes)?;
    let values = Cell::new(0);
    let mut deserializer = serde_json::Deserializer::from_str(text);
    let json = JsonReader(&values).deserialize(&mut deserializer).and_then(|json| deserializer.end().map(|()| json));
    json.map_err(|e| {
        let message = e.to_string();
        let what = message.rsplit_once(" at line ").map_or(message.as_str(), |(what, _)| what);
        Malformed { line: e.line() as u64, column: Some(e.column() as u64).filter(|c| *c > 0), what: what.to_owned() }
    })
}

/// Makes a [`Json`] and counts the values of the whole file.
#[derive(Clone, Copy)]
struct JsonReader<'a>(&'a Cell<usize>);

impl<'de> DeserializeSeed<'de> for JsonReader<'_> {
    type Value = Json;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Json, D::Error> {
        self.0.set(self.0.get() + 1);
        if self.0.get() > limits::LIST_MEMBERS {
            return Err(de::Error::custom(format!("the file has more than {} values", limits::LIST_MEMBERS)));
        }
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for JsonReader<'_> {
    type Value = Json;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a JSON value")
    }

    fn visit_unit<E: de::Error>(self) -> Result<Json, E> {
        Ok(Json::Null)
    }

    fn visit_bool<E: de::Error>(self, value: bool) -> Result<Json, E> {
        Ok(Json::Bool(value))
    }

    fn visit_u64<E: de::Error>(self, value: u64) -> Result<Json, E> {
        Ok(Json::Number(value as f64))
    }

    fn visit_i64<E: de::Error>(self, value: i64) -> Result<Json, E> {
        Ok(Json::Number(value as f64))
    }

    fn visit_f64<E: de::Error>(self, value: f64) -> Result<Json, E> {
        if value.is_finite() { Ok(Json::Number(value)) } else { Err(E::custom("number out of range")) }
    }

    fn visit_str<E: de::Error>(self, value: &str) -> Result<Json, E> {
        Ok(Json::Text(value.to_owned()))
    }

    fn visit_string<E: de::Error>(self, value: String) -> Result<Json, E> {
        Ok(Json::Text(value))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut access: A) -> Result<Json, A::Error> {
        let mut list = Vec::new();
        while let Some(value) = access.next_element_seed(self)? {
            list.push(value);
        }
        Ok(Json::List(list))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut access: A) -> Result<Json, A::Error> {
        let mut record: Vec<(String, Json)> = Vec::new();
        let mut known = BTreeSet::new();
        while let Some(key) = access.next_key::<String>()? {
            if !known.insert(key.clone()) {
                return Err(de::Error::custom(format!("the key \"{key}\" is given twice")));
            }
            let value = access.next_value_seed(self)?;
            record.push((key, value));
        }
        Ok(Json::Record(record))
    }
}

/// Writes a tree: lists of records one record a line, everything below on that line.
pub fn write(json: &Json, out: &mut dyn Write) -> io::Result<()> {
    let mut text = Vec::new();
    if let Json::List(list) = json
        && !list.is_empty()
    {
        out.write_all(b"[\n")?;
        for (k, value) in list.iter().enumerate() {
            text.clear();
            text.extend_from_slice(b"  ");
            push(value, &mut text);
            text.extend_from_slice(if k + 1 < list.len() { b",\n" } else { b"\n" });
            out.write_all(&text)?;
        }
        return out.write_all(b"]\n");
    }
    push(json, &mut text);
    text.push(b'\n');
    out.write_all(&text)
}

fn push(json: &Json, text: &mut Vec<u8>) {
    match json {
        Json::Null => text.extend_from_slice(b"null"),
        Json::Bool(value) => text.extend_from_slice(if *value { b"true" } else { b"false" }),
        // JSON has no infinite numbers; a value without one is null.
        Json::Number(x) if x.is_finite() => push_real(text, *x),
        Json::Number(_) => text.extend_from_slice(b"null"),
        Json::Text(words) => push_string(words, text),
        Json::List(list) => {
            text.push(b'[');
            for (k, value) in list.iter().enumerate() {
                if k > 0 {
                    text.extend_from_slice(b", ");
                }
                push(value, text);
            }
            text.push(b']');
        }
        Json::Record(record) => {
            text.push(b'{');
            for (k, (key, value)) in record.iter().enumerate() {
                if k > 0 {
                    text.extend_from_slice(b", ");
                }
                push_string(key, text);
                text.extend_from_slice(b": ");
                push(value, text);
            }
            text.push(b'}');
        }
    }
}

fn push_string(words: &str, text: &mut Vec<u8>) {
    text.push(b'"');
    for c in words.chars() {
        match c {
            '"' => text.extend_from_slice(b"\\\""),
            '\\' => text.extend_from_slice(b"\\\\"),
            '\n' => text.extend_from_slice(b"\\n"),
            c if c.is_control() => text.extend_from_slice(format!("\\u{:04x}", c as u32).as_bytes()),
            c => text.extend_from_slice(c.encode_utf8(&mut [0; 4]).as_bytes()),
        }
    }
    text.push(b'"');
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_and_writes_a_tree() {
        let text = "[\n  {\"name\": \"a \\\"b\\\"\", \"x\": 0.1, \"deep\": [1, null, true, {}]},\n  2\n]\n";
        let json = read(text.as_bytes()).unwrap();
        let mut out = Vec::new();
        write(&json, &mut out).unwrap();
        assert_eq!(String::from_utf8(out).unwrap(), text);
    }

    #[test]
    fn mistakes_have_a_place() {
        let check = |text: &str, line: u64, what: &str| {
            let e = read(text.as_bytes()).unwrap_err();
            assert!(e.line == line && e.what.contains(what), "{e:?}");
        };
        check("{\"a\": 1,\n \"a\": 2}", 2, "\"a\" is given twice");
        check("[1, 1e999]", 1, "number out of range");
        check("[1, NaN]", 1, "expected");
        check("[1,\n2", 2, "EOF");
        check(&"[".repeat(100_000), 1, "recursion limit");
        check("", 1, "EOF");
        check("1 2", 1, "trailing");
    }
}
