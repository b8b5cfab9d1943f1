// Rows of members in the tree. They are made when their thing is opened, some at a time, so that thousands cost nothing.

import { element, icon } from './dom.js';
import { hasMembers, membersOf, pickOf } from './members.js';

const STEP = 200; // Rows that are made at once.

/** `row` makes a row that the arrow keys reach; `redraw` draws the tree; `on` has `pick(pick)`, `isPicked(drawing, item)` and `zoomTo(pick)`. */
export function createMemberRows(model, state, row, redraw, on) {
  const wanted = new Map(); // By name of the thing: rows that somebody asked for.

  const isOpen = (thing) => state.get().open.includes(thing.name);

  function flip(thing) {
    const { open } = state.get();
    state.set({ open: isOpen(thing) ? open.filter((name) => name !== thing.name) : [...open, thing.name] });
    wanted.delete(thing.name);
    redraw();
  }

  function rowOf({ name, drawing, item }) {
    const pick = () => on.pick(pickOf({ drawing, item }));
    const picked = on.isPicked(drawing, item);
    return row(
      `member ${name}`,
      {
        class: picked ? 'member chosen' : 'member',
        'aria-level': '3',
        'aria-label': name,
        'aria-selected': String(picked),
        title: name,
        onclick: pick,
        ondblclick: () => on.zoomTo(pickOf({ drawing, item })),
        enter: pick,
        space: pick,
      },
      element('span', { class: 'name', text: name }),
    );
  }

  return {
    has: hasMembers,
    isOpen,
    flip,
    /** The sign before the name of a thing that has members. */
    sign: (thing) =>
      element(
        'span',
        {
          class: isOpen(thing) ? 'turn open' : 'turn',
          onclick(event) {
            event.stopPropagation();
            flip(thing);
          },
        },
        icon('open'),
      ),
    /** What `rows` reads beside the frame. */
    content: () => [state.get().open, [...wanted]],
    /** Whether a member has a name that is searched for. */
    some: (thing, fits) => membersOf(thing, model.drawings).some(({ name }) => fits(name)),
    /** Rows below a thing: those of its members whose names fit, where it is open or something is searched for. */
    rows(thing, fits, searched) {
      if (!hasMembers(thing) || !(searched || isOpen(thing))) return [];
      const all = membersOf(thing, model.drawings).filter(({ name }) => fits(name));
      const count = wanted.get(thing.name) ?? STEP;
      const more = () => {
        wanted.set(thing.name, count + STEP);
        redraw();
      };
      const left = all.length - count;
      const words = `${Math.min(left, STEP)} more of ${left}`;
      return [
        ...all.slice(0, count).map(rowOf),
        ...(left > 0
          ? [
              row(
                `more ${thing.name}`,
                { class: 'member more', 'aria-level': '3', 'aria-label': words, onclick: more, enter: more, space: more },
                element('span', { class: 'name', text: words }),
              ),
            ]
          : []),
      ];
    },
  };
}
