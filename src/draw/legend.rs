//! The legend: the scale of values, and signs with what they mean.

use glam::DVec2;

use super::annotate::{Layout, number};
use super::camera::Rect;
use super::color::{self, Rgb};
use super::font;
use super::page::Item;
use super::scene::{Kind, Paint, Scale, Scene};

/// Keys of faces that a legend lists.
const KEYS: usize = 12;
/// Numbers along a scale.
const TICKS: usize = 5;

/// A sign and its words in the legend.
enum Key {
    Line(Kind),
    Face(Rgb),
    More,
}

fn keys(scene: &Scene) -> Vec<(Key, String)> {
    let mut keys: Vec<(Key, String)> = Vec::new();
    if scene.sheets.iter().any(|s| matches!(s.paint, Paint::Sides(..))) {
        keys.push((Key::Face(color::FRONT), "normal side".to_owned()));
        keys.push((Key::Face(color::BACK), "other side".to_owned()));
    }
    keys.extend(scene.keys.iter().take(KEYS).map(|(color, words)| (Key::Face(*color), words.clone())));
    if scene.keys.len() > KEYS {
        keys.push((Key::More, format!("and {} more", scene.keys.len() - KEYS)));
    }
    let drawn = |kind: &Kind| kind.is_explained() && scene.lines.iter().any(|l| l.kind == *kind);
    keys.extend(Kind::ALL.into_iter().filter(drawn).map(|kind| (Key::Line(kind), kind.words().to_owned())));
    keys
}

/// The width that a legend takes, with its margin; `size` is that of its words. 0 where there is nothing to explain.
pub fn width(scene: &Scene, size: f64) -> f64 {
    let widest = |words: &mut dyn Iterator<Item = String>| words.map(|w| font::width(&w, size)).fold(0.0, f64::max);
    let of_keys = widest(&mut keys(scene).into_iter().map(|k| k.1));
    let of_scale = scene.scale.as_ref().map_or(0.0, |scale| widest(&mut ticks(scale).into_iter().map(|t| t.1).chain([title(scale)])));
    let room: f64 = of_keys.max(of_scale);
    if room > 0.0 { room + 2.4 * size } else { 0.0 }
}

fn title(scale: &Scale) -> String {
    if scale.unit.is_empty() { scale.title.clone() } else { format!("{} [{}]", scale.title, scale.unit) }
}

/// Shares of a scale and the numbers there.
fn ticks(scale: &Scale) -> Vec<(f64, String)> {
    let step = (scale.high - scale.low) / (TICKS - 1) as f64;
    let at = |k: usize| k as f64 / (TICKS - 1) as f64;
    (0..TICKS).map(|k| (at(k), number(scale.low + step * k as f64, step))).collect()
}

/// Right of the model: the scale of values, then signs and words.
pub fn items(scene: &Scene, layout: &Layout) -> Vec<Item> {
    let (size, mut items) = (layout.size, Vec::new());
    let left = layout.page.max.x - layout.margin - width(scene, size) + 0.4 * size;
    let mut y = layout.frame.min.y;
    if !scene.focus.is_empty() && layout.frame.max.x < layout.page.max.x - 3.0 * layout.margin {
        // The model goes on under the legend.
        let rows = keys(scene).len() as f64 * 1.5 * size;
        let bar = if scene.scale.is_some() { (0.42 * layout.page.size().y).min(16.0 * size) + 3.4 * size } else { 0.0 };
        let low = DVec2::new(left - 0.6 * size, y - 1.1 * size);
        items.push(Item::rect(
            &Rect::new(low, DVec2::new(layout.page.max.x - 0.4 * layout.margin, y + rows + bar - 0.4 * size)),
            color::WHITE,
            0.85,
        ));
    }
    if let Some(scale) = &scene.scale {
        items.push(layout.text(DVec2::new(left, y + 0.2 * size), &title(scale), color::INK));
        y += 1.2 * size;
        let height = (0.42 * layout.page.size().y).min(16.0 * size);
        let steps = (height.ceil() as usize).clamp(2, 128);
        for k in 0..steps {
            let share = |k: usize| y + height * k as f64 / steps as f64;
            let color = scale.ramp.at(1.0 - (k as f64 + 0.5) / steps as f64);
            // Each reaches under the next one, so that no paper shows between them.
            let low = if k + 1 < steps { share(k + 2) } else { share(k + 1) };
            items.push(Item::rect(&Rect::new(DVec2::new(left, share(k)), DVec2::new(left + 1.1 * size, low)), color, 1.0));
        }
        for (share, words) in ticks(scale) {
            let at = y + height * (1.0 - share);
            let tick = [DVec2::new(left + 1.1 * size, at), DVec2::new(left + 1.4 * size, at)];
            items.push(Item::Stroke { points: tick.to_vec(), width: 0.08 * size, color: color::INK });
            items.push(layout.text(DVec2::new(left + 1.6 * size, at + 0.35 * size), &words, color::INK));
        }
        y += height + 2.2 * size;
    }
    for (key, words) in keys(scene) {
        let middle = y - 0.15 * size;
        match key {
            Key::Line(kind) => {
                let points = vec![DVec2::new(left, middle), DVec2::new(left + 1.3 * size, middle)];
                items.push(Item::Stroke { points, width: kind.width() * layout.line, color: kind.color() });
            }
            Key::Face(color) => {
                let low = DVec2::new(left + 0.1 * size, middle - 0.5 * size);
                items.push(Item::rect(&Rect::new(low, low + DVec2::splat(size)), color, 1.0));
            }
            Key::More => {}
        }
        items.push(layout.text(DVec2::new(left + 1.8 * size, middle + 0.35 * size), &words, color::INK));
        y += 1.5 * size;
    }
    items
}
