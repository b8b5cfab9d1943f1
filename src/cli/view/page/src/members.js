// Members of a thing that is drawn as one because it has many: their names, and what a click on one picks.

/** The name of the member that a face or an edge belongs to: `rib[3]` of `rib[3].patches[1]`. */
const memberOf = (name) => name?.match(/^[^[]*(\[[^\]]*\])+/)?.[0] ?? name;

const NAMES = {
  faces: ({ faces }) => (faces ?? []).map(({ name }) => name),
  lines: ({ edges }) => (edges ?? []).map(({ name }) => name),
  points: ({ names }) => names ?? [],
};

/** Whether a thing has members that are no things of their own. */
export const hasMembers = (thing) => (thing.facts ?? []).some(([name]) => name === 'members');

/** Each member of a thing once: `{ name, drawing, item }`. */
export function membersOf(thing, drawings) {
  const found = new Map();
  for (const drawing of hasMembers(thing) ? drawings : []) {
    if (drawing.name !== thing.name || !NAMES[drawing.role]) continue;
    NAMES[drawing.role](drawing.buffer.header).forEach((full, item) => {
      const name = memberOf(full);
      if (!found.has(name)) found.set(name, { name, drawing, item });
    });
  }
  return [...found.values()];
}

/** The pick of a member, as a click into its middle gives it. */
export function pickOf({ drawing, item }) {
  const { arrays, origin, index } = drawing.buffer;
  const p = arrays.positions;
  const corner = (n) => [p[3 * n], p[3 * n + 1], p[3 * n + 2]];
  const at = (corners) => origin.map((o, k) => o + corners.reduce((sum, n) => sum + p[3 * n + k] / corners.length, 0));
  if (drawing.role === 'points') return { drawing, kind: 'point', item, point: at([item]) };
  if (drawing.role === 'faces') {
    const triangle = Math.max(arrays.face?.indexOf(item) ?? 0, 0);
    const corners = [...index.slice(3 * triangle, 3 * triangle + 3)];
    const [a, b, c] = corners.map(corner);
    return { drawing, kind: 'face', item, triangle, point: at(corners), normal: unit(cross(minus(b, a), minus(c, a))) };
  }
  const first = arrays.starts[item] + ((arrays.starts[item + 1] - arrays.starts[item] - 1) >> 1);
  return { drawing, kind: 'edge', item, point: at([first]), direction: unit(minus(corner(first + 1), corner(first))) };
}

const minus = (a, b) => a.map((x, k) => x - b[k]);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => a.map((x) => x / (Math.hypot(...a) || 1));
