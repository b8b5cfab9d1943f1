// Reads one buffer as the server sends it: a header in JSON and typed arrays, used in place without a copy.

const KINDS = {
  f32: Float32Array,
  f64: Float64Array,
  i16: Int16Array,
  u8: Uint8Array,
  u16: Uint16Array,
  u32: Uint32Array,
};

/** Gives `{ header, arrays }`; throws where the bytes are not a buffer of version 1. */
export function readBuffer(bytes) {
  if (bytes.byteLength < 8) throw new Error('a buffer of fewer than 8 bytes');
  const view = new DataView(bytes);
  const magic = String.fromCharCode(...new Uint8Array(bytes, 0, 4));
  if (magic !== 'LVB1') throw new Error('not a buffer of version 1');
  const length = view.getUint32(4, true);
  if (8 + length > bytes.byteLength) throw new Error('a header longer than its buffer');
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 8, length)));
  const arrays = {};
  for (const [name, { type, width, count, offset, coding }] of Object.entries(header.arrays ?? {})) {
    const Kind = KINDS[type];
    if (!Kind) throw new Error(`an array of type ${type}`);
    if (coding && coding !== 'steps') throw new Error(`an array in the coding ${coding}`);
    if (offset + width * count * Kind.BYTES_PER_ELEMENT > bytes.byteLength) throw new Error(`the array ${name} ends after its buffer`);
    const values = new Kind(bytes, offset, width * count);
    arrays[name] = coding ? fromSteps(values, width) : values;
  }
  checkIndices(arrays);
  return { header, arrays };
}

/**
 * Plain indices from steps: in each row of a table the first number is the difference from the first index of the row
 * before, the others are differences from the first index of their own row.
 */
function fromSteps(steps, width) {
  const indices = new Uint32Array(steps.length);
  let first = 0;
  for (let i = 0; i < steps.length; i += width) {
    first += steps[i];
    indices[i] = first;
    for (let k = 1; k < width; k++) indices[i + k] = first + steps[i + k];
  }
  return indices;
}

/** Indices must be of points that are there, or the graphics driver reads elsewhere. */
function checkIndices(arrays) {
  const points = (arrays.positions?.length ?? 0) / 3;
  for (const name of ['triangles', 'quads', 'lines']) {
    const indices = arrays[name];
    if (!indices) continue;
    let largest = -1;
    for (let i = 0; i < indices.length; i++) if (indices[i] > largest) largest = indices[i];
    if (largest >= points) throw new Error(`${name} name point ${largest} of ${points}`);
  }
}

/** Takes the bytes of a gzipped text in base 64. */
export async function unpack(text) {
  const packed = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'));
  return new Response(stream).arrayBuffer();
}
