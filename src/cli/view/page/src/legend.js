// What the colours mean: a list, a scale, or a histogram in which a range can be brushed.

import { element, shortNumber } from './dom.js';

const BARS = 40;

export function createLegend(holder, onBrush) {
  let now = null;

  function show(legend) {
    now = legend;
    const parts = [];
    if (legend.entries?.length) {
      parts.push(
        element(
          'ul',
          { class: 'swatches' },
          legend.entries.map((entry) => element('li', {}, entry.share === undefined ? swatch(entry) : choice(entry))),
        ),
      );
    }
    if (legend.scale) {
      const { from, to, kind, unit } = legend.scale;
      parts.push(
        element('div', { class: `scale ${kind}` }),
        element(
          'div',
          { class: 'ends' },
          element('span', { text: shortNumber(from, 3) }),
          element('span', { text: unit }),
          element('span', { text: shortNumber(to, 3) }),
        ),
      );
    }
    if (legend.histogram) parts.push(...histogram(legend.histogram));
    if (legend.note) parts.push(element('p', { text: legend.note }));
    const focused = document.activeElement?.dataset?.entry;
    holder.replaceChildren(...parts);
    if (focused !== undefined) holder.querySelector(`[data-entry="${CSS.escape(focused)}"]`)?.focus();
    holder.hidden = parts.length === 0;
  }

  const swatch = ({ name, color }) => [element('span', { class: 'swatch', style: `background:${color}` }), name];

  /** An entry with its share of the elements; a click shows these alone. */
  function choice({ chosen, count, share, ...entry }) {
    const attributes = { type: 'button', 'aria-pressed': String(chosen), title: `${count} elements`, dataset: { entry: entry.name } };
    const onclick = () => onBrush(chosen ? null : entry.name);
    return element(
      'button',
      { ...attributes, onclick },
      swatch(entry),
      element('span', { class: 'share', text: `${shortNumber(100 * share, 3)} %` }),
    );
  }

  function histogram(about) {
    const { values, brush } = about;
    let [low, high] = [Infinity, -Infinity];
    let total = 0;
    for (const list of values)
      for (const v of list)
        if (!Number.isNaN(v)) {
          low = Math.min(low, v);
          high = Math.max(high, v);
          total++;
        }
    if (!total) return [];
    // The whole range where the values fill it, else what they span.
    const [from, to] =
      about.measure === 'angle'
        ? [0, high > 60 ? 90 : 60]
        : about.measure === 'jacobian'
          ? [Math.min(0, low), 1]
          : [0, Math.max(2, Math.min(high, 4))];
    const counts = new Array(BARS).fill(0);
    for (const list of values)
      for (const v of list) if (!Number.isNaN(v)) counts[Math.max(0, Math.min(BARS - 1, Math.floor(((v - from) / (to - from)) * BARS)))]++;
    const most = Math.max(...counts);
    const at = (share) => from + (to - from) * share;
    const bars = counts.map((count, i) => {
      const middle = at((i + 0.5) / BARS);
      const color = about.color(middle).map((c) => Math.round(c * 255));
      const outside = brush && (at((i + 1) / BARS) < brush[0] || at(i / BARS) > brush[1]);
      return element('span', {
        class: outside ? 'bar outside' : 'bar',
        title: `${shortNumber(at(i / BARS), 3)} to ${shortNumber(at((i + 1) / BARS), 3)}: ${count}`,
        style: `height:${count ? Math.max(2, 100 * Math.sqrt(count / most)) : 0}%;background:rgb(${color})`,
      });
    });
    const plot = element('div', { class: 'histogram', 'aria-hidden': 'true' }, bars);
    brushable(plot, (a, b) => onBrush(b - a < 0.02 ? null : [at(a), at(b)]));
    let inside = 0;
    if (brush) for (const list of values) for (const v of list) if (v >= brush[0] && v <= brush[1]) inside++;
    const summary = brush
      ? `${inside} of ${total} elements, ${shortNumber(brush[0], 3)} to ${shortNumber(brush[1], 3)}`
      : `${total} elements, ${shortNumber(low, 3)} to ${shortNumber(high, 4)}${about.unit}`;
    const field = (label, k) =>
      element('input', {
        type: 'number',
        step: 'any',
        'aria-label': label,
        placeholder: shortNumber(k ? to : from, 3),
        value: brush ? shortNumber(brush[k], 4) : '',
        onchange: (event) => {
          const next = brush ? [...brush] : [from, to];
          next[k] = event.target.value === '' ? (k ? to : from) : Number(event.target.value);
          onBrush(next[0] <= from && next[1] >= to ? null : next);
        },
      });
    return [
      element('h2', { text: about.title }),
      plot,
      element(
        'div',
        { class: 'ends' },
        element('span', { text: shortNumber(from, 3) }),
        element('span', { text: shortNumber(to, 3) + about.unit }),
      ),
      element(
        'div',
        { class: 'brush' },
        element('span', { text: 'show' }),
        field('Shown from', 0),
        element('span', { text: 'to' }),
        field('Shown up to', 1),
        brush && element('button', { type: 'button', text: 'all', onclick: () => onBrush(null) }),
      ),
      element('p', { text: summary, role: 'status' }),
    ];
  }

  /** Drags a range over the bars; both ends are shares from 0 to 1. */
  function brushable(plot, done) {
    const mark = element('span', { class: 'brushed' });
    plot.append(mark);
    let start = null;
    const share = (event) => {
      const box = plot.getBoundingClientRect();
      return Math.min(1, Math.max(0, (event.clientX - box.left) / box.width));
    };
    const range = (event) => [Math.min(start, share(event)), Math.max(start, share(event))];
    plot.addEventListener('pointerdown', (event) => {
      start = share(event);
      plot.setPointerCapture(event.pointerId);
    });
    plot.addEventListener('pointermove', (event) => {
      if (start === null) return;
      const [a, b] = range(event);
      mark.style.cssText = `left:${a * 100}%;width:${(b - a) * 100}%`;
    });
    plot.addEventListener('pointerup', (event) => {
      if (start === null) return;
      const [a, b] = range(event);
      start = null;
      done(a, b);
    });
  }

  return { show, current: () => now };
}
