// Params of the script: sliders within their ranges, else text fields. Moving one sets it for the running view.

import { element, shortNumber } from './dom.js';

const PER_UNIT = { deg: 1, '°': 1 };

/** `on` has `set(name, text)`, `write(name, text)` and `goTo(place)`; `live` is false where nothing can be moved. */
export function createParamsPane(holder, live, on) {
  const rows = new Map();
  let shape = '';

  function setFrame(frame) {
    const next = JSON.stringify(
      frame.params.map(({ name, kind, unit, min, max, choices, family }) => [name, kind, unit, min, max, choices, family]),
    );
    if (next !== shape) {
      shape = next;
      rows.clear();
      const parts = [];
      let family = null;
      for (const param of frame.params) {
        if (param.family !== family) {
          family = param.family;
          if (family) parts.push(element('h2', { text: family }));
        }
        const row = makeRow(param);
        rows.set(param.name, row);
        parts.push(row.node);
      }
      if (!parts.length)
        parts.push(
          element('p', { class: 'empty', text: 'The script has no params. A line such as “param w = 3m in 1m to 5m” makes one.' }),
        );
      else if (!live)
        parts.unshift(
          element('p', { class: 'empty', text: 'This page holds one state of the model: params are shown but cannot be moved.' }),
        );
      holder.replaceChildren(...parts);
    }
    for (const param of frame.params) rows.get(param.name)?.update(param);
  }

  function makeRow(first) {
    let param = first;
    const id = `param-${first.name.replace(/\W/g, '-')}`;
    const ranged = first.min !== null && first.max !== null && ['length', 'angle', 'number', 'count'].includes(first.kind);
    const unit = first.unit ?? '';
    const step = ranged ? stepOf(first) : 0;
    const textOf = (value) => (unit && !PER_UNIT[unit] ? `${trim(value)} ${unit}` : `${trim(value)}${unit}`);
    let touched = 0; // When a person moved it last: a frame that was under way does not move it back.
    const send = (text) => {
      touched = performance.now();
      on.set(param.name, text);
    };

    const field = fieldOf();
    const slider =
      ranged &&
      element('input', {
        type: 'range',
        id: `${id}-slider`,
        min: String(first.min),
        max: String(first.max),
        step: String(step),
        disabled: !live,
        'aria-label': `${first.name}, ${textOf(first.min)} to ${textOf(first.max)}`,
        oninput: () => {
          field.value = textOf(Number(slider.value));
          slider.setAttribute('aria-valuetext', field.value);
          send(field.value);
        },
      });
    const back = element('button', {
      type: 'button',
      text: 'reset',
      title: 'Back to the default in the script',
      'aria-label': `Reset ${first.name}`,
      onclick: () => {
        touched = 0;
        on.set(param.name, null);
      },
    });
    const write = element('button', {
      type: 'button',
      text: 'write to script',
      title: 'Write this value into the script as the default',
      'aria-label': `Write ${first.name} back to the script`,
      onclick: () => on.write(param.name, valueOf()),
    });
    const acts = element('div', { class: 'acts' }, back, write);
    const name = element('button', {
      type: 'button',
      class: 'param-name',
      text: first.name,
      title: 'Show in the script',
      'aria-label': `Show ${first.name} in the script`,
      onclick: () => on.goTo(param.place),
    });
    const node = element(
      'div',
      { class: 'param', dataset: { name: first.name } },
      element('div', { class: 'head' }, name, field),
      slider &&
        element(
          'div',
          { class: 'slide' },
          element('span', { text: textOf(first.min) }),
          slider,
          element('span', { text: textOf(first.max) }),
        ),
      acts,
    );

    function fieldOf() {
      const shared = { id, disabled: !live, 'aria-label': first.name };
      if (first.kind === 'bool')
        return element('input', { ...shared, type: 'checkbox', onchange: (event) => send(String(event.target.checked)) });
      if (first.kind === 'choice' || first.choices?.length)
        return element(
          'select',
          { ...shared, onchange: (event) => send(event.target.value) },
          (first.choices ?? []).map((choice) => element('option', { value: String(choice), text: String(choice) })),
        );
      return element('input', {
        ...shared,
        type: 'text',
        spellcheck: 'false',
        autocomplete: 'off',
        onchange: (event) => send(event.target.value.trim()),
      });
    }

    function valueOf() {
      return first.kind === 'bool' ? String(field.checked) : field.value;
    }

    function update(next) {
      param = next;
      acts.hidden = !live || !next.set;
      node.classList.toggle('set', Boolean(next.set));
      const busy = performance.now() - touched < 700 || document.activeElement === field;
      if (busy) return;
      if (first.kind === 'bool') field.checked = next.text === 'true' || next.value === true;
      else field.value = next.text;
      if (slider && next.value !== null) slider.value = String(next.value);
      slider && slider.setAttribute('aria-valuetext', next.text);
    }
    return { node, update };
  }

  return { setFrame };
}

/** Steps that read well: about 200 over the range, one of 1, 2, 5 times a power of ten. */
function stepOf({ min, max, kind }) {
  if (kind === 'count') return 1;
  const raw = (max - min) / 200;
  const power = 10 ** Math.floor(Math.log10(raw || 1));
  return power * ([1, 2, 5].find((n) => n * power >= raw) ?? 10);
}

const trim = (value) => shortNumber(Number(value.toPrecision(8)), 8);
