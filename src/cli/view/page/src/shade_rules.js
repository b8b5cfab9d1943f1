// What each shade writes into the drawings and into the legend, by the first word of its name.

import { BufferAttribute } from 'three';
import { decidersOf, NOT_KNOWN } from './deciders.js';
import { inRanges } from './described.js';
import { MEASURES } from './quality.js';
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

const elementCount = ({ arrays }) => (arrays.triangles?.length ?? 0) / 3 + (arrays.quads?.length ?? 0) / 4;

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
    const groups = this.model.frame.things.filter((thing) => thing.kind === 'group').map((thing) => thing.name);
    for (const drawing of this.solids('mesh'))
      for (const { name } of drawing.buffer.header.groups ?? []) if (!groups.includes(name)) groups.push(name);
    const color = (name) => rgb(paletteColor(groups.indexOf(name)));
    const pale = rgb(theme.dark ? '#59636e' : '#cfd6dd');
    for (const drawing of this.model.drawings) {
      const mine = this.model.frame.things.find((thing) => thing.kind === 'group' && thing.of?.includes(drawing.name));
      if (drawing.role !== 'mesh') {
        if (mine && drawing.role !== 'edges') drawing.set({ color: paletteColor(groups.indexOf(mine.name)) });
        else if (drawing.role === 'faces') drawing.set({ color: theme.dark ? '#59636e' : '#cfd6dd' });
        continue;
      }
      const { header } = drawing.buffer;
      const first = header.first_element ?? 1;
      const owner = (i) => (header.groups ?? []).find((group) => inRanges(group.elements, i + first));
      paint(drawing, elementCount(drawing.buffer), (i) => {
        const group = owner(i);
        return group ? color(group.name) : mine ? color(mine.name) : pale;
      });
    }
    legend.entries = groups.map((name) => ({ name, color: paletteColor(groups.indexOf(name)) }));
    if (!groups.length) legend.note = 'The model has no groups.';
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

function curvature(legend, which) {
  const sample = [];
  const drawn = this.solids('faces').filter((drawing) => drawing.buffer.arrays.curvature);
  for (const drawing of drawn) {
    const { curvature: values } = drawing.buffer.arrays;
    const step = Math.max(1, Math.floor(values.length / 2 / 4000));
    for (let i = 0; i < values.length / 2; i += step)
      if (Number.isFinite(values[2 * i + which])) sample.push(Math.abs(values[2 * i + which]));
  }
  sample.sort((a, b) => a - b);
  const reach = sample[Math.floor(sample.length * 0.96)] ?? 0;
  for (const drawing of drawn) {
    drawing.set({ mode: 2, which, range: [0, reach || 1e-9] });
  }
  const units = this.model.frame.units;
  legend.scale = { from: -reach, to: reach, kind: 'ramp', unit: which === 0 ? `1/${units}²` : `1/${units}` };
  if (!drawn.length) Object.assign(legend, { scale: null, note: 'No surface that is shown has curvature.' });
}
