// From the arrays of a buffer to what the graphics card draws, and the triangles that are picked.

import {
  BufferAttribute,
  BufferGeometry,
  InstancedBufferAttribute,
  InstancedBufferGeometry,
  InstancedInterleavedBuffer,
  InterleavedBufferAttribute,
  Sphere,
  Vector3,
} from 'three';

const NO_EDGE = 0xffffffff;

function enclose(geometry, header) {
  const [low, high] = header.box ?? [
    [0, 0, 0],
    [0, 0, 0],
  ];
  const center = low.map((l, i) => (l + high[i]) / 2 - header.origin[i]);
  const radius = Math.hypot(...low.map((l, i) => high[i] - l)) / 2;
  geometry.boundingSphere = new Sphere(new Vector3(...center), radius * 1.001 + 1e-9);
  return geometry;
}

/**
 * Display triangles of a surface. The number of a face goes with the last corner of each triangle, which is the one
 * the graphics card asks; corners that two faces want are turned, and only where that does not help doubled.
 */
export function faceGeometry({ header, arrays }) {
  let { positions, normals } = arrays;
  const { triangles, face, curvature } = arrays;
  const count = positions.length / 3;
  const owner = new Uint32Array(count).fill(NO_EDGE);
  const index = new Uint32Array(triangles);
  const doubled = [];
  for (let t = 0; t < index.length / 3; t++) {
    const own = face ? face[t] : 0;
    let done = false;
    for (let k = 2; k >= 0 && !done; k--) {
      const corner = index[3 * t + k];
      if (owner[corner] !== own && owner[corner] !== NO_EDGE) continue;
      owner[corner] = own;
      const [a, b, c] = [index[3 * t], index[3 * t + 1], index[3 * t + 2]];
      if (k === 1) index.set([c, a, b], 3 * t);
      if (k === 0) index.set([b, c, a], 3 * t);
      done = true;
    }
    if (!done) {
      doubled.push([index[3 * t + 2], own]);
      index[3 * t + 2] = count + doubled.length - 1;
    }
  }
  let owners = owner;
  let value = curvature;
  if (doubled.length > 0) {
    const longer = (old, width, Kind) => {
      const made = new Kind(old.length + doubled.length * width);
      made.set(old);
      doubled.forEach(([from], i) => made.set(old.subarray(from * width, from * width + width), old.length + i * width));
      return made;
    };
    positions = longer(positions, 3, Float32Array);
    normals = longer(normals, 3, Int16Array);
    if (value) value = longer(value, 2, Float32Array);
    owners = longer(owner, 1, Uint32Array);
    doubled.forEach(([, own], i) => (owners[count + i] = own));
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(positions, 3));
  geometry.setAttribute('normal', new BufferAttribute(normals, 3, true));
  geometry.setAttribute('face', new BufferAttribute(owners, 1));
  if (value) geometry.setAttribute('value', new BufferAttribute(value, 2));
  geometry.setIndex(new BufferAttribute(index, 1));
  return enclose(geometry, header);
}

/** The triangles of some faces of a surface, over the same points. */
export function onlyFaces({ geometry, arrays }, isKept) {
  const all = geometry.index.array;
  const kept = [];
  for (let t = 0; t < all.length / 3; t++) if (isKept(arrays.face?.[t] ?? 0)) kept.push(all[3 * t], all[3 * t + 1], all[3 * t + 2]);
  const made = new BufferGeometry();
  for (const [name, attribute] of Object.entries(geometry.attributes)) made.setAttribute(name, attribute);
  made.setIndex(new BufferAttribute(new Uint32Array(kept), 1));
  made.boundingSphere = geometry.boundingSphere;
  return made;
}

/** Lets go of a geometry that `onlyFaces` made, and not of the points, which others have. */
export function release(geometry) {
  for (const name of Object.keys(geometry.attributes)) geometry.deleteAttribute(name);
  geometry.dispose();
}

/** Triangles of a mesh, quadrangles as two each: indices of nodes. */
export function meshTriangles({ triangles, quads }) {
  const nt = triangles?.length ?? 0;
  const nq = (quads?.length ?? 0) / 4;
  const index = new Uint32Array(nt + 6 * nq);
  if (triangles) index.set(triangles);
  for (let q = 0; q < nq; q++) {
    const [a, b, c, d] = [quads[4 * q], quads[4 * q + 1], quads[4 * q + 2], quads[4 * q + 3]];
    index.set([a, b, c, a, c, d], nt + 6 * q);
  }
  return index;
}

/** A mesh is drawn corner by corner, so that an element has its own colour and its own sides. */
export function meshGeometry({ header, arrays }, index) {
  const corners = new Float32Array(index.length * 3);
  const p = arrays.positions;
  for (let i = 0; i < index.length; i++) {
    const at = 3 * index[i];
    corners[3 * i] = p[at];
    corners[3 * i + 1] = p[at + 1];
    corners[3 * i + 2] = p[at + 2];
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(corners, 3));
  return enclose(geometry, header);
}

const CORNERS = new Float32Array([0, -1, 1, -1, 1, 1, 0, 1]);

/** Polylines as one row of points: point i and i + 1 are a segment, unless the polyline ends at i. */
export function lineGeometry(header, positions, starts) {
  const count = positions.length / 3;
  const edge = new Uint32Array(count).fill(NO_EDGE);
  for (let e = 0; e + 1 < starts.length; e++) edge.fill(e, starts[e], Math.max(starts[e + 1] - 1, starts[e]));
  const geometry = new InstancedBufferGeometry();
  geometry.setAttribute('corner', new BufferAttribute(CORNERS, 2));
  geometry.setIndex(new BufferAttribute(new Uint16Array([0, 1, 2, 0, 2, 3]), 1));
  const row = new InstancedInterleavedBuffer(positions, 3, 1);
  geometry.setAttribute('from', new InterleavedBufferAttribute(row, 3, 0));
  geometry.setAttribute('to', new InterleavedBufferAttribute(row, 3, 3));
  geometry.setAttribute('edge', new InstancedBufferAttribute(edge, 1));
  geometry.instanceCount = Math.max(count - 1, 0);
  return enclose(geometry, header);
}

/** Separate segments between nodes, as polylines of two points; each with its own number. */
export function segmentsOf(positions, ends) {
  const points = new Float32Array(ends.length * 3);
  const starts = new Uint32Array(ends.length / 2 + 1);
  for (let i = 0; i < ends.length; i++) points.set(positions.subarray(3 * ends[i], 3 * ends[i] + 3), 3 * i);
  for (let i = 0; i < starts.length; i++) starts[i] = 2 * i;
  return { points, starts };
}

export function pointGeometry({ header, arrays }) {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(arrays.positions, 3));
  return enclose(geometry, header);
}
