// What each shade writes into the drawings and into the legend, by the first word of its name.

import { BufferAttribute } from 'three';
import { decidersOf, NOT_KNOWN } from './deciders.js';
import { elementCount } from './elements.js';
import { MEASURES } from './quality.js';
import { paintGroups } from './shade_groups.js';
import { ask } from './tasks.js';
import { goodness, paletteColor, rgb, theme } from './theme.js';

/** Colours of a list of items: `color(i)` gives three numbers, or null for an item that is not drawn. */
function paint(drawing, count, color) {
  drawing.setColors(count, (bytes) => {
    for (let i = 0; i < count; i++) {
      const c = color(i);
      if (!c) {
        bytes[4 * i + 3] = 0;
        continue;
      }
      for (let k = 0; k < 3; k++) bytes[4 * i + k] = Math.round(c[k] * 255);
      bytes[4 * i + 3] = 255;
    }
  });
  drawing.set({ mode: 1 });
}

const UNKNOWN = [0.6, 0.6, 0.6]; // Elements of which a shade can say nothing.

/** Each is called with the shades as `this`; one that measures first is a promise. */
export const RULES = {
  patch(legend) {
    for (const drawing of this.solids()) {
      const { header, arrays } = drawing.buffer;
      // Patches of one thing differ, and so do things of one patch each.
      const shift = this.model.frame.things.findIndex((thing) => thing.name === drawing.name) * 3;
      const color = (face) => rgb(paletteColor(face + shift));
      if (drawing.role === 'faces') paint(drawing, header.faces?.length ?? 1, color);
      else paint(drawing, elementCount(drawing.buffer), (i) => color(arrays.face?.[i] ?? 0));
    }
    legend.note = 'Each patch has a colour of its own.';
  },

  group(legend) {
    paintGroups(this.model, legend, paint);
  },

  mesh(legend) {
    if (!this.solids('mesh').length) legend.note = 'The model has no mesh.';
  },

  async quality(legend, shade, current) {
    const measure = shade.split('-')[1];
    const about = MEASURES[measure];
    const meshes = this.solids('mesh').filter((drawing) => drawing.object.visible);
    if (!meshes.length) {
      legend.note = 'No mesh is shown.';
      return;
    }
    const found = await Promise.all(meshes.map((drawing) => drawing.buffer.find('quality', { measure })));
    if (!current()) return;
    const share = (value) =>
      about.bad === 'both' ? 1 - Math.abs(value - 1) : (value - about.from) / (measure === 'angle' ? 60 : about.to);
    const brush = Array.isArray(this.brush) ? this.brush : null;
    const inside = (value) => !brush || (value >= brush[0] && value <= brush[1]);
    meshes.forEach((drawing, m) => {
      const values = found[m];
      paint(drawing, values.length, (i) =>
        Number.isNaN(values[i]) ? (brush ? null : UNKNOWN) : inside(values[i]) ? goodness(share(values[i])) : null,
      );
      if (brush) drawing.filter = (i) => inside(values[i]);
    });
    legend.histogram = { ...about, measure, values: found, brush, color: (value) => goodness(share(value)) };
    const elements = found.reduce((sum, values) => sum + values.length, 0);
    const unknown = found.reduce((sum, values) => sum + values.reduce((n, value) => n + Number.isNaN(value), 0), 0);
    if (unknown === elements) legend.note = 'The mesh does not tell what edge length was asked.';
    else if (unknown > 0) legend.note = `${unknown} more are grey: what was asked there is not known.`;
  },

  decided(legend) {
    const meshes = this.solids('mesh').filter((drawing) => drawing.object.visible && drawing.buffer.arrays.decided);
    if (!meshes.length) {
      legend.note = 'No mesh that is shown tells what decided its sizes.';
      return;
    }
    const entries = new Map(); // By name: meshes may have the same deciders.
    const entryOf = (name) => {
      const color = name === NOT_KNOWN ? '#999999' : paletteColor([...entries.keys()].filter((one) => one !== NOT_KNOWN).length);
      if (!entries.has(name)) entries.set(name, { name, color, rgb: rgb(color), count: 0 });
      return entries.get(name);
    };
    const found = meshes.map((drawing) => {
      const own = (drawing.buffer.header.deciders ?? []).map(entryOf);
      const unknown = entryOf(NOT_KNOWN);
      const numbers = decidersOf(drawing.buffer);
      for (const n of numbers) (own[n] ?? unknown).count++;
      return { drawing, numbers, of: (i) => own[numbers[i]] ?? unknown };
    });
    const chosen = entries.get(this.brush)?.count ? entries.get(this.brush) : null;
    for (const { drawing, numbers, of } of found) {
      const inside = (i) => !chosen || of(i) === chosen;
      paint(drawing, numbers.length, (i) => (inside(i) ? of(i).rgb : null));
      if (chosen) drawing.filter = inside;
    }
    const total = found.reduce((sum, { numbers }) => sum + numbers.length, 0);
    legend.entries = [...entries.values()]
      .filter(({ count }) => count > 0)
      .sort((a, b) => (a.name === NOT_KNOWN) - (b.name === NOT_KNOWN) || b.count - a.count)
      .map((entry) => ({ ...entry, share: entry.count / total, chosen: entry === chosen }));
    legend.note = chosen ? `${chosen.count} of ${total} elements` : `${total} elements`;
  },

  gauss(legend) {
    curvature.call(this, legend, 0);
  },

  mean(legend) {
    curvature.call(this, legend, 1);
  },

  zebra() {
    for (const drawing of this.solids()) drawing.set({ mode: 3 });
  },

  side(legend) {
    for (const drawing of this.solids()) drawing.set({ mode: 4 });
    legend.entries = [
      { name: 'front side', color: '#739ecc' },
      { name: 'back side', color: '#e67a33' },
    ];
  },

  async edges(legend, shade, current) {
    let [free, three] = [0, 0];
    const refresh = () => {
      legend.entries = [
        { name: `free: ${free}`, color: theme.loose },
        { name: `of three faces and more: ${three}`, color: theme.triple },
        { name: 'of two faces', color: theme.ink },
      ];
    };
    for (const drawing of this.model.drawings) {
      if (drawing.isSolid) drawing.set({ color: theme.dark ? '#59636e' : '#dfe4e9' });
      if (drawing.role !== 'edges') continue;
      const meeting = drawing.buffer.arrays.faces;
      const count = drawing.buffer.arrays.starts.length - 1;
      drawing.setColors(count, (bytes) => {
        for (let e = 0; e < count; e++) {
          const n = meeting?.[e] ?? 0;
          if (n === 1) free++;
          if (n > 2) three++;
          const c = rgb(n === 1 ? theme.loose : n > 2 ? theme.triple : theme.ink);
          for (let k = 0; k < 3; k++) bytes[4 * e + k] = c[k] * 255;
          bytes[4 * e + 3] = n === 1 || n > 2 ? 190 : 40;
        }
      });
      drawing.set({ mode: 1 });
    }
    refresh();
    for (const drawing of this.solids('mesh').filter((one) => one.object.visible)) {
      const { ends, counts } = await drawing.buffer.find('sides');
      if (!current()) return;
      for (const n of counts) n === 1 ? free++ : three++;
      if (counts.length > 0) this.sides.push(this.drawSides(drawing, ends, counts));
    }
    refresh();
  },

  async moved(legend, shade, current) {
    const { compare } = this.model.frame;
    if (!compare || compare.pending || compare.failed) {
      legend.note = compare?.pending ? 'The other state is being evaluated.' : 'Choose a state to compare with first.';
      return;
    }
    legend.note = 'Measuring…';
    let largest = 0;
    const jobs = this.solids('faces').map(async (drawing) => {
      const other = this.model.compared.find((d) => d.name === drawing.name && d.role === 'faces');
      if (!other) return null;
      const points = drawing.object.geometry.getAttribute('position').array;
      const shift = other.buffer.origin.map((o, i) => o - drawing.buffer.origin[i]);
      const { positions, triangles } = other.buffer.arrays;
      const far = await ask(
        'distances',
        () => ({ points: points.slice(), positions: positions.slice(), index: triangles.slice(), shift }),
        current,
      );
      return { drawing, far };
    });
    const found = (await Promise.all(jobs)).filter(Boolean);
    if (!current()) return;
    for (const { far } of found) for (const d of far) if (d > largest) largest = d;
    for (const { drawing, far } of found) {
      drawing.object.geometry.setAttribute('moved', new BufferAttribute(far, 1));
      drawing.set({ mode: 5, range: [0, largest || 1] });
    }
    for (const drawing of this.model.compared) drawing.set({ opacity: drawing.isSolid ? 0.12 : 0.5 });
    legend.note = null;
    legend.scale = { from: 0, to: largest, kind: 'rise', unit: this.model.frame.units };
  },
};

// The share of the area that is bent whose curvature lies inside the scale: a few sharp places do not take all colours.
const MOST = 0.95;
// The turn of the normal over the size of the model below which a place is flat.
const FLAT = 1e-4;

function curvature(legend, which) {
  const drawn = this.solids('faces').filter((drawing) => drawing.buffer.arrays.curvature);
  const flat = (FLAT / (2 * this.stage.sphere().radius)) ** (which === 0 ? 2 : 1);
  const reach = reachOf(
    drawn.filter((drawing) => drawing.object.visible).flatMap((drawing) => bent(drawing.buffer.arrays, which, flat)),
  );
  for (const drawing of drawn) {
    drawing.set({ mode: 2, which, range: [0, reach || 1e-9] });
  }
  const units = this.model.frame.units;
  legend.scale = { from: -reach, to: reach, kind: 'ramp', unit: which === 0 ? `1/${units}²` : `1/${units}` };
  if (!drawn.length) Object.assign(legend, { scale: null, note: 'No surface that is shown has curvature.' });
}

/** Sizes of curvatures above `flat` with the areas that have them, of some thousand triangles. */
function bent({ positions: p, triangles, curvature: values }, which, flat) {
  const found = [];
  const step = Math.max(1, Math.floor(triangles.length / 3 / 4000));
  for (let t = 0; t < triangles.length / 3; t += step) {
    const corners = triangles.subarray(3 * t, 3 * t + 3);
    const [a, b, c] = corners;
    const [u, v] = [b, c].map((k) => [0, 1, 2].map((i) => p[3 * k + i] - p[3 * a + i]));
    const area = step * Math.hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]);
    for (const k of corners) {
      const size = Math.abs(values[2 * k + which]);
      if (size > flat && size < Infinity) found.push({ size, area });
    }
  }
  return found;
}

/** The size that nearly all of the area is below. */
function reachOf(places) {
  places.sort((a, b) => a.size - b.size);
  const wanted = MOST * places.reduce((sum, { area }) => sum + area, 0);
  let below = 0;
  return places.find(({ area }) => (below += area) >= wanted)?.size ?? 0;
}
