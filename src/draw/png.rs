//! PNG files: eight bits a colour, no time stamp, the same bytes every time.

use std::io::{self, Write};

use super::raster::Image;

/// Writes an image.
pub fn write(image: &Image, out: &mut dyn Write) -> io::Result<()> {
    let size = |n: usize| u32::try_from(n).map_err(|_| io::Error::other("the picture is too large"));
    let mut encoder = ::png::Encoder::new(out, size(image.width)?, size(image.height)?);
    encoder.set_color(::png::ColorType::Rgb);
    encoder.set_depth(::png::BitDepth::Eight);
    encoder.set_compression(::png::Compression::Balanced);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&image.rgb)?;
    writer.finish()?;
    Ok(())
}
