// How good elements are. A triangle and a quadrangle are measured by their corners; second-order nodes do not count.

/** The measures by name: what a value means, its unit and which end is bad. */
export const MEASURES = {
  angle: { title: 'Least angle', unit: '°', from: 0, to: 90, bad: 'low' },
  jacobian: { title: 'Scaled Jacobian', unit: '', from: -1, to: 1, bad: 'low' },
  length: { title: 'Edge length / asked', unit: '', from: 0, to: 2, bad: 'both' },
};

/** One value per element: triangles first, then quadrangles. */
export function measureElements(measure, { positions, triangles, quads, asked }) {
  const nt = (triangles?.length ?? 0) / 3;
  const nq = (quads?.length ?? 0) / 4;
  const values = new Float32Array(nt + nq);
  const one = measure === 'angle' ? leastAngle : measure === 'jacobian' ? scaledJacobian : lengthAgainstAsked;
  for (let t = 0; t < nt; t++) values[t] = one(positions, triangles, 3 * t, 3, asked);
  for (let q = 0; q < nq; q++) values[nt + q] = one(positions, quads, 4 * q, 4, asked);
  return values;
}

/** The two sides at corner `k`, written into `out`: first to the next corner, then to the one before. */
function sidesAt(p, ids, at, corners, k, out) {
  const a = 3 * ids[at + k];
  const b = 3 * ids[at + ((k + 1) % corners)];
  const c = 3 * ids[at + ((k + corners - 1) % corners)];
  for (let i = 0; i < 3; i++) {
    out[i] = p[b + i] - p[a + i];
    out[3 + i] = p[c + i] - p[a + i];
  }
}

const sides = new Float64Array(6);
const normal = new Float64Array(3);

function cross(s, out) {
  out[0] = s[1] * s[5] - s[2] * s[4];
  out[1] = s[2] * s[3] - s[0] * s[5];
  out[2] = s[0] * s[4] - s[1] * s[3];
}

function leastAngle(p, ids, at, corners) {
  let least = Infinity;
  for (let k = 0; k < corners; k++) {
    sidesAt(p, ids, at, corners, k, sides);
    cross(sides, normal);
    const dot = sides[0] * sides[3] + sides[1] * sides[4] + sides[2] * sides[5];
    const angle = Math.atan2(Math.hypot(normal[0], normal[1], normal[2]), dot);
    if (angle < least) least = angle;
  }
  return (least * 180) / Math.PI;
}

const mean = new Float64Array(3);

function scaledJacobian(p, ids, at, corners) {
  mean.fill(0);
  for (let k = 0; k < corners; k++) {
    sidesAt(p, ids, at, corners, k, sides);
    cross(sides, normal);
    for (let i = 0; i < 3; i++) mean[i] += normal[i];
  }
  const size = Math.hypot(mean[0], mean[1], mean[2]);
  if (size === 0) return 0;
  let least = Infinity;
  for (let k = 0; k < corners; k++) {
    sidesAt(p, ids, at, corners, k, sides);
    cross(sides, normal);
    const along = (normal[0] * mean[0] + normal[1] * mean[1] + normal[2] * mean[2]) / size;
    const lengths = Math.hypot(sides[0], sides[1], sides[2]) * Math.hypot(sides[3], sides[4], sides[5]);
    least = Math.min(least, lengths > 0 ? along / lengths : 0);
  }
  return corners === 3 ? (least * 2) / Math.sqrt(3) : least;
}

function lengthAgainstAsked(p, ids, at, corners, asked) {
  if (!asked) return NaN;
  let length = 0;
  let wanted = 0;
  for (let k = 0; k < corners; k++) {
    const [here, next] = [asked[ids[at + k]], asked[ids[at + ((k + 1) % corners)]]];
    // Where one end of a side asks nothing, the other end says it; where neither does, the side does not count.
    const own = Number.isNaN(here) ? next : Number.isNaN(next) ? here : (here + next) / 2;
    if (Number.isNaN(own)) continue;
    sidesAt(p, ids, at, corners, k, sides);
    length += Math.hypot(sides[0], sides[1], sides[2]);
    wanted += own;
  }
  return wanted > 0 ? length / wanted : NaN;
}

/** Sides of elements that belong to one element, or to three and more: `{ ends, counts }`, two node indices per side. */
export function openSides({ positions, triangles, quads }) {
  const nodes = positions.length / 3;
  const nt = (triangles?.length ?? 0) / 3;
  const nq = (quads?.length ?? 0) / 4;
  const keys = new Float64Array(3 * nt + 4 * nq);
  let n = 0;
  const put = (a, b) => (keys[n++] = a < b ? a * nodes + b : b * nodes + a);
  for (let t = 0; t < nt; t++) for (let k = 0; k < 3; k++) put(triangles[3 * t + k], triangles[3 * t + ((k + 1) % 3)]);
  for (let q = 0; q < nq; q++) for (let k = 0; k < 4; k++) put(quads[4 * q + k], quads[4 * q + ((k + 1) % 4)]);
  keys.sort();
  const ends = [];
  const counts = [];
  for (let i = 0; i < n;) {
    let j = i + 1;
    while (j < n && keys[j] === keys[i]) j++;
    if (j - i !== 2) {
      const a = Math.floor(keys[i] / nodes);
      ends.push(a, keys[i] - a * nodes);
      counts.push(Math.min(j - i, 3));
    }
    i = j;
  }
  return { ends: Uint32Array.from(ends), counts: Uint8Array.from(counts) };
}
