// The buffers in memory, by key: each is fetched once, and let go when no thing of the newest frame has it.

import { BufferAttribute, BufferGeometry } from 'three';
import { MeshBVH } from 'three-mesh-bvh';
import { faceGeometry, lineGeometry, meshGeometry, meshTriangles, pointGeometry, segmentsOf } from './geometry.js';
import { ask } from './tasks.js';
import { grouped } from './together.js';
import { readBuffer } from './wire.js';

/** One buffer: its arrays, what is drawn of it, and a tree over its triangles for picking. */
class Buffer {
  constructor(key, bytes) {
    const { header, arrays } = readBuffer(bytes);
    Object.assign(this, { key, header, arrays, bytes: bytes.byteLength, role: header.role, origin: header.origin });
    this.geometry = null;
    this.tree = null;
    this.results = new Map(); // What the worker found about it: measures, open sides.
    if (this.role === 'faces') this.geometry = faceGeometry(this);
    else if (this.role === 'edges' || this.role === 'lines') this.geometry = lineGeometry(header, arrays.positions, arrays.starts);
    else if (this.role === 'points') this.geometry = pointGeometry(this);
    else if (this.role === 'mesh') {
      this.index = meshTriangles(arrays);
      if (this.index.length > 0) this.geometry = meshGeometry(this, this.index);
      if (arrays.lines?.length > 0) {
        const { points, starts } = segmentsOf(arrays.positions, arrays.lines);
        this.bars = { points, starts, geometry: lineGeometry(header, points, starts) };
      }
    } else throw new Error(`a buffer of role ${this.role}`);
    if (this.role === 'faces') this.index = arrays.triangles;
  }

  /** The number of a face or element for a triangle. */
  itemOf(triangle) {
    if (this.role === 'faces') return this.arrays.face?.[triangle] ?? 0;
    const nt = (this.arrays.triangles?.length ?? 0) / 3;
    return triangle < nt ? triangle : nt + ((triangle - nt) >> 1);
  }

  async growTree() {
    const positions = this.arrays.positions;
    const wanted = () => !this.gone;
    try {
      // A view of the whole buffer would copy all of it, so each array goes by itself.
      const data = await ask('tree', () => ({ positions: positions.slice(), index: this.index.slice() }), wanted);
      if (this.gone) return;
      const geometry = new BufferGeometry();
      geometry.setAttribute('position', new BufferAttribute(positions, 3));
      geometry.setIndex(new BufferAttribute(this.index, 1));
      this.tree = MeshBVH.deserialize(data, geometry, { setIndex: false });
    } catch (error) {
      if (!this.gone) this.treeFailed = error.message;
    }
  }

  /** Asks the worker once and keeps the answer. */
  find(task, more = {}) {
    const name = task + JSON.stringify(more);
    if (!this.results.has(name)) {
      const { positions, triangles, quads, asked } = this.arrays;
      const own = (array) => array && array.slice();
      const input = () => ({
        ...more,
        mesh: { positions: own(positions), triangles: own(triangles), quads: own(quads), asked: own(asked) },
      });
      this.results.set(
        name,
        ask(task, input, () => !this.gone),
      );
    }
    return this.results.get(name);
  }

  dispose() {
    this.gone = true;
    this.geometry?.dispose();
    this.bars?.geometry.dispose();
    this.tree = null;
    this.results.clear();
  }
}

export class Buffers {
  constructor() {
    this.held = new Map();
    this.coming = new Map();
    this.treeless = []; // Buffers with triangles whose trees are not asked for yet.
    this.fetched = 0; // Bytes over the wire since the page was opened.
  }

  /**
   * Makes sure that the buffers of these rows are here; only missing ones are fetched. `fetchBytes(keys)` gives the bytes of
   * each key that there is.
   */
  load(rows, fetchBytes) {
    const missing = new Map(rows.filter(({ key }) => !this.held.has(key)).map((row) => [row.key, row]));
    for (const keys of grouped([...missing.values()].filter(({ key }) => !this.coming.has(key)))) {
      const all = fetchBytes(keys);
      const one = (key) => all.then((found) => this.take(key, found.get(key))).finally(() => this.coming.delete(key));
      for (const key of keys) this.coming.set(key, one(key));
    }
    return Promise.all([...missing.keys()].map((key) => this.coming.get(key)));
  }

  take(key, bytes) {
    if (!bytes) throw new Error(`the server no longer has its buffer ${key}`);
    this.fetched += bytes.byteLength;
    const buffer = new Buffer(key, bytes);
    this.held.set(key, buffer);
    if (buffer.index?.length > 0) this.treeless.push(buffer);
  }

  get(key) {
    return this.held.get(key);
  }

  /** Lets go of all buffers but these. */
  keep(keys) {
    const wanted = new Set(keys);
    for (const [key, buffer] of this.held) {
      if (wanted.has(key)) continue;
      buffer.dispose();
      this.held.delete(key);
    }
  }

  /** Has the missing trees made once the picture, which does not need them, is on the screen. */
  growTreesSoon() {
    if (this.treeless.length === 0) return;
    const now = this.treeless.splice(0);
    setTimeout(() => {
      for (const buffer of now) if (!buffer.gone) buffer.growTree();
    });
  }

  bytes() {
    let sum = 0;
    for (const buffer of this.held.values()) sum += buffer.bytes;
    return sum;
  }
}
