// Models made by hand, as frames of the viewer's protocol.

import { curve, mesh, points, surface } from './fake_buffers.mjs';

const place = (line, column = 1, label = null, end = column + 8) => ({ file: 0, line, column, end_line: line, end_column: end, label });

export function thing(name, kind, buffers, line, more = {}) {
  return {
    name,
    kind,
    of: [],
    surfaces: [],
    chain: [place(line, 1, `${kind} ${name}`), place(2, 1, 'fn profile')],
    facts: [['area', '3.2 m²']],
    buffers: buffers.map(({ key, bytes, role }) => ({ key, bytes: bytes.length, role })),
    visible: kind !== 'mesh',
    color: null,
    unmade: null,
    stale: false,
    ...more,
  };
}

const SCRIPT = `units m                       // a roof over four corners
fn profile(h) = arc(SW, SE, through: (2, 0, h))
param rise = 1.2m in 0.2m to 3m
param count = 4 in 1 to 12
point SW = (0, 0, 0)
curve south = profile(rise)
surface roof = coons(south, east, north, west)
surface wall = extrude(south, (0, 0, -2))
mesh plate of roof { size: 300mm }
check "high enough": rise > 1m
report areas of roof
export plate to "roof.msh"
`;

/** A frame with all its parts; what is given replaces the empty ones. */
export function frame(number, buffers, things, more = {}) {
  const boxes = buffers.map(({ bytes }) => JSON.parse(bytes.subarray(8, 8 + bytes.readUInt32LE(4)).toString()).box);
  const box = boxes.length
    ? [0, 1].map((side) => [0, 1, 2].map((i) => (side ? Math.max : Math.min)(...boxes.map((b) => b[side][i]))))
    : null;
  return {
    frame: {
      loft: 1,
      number,
      model: 'roof.loft',
      title: 'roof.loft',
      units: 'm',
      ok: true,
      stale: false,
      drawn: number,
      seconds: 0.004,
      box,
      chord_error: 0.01,
      things,
      sources: [{ file: 'roof.loft', path: '/models/roof.loft', text: SCRIPT }],
      params: [],
      diagnostics: [],
      checks: [],
      reports: [],
      pictures: [],
      outputs: [],
      compare: null,
      ...more,
    },
    buffers: new Map(buffers.map((one) => [one.key, one.bytes])),
  };
}

const arch =
  (rise, shift, depth = 3) =>
  (u, v) => [shift + 2 * u, depth * v, rise * Math.sin((Math.PI * (shift + 2 * u)) / 4) * (1 + 0.25 * Math.sin(Math.PI * v))];

const PLATE = [14, 10]; // Cells of the mesh `plate`.

/** Where node `i` of row `j` of the plate is, for the rise that the roof has without more. */
export const plateNode = (i, j) => arch(1.2, 0)((2 * i) / PLATE[0], j / PLATE[1]);

/** A small roof with everything that a frame can hold; `broken` opens a gap in it. */
export function roof(number, { rise = 1.2, set = {}, broken = false, origin = [0, 0, 0], compare = null, script = SCRIPT } = {}) {
  const roofs = surface('roof', [arch(rise, 0), arch(rise, 2)], { origin });
  const walls = surface('wall', [(u, v) => [4 * u, 0, rise * Math.sin(Math.PI * u) * v - 2 * (1 - v)]], { origin });
  const tank = surface('tank', box([5, 0.5, -1], [1.5, 1.5, 1.5]), { origin, cells: [4, 4], closed: true });
  const south = curve('south', (t) => [4 * t, 0, rise * Math.sin(Math.PI * t)], origin);
  const corners = points(
    ['SW', 'SE', 'NE', 'NW'],
    [
      [0, 0, 0],
      [4, 0, 0],
      [4, 3, 0],
      [0, 3, 0],
    ],
    origin,
  );
  const plate = mesh((u, v) => arch(rise, 0)(2 * u, v), ...PLATE, origin);
  const buffers = [...roofs, ...walls, ...tank, south, corners, plate];
  const other = compare ? surface('roof', [arch(rise * 0.8, 0), arch(rise * 0.8, 2)], { origin }) : [];
  const at = (p) => p.map((x, i) => x + origin[i]);
  const params = [
    {
      name: 'rise',
      text: `${rise} m`,
      value: rise,
      unit: 'm',
      kind: 'length',
      min: 0.2,
      max: 3,
      choices: [],
      set: 'rise' in set,
      place: place(3),
      family: null,
    },
    {
      name: 'count',
      text: '4',
      value: 4,
      unit: null,
      kind: 'count',
      min: 1,
      max: 12,
      choices: [],
      set: false,
      place: place(4),
      family: null,
    },
    {
      name: 'title',
      text: '"a roof"',
      value: null,
      unit: null,
      kind: 'text',
      min: null,
      max: null,
      choices: [],
      set: false,
      place: place(4),
      family: 'drawing',
    },
    {
      name: 'closed',
      text: 'true',
      value: true,
      unit: null,
      kind: 'bool',
      min: null,
      max: null,
      choices: [],
      set: false,
      place: place(4),
      family: 'drawing',
    },
  ];
  const things = [
    thing('SW', 'point', [corners], 5),
    thing('south', 'curve', [south], 6),
    thing('roof', 'surface', roofs, 7, broken ? { stale: true } : {}),
    thing('wall', 'surface', walls, 8),
    thing('tank', 'shell', tank, 8),
    thing('plate', 'mesh', [plate], 9, { of: ['roof'] }),
    thing('all_of_it', 'group', [], 9, { of: ['roof', 'wall'], surfaces: ['roof', 'wall'] }),
  ];
  if (broken) things.push(thing('porch', 'surface', [], 8, { unmade: 'its border is open' }));
  const made = frame(number, [...buffers, ...other], things, {
    ok: !broken && rise > 1,
    params,
    sources: [{ file: 'roof.loft', path: '/models/roof.loft', text: script }],
    stale: broken,
    drawn: broken ? number - 1 : number,
    diagnostics: broken
      ? [
          {
            severity: 'error',
            code: 'E501',
            message: 'the border of wall has a gap of 0.12 m',
            help: 'snap the ends, or draw the curve between them',
            places: [place(8, 9), place(6, 1, 'ends here')],
            points: [at([4, 0, 0]), at([4.12, 0, 0.02])],
            size: 0.12,
            things: ['wall'],
          },
        ]
      : [],
    checks: [
      { name: 'high enough', text: 'rise > 1m', pass: rise > 1, found: `${rise} m`, place: place(10), things: ['roof'] },
      { name: 'two patches', text: 'len(roof.patches) == 2', pass: true, found: null, place: place(10), things: ['roof'] },
    ],
    reports: [
      {
        name: 'areas',
        title: 'Areas',
        columns: ['name', 'area'],
        units: ['', 'm²'],
        rows: [
          ['roof', 12.5],
          ['wall', 3.25],
          ['tank', null],
        ],
        place: place(11),
      },
    ],
    pictures: [{ path: 'roof.svg', place: place(12) }],
    outputs: [{ path: 'roof.msh', place: place(12) }],
    compare: compare ? { with: compare, moved: { largest: 0.24 }, things: [thing('roof', 'surface', other, 7)] } : null,
  });
  return made;
}

/** The six faces of a box, with their front sides outwards. */
export function box(low, size) {
  const at = (u, v, w) => [low[0] + size[0] * u, low[1] + size[1] * v, low[2] + size[2] * w];
  return [
    (u, v) => at(v, u, 0),
    (u, v) => at(u, v, 1),
    (u, v) => at(u, 0, v),
    (u, v) => at(v, 1, u),
    (u, v) => at(0, v, u),
    (u, v) => at(1, u, v),
  ];
}

/** One surface of `n` by `n` cells, and a curve, so that picks have something to search. */
export function large(number, n = 707) {
  const wave = (u, v) => [10 * u, 10 * v, Math.sin(9 * u) * Math.cos(7 * v)];
  const faces = surface('wave', [wave], { cells: [n, n] });
  return frame(number, faces, [thing('wave', 'surface', faces, 7)]);
}

/** A mesh of `2 n²` triangles. */
export function largeMesh(number, n = 707) {
  const wave = (u, v) => [10 * u, 10 * v, Math.sin(9 * (u - 0.5)) * Math.cos(7 * v)];
  const made = mesh(wave, n, n, [0, 0, 0], 1);
  return frame(number, [made], [thing('net', 'mesh', [made], 9, { visible: true })]);
}

/**
 * A model while its evaluation still runs: shapes, but nothing of checks and tables. Its meshes are those of `before`,
 * not there at all, or listed without buffers.
 */
export function partial(model, { before = null, listed = false } = {}) {
  const things = model.frame.things.flatMap((one) => {
    if (one.kind !== 'mesh') return [one];
    const old = before?.frame.things.find(({ name }) => name === one.name);
    if (old) return [{ ...one, buffers: old.buffers, stale: true, pending: true }];
    return listed ? [{ ...one, buffers: [], unmade: null, pending: true }] : [];
  });
  const { loft, number, title, units, box, chord_error, sources, params } = model.frame;
  const nothing = { checks: [], reports: [], diagnostics: [], pictures: [], outputs: [], compare: null, ok: false, seconds: 0 };
  return {
    frame: { loft, number, title, units, box, chord_error, sources, params, things, ...nothing, partial: true },
    buffers: new Map([...(before?.buffers ?? []), ...model.buffers]),
  };
}
