// What lies over the picture as text: places of diagnostics with the size of a gap, and the measure between two picks.

import { element, shortNumber } from './dom.js';

const SVG = 'http://www.w3.org/2000/svg';

export class Marks {
  constructor(stage, layer, onDiagnostic) {
    Object.assign(this, { stage, layer, onDiagnostic, marks: [] });
    this.lines = document.createElementNS(SVG, 'svg');
    this.lines.setAttribute('aria-hidden', 'true');
    layer.append(this.lines);
    stage.after.push(() => this.place());
  }

  /** Makes the marks of a frame anew; a gap of two points is a line with its size. */
  setDiagnostics(diagnostics, units) {
    this.clear('diagnostic');
    diagnostics.forEach((diagnostic, number) => {
      const points = diagnostic.points ?? [];
      const gap = points.length === 2 && diagnostic.size != null;
      const size = diagnostic.size != null ? `${shortNumber(diagnostic.size, 4)} ${units}` : null;
      const text = [diagnostic.code, gap || size ? size : null].filter(Boolean).join(' · ');
      const open = () => this.onDiagnostic(diagnostic, number);
      if (points.length === 0) return;
      // Notes are small spots, so that they do not hide the model; errors and warnings have their text beside them.
      const small = diagnostic.severity === 'note';
      const label = element('button', {
        type: 'button',
        class: `${small ? 'spot' : 'mark'} ${diagnostic.severity}`,
        text: small ? null : text || diagnostic.severity,
        title: `${diagnostic.code ?? diagnostic.severity}: ${diagnostic.message}`,
        'aria-label': `${diagnostic.code ?? diagnostic.severity}: ${diagnostic.message}`,
        onclick: open,
      });
      this.add('diagnostic', gap ? middle(points[0], points[1]) : points[0], label, small);
      if (small) return;
      for (const point of points.slice(0, 50))
        this.add('diagnostic', point, element('span', { class: `spot ${diagnostic.severity}` }), true);
      if (gap) this.addLine('diagnostic', points[0], points[1], diagnostic.severity);
    });
    this.place();
  }

  setMeasure(first, second, text) {
    this.clear('measure');
    for (const hit of [first, second]) if (hit) this.add('measure', hit.point, element('span', { class: 'spot measure' }), true);
    if (first && second) {
      this.addLine('measure', first.point, second.point, 'measure');
      this.add('measure', middle(first.point, second.point), element('span', { class: 'mark measure', text }));
    }
    this.place();
  }

  clear(group) {
    for (const mark of this.marks) if (mark.group === group) mark.node.remove();
    this.marks = this.marks.filter((mark) => mark.group !== group);
  }

  add(group, point, node, centred = false) {
    this.layer.append(node);
    this.marks.push({ group, point, node, centred });
  }

  addLine(group, from, to, kind) {
    const node = document.createElementNS(SVG, 'line');
    node.setAttribute('class', `between ${kind}`);
    this.lines.append(node);
    this.marks.push({ group, from, to, node });
  }

  place() {
    for (const { point, from, to, node, centred } of this.marks) {
      if (from) {
        const [a, b] = [this.stage.toScreen(from), this.stage.toScreen(to)];
        node.style.display = a && b ? '' : 'none';
        if (a && b) ['x1', 'y1', 'x2', 'y2'].forEach((name, i) => node.setAttribute(name, [a[0], a[1], b[0], b[1]][i].toFixed(1)));
        continue;
      }
      const at = this.stage.toScreen(point);
      const { width, height } = this.stage.size;
      const inside = at && at[0] > -50 && at[1] > -50 && at[0] < width + 50 && at[1] < height + 50;
      node.style.display = inside ? '' : 'none';
      if (inside)
        node.style.transform = `translate(${at[0].toFixed(1)}px, ${at[1].toFixed(1)}px) translate(${centred ? '-50%, -50%' : '10px, -130%'})`;
    }
  }
}

const middle = (a, b) => a.map((x, i) => (x + b[i]) / 2);

/** The three axes in the corner, which turn with the view; a click on one looks along it. */
export function axes(stage, holder, look) {
  const ends = [
    ['x', 'right'],
    ['y', 'back'],
    ['z', 'top'],
  ];
  const svg = document.createElementNS(SVG, 'svg');
  svg.setAttribute('viewBox', '-40 -40 80 80');
  svg.setAttribute('aria-hidden', 'true');
  const parts = ends.map(([name, view]) => {
    const group = document.createElementNS(SVG, 'g');
    group.setAttribute('class', `axis ${name}`);
    const line = document.createElementNS(SVG, 'line');
    const disc = document.createElementNS(SVG, 'circle');
    const text = document.createElementNS(SVG, 'text');
    disc.setAttribute('r', '8');
    text.textContent = name.toUpperCase();
    group.append(line, disc, text);
    group.addEventListener('click', () => look(view));
    return { group, line, disc, text };
  });
  svg.append(...parts.map((part) => part.group));
  holder.append(svg);
  stage.after.push((camera) => {
    const m = camera.matrixWorldInverse.elements;
    const order = parts.map((part, i) => ({ part, x: m[4 * i] * 27, y: -m[4 * i + 1] * 27, z: m[4 * i + 2] })).sort((a, b) => a.z - b.z);
    for (const { part, x, y } of order) {
      part.line.setAttribute('x2', x.toFixed(2));
      part.line.setAttribute('y2', y.toFixed(2));
      for (const [node, nx, ny] of [
        [part.disc, 'cx', 'cy'],
        [part.text, 'x', 'y'],
      ]) {
        node.setAttribute(nx, x.toFixed(2));
        node.setAttribute(ny, y.toFixed(2));
      }
      svg.append(part.group);
    }
  });
}
