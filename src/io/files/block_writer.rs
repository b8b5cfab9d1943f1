//! Long files in blocks: records are turned into bytes on several threads, written in order, in large pieces.

use std::io::{self, Write};

use crate::base::par;

/// Records of a block: a few hundred kilobytes of text.
const RECORDS: usize = 8192;
/// Blocks that are made at a time; bounds the memory, not the result.
const BLOCKS: usize = 8;

/// Writes `record(i, …)` for `i` in `0..n`, each of any length.
pub fn write_records(out: &mut dyn Write, n: usize, record: impl Fn(usize, &mut Vec<u8>) + Sync + Send) -> io::Result<()> {
    let blocks = n.div_ceil(RECORDS);
    let mut buffers: Vec<Vec<u8>> = vec![Vec::new(); blocks.min(BLOCKS)];
    for first in (0..blocks).step_by(BLOCKS) {
        let here = (blocks - first).min(BLOCKS);
        par::chunks_mut(&mut buffers[..here], 1, |k, buffer| {
            let start = (first + k) * RECORDS;
            for text in buffer {
                text.clear();
                for i in start..n.min(start + RECORDS) {
                    record(i, text);
                }
            }
        });
        for buffer in &buffers[..here] {
            out.write_all(buffer)?;
        }
    }
    Ok(())
}

/// Writes `record(i, …)` for `i` in `0..n`, each of exactly `SIZE` bytes.
pub fn write_fixed<const SIZE: usize>(
    out: &mut dyn Write,
    n: usize,
    record: impl Fn(usize, &mut [u8; SIZE]) + Sync + Send,
) -> io::Result<()> {
    let mut buffer = vec![[0_u8; SIZE]; n.min(RECORDS * BLOCKS)];
    for first in (0..n).step_by(RECORDS * BLOCKS) {
        let here = (n - first).min(RECORDS * BLOCKS);
        par::chunks_mut(&mut buffer[..here], RECORDS, |k, part| {
            for (i, bytes) in part.iter_mut().enumerate() {
                record(first + k * RECORDS + i, bytes);
            }
        });
        out.write_all(buffer[..here].as_flattened())?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::text::push_count;

    #[test]
    fn blocks_come_in_order() {
        for n in [0, 1, RECORDS, RECORDS * BLOCKS + 3] {
            let (mut text, mut bytes) = (Vec::new(), Vec::new());
            write_records(&mut text, n, |i, out| {
                push_count(out, i as u64);
                out.push(b' ');
            })
            .unwrap();
            write_fixed::<4>(&mut bytes, n, |i, out| *out = (i as u32).to_le_bytes()).unwrap();
            assert_eq!(String::from_utf8(text).unwrap().split_whitespace().count(), n);
            assert!(bytes.as_chunks::<4>().0.iter().enumerate().all(|(i, b)| u32::from_le_bytes(*b) == i as u32));
        }
    }
}
