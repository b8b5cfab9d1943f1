//! Pictures of drawings: a plot or a lines plan fills its page by itself, and settings of views say nothing of it.

use super::pictures::unsupported;
use crate::draw::{Drawing, Page, View};
use crate::lang::eval::halt::Halt;
use crate::lang::values::plans::PictureSpec;
use crate::lang::values::value::Value;

/// The drawing that a picture shows, and its page; `None` where things in space are shown.
///
/// Fails with E805 for a drawing beside other things, and for settings that say nothing of it.
pub(super) fn drawing<'s>(spec: &'s PictureSpec, model: &str) -> Result<Option<(&'s Drawing, Page)>, Halt> {
    let flat = |value: &'s Value| if let Value::Drawing(drawing) = value { Some(&**drawing) } else { None };
    let Some((drawing, of)) = spec.things.iter().find_map(|(value, origin)| Some((flat(value)?, *origin))) else {
        return match spec.zoom.iter().find(|(value, _)| flat(value).is_some()) {
            Some((_, of)) => Err(unsupported(*of, "a drawing is no place to zoom to", "zoom to things that are drawn")),
            None => Ok(None),
        };
    };
    if spec.things.len() > 1 {
        return Err(unsupported(of, &format!("{} fills a picture by itself", drawing.words()), "one picture for each drawing"));
    }
    if let Some(setting) = idle(spec) {
        let text = format!("`{setting}` says nothing of {}", drawing.words());
        return Err(unsupported(spec.origin, &text, "`width`, `height`, `title` and `legend` do"));
    }
    let name = if spec.named.is_empty() || spec.named.contains('(') { model.to_owned() } else { format!("{model}: {}", spec.named) };
    let page = Page {
        size: (spec.size.0 as usize, spec.size.1 as usize),
        title: spec.title.as_deref().map(str::to_owned),
        name,
        legend: spec.show.legend.unwrap_or(true),
    };
    Ok(Some((drawing, page)))
}

/// A setting that was said and means nothing to a drawing.
fn idle(spec: &PictureSpec) -> Option<&'static str> {
    let show = &spec.show;
    let said = [
        ("view", View::named("isometric").is_none_or(|usual| View { up: usual.up, perspective: false, ..spec.view } != usual)),
        ("views", !spec.views.is_empty()),
        ("up", View::named("isometric").is_none_or(|usual| spec.view.up != usual.up)),
        ("perspective", spec.view.perspective),
        ("zoom", !spec.zoom.is_empty()),
        ("shade", spec.shade.is_some()),
        ("elements", show.elements.is_some()),
        ("borders", show.borders.is_some()),
        ("network", show.network.is_some()),
        ("labels", show.labels.is_some()),
        ("axes", show.axes.is_some()),
        ("ruler", show.ruler.is_some()),
        ("combs", show.combs.is_some()),
    ];
    said.into_iter().find(|s| s.1).map(|s| s.0)
}
