//! `import "offsets.csv" (unit: m) as offsets`: data files as values.

use super::cx::{Cx, Stop};
use super::eval::Code;
use super::later;
use super::syntax::ast::{Arg, ExprId};
use super::value::Value;

impl Cx<'_> {
    pub(super) fn import(&mut self, code: Code<'_>, path: ExprId, args: &[Arg]) -> Result<Value, Stop> {
        let (written, origin) = self.path_text(code, path)?;
        let ending = written.rsplit_once('.').map_or(String::new(), |e| e.1.to_ascii_lowercase());
        if later::is_ending(&ending) {
            return Err(self.not_yet(code, &format!("reading .{ending} files"), code.span(path)));
        }
        let _ = (origin, args);
        Err(self.not_yet(code, "reading data", code.span(path)))
    }
}
