//! A picture in few colours: those it has where they are few, else the means of boxes by median cut.

use std::collections::BTreeMap;

/// Red, green, blue.
pub type Rgb = [u8; 3];

/// At most `most` colours that stand for those of some pixels, and the place of each of their colours among them.
pub fn palette(pixels: &[Rgb], most: usize) -> (Vec<Rgb>, BTreeMap<Rgb, usize>) {
    let mut counts: BTreeMap<Rgb, u64> = BTreeMap::new();
    for pixel in pixels {
        *counts.entry(*pixel).or_default() += 1;
    }
    let mut boxes: Vec<Colors> = vec![Colors(counts.into_iter().collect())];
    while boxes.len() < most {
        let widest = (0..boxes.len()).max_by_key(|k| (boxes[*k].error(), usize::MAX - k));
        let Some((k, halves)) = widest.and_then(|k| Some((k, boxes[k].halves()?))) else { break };
        boxes[k] = halves.0;
        boxes.push(halves.1);
    }
    let means = boxes.iter().map(Colors::mean).collect();
    let of = boxes.iter().enumerate().flat_map(|(k, colors)| colors.0.iter().map(move |c| (c.0, k))).collect();
    (means, of)
}

/// Colours with their pixels.
struct Colors(Vec<(Rgb, u64)>);

impl Colors {
    fn pixels(&self) -> u64 {
        self.0.iter().map(|c| c.1).sum()
    }

    fn mean(&self) -> Rgb {
        let all = self.pixels().max(1);
        [0, 1, 2].map(|channel| ((self.0.iter().map(|c| u64::from(c.0[channel]) * c.1).sum::<u64>() + all / 2) / all) as u8)
    }

    /// Least and most of a channel.
    fn range(&self, channel: usize) -> (u8, u8) {
        let values = || self.0.iter().map(|c| c.0[channel]);
        (values().min().unwrap_or(0), values().max().unwrap_or(0))
    }

    /// The channel that spreads most, and by how much.
    fn spread(&self) -> (usize, u64) {
        let wide = |channel: usize| self.range(channel).1 - self.range(channel).0;
        let channel = (0..3).max_by_key(|channel| (wide(*channel), 3 - channel)).unwrap_or(0);
        (channel, u64::from(wide(channel)))
    }

    /// What dividing the box may better: pixels times the square of its width; 0 for a single colour.
    fn error(&self) -> u64 {
        let (_, wide) = self.spread();
        self.pixels() * wide * wide
    }

    /// Both sides of the middle pixel along the widest channel; `None` for a single colour.
    fn halves(&self) -> Option<(Self, Self)> {
        let (channel, wide) = self.spread();
        if wide == 0 {
            return None;
        }
        let mut sorted = self.0.clone();
        sorted.sort_by_key(|c| (c.0[channel], c.0));
        let (half, mut seen) = (self.pixels() / 2, 0);
        let middle = sorted.iter().position(|c| {
            seen += c.1;
            seen > half
        });
        let rest = sorted.split_off(middle.unwrap_or(1).clamp(1, sorted.len() - 1));
        Some((Self(sorted), Self(rest)))
    }
}
