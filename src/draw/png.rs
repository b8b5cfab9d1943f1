//! PNG files: eight bits a colour, no time stamp, the same bytes every time.

use std::io::{self, Cursor, Write};

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

/// Pixels of a row, and red, green, blue of all pixels, row by row, as [`write()`] wrote them; `None` for any other file.
pub fn read(file: &[u8]) -> Option<(usize, Vec<[u8; 3]>)> {
    let mut reader = ::png::Decoder::new(Cursor::new(file)).read_info().ok()?;
    let mut bytes = vec![0; reader.output_buffer_size()?];
    let info = reader.next_frame(&mut bytes).ok()?;
    let plain = info.color_type == ::png::ColorType::Rgb && info.bit_depth == ::png::BitDepth::Eight;
    plain.then(|| (info.width as usize, bytes.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect()))
}
