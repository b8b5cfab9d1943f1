// The tree of declarations: things by kind, then checks, reports and pictures; with search, visibility, colour, isolation.

import { button, element, icon } from './dom.js';
import { isAwaited } from './model.js';
import { theme } from './theme.js';
import { createMemberRows } from './tree_members.js';

const SECTIONS = [
  ['surface', 'Surfaces'],
  ['shell', 'Shells'],
  ['curve', 'Curves'],
  ['mesh', 'Meshes'],
  ['network', 'Networks'],
  ['point', 'Points'],
  ['group', 'Groups'],
];

/** `on` has `toggle(thing, shown)`, `color(thing, text)`, `isolate(name)`, `choose(thing)`, `goTo(place)`, `zoom(names)`, `hover(name)`. */
export function createTree(holder, search, model, state, on) {
  let drawn = ''; // What the tree shows, as text.
  const members = createMemberRows(model, state, row, draw, on);
  search.addEventListener('input', draw);

  function draw() {
    const { frame } = model;
    if (!frame) return;
    const next = content(frame);
    if (next === drawn) return;
    drawn = next;
    const focused = document.activeElement?.closest?.('[role=treeitem]')?.dataset.key;
    const wanted = search.value.trim().toLowerCase();
    const fits = (text) => !wanted || text.toLowerCase().includes(wanted);
    const sections = SECTIONS.map(([kind, title]) => {
      const things = frame.things.filter(
        (thing) => thing.kind === kind && (fits(thing.name) || (members.has(thing) && members.some(thing, fits))),
      );
      const rows = (thing) => [thingItem(thing), ...members.rows(thing, fits, wanted !== '')];
      return section(kind, title, things.flatMap(rows), things.length);
    });
    sections.push(section('checks', 'Checks', frame.checks.filter((check) => fits(check.name || check.text)).map(checkItem)));
    sections.push(
      section(
        'reports',
        'Reports',
        frame.reports
          .filter((report) => fits(report.name))
          .map((report) => plainItem(`report ${report.name}`, report.title || report.name, 'report', () => on.report(report))),
      ),
    );
    sections.push(
      section(
        'pictures',
        'Pictures and files',
        [...frame.pictures, ...frame.outputs]
          .filter((one) => fits(one.path))
          .map((one) => plainItem(`file ${one.path}`, one.path, 'picture', () => on.goTo(one.place))),
      ),
    );
    const shown = sections.filter(Boolean);
    const none = wanted ? 'Nothing has this name.' : frame.partial ? 'Evaluating…' : 'The script declares nothing yet.';
    if (!shown.length) shown.push(element('p', { class: 'empty', text: none }));
    holder.replaceChildren(...shown);
    const rows = [...holder.querySelectorAll('[role=treeitem]')];
    const again = rows.find((row) => row.dataset.key === focused);
    (again ?? rows[0])?.setAttribute('tabindex', '0');
    if (again) again.focus();
  }

  /** All that `draw` reads; where it is as before, the rows stay. */
  function content(frame) {
    const { checks, reports, pictures, outputs, partial } = frame;
    const { colors, only, closed } = state.get();
    const things = frame.things.map((thing) => {
      const { name, kind, of, color, unmade, stale } = thing;
      const drawn = members.has(thing) && [thing.buffers, on.pickedOf(name)];
      return [name, kind, of, color, unmade, stale, isAwaited(thing), model.isShown(thing), on.isChosen(name), on.isLit(name), drawn];
    });
    const named = reports.map(({ name, title }) => [name, title]);
    const shown = [colors, only, closed, members.content(), search.value, theme.dark];
    return JSON.stringify([things, checks, named, pictures, outputs, Boolean(partial), shown]);
  }

  function section(key, title, items, count = items.length) {
    if (!items.length) return null;
    const open = !state.get().closed[key] || search.value !== '';
    const flip = () => {
      state.set({ closed: { ...state.get().closed, [key]: open } });
      draw();
    };
    const head = row(
      `section ${key}`,
      { class: 'section', 'aria-expanded': String(open), 'aria-level': '1', onclick: flip, flip, open },
      element('span', { class: open ? 'turn open' : 'turn' }, icon('open')),
      element('span', { class: 'name', text: title }),
      element('span', { class: 'count', text: String(count) }),
    );
    const isResult = key === 'checks' || key === 'reports' || key === 'pictures';
    if (!isResult) {
      const things = model.frame.things.filter((thing) => thing.kind === key);
      const some = things.some((thing) => model.isShown(thing));
      head.append(
        button(
          `${some ? 'Hide' : 'Show'} all ${title.toLowerCase()}`,
          some ? 'eye' : 'hidden',
          (event) => {
            event.stopPropagation();
            on.toggleAll(things, !some);
          },
          { class: some ? 'eye' : 'eye off', tabindex: '-1' },
        ),
      );
    }
    const busy = isResult && model.frame.partial ? 'true' : null;
    return element('div', { role: 'group', 'aria-label': title, 'aria-busy': busy, class: 'branch' }, head, open && items);
  }

  /** A row that the arrow keys reach. */
  function row(key, { flip, open, space, enter, isolate, ...attributes }, ...children) {
    return element(
      'div',
      {
        role: 'treeitem',
        tabindex: '-1',
        'aria-level': '2',
        dataset: { key },
        ...attributes,
        onkeydown: (event) => {
          if (event.target !== event.currentTarget) return;
          const rows = [...holder.querySelectorAll('[role=treeitem]')];
          const at = rows.indexOf(event.currentTarget);
          const go = (n) => {
            const next = rows[Math.min(rows.length - 1, Math.max(0, n))];
            rows[at].setAttribute('tabindex', '-1');
            next.setAttribute('tabindex', '0');
            next.focus();
          };
          if (event.key === 'ArrowDown') go(at + 1);
          else if (event.key === 'ArrowUp') go(at - 1);
          else if (event.key === 'Home') go(0);
          else if (event.key === 'End') go(rows.length - 1);
          else if (flip && ((event.key === 'ArrowRight' && !open) || (event.key === 'ArrowLeft' && open))) flip();
          else if (event.key === ' ') (space ?? flip ?? enter)?.();
          else if (event.key === 'Enter') (enter ?? flip)?.();
          else if (event.key === 'i' && isolate) isolate();
          else return;
          event.preventDefault();
          event.stopPropagation();
        },
      },
      ...children,
    );
  }

  function thingItem(thing) {
    const { colors, only } = state.get();
    const shown = model.isShown(thing);
    const toggle = () => on.toggle(thing, !shown);
    const alone = only?.includes(thing.name);
    const color =
      colors[thing.name] ??
      thing.color ??
      (thing.kind === 'curve' ? theme.curve : thing.kind === 'point' ? theme.point : thing.kind === 'mesh' ? theme.mesh : theme.surface);
    const awaited = isAwaited(thing);
    const labels = [thing.unmade && 'not made', awaited && 'not made yet', thing.stale && 'as it was before', !shown && 'hidden'].filter(Boolean);
    const item = row(
      thing.name,
      {
        class: [
          'thing',
          shown ? '' : 'off',
          thing.stale ? 'stale' : '',
          thing.unmade ? 'unmade' : '',
          awaited ? 'awaited' : '',
          on.isChosen(thing.name) ? 'chosen' : '',
          on.isLit(thing.name) ? 'lit' : '',
        ].join(' '),
        'aria-label': `${thing.kind} ${thing.name}${labels.length ? `, ${labels.join(', ')}` : ''}`,
        'aria-selected': String(on.isChosen(thing.name)),
        title: thing.unmade ? `${thing.name}: ${thing.unmade}` : awaited ? `${thing.name}: not made yet` : thing.name,
        onclick: () => on.choose(thing),
        ondblclick: () => on.zoom([thing.name]),
        onpointerenter: () => on.hover(thing.name),
        onpointerleave: () => on.hover(null),
        space: toggle,
        enter: () => on.choose(thing),
        isolate: () => on.isolate(thing.name),
        ...(members.has(thing) && {
          'aria-expanded': String(members.isOpen(thing)),
          open: members.isOpen(thing),
          flip: () => members.flip(thing),
        }),
      },
      members.has(thing) && members.sign(thing),
      thing.kind === 'group'
        ? element('span', { class: 'dot report', 'aria-hidden': 'true' })
        : element('input', {
            type: 'color',
            class: 'colour',
            value: color.slice(0, 7),
            tabindex: '-1',
            'aria-label': `Colour of ${thing.name}`,
            onclick: (event) => event.stopPropagation(),
            oninput: (event) => on.color(thing, event.target.value),
          }),
      element('span', { class: 'name', text: thing.name }),
      thing.unmade && element('span', { class: 'tag', text: 'not made' }),
      awaited && element('span', { class: 'tag', text: 'not yet' }),
      thing.stale && element('span', { class: 'tag', text: 'stale' }),
      button(
        alone ? 'Show all again' : `Show ${thing.name} alone`,
        'only',
        (event) => {
          event.stopPropagation();
          on.isolate(thing.name);
        },
        { class: alone ? 'alone on' : 'alone', tabindex: '-1', 'aria-pressed': String(Boolean(alone)) },
      ),
      button(
        `${shown ? 'Hide' : 'Show'} ${thing.name}`,
        shown ? 'eye' : 'hidden',
        (event) => {
          event.stopPropagation();
          toggle();
        },
        { class: shown ? 'eye' : 'eye off', tabindex: '-1' },
      ),
    );
    return item;
  }

  function checkItem(check) {
    return plainItem(
      `check ${check.name}${check.text}`,
      check.name || check.text,
      check.pass ? 'pass' : 'fail',
      () => on.check(check),
      check.pass ? 'kept' : 'failed',
    );
  }

  function plainItem(key, name, kind, act, words = '') {
    return row(
      key,
      { class: `plain ${kind}`, title: name, 'aria-label': words ? `${name}, ${words}` : name, onclick: act, enter: act, space: act },
      element('span', { class: `dot ${kind}`, 'aria-hidden': 'true' }),
      element('span', { class: 'name', text: name }),
    );
  }

  return { draw };
}
