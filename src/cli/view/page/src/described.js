// What is shown of a pick: name, kind, size, coordinates, neighbours; and what lies between two picks.

import { askedFacts } from './deciders.js';
import { coordinate, shortNumber } from './dom.js';
import { cornersOf } from './elements.js';

/** `{ title, kind, facts: [[name, value]], neighbours: [{ name, item }] }` of a pick. */
export function describe(hit, units, radius) {
  const { drawing, item, kind, point } = hit;
  const { header, arrays } = drawing.buffer;
  const facts = [];
  let title = drawing.name;
  let neighbours = [];
  if (kind === 'face') {
    const face = header.faces?.[item];
    title = face?.name ?? `${drawing.name}, face ${item}`;
    if (face?.area != null) facts.push(['area', `${shortNumber(face.area)} ${units}²`]);
    neighbours = (face?.neighbours ?? []).map((n) => ({ name: header.faces[n]?.name ?? `face ${n}`, item: n }));
  } else if (kind === 'edge') {
    const edge = drawing.role === 'bars' ? { name: `${drawing.name}, line element ${item + 1}` } : header.edges?.[item];
    title = edge?.name ?? `${drawing.name}, edge ${item}`;
    if (edge?.length != null) facts.push(['length', `${shortNumber(edge.length)} ${units}`]);
    if (edge?.curve) facts.push(['curve', edge.curve]);
    const meeting = arrays.faces?.[item];
    if (meeting) facts.push(['faces that meet', String(meeting)]);
    neighbours = (edge?.faces ?? []).map((n) => ({ name: drawing.faceName?.(n) ?? `face ${n}`, item: n }));
  } else if (kind === 'point') {
    title = header.names?.[item] ?? `${drawing.name}[${item}]`;
  } else {
    const numberOf = (n) => n + (header.first_element ?? 1);
    const number = numberOf(item);
    const idOf = (n) => arrays.ids?.[n] ?? n + 1;
    const length = (value) => `${shortNumber(value)} ${units}`;
    if (kind === 'node') {
      title = `${drawing.name}, node ${idOf(hit.node)}`;
      facts.push(...askedFacts(drawing.buffer, [hit.node], length));
      facts.push(['in element', String(number)]);
    } else if (kind === 'side') {
      title = `${drawing.name}, side ${hit.nodes.map(idOf).join('–')}`;
      facts.push(['nodes', hit.nodes.map(idOf).join(', ')]);
      facts.push(['length', length(lengthOf(arrays.positions, hit.nodes))]);
      facts.push(...askedFacts(drawing.buffer, hit.nodes, length));
      const beside = hit.elements.map(numberOf).join(', ');
      facts.push(hit.elements.length === 1 ? ['free side of element', beside] : ['between elements', beside]);
    } else {
      const corners = cornersOf(arrays, item);
      title = `${drawing.name}, element ${number}`;
      facts.push(['shape', corners.length === 3 ? 'triangle' : 'quadrangle']);
      facts.push(['nodes', corners.map(idOf).join(', ')]);
      facts.push(['area', `${shortNumber(areaOf(arrays.positions, corners))} ${units}²`]);
      facts.push(...askedFacts(drawing.buffer, corners, length));
      const groups = (header.groups ?? []).filter((g) => inRanges(g.elements, number)).map((g) => g.name);
      if (groups.length) facts.push(['groups', groups.join(', ')]);
      const face = header.faces?.[arrays.face?.[item]];
      if (face) facts.push(['on', face.name]);
    }
  }
  ['x', 'y', 'z'].forEach((name, i) => facts.push([name, `${coordinate(point[i], radius)} ${units}`]));
  return { title, kind, facts, neighbours };
}

export const inRanges = (ranges, number) => (ranges ?? []).some(([from, to]) => number >= from && number <= to);

const lengthOf = (p, [a, b]) => Math.hypot(...[0, 1, 2].map((i) => p[3 * b + i] - p[3 * a + i]));

function areaOf(p, corners) {
  let area = 0;
  for (let k = 1; k + 1 < corners.length; k++) {
    const [a, b, c] = [corners[0], corners[k], corners[k + 1]].map((n) => 3 * n);
    const u = [0, 1, 2].map((i) => p[b + i] - p[a + i]);
    const v = [0, 1, 2].map((i) => p[c + i] - p[a + i]);
    area += Math.hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]) / 2;
  }
  return area;
}

/** Distance and angle between two picks. The angle is between normals or directions, where both have one. */
export function between(first, second, units, radius) {
  const step = first.point.map((p, i) => second.point[i] - p);
  const facts = [['distance', `${coordinate(Math.hypot(...step), radius)} ${units}`]];
  ['Δx', 'Δy', 'Δz'].forEach((name, i) => facts.push([name, `${coordinate(step[i], radius)} ${units}`]));
  const [a, b] = [first.normal ?? first.direction, second.normal ?? second.direction];
  if (a && b) {
    const dot = a.reduce((sum, x, i) => sum + x * b[i], 0);
    const cross = Math.hypot(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
    let angle = (Math.atan2(cross, Math.abs(dot)) * 180) / Math.PI;
    // A normal and a direction: the angle between plane and line.
    if (Boolean(first.normal) !== Boolean(second.normal)) angle = 90 - angle;
    facts.push(['angle', `${shortNumber(angle, 5)}°`]);
  }
  return facts;
}
