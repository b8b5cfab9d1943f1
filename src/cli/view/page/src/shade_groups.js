// The shade by group: the groups of the script first, then those that each mesh makes of its surfaces and shells.

import { elementCount } from './elements.js';
import { paletteColor, rgb, theme } from './theme.js';

/** `paint(drawing, count, color)` colours faces or elements. Groups that colour nothing that is shown are not in the legend. */
export function paintGroups(model, legend, paint) {
  const { things } = model.frame;
  const own = things.filter((thing) => thing.kind === 'group');
  const names = new Set(own.map((thing) => thing.name));
  const meshes = model.drawings.filter((drawing) => drawing.role === 'mesh');
  for (const { buffer } of meshes) for (const { name } of buffer.header.groups ?? []) names.add(name);

  const paleText = theme.dark ? '#59636e' : '#cfd6dd';
  const pale = rgb(paleText);
  // Beside groups of the script the others are faint.
  const colors = new Map();
  [...names].forEach((name, k) => {
    const faint = own.length > 0 && k >= own.length ? 0.6 : 0;
    colors.set(
      name,
      rgb(paletteColor(k)).map((c, i) => c + (pale[i] - c) * faint),
    );
  });
  const seen = new Set();
  const see = (drawing, name) => drawing.object.visible && seen.add(name);
  const color = (name) => (name === undefined ? pale : colors.get(name));

  const faces = groupsOfFaces(model, own, [...names].slice(own.length));
  for (const drawing of model.drawings) {
    if (drawing.role === 'edges') continue;
    if (drawing.isSolid) {
      const count = drawing.role === 'mesh' ? elementCount(drawing.buffer) : (drawing.buffer.header.faces?.length ?? 1);
      const of = drawing.role === 'mesh' ? groupsOfElements(drawing.buffer, own) : (faces.get(drawing) ?? []);
      for (let i = 0; i < count; i++) if (of[i] !== undefined) see(drawing, of[i]);
      paint(drawing, count, (i) => color(of[i]));
      continue;
    }
    const mine = own.find((thing) => thing.of?.includes(drawing.name));
    if (!mine) continue;
    see(drawing, mine.name);
    drawing.set({ color: paletteColor(own.indexOf(mine)) });
  }
  legend.entries = [...names].filter((name) => seen.has(name)).map((name) => ({ name, color: text(colors.get(name)) }));
  if (!names.size) legend.note = 'The model has no groups.';
  else if (!seen.size) legend.note = 'Nothing that is shown is in a group.';
}

const text = (color) => `#${color.map((c) => Math.round(c * 255).toString(16).padStart(2, '0')).join('')}`;

/** The group of each face, by drawing; of several the first. */
function groupsOfFaces(model, own, automatic) {
  const found = new Map();
  const take = (name, drawing, faces) => {
    if (!found.has(drawing)) found.set(drawing, []);
    const list = found.get(drawing);
    for (const face of faces) list[face] ??= name;
  };
  for (const { name, surfaces } of own)
    for (const one of surfaces ?? []) for (const [drawing, faces] of model.faces.of(one)) take(name, drawing, faces);
  for (const name of automatic) {
    for (const [drawing, faces] of model.faces.of(name)) take(name, drawing, faces);
    const shell = model.thing(name);
    for (const { drawing, faces } of shell?.kind === 'shell' ? model.partsOf(shell) : [])
      take(name, drawing, faces ?? (drawing.buffer.header.faces ?? []).keys());
  }
  return found;
}

/** The group of each element of a mesh; of several the first, those of the script before others. */
function groupsOfElements({ header }, own) {
  const first = header.first_element ?? 1;
  const list = [];
  const isOwn = ({ name }) => own.some((thing) => thing.name === name);
  const groups = header.groups ?? [];
  for (const { name, elements } of [...groups.filter(isOwn), ...groups.filter((group) => !isOwn(group))])
    for (const [low, high] of elements) for (let i = low - first; i <= high - first; i++) list[i] ??= name;
  return list;
}
