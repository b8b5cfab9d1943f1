// Which buffers one request asks for: small ones go together, a large one goes alone, as the server compresses it then.

const LARGE = 256 * 1024; // Bytes of a buffer that goes alone.
const MOST_BYTES = 1024 * 1024; // Of buffers that go together; the server sends up to four times as many.
const MOST_BUFFERS = 64; // The server takes up to twice as many.

/** Lists of keys, each for one request, from rows `{ key, bytes }`. */
export function grouped(rows) {
  const groups = [];
  let room = null; // The list that the next small one goes to, and what it has.
  for (const { key, bytes } of rows) {
    if (bytes > LARGE) {
      groups.push([key]);
      continue;
    }
    if (!room || room.keys.length >= MOST_BUFFERS || room.bytes + bytes > MOST_BYTES) {
      room = { keys: [], bytes: 0 };
      groups.push(room.keys);
    }
    room.keys.push(key);
    room.bytes += bytes;
  }
  return groups;
}

/**
 * The bytes of each key in an answer to several: `lengths` has a length for each key, or `-` where the server has none,
 * which is left out. Without lengths the answer is one buffer.
 */
export function parted(keys, lengths, bytes) {
  if (lengths === null) return new Map([[keys[0], bytes]]);
  const all = lengths.split(',');
  const found = new Map();
  let at = 0;
  all.forEach((text, i) => {
    if (text === '-') return;
    const end = at + Number(text);
    found.set(keys[i], bytes.slice(at, end));
    at = end;
  });
  if (all.length !== keys.length || at !== bytes.byteLength) throw new Error('an answer that does not fit the buffers that were asked for');
  return found;
}
