//! Nodes and elements as bytes, little endian.

use crate::io::mesh_files::deck::Deck;

/// A node as three doubles.
pub(crate) fn coordinates(deck: &Deck, node: usize, record: &mut [u8; 24]) {
    for (x, bytes) in deck.node(node).into_iter().zip(record.as_chunks_mut::<8>().0) {
        *bytes = (x + 0.0).to_le_bytes();
    }
}

/// Nodes as four-byte integers.
pub(crate) fn integers(nodes: &[u32], record: &mut [u8]) {
    for (n, bytes) in nodes.iter().zip(record.as_chunks_mut::<4>().0) {
        *bytes = n.to_le_bytes();
    }
}
