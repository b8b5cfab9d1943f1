//! Pictures as sixels: columns of six pixels as characters, one colour after the other, equal ones in a row as one run.

use super::palette::{Rgb, palette};

/// Colours that terminals keep.
const COLORS: usize = 256;
/// Pixels of a column that one character holds.
const BAND: usize = 6;
/// Equal characters from which a run is the shorter text.
const RUN: usize = 4;
/// Terminals take shares of colours as whole numbers up to this.
const WHOLE: u16 = 100;

/// A picture as rows of pixels.
pub struct Pixels {
    /// Pixels of a row.
    pub width: usize,
    /// Red, green and blue of all pixels, row by row.
    pub rgb: Vec<Rgb>,
}

impl Pixels {
    /// What a PNG file that was drawn here holds.
    pub fn of_png(file: &[u8]) -> Option<Self> {
        crate::draw::png::read(file).map(|(width, rgb)| Self { width, rgb })
    }

    fn height(&self) -> usize {
        self.rgb.len().checked_div(self.width).unwrap_or(0)
    }

    /// The same with rows of at most so many pixels: squares of pixels become their mean.
    pub fn within(self, most: usize) -> Self {
        let step = self.width.div_ceil(most.max(1));
        if step <= 1 {
            return self;
        }
        let (width, height) = (self.width / step, self.height() / step);
        let mean = |x: usize, y: usize| {
            let square = (0..step * step).map(|k| self.rgb[(y * step + k / step) * self.width + x * step + k % step]);
            let sum = square.fold([0_usize; 3], |s, c| [0, 1, 2].map(|k| s[k] + usize::from(c[k])));
            sum.map(|s| ((s + step * step / 2) / (step * step)) as u8)
        };
        let rgb = (0..width * height).map(|k| mean(k % width, k / width)).collect();
        Self { width, rgb }
    }

    /// The text that shows it.
    pub fn sixels(&self) -> String {
        let (colors, of) = palette(&self.rgb, COLORS);
        let mut out = format!("\u{1b}P0;1;0q\"1;1;{};{}", self.width, self.height());
        for (k, color) in colors.iter().enumerate() {
            let [r, g, b] = color.map(|c| (u16::from(c) * WHOLE + 127) / 255);
            out.push_str(&format!("#{k};2;{r};{g};{b}"));
        }
        let places: Vec<usize> = self.rgb.iter().map(|c| of.get(c).copied().unwrap_or(0)).collect();
        for band in places.chunks(self.width.max(1) * BAND) {
            push_band(&mut out, band, self.width);
        }
        out.push_str("\u{1b}\\");
        out
    }
}

/// Six rows of pixels: a line of characters for each colour in them.
fn push_band(out: &mut String, band: &[usize], width: usize) {
    let mut used: Vec<usize> = band.to_vec();
    used.sort_unstable();
    used.dedup();
    // The rows of each colour in each column.
    let mut lines: Vec<Vec<u8>> = vec![vec![0; width]; used.len()];
    for (k, color) in band.iter().enumerate() {
        if let Ok(line) = used.binary_search(color) {
            lines[line][k % width] |= 1 << (k / width);
        }
    }
    for (k, (color, line)) in used.iter().zip(&lines).enumerate() {
        out.push_str(if k == 0 { "" } else { "$" });
        out.push_str(&format!("#{color}"));
        push_line(out, line);
    }
    out.push('-');
}

/// One line of characters, without the empty ones at its end.
fn push_line(out: &mut String, line: &[u8]) {
    let end = line.iter().rposition(|rows| *rows != 0).map_or(0, |last| last + 1);
    for run in line[..end].chunk_by(|a, b| a == b) {
        let character = char::from(b'?' + run[0]);
        if run.len() >= RUN {
            out.push_str(&format!("!{}{character}", run.len()));
        } else {
            out.extend(std::iter::repeat_n(character, run.len()));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Width and pixels of a text of sixels, in shares of 100; pixels that no colour sets are `None`.
    fn decoded(text: &str) -> (usize, Vec<Option<[u16; 3]>>) {
        let body = text.strip_prefix("\u{1b}P0;1;0q\"").unwrap().strip_suffix("\u{1b}\\").unwrap();
        let signs: Vec<char> = body.chars().collect();
        let mut at = 0;
        let numbers = |at: &mut usize| {
            let end = (*at..signs.len()).find(|k| !signs[*k].is_ascii_digit() && signs[*k] != ';').unwrap_or(signs.len());
            let text: String = signs[*at..end].iter().collect();
            *at = end;
            text.split(';').map(|n| n.parse().unwrap()).collect::<Vec<usize>>()
        };
        let size = numbers(&mut at);
        let (width, height) = (size[2], size[3]);
        let (mut colors, mut color, mut x, mut y) = (vec![[0; 3]; COLORS], 0, 0, 0);
        let mut pixels = vec![None; width * height];
        while at < signs.len() {
            let sign = signs[at];
            at += 1;
            let mut times = 1;
            let sign = match sign {
                '#' => {
                    let found = numbers(&mut at);
                    color = found[0];
                    if let [_, 2, r, g, b] = found[..] {
                        colors[color] = [r as u16, g as u16, b as u16];
                    }
                    continue;
                }
                '$' => {
                    x = 0;
                    continue;
                }
                '-' => {
                    (x, y) = (0, y + BAND);
                    continue;
                }
                '!' => {
                    times = numbers(&mut at)[0];
                    at += 1;
                    signs[at - 1]
                }
                other => other,
            };
            let rows = sign as usize - '?' as usize;
            for _ in 0..times {
                for row in (0..BAND).filter(|row| rows >> row & 1 == 1) {
                    assert!(pixels[(y + row) * width + x].is_none(), "a pixel is set twice");
                    pixels[(y + row) * width + x] = Some(colors[color]);
                }
                x += 1;
            }
        }
        (width, pixels)
    }

    /// The largest difference of a channel between a picture and its sixels, in shares of 100.
    fn off(pixels: &Pixels) -> f64 {
        let (width, found) = decoded(&pixels.sixels());
        assert_eq!((width, found.len()), (pixels.width, pixels.rgb.len()));
        let channels = found.iter().zip(&pixels.rgb).flat_map(|(found, wanted)| {
            let found = found.expect("every pixel is set");
            [0, 1, 2].map(|k| (f64::from(found[k]) - f64::from(wanted[k]) / 2.55).abs())
        });
        channels.fold(0.0, f64::max)
    }

    #[test]
    fn sixels_show_the_picture() {
        // Few colours, a height that is no whole number of bands, runs and single pixels.
        let few = |k: usize| if k % 37 < 30 { [255, 255, 255] } else { [(k % 5 * 50) as u8, 10, 200] };
        for (width, height) in [(1, 1), (40, 6), (33, 20), (100, 13)] {
            assert!(off(&Pixels { width, rgb: (0..width * height).map(few).collect() }) <= 0.5, "{width} × {height}");
        }
        // More colours than there is room for.
        let many = |k: usize| [(k % 128 * 2) as u8, (k / 128 * 2) as u8, ((k % 128 + k / 128) % 256) as u8];
        let off = off(&Pixels { width: 128, rgb: (0..128 * 96).map(many).collect() });
        assert!((1.0..12.0).contains(&off), "{off}");
    }

    #[test]
    fn runs_are_short_and_wide_pictures_are_made_narrower() {
        let white = Pixels { width: 1000, rgb: vec![[255; 3]; 1000 * 12] };
        assert!(white.sixels().len() < 80, "{}", white.sixels());
        let stripes = Pixels { width: 1000, rgb: (0..1000 * 40).map(|k| if k % 2 == 0 { [200, 0, 0] } else { [0, 0, 0] }).collect() };
        let narrow = stripes.within(400);
        assert_eq!((narrow.width, narrow.height()), (333, 13));
        assert!(narrow.rgb.iter().all(|c| c[0] > 50 && c[0] < 150 && c[1] == 0));
    }

    #[test]
    fn png_files_are_read_and_nothing_else() {
        let image = crate::draw::raster::Image { width: 2, height: 1, rgb: vec![1, 2, 3, 250, 251, 252], near: vec![0.0; 2] };
        let mut file = Vec::new();
        crate::draw::png::write(&image, &mut file).unwrap();
        let pixels = Pixels::of_png(&file).unwrap();
        assert_eq!((pixels.width, pixels.rgb), (2, vec![[1, 2, 3], [250, 251, 252]]));
        assert!(Pixels::of_png(b"abc").is_none());
    }
}
