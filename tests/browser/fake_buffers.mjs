// Buffers of the viewer's protocol, made by hand: surfaces, curves, points, meshes.

import { createHash } from 'node:crypto';

const TYPES = { f32: Float32Array, i16: Int16Array, u32: Uint32Array, u8: Uint8Array };

/** A table of indices in steps, as the program sends it, or plain where a step is too long. */
export function inSteps(width, indices) {
  const steps = indices.map((index, i) => {
    const start = i - (i % width);
    return index - (i === start ? (indices[i - width] ?? 0) : indices[start]);
  });
  return steps.some((step) => Math.abs(step) > 32767) ? ['u32', width, indices] : ['i16', width, steps, 'steps'];
}

/** One buffer, `{ key, bytes, role }`; `arrays` holds `name: [type, width, values, coding]`. */
export function buffer(role, origin, box, arrays, more = {}) {
  const described = {};
  let size = 0;
  const list = Object.entries(arrays)
    .filter(([, array]) => array)
    .map(([name, [type, width, values, coding]]) => {
      const typed = TYPES[type].from(values);
      return { name, type, width, typed, coding };
    });
  const header = (from) => {
    size = from;
    for (const { name, type, width, typed, coding } of list) {
      described[name] = { type, width, count: typed.length / width, offset: size, coding };
      size += Math.ceil(typed.byteLength / 8) * 8;
    }
    return JSON.stringify({ role, origin, box, arrays: described, ...more });
  };
  // The offsets stand in the header, whose length they change: room is left for them.
  const room = Math.ceil((Buffer.byteLength(header(0)) + 16 * list.length) / 8) * 8;
  const text = Buffer.from(header(8 + room));
  const bytes = Buffer.alloc(size, 0);
  bytes.write('LVB1', 0);
  bytes.writeUInt32LE(room, 4);
  bytes.fill(0x20, 8, 8 + room);
  text.copy(bytes, 8);
  for (const { name, typed } of list) Buffer.from(typed.buffer).copy(bytes, described[name].offset);
  return { key: createHash('sha256').update(bytes).digest('hex').slice(0, 32), bytes, role };
}

function boxOf(points, origin) {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < points.length; i++) {
    low[i % 3] = Math.min(low[i % 3], points[i]);
    high[i % 3] = Math.max(high[i % 3], points[i]);
  }
  return [low.map((l, i) => l + origin[i]), high.map((h, i) => h + origin[i])];
}

/** A patch over u and v from 0 to 1, with `n` by `m` cells; `at(u, v)` is relative to the origin. */
function patch(at, n, m) {
  const positions = [];
  const normals = [];
  const triangles = [];
  const curvature = [];
  for (let j = 0; j <= m; j++) {
    for (let i = 0; i <= n; i++) {
      const [u, v] = [i / n, j / m];
      const e = 1e-4;
      const p = at(u, v);
      const du = at(u + e, v).map((x, k) => x - at(u - e, v)[k]);
      const dv = at(u, v + e).map((x, k) => x - at(u, v - e)[k]);
      const c = [du[1] * dv[2] - du[2] * dv[1], du[2] * dv[0] - du[0] * dv[2], du[0] * dv[1] - du[1] * dv[0]];
      const l = Math.hypot(...c) || 1;
      positions.push(...p);
      normals.push(...c.map((x) => Math.round((x / l) * 32767)));
      curvature.push(Math.sin(6 * u) * 0.2, Math.cos(5 * v) * 0.1);
      if (i < n && j < m) {
        const a = j * (n + 1) + i;
        triangles.push(a, a + 1, a + n + 2, a, a + n + 2, a + n + 1);
      }
    }
  }
  return { positions, normals, triangles, curvature };
}

/**
 * Several patches as one surface: its faces and its edges. `meeting` says how many faces meet on each edge, `bends` gives the Gauss and
 * the mean curvature of each patch.
 */
export function surface(
  name,
  patches,
  { origin = [0, 0, 0], cells = [16, 16], closed = false, names = null, meeting = null, bends = null } = {},
) {
  const all = { positions: [], normals: [], triangles: [], curvature: [], face: [] };
  const lines = { positions: [], starts: [0], edges: [], faces: [] };
  patches.forEach((at, f) => {
    const made = patch(at, ...cells);
    const first = all.positions.length / 3;
    for (const x of made.positions) all.positions.push(x);
    for (const x of made.normals) all.normals.push(x);
    for (let i = 0; i < made.curvature.length; i++) all.curvature.push(bends ? bends[f][i % 2] : made.curvature[i]);
    for (const t of made.triangles) all.triangles.push(first + t);
    for (let t = 0; t < made.triangles.length / 3; t++) all.face.push(f);
    [(s) => at(s, 0), (s) => at(1, s), (s) => at(1 - s, 1), (s) => at(0, 1 - s)].forEach((side, k) => {
      const points = Array.from({ length: 17 }, (_, i) => side(i / 16));
      for (const p of points) lines.positions.push(...p);
      lines.starts.push(lines.positions.length / 3);
      const inner = closed || (k === 1 && f + 1 < patches.length) || (k === 3 && f > 0);
      lines.faces.push(meeting ?? (inner ? 2 : 1));
      lines.edges.push({
        name: `${name}.patches[${f}].${['south', 'east', 'north', 'west'][k]}`,
        length: points.slice(1).reduce((sum, p, i) => sum + Math.hypot(...p.map((x, q) => x - points[i][q])), 0),
        faces: [f],
        curve: k === 0 ? 'south' : null,
      });
    });
  });
  const box = boxOf(all.positions, origin);
  const faces = patches.map((_, f) => ({
    name: names?.[f] ?? `${name}.patches[${f}]`,
    area: 1.25,
    neighbours: [f - 1, f + 1].filter((n) => n >= 0 && n < patches.length),
  }));
  return [
    buffer(
      'faces',
      origin,
      box,
      {
        positions: ['f32', 3, all.positions],
        normals: ['i16', 3, all.normals],
        triangles: closed ? ['u32', 3, all.triangles] : inSteps(3, all.triangles),
        face: ['u32', 1, all.face],
        curvature: ['f32', 2, all.curvature],
      },
      { faces },
    ),
    buffer(
      'edges',
      origin,
      boxOf(lines.positions, origin),
      { positions: ['f32', 3, lines.positions], starts: ['u32', 1, lines.starts], faces: ['u8', 1, lines.faces] },
      { edges: lines.edges },
    ),
  ];
}

export function curve(name, at, origin = [0, 0, 0], count = 65) {
  const positions = Array.from({ length: count }, (_, i) => at(i / (count - 1))).flat();
  return buffer(
    'lines',
    origin,
    boxOf(positions, origin),
    { positions: ['f32', 3, positions], starts: ['u32', 1, [0, count]], faces: ['u8', 1, [0]] },
    { edges: [{ name, length: 3, faces: [], curve: name }] },
  );
}

export function points(names, places, origin = [0, 0, 0]) {
  return buffer('points', origin, boxOf(places.flat(), origin), { positions: ['f32', 3, places.flat()] }, { names });
}

/**
 * A mesh over one patch: triangles in one share of it and quadrangles in the rest. Of the sizes in the last two columns
 * of nodes nothing is known.
 */
export function mesh(at, n, m, origin = [0, 0, 0], share = 0.5, { faces = ['roof.patches[0]', 'roof.patches[1]'], groups = null } = {}) {
  const { positions } = patch(at, n, m);
  const triangles = [];
  const quads = [];
  const face = [];
  const quadFace = [];
  for (let j = 0; j < m; j++)
    for (let i = 0; i < n; i++) {
      const a = j * (n + 1) + i;
      const four = [a, a + 1, a + n + 2, a + n + 1];
      if (i < n * share) {
        triangles.push(four[0], four[1], four[2], four[0], four[2], four[3]);
        face.push(0, 0);
      } else {
        quads.push(...four);
        quadFace.push(1);
      }
    }
  const nodes = positions.length / 3;
  const column = (i) => i % (n + 1);
  const decided = Array.from({ length: nodes }, (_, i) => (column(i) >= n - 1 ? 0 : column(i) < n / 3 ? 2 : 1));
  return buffer(
    'mesh',
    origin,
    boxOf(positions, origin),
    {
      positions: ['f32', 3, positions],
      triangles: inSteps(3, triangles),
      quads: inSteps(4, quads),
      lines: ['u32', 2, []],
      face: ['u32', 1, [...face, ...quadFace]],
      decided: ['u8', 1, decided],
      asked: ['f32', 1, decided.map((d) => [NaN, 0.3, 0.2][d])],
    },
    {
      faces: faces.map((name) => ({ name, area: 1 })),
      groups: groups ?? [{ name: 'rim', elements: [[1, n]], nodes: [] }],
      deciders: ['not known', 'the size', 'size 0.2 near (0, 0, 0)', 'chord_error'],
      first_element: 1,
    },
  );
}

/** A box as eight nodes and six quadrangles, about its middle. */
export function boxMesh(low, size) {
  const origin = low.map((l, i) => l + size[i] / 2);
  const positions = Array.from({ length: 8 }, (_, n) => size.map((s, i) => (n & (1 << i) ? s : -s) / 2)).flat();
  const quads = [0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5];
  const face = ['u32', 1, [0, 0, 0, 0, 0, 0]];
  const arrays = { positions: ['f32', 3, positions], triangles: ['u32', 3, []], quads: inSteps(4, quads), lines: ['u32', 2, []], face };
  const more = { faces: [{ name: 'box', area: 1 }], groups: [], first_element: 1 };
  return buffer('mesh', origin, boxOf(positions, origin), arrays, more);
}
