// What lies under a place of the screen: triangles by their tree, edges and points by what is nearest on the screen.

import { DoubleSide, Ray } from 'three';
import { rayThrough } from './camera.js';
import { cornersOf, elementsBeside, sidesOf } from './elements.js';

const EDGE_PIXELS = 6;
const NODE_PIXELS = 7;
const SIDE_PIXELS = 5;
const CHUNK = 32;
const ray = new Ray();

/** `{ drawing, kind, item, triangle, point, distance }` or null; the point is absolute. `drawings` are the visible ones. */
export function pick(stage, drawings, x, y, section) {
  const sx = (2 * x) / stage.size.width - 1;
  const sy = 1 - (2 * y) / stage.size.height;
  const { start, along } = rayThrough(stage.view, stage.aspect, sx, sy);
  const span = keptPart(start, along, section);
  if (!span) return null;
  let best = null;
  for (const drawing of drawings) {
    if (!drawing.isSolid || !drawing.buffer.tree || drawing.ghost) continue;
    const hit = firstTriangle(drawing, start, along, span, best?.distance ?? Infinity);
    if (hit) best = hit;
  }
  const line = nearestOnLines(stage, drawings, start, along, span, best);
  const point = nearestPoint(stage, drawings, x, y, best, section);
  if (point) return point;
  if (line) return line;
  if (best?.drawing.role !== 'mesh') return best;
  return nearNode(stage, best, x, y) ?? nearSide(stage, best, start, along, span) ?? best;
}

/** The part of a ray that the section plane leaves, as distances from its start. */
function keptPart(start, along, section) {
  if (!section) return [0, Infinity];
  const { normal, offset } = section;
  const here = start.reduce((sum, s, i) => sum + s * normal[i], offset);
  const speed = along.reduce((sum, a, i) => sum + a * normal[i], 0);
  if (Math.abs(speed) < 1e-12) return here >= 0 ? [0, Infinity] : null;
  const at = -here / speed;
  if (speed > 0) return [Math.max(at, 0), Infinity];
  return at > 0 ? [0, at] : null;
}

function firstTriangle(drawing, start, along, span, limit) {
  const { buffer } = drawing;
  ray.origin.set(...start.map((s, i) => s - buffer.origin[i]));
  ray.direction.set(...along);
  // Where two things lie on each other the one that was declared first is picked.
  const far = Math.min(span[1], limit * (1 - 1e-6));
  if (!(far > span[0])) return null;
  let hit;
  if (drawing.filter) {
    hit = null;
    for (const one of buffer.tree.raycast(ray, DoubleSide, span[0], far)) {
      if (drawing.filter(buffer.itemOf(one.faceIndex)) && (!hit || one.distance < hit.distance)) hit = one;
    }
  } else hit = buffer.tree.raycastFirst(ray, DoubleSide, span[0], far);
  if (!hit) return null;
  return {
    drawing,
    kind: drawing.role === 'mesh' ? 'element' : 'face',
    item: buffer.itemOf(hit.faceIndex),
    triangle: hit.faceIndex,
    point: hit.point.toArray().map((p, i) => p + buffer.origin[i]),
    normal: hit.face.normal.toArray(),
    distance: hit.distance,
  };
}

/** Spheres about runs of segments, so that most of a long polyline is passed over. */
function chunksOf(buffer, positions) {
  if (buffer.chunks) return buffer.chunks;
  const count = positions.length / 3;
  const made = new Float64Array(Math.ceil(count / CHUNK) * 4);
  for (let c = 0; c * CHUNK < count; c++) {
    const low = [Infinity, Infinity, Infinity];
    const high = [-Infinity, -Infinity, -Infinity];
    for (let i = c * CHUNK; i <= Math.min((c + 1) * CHUNK, count - 1); i++) {
      for (let k = 0; k < 3; k++) {
        low[k] = Math.min(low[k], positions[3 * i + k]);
        high[k] = Math.max(high[k], positions[3 * i + k]);
      }
    }
    for (let k = 0; k < 3; k++) made[4 * c + k] = (low[k] + high[k]) / 2;
    made[4 * c + 3] = Math.hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]) / 2;
  }
  buffer.chunks = made;
  return made;
}

function nearestOnLines(stage, drawings, start, along, span, front) {
  let best = null;
  // The ray widens away from the eye: how wide a pixel is at distance t.
  const { view } = stage;
  const grow = view.flat ? 0 : stage.pixelAt(start.map((s, i) => s + along[i])) - 0;
  const pixel = (t) => (view.flat ? view.height / stage.size.height : grow * Math.max(t, 0));
  for (const drawing of drawings) {
    if (!drawing.isLine || drawing.ghost) continue;
    const { buffer } = drawing;
    const positions = drawing.role === 'bars' ? buffer.bars.points : buffer.arrays.positions;
    const edges = drawing.object.geometry.getAttribute('edge').array;
    const o = start.map((s, i) => s - buffer.origin[i]);
    const chunks = chunksOf(drawing.role === 'bars' ? buffer.bars : buffer, positions);
    const count = positions.length / 3;
    for (let c = 0; 4 * c < chunks.length; c++) {
      const dx = chunks[4 * c] - o[0],
        dy = chunks[4 * c + 1] - o[1],
        dz = chunks[4 * c + 2] - o[2];
      const t = dx * along[0] + dy * along[1] + dz * along[2];
      const off = Math.sqrt(Math.max(dx * dx + dy * dy + dz * dz - t * t, 0));
      const r = chunks[4 * c + 3];
      if (off > r + EDGE_PIXELS * pixel(t + r)) continue;
      for (let i = c * CHUNK; i < Math.min((c + 1) * CHUNK, count - 1); i++) {
        if (edges[i] === 0xffffffff) continue;
        const near = nearestToRay(positions, i, o, along);
        if (near.t < span[0] || near.t > span[1]) continue;
        const pixels = near.off / Math.max(pixel(near.t), 1e-300);
        if (pixels > EDGE_PIXELS) continue;
        // A line behind a surface is hidden, but for the surface that it borders.
        if (front && near.t > front.distance + 4 * EDGE_PIXELS * pixel(near.t)) continue;
        const weight = pixels + (drawing.role === 'edges' ? 0.5 : 0);
        if (best && best.weight <= weight) continue;
        best = {
          drawing,
          weight,
          kind: 'edge',
          item: edges[i],
          segment: i,
          distance: near.t,
          point: near.at.map((p, k) => p + buffer.origin[k]),
          direction: near.direction,
        };
      }
    }
  }
  return best;
}

/** The point of segment i that comes nearest to the ray. */
function nearestToRay(p, i, o, d) {
  const a = [p[3 * i], p[3 * i + 1], p[3 * i + 2]];
  const e = [p[3 * i + 3] - a[0], p[3 * i + 4] - a[1], p[3 * i + 5] - a[2]];
  const w = [a[0] - o[0], a[1] - o[1], a[2] - o[2]];
  const dot = (u, v) => u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
  const [ee, ed, we, wd] = [dot(e, e), dot(e, d), dot(w, e), dot(w, d)];
  const below = ee - ed * ed;
  const s = below > 1e-14 * ee ? Math.min(1, Math.max(0, (wd * ed - we) / below)) : 0;
  const at = a.map((x, k) => x + s * e[k]);
  const v = at.map((x, k) => x - o[k]);
  const t = dot(v, d);
  return { at, t, off: Math.sqrt(Math.max(dot(v, v) - t * t, 0)), direction: e.map((x) => x / Math.sqrt(ee || 1)) };
}

function nearestPoint(stage, drawings, x, y, front, section) {
  let best = null;
  for (const drawing of drawings) {
    if (drawing.role !== 'points' || drawing.ghost) continue;
    const { origin, arrays } = drawing.buffer;
    for (let i = 0; i < arrays.positions.length / 3; i++) {
      const point = origin.map((o, k) => o + arrays.positions[3 * i + k]);
      if (section && point.reduce((sum, p, k) => sum + p * section.normal[k], section.offset) < 0) continue;
      const at = stage.toScreen(point);
      if (!at) continue;
      const pixels = Math.hypot(at[0] - x, at[1] - y);
      if (pixels > NODE_PIXELS + 2 || (best && best.pixels <= pixels)) continue;
      const distance = distanceFromEye(stage, point);
      if (front && distance > distanceFromEye(stage, front.point) + 20 * stage.pixelAt(point)) continue;
      best = { drawing, kind: 'point', item: i, point, pixels, distance };
    }
  }
  return best;
}

function distanceFromEye(stage, point) {
  return -stage.toScreen(point)?.[2] || 0;
}

/** The corner of a picked element, where the cursor is on it. */
function nearNode(stage, hit, x, y) {
  const { buffer } = hit.drawing;
  for (const node of cornersOf(buffer.arrays, hit.item)) {
    const point = buffer.origin.map((o, i) => o + buffer.arrays.positions[3 * node + i]);
    const at = stage.toScreen(point);
    if (at && Math.hypot(at[0] - x, at[1] - y) <= NODE_PIXELS) return { ...hit, kind: 'node', node, point };
  }
  return null;
}

/** The side of a picked element, where the cursor is on it. */
function nearSide(stage, hit, start, along, span) {
  const { buffer } = hit.drawing;
  const { positions } = buffer.arrays;
  const from = start.map((s, i) => s - buffer.origin[i]);
  let best = null;
  for (const side of sidesOf(buffer.arrays, hit.item)) {
    const nodes = side.sort((a, b) => a - b); // The same from both elements.
    const ends = nodes.flatMap((node) => [...positions.subarray(3 * node, 3 * node + 3)]);
    const near = nearestToRay(ends, 0, from, along);
    if (near.t < span[0] || near.t > span[1]) continue;
    const point = near.at.map((p, i) => p + buffer.origin[i]);
    const pixels = near.off / stage.pixelAt(point);
    if (pixels > SIDE_PIXELS || (best && best.pixels <= pixels)) continue;
    best = { nodes, point, pixels, direction: near.direction, distance: near.t };
  }
  // A side has a direction as an edge has, and no normal.
  return best && { ...hit, ...best, kind: 'side', normal: null, elements: elementsBeside(buffer, best.nodes) };
}
