// The bar above: shades, standard views, projection, section, measure, compare, theme, and the panes at the sides.

import { createCompareChoice } from './compare_choice.js';
import { button, element, icon } from './dom.js';
import { SHADES } from './shades.js';

/** `run(command)` does what a key does too; gives `update()`, which shows the state. */
export function createToolbar(holder, state, model, { run, shade, cut, compare, compared, live }) {
  const shades = element(
    'select',
    { id: 'shade', 'aria-label': 'Shade', onchange: () => shade(shades.value) },
    SHADES.map(([value, text]) => element('option', { value, text })),
  );
  const views = [
    ['iso', 'Iso', '0'],
    ['front', 'Front', '1'],
    ['top', 'Top', '2'],
    ['right', 'Right', '3'],
  ].map(([name, text, key]) => element('button', { type: 'button', text, title: `${text} (${key})`, onclick: () => run(name) }));
  const flat = button('Orthographic (O)', 'box', () => run('flat'), { 'aria-pressed': 'false' });
  const section = button('Section plane (S)', 'cut', () => run('section'), { 'aria-pressed': 'false' });
  const measure = button('Measure between two picks (M)', 'measure', () => run('measure'), { 'aria-pressed': 'false' });
  const others = createCompareChoice(compare, compared);
  const left = button('Tree', 'left', () => run('tree'), { 'aria-pressed': 'true' });
  const right = button('Script and tables', 'right', () => run('tables'), { 'aria-pressed': 'true' });
  const name = element('h1', { text: 'loft' });
  const group = (label, ...parts) => element('div', { class: 'group', role: 'group', 'aria-label': label }, parts);
  holder.append(
    left,
    name,
    group('Shade', shades),
    group('Views', views),
    group(
      'Picture',
      button('Fit (F)', 'fit', () => run('fit')),
      flat,
      section,
      measure,
    ),
    ...(live ? [group('Compare', others.parts)] : []),
    element('span', { class: 'space' }),
    button('Light or dark', 'sun', () => run('theme')),
    button('Keys (?)', 'help', () => run('help')),
    right,
  );

  // The section's own bar lies over the picture while it is on.
  const axis = ['x', 'y', 'z'].map((name) =>
    element('button', {
      type: 'button',
      text: name.toUpperCase(),
      'aria-label': `Section across ${name}`,
      onclick: () => cut({ axis: name }),
    }),
  );
  const share = element('input', {
    type: 'range',
    min: '0',
    max: '1',
    step: '0.002',
    'aria-label': 'Place of the section plane',
    oninput: () => cut({ share: Number(share.value) }),
  });
  const at = element('output', { class: 'at' });
  const flip = button('Other side', 'flip', () => cut({ flip: !state.get().cut?.flip }));
  const off = button('Section off', 'close', () => run('section'));
  const bar = element(
    'div',
    { class: 'section-bar', role: 'group', 'aria-label': 'Section', hidden: true },
    icon('cut'),
    axis,
    share,
    at,
    flip,
    off,
  );

  function update(place) {
    const now = state.get();
    shades.value = now.shade;
    flat.setAttribute('aria-pressed', String(Boolean(now.view?.flat)));
    section.setAttribute('aria-pressed', String(Boolean(now.cut)));
    measure.setAttribute('aria-pressed', String(Boolean(model.measuring)));
    left.setAttribute('aria-pressed', String(now.left));
    right.setAttribute('aria-pressed', String(now.right));
    name.textContent = model.frame?.title ?? 'loft';
    others.update();
    bar.hidden = !now.cut;
    if (now.cut) {
      axis.forEach((one, i) => one.setAttribute('aria-pressed', String('xyz'[i] === now.cut.axis)));
      share.value = String(now.cut.share);
      at.textContent = place ?? '';
    }
  }
  return { update, bar };
}
