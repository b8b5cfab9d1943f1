//! The page with a model inside, which opens from the disk without any connection.

use std::collections::BTreeSet;
use std::io::{self, Write};

use flate2::Compression;

use super::compress::gzip;
use super::model::Frame;
use crate::draw::svg::base64;

/// Where the model goes in the page.
pub const MARKER: &str = "<!--MODEL-->";

/// Writes the page with the model in place of its marker.
///
/// Fails when the sink does, and with `InvalidData` when the page has no marker.
pub fn write(page: &str, frame: &Frame, out: &mut dyn Write) -> io::Result<()> {
    let missing = || io::Error::new(io::ErrorKind::InvalidData, format!("the page has no `{MARKER}`"));
    let (before, after) = page.split_once(MARKER).ok_or_else(missing)?;
    write!(out, "{before}<script type=\"application/json\" id=\"model\">{{\"frame\":{},\"buffers\":{{", escaped(&frame.json))?;
    let mut written = BTreeSet::new();
    for buffer in &frame.buffers {
        if !written.insert(&buffer.key) {
            continue;
        }
        let comma = if written.len() > 1 { "," } else { "" };
        write!(out, "{comma}{}:\"", escaped(&serde_json::Value::from(buffer.key.as_str()).to_string()))?;
        write!(out, "{}\"", base64(&gzip(&buffer.bytes, Compression::default())?))?;
    }
    write!(out, "}}}}</script>{after}")
}

/// JSON that does not end the element it stands in, nor begin a comment: `<` occurs only inside of texts, where it can be written by its
/// number.
fn escaped(json: &str) -> String {
    json.replace('<', "\\u003c")
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::super::model::Buffer;
    use super::*;

    #[test]
    fn the_model_stands_in_the_page_and_cannot_leave_its_element() {
        let buffer = |key: &str| Buffer { key: key.to_owned(), bytes: Arc::new(vec![7; 10_000]) };
        let frame = Frame { json: r#"{"title":"</script><!-- x"}"#.to_owned(), buffers: vec![buffer("ab"), buffer("cd"), buffer("ab")] };
        let mut out = Vec::new();
        write("<html><!--MODEL--><p></html>", &frame, &mut out).unwrap();
        let text = String::from_utf8(out).unwrap();
        let model = text.strip_prefix("<html><script type=\"application/json\" id=\"model\">").unwrap();
        let model = model.strip_suffix("</script><p></html>").unwrap();
        assert!(!model.contains('<'));
        let model: serde_json::Value = serde_json::from_str(model).unwrap();
        assert_eq!(model["frame"]["title"], "</script><!-- x");
        assert_eq!(model["buffers"].as_object().unwrap().len(), 2);
        assert!(model["buffers"]["cd"].as_str().unwrap().starts_with("H4sI"));
        assert!(write("<html>", &frame, &mut Vec::new()).is_err());
    }
}
