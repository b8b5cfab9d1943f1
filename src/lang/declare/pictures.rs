//! `picture things to "…" { … }`: resolved to plain data for the session.

use std::sync::Arc;

use glam::DVec3;

use crate::base::limits;
use crate::base::origin::Origin;
use crate::draw::View;
use crate::lang::declare::setting_values::{Resolved, find};
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::machine::{Code, Gather};
use crate::lang::syntax::ast;
use crate::lang::syntax::ast::{ExprId, Keyword};
use crate::lang::values::plans::{PICTURE_SIZE, PictureSpec, Show};
use crate::lang::values::settings;
use crate::lang::values::value::Value;

/// Most views on one sheet.
const MOST_VIEWS: usize = 16;

fn flag(settings: &[Resolved], key: &str) -> Option<bool> {
    match find(settings, key)?.value {
        Value::Bool(b) => Some(b),
        _ => None,
    }
}

fn pixels(settings: &[Resolved], key: &str, default: u32) -> u32 {
    match find(settings, key).map(|r| &r.value) {
        Some(Value::Number(q)) => q.value as u32,
        _ => default,
    }
}

fn vector(settings: &[Resolved], key: &str) -> Option<(DVec3, Origin)> {
    let found = find(settings, key)?;
    match found.value {
        Value::Vector(v, _) => Some((v, found.origin)),
        _ => None,
    }
}

impl Cx<'_> {
    pub(crate) fn picture(
        &mut self,
        code: Code<'_>,
        member: [u32; 2],
        things: &[ExprId],
        to: Option<ExprId>,
        settings: &[ast::SettingEntry],
    ) -> Result<PictureSpec, Halt> {
        let mut gather = Gather::default();
        let named: Vec<String> = things.iter().map(|t| self.source(code, *t).split_whitespace().collect::<Vec<_>>().join(" ")).collect();
        let drawn = gather.take(self.things(code, things, Keyword::Picture));
        let path = gather.take(self.path(code, to));
        let resolved = gather.take(self.settings(code, "picture", settings::PICTURE, settings));
        let zoom = settings.iter().find(|s| self.program.names.text(s.key) == "zoom").map(|s| s.value);
        let zoom = zoom.map(|id| self.things(code, &[id], Keyword::Picture)).and_then(|found| gather.take(found));
        gather.done()?;
        let resolved = resolved.unwrap_or_default();
        let view = self.view(code, settings, &resolved)?;
        let views = self.views(code, settings, &resolved)?;
        let size = (pixels(&resolved, "width", PICTURE_SIZE.0), pixels(&resolved, "height", PICTURE_SIZE.1));
        self.page(code, settings, size)?;
        let word = |key: &str| match find(&resolved, key) {
            Some(Resolved { value: Value::Word(w), origin, .. }) => Some((w.clone(), *origin)),
            _ => None,
        };
        let title = match find(&resolved, "title").map(|r| &r.value) {
            Some(Value::Text(text)) => Some(Arc::clone(text)),
            _ => None,
        };
        let is = |key: &str| flag(&resolved, key);
        let show = Show {
            elements: is("elements"),
            borders: is("borders"),
            network: is("network"),
            labels: is("labels"),
            axes: is("axes"),
            ruler: is("ruler"),
            legend: is("legend"),
            combs: is("combs"),
        };
        let (path, path_origin) = path.unwrap_or_default();
        let shade = word("shade");
        let origin = self.own_origin(code, member);
        let things = drawn.unwrap_or_default();
        Ok(PictureSpec {
            things,
            named: named.join(", "),
            path,
            path_origin,
            view,
            views,
            size,
            shade,
            zoom: zoom.unwrap_or_default(),
            title,
            show,
            origin,
        })
    }

    /// Where the eye is; E306 for a direction without length or an up along it.
    fn view(&mut self, code: Code<'_>, settings: &[ast::SettingEntry], resolved: &[Resolved]) -> Result<View, Halt> {
        let place = |cx: &Self, key: &str| settings.iter().find(|s| cx.program.names.text(s.key) == key).map(|s| s.value);
        let mut view = match find(resolved, "view").map(|r| &r.value) {
            Some(Value::Word(word)) => View::named(word),
            Some(Value::Vector(eye, _)) => Some(View { eye: *eye, up: None, perspective: false }),
            _ => View::named("isometric"),
        }
        .ok_or(Halt::Bug("a view that is none"))?;
        let up = vector(resolved, "up").map(|found| found.0);
        view.up = up.or(view.up);
        view.perspective = flag(resolved, "perspective").unwrap_or(false);
        for (key, direction) in [("view", Some(view.eye)), ("up", up)] {
            if let (Some(id), Some(direction)) = (place(self, key), direction)
                && direction.try_normalize().is_none()
            {
                return Err(self
                    .error(code, "E306", format!("`{key}` is a direction, got one without length"), code.span(id), "no length")
                    .stop());
            }
        }
        if let (Some(id), true) = (place(self, "up"), view.up_is_lost()) {
            let text = "`up` is parallel to the line of sight";
            return Err(self.error(code, "E306", text, code.span(id), "the eye looks along this").help("a direction across it").stop());
        }
        Ok(view)
    }

    /// The views of `views:`; E305 beside `view` or `up`, E306 for none, too many, or a direction without length.
    fn views(&mut self, code: Code<'_>, settings: &[ast::SettingEntry], resolved: &[Resolved]) -> Result<Vec<(String, View)>, Halt> {
        let place = |cx: &Self, key: &str| settings.iter().find(|s| cx.program.names.text(s.key) == key).map(|s| s.value);
        let (Some(id), Some(found)) = (place(self, "views"), find(resolved, "views")) else { return Ok(Vec::new()) };
        if let Some((key, other)) = ["view", "up"].iter().find_map(|key| Some((*key, place(self, key)?))) {
            let text = format!("`views` or `{key}`, not both");
            return Err(self.error(code, "E305", text, code.span(other), "beside `views`").stop());
        }
        let perspective = flag(resolved, "perspective").unwrap_or(false);
        let mut out = Vec::new();
        for k in 0..found.value.len().unwrap_or(0) {
            let value = found.value.item(k).unwrap_or_default();
            let view = match &value {
                Value::Word(word) => View::named(word),
                Value::Vector(eye, _) => eye.try_normalize().map(|_| View { eye: *eye, up: None, perspective }),
                _ => None,
            };
            let Some(view) = view else {
                let text = "a view is a direction, got one without length";
                return Err(self.error(code, "E306", text, code.span(id), "no length").stop());
            };
            out.push((self.show(&value), View { perspective, ..view }));
        }
        if !(1..=MOST_VIEWS).contains(&out.len()) {
            let text = format!("a sheet has 1 to {MOST_VIEWS} views, got {}", out.len());
            return Err(self.error(code, "E306", text, code.span(id), format!("{} given", out.len())).stop());
        }
        Ok(out)
    }

    /// E306 for more pixels than a picture may have.
    fn page(&mut self, code: Code<'_>, settings: &[ast::SettingEntry], (width, height): (u32, u32)) -> Result<(), Halt> {
        let pixels = u64::from(width) * u64::from(height);
        let last = settings.iter().rfind(|s| matches!(self.program.names.text(s.key), "width" | "height")).map(|s| s.value);
        match last {
            Some(id) if pixels > limits::PICTURE_PIXELS => {
                let text = format!("a picture has at most {} pixels, got {width} × {height} = {pixels}", limits::PICTURE_PIXELS);
                Err(self.error(code, "E306", text, code.span(id), "too many together").stop())
            }
            _ => Ok(()),
        }
    }
}
