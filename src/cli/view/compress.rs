//! Bytes that are sent many times, compressed once.

use std::io::{self, Write};
use std::sync::{Arc, OnceLock};

use flate2::write::{DeflateEncoder, GzEncoder};
use flate2::{Compression, Crc};

/// Less than this is sent as it is.
const SMALL: usize = 4096;

/// Of more than this only what compresses fast is compressed: over the loopback interface ten megabytes take some ten milliseconds,
/// compressing them takes ten times as long.
const LARGE: usize = 512 * 1024;

/// Bytes of large content about which one decision is made.
const PIECE: usize = 128 * 1024;

/// Bytes of a piece that are tried.
const SAMPLE: usize = 2048;

/// A piece is compressed when its sample shrinks to this share, one part in so many; runs of equal numbers do, and take no time.
const SHARE: usize = 8;

/// Bytes and, once somebody asked, what they compress to.
#[derive(Debug, Default)]
pub struct Packed {
    plain: Arc<Vec<u8>>,
    gzip: OnceLock<Option<Arc<Vec<u8>>>>,
}

impl Packed {
    /// Nothing is compressed yet.
    pub fn new(plain: Arc<Vec<u8>>) -> Self {
        Self { plain, gzip: OnceLock::new() }
    }

    /// The bytes as they are.
    pub fn plain(&self) -> &Arc<Vec<u8>> {
        &self.plain
    }

    /// The bytes in gzip format, where that is worth while. The first call compresses, later ones find it done.
    pub fn gzip(&self) -> Option<&Arc<Vec<u8>>> {
        let pack = || {
            let packed = match self.plain.len() {
                ..SMALL => return None,
                SMALL..=LARGE => gzip(&self.plain, Compression::fast()).ok()?,
                _ => gzip_in_part(&self.plain).ok()??,
            };
            (packed.len() < self.plain.len()).then(|| Arc::new(packed))
        };
        self.gzip.get_or_init(pack).as_ref()
    }
}

/// Bytes in gzip format; the same bytes in every run.
///
/// Fails as writing to memory does, that is, not in practice.
pub fn gzip(plain: &[u8], level: Compression) -> io::Result<Vec<u8>> {
    let mut encoder = GzEncoder::new(Vec::with_capacity(plain.len() / 2), level);
    encoder.write_all(plain)?;
    encoder.finish()
}

/// Bytes in gzip format (RFC 1952), of which only those pieces are compressed that shrink a lot; the others are stored. `None` where
/// there are none of the first kind.
///
/// Fails as [`gzip`].
pub fn gzip_in_part(plain: &[u8]) -> io::Result<Option<Vec<u8>>> {
    let shrinks: Vec<bool> = plain.chunks(PIECE).map(shrinks).collect::<io::Result<_>>()?;
    if !shrinks.contains(&true) {
        return Ok(None);
    }
    // No name, no time, compressed for speed, on an unknown system.
    let mut out = vec![0x1f, 0x8b, 8, 0, 0, 0, 0, 0, 4, 255];
    out.reserve(plain.len());
    let mut sum = Crc::new();
    for (piece, shrinks) in plain.chunks(PIECE).zip(shrinks) {
        sum.update(piece);
        if shrinks {
            out.extend_from_slice(&deflated(piece)?);
        } else {
            store(piece, &mut out);
        }
    }
    // An empty block that is the last one.
    out.extend_from_slice(&[3, 0]);
    out.extend_from_slice(&sum.sum().to_le_bytes());
    out.extend_from_slice(&sum.amount().to_le_bytes());
    Ok(Some(out))
}

fn shrinks(piece: &[u8]) -> io::Result<bool> {
    let middle = piece.len().saturating_sub(SAMPLE) / 2;
    let sample = &piece[middle..piece.len().min(middle + SAMPLE)];
    Ok(deflated(sample)?.len() * SHARE < sample.len())
}

/// Compressed blocks (RFC 1951) that end at a whole byte, none of them the last one.
fn deflated(piece: &[u8]) -> io::Result<Vec<u8>> {
    let mut encoder = DeflateEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(piece)?;
    encoder.flush()?;
    Ok(std::mem::take(encoder.get_mut()))
}

/// Blocks that are stored, none of them the last one. They begin at a whole byte.
fn store(piece: &[u8], out: &mut Vec<u8>) {
    for block in piece.chunks(usize::from(u16::MAX)) {
        // Never longer than the largest number of two bytes.
        let length = u16::try_from(block.len()).unwrap_or(u16::MAX);
        out.push(0);
        out.extend_from_slice(&length.to_le_bytes());
        out.extend_from_slice(&(!length).to_le_bytes());
        out.extend_from_slice(block);
    }
}

#[cfg(test)]
mod tests {
    use std::io::Read;

    use flate2::read::GzDecoder;

    use super::*;

    fn check(plain: Vec<u8>, expected: Option<std::ops::Range<usize>>) {
        let packed = Packed::new(Arc::new(plain));
        let Some(gzip) = packed.gzip() else {
            assert_eq!(expected, None);
            return;
        };
        let mut back = Vec::new();
        GzDecoder::new(gzip.as_slice()).read_to_end(&mut back).unwrap();
        assert!(back == **packed.plain());
        assert!(expected.is_some_and(|range| range.contains(&gzip.len())), "{}", gzip.len());
    }

    /// Bytes that do not compress.
    fn noise(n: usize) -> Vec<u8> {
        let mut state = 1_u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 40) as u8
        };
        (0..n).map(|_| next()).collect()
    }

    #[test]
    fn what_is_worth_while_is_compressed() {
        check(vec![0; 4000], None);
        check(vec![0; 5000], Some(0..100));
        check(noise(5000), None);
        check(vec![0; 3_000_001], Some(0..60_000));
        check(noise(3_000_001), None);
        check([noise(1_000_000), vec![7; 1_000_000], noise(1_000_000)].concat(), Some(2_000_000..2_400_000));
        check([vec![7; 1_000_000], noise(1)].concat(), Some(0..20_000));
    }
}
