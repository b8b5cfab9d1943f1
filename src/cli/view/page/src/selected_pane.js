// What is picked: facts, neighbours, the thing it belongs to, and the measure between two picks.

import { element } from './dom.js';
import { between, describe } from './described.js';
import { isAwaited } from './model.js';

const list = (facts) =>
  element(
    'dl',
    { class: 'facts' },
    facts.flatMap(([name, value]) => [element('dt', { text: name }), element('dd', { text: value })]),
  );

/** `on` has `neighbour(hit, item)`, `zoom(names)`, `isolate(name)`. */
export function drawSelected(holder, { picks, thing, units, radius, measuring }, on) {
  const parts = [];
  picks.forEach((hit, i) => {
    const description = describe(hit, units, radius);
    parts.push(
      element(
        'section',
        { class: 'picked' },
        element(
          'h2',
          {},
          picks.length > 1 && element('span', { class: 'order', text: i === 0 ? 'A' : 'B' }),
          element('span', { class: 'kind', text: description.kind }),
          element('span', { text: description.title }),
        ),
        list(description.facts),
        description.neighbours.length > 0 &&
          element(
            'p',
            { class: 'neighbours' },
            'Beside: ',
            description.neighbours.map(({ name, item }) =>
              element('button', { type: 'button', class: 'link', text: name, onclick: () => on.neighbour(hit, item) }),
            ),
          ),
      ),
    );
  });
  if (picks.length === 2)
    parts.unshift(
      element(
        'section',
        { class: 'picked between' },
        element('h2', { text: 'From A to B' }),
        list(between(picks[0], picks[1], units, radius)),
      ),
    );
  else if (picks.length === 1)
    parts.push(
      element('p', {
        class: 'hint',
        text: measuring ? 'Pick a second place to measure.' : 'Shift and a click on a second place measures distance and angle.',
      }),
    );
  if (thing) {
    parts.push(
      element(
        'section',
        { class: 'picked' },
        element('h2', {}, element('span', { class: 'kind', text: thing.kind }), element('span', { text: thing.name })),
        thing.unmade && element('p', { class: 'unmade', text: `Not made: ${thing.unmade}` }),
        isAwaited(thing) && element('p', { class: 'hint', text: 'Not made yet.' }),
        thing.stale && element('p', { class: 'unmade', text: 'Drawn as it was before the last change.' }),
        thing.facts?.length > 0 && list(thing.facts),
        thing.of?.length > 0 &&
          element(
            'p',
            { class: 'neighbours' },
            'Of: ',
            thing.of.map((name) => element('button', { type: 'button', class: 'link', text: name, onclick: () => on.chooseName(name) })),
          ),
        element(
          'div',
          { class: 'acts' },
          element('button', { type: 'button', text: 'zoom to it', onclick: () => on.zoom([thing.name]) }),
          element('button', { type: 'button', text: 'show alone', onclick: () => on.isolate(thing.name) }),
        ),
      ),
    );
  }
  if (!parts.length)
    parts.push(element('p', { class: 'empty', text: 'Nothing is picked. Click on a face, an edge, a node or a name in the tree.' }));
  holder.replaceChildren(...parts);
}
