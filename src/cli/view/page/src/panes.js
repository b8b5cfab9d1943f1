// The panes at the sides: the tree at the left, the tabs at the right, and how wide they are.

import { element, soon } from './dom.js';
import { createParamsPane } from './params_pane.js';
import { drawChecks, drawProblems, drawReports } from './problems_pane.js';
import { createScriptPane } from './script_pane.js';
import { drawSelected } from './selected_pane.js';
import { createTree } from './tree.js';

const TABS = [
  ['script', 'Script'],
  ['params', 'Params'],
  ['problems', 'Problems'],
  ['checks', 'Checks'],
  ['reports', 'Reports'],
  ['selected', 'Selected'],
];
const RESULTS = ['problems', 'checks', 'reports']; // Panes of what is known when an evaluation has ended.

export function createPanes(app, byId) {
  const { state, model, selection, control } = app;
  const bar = byId('tabs');
  const tabs = TABS.map(([name, text]) =>
    element(
      'button',
      {
        type: 'button',
        role: 'tab',
        id: `tab-${name}`,
        'aria-controls': `pane-${name}`,
        onclick: () => state.set({ tab: name }),
        onkeydown(event) {
          const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
          if (!step) return;
          const next = tabs[(TABS.findIndex(([one]) => one === name) + step + TABS.length) % TABS.length];
          next.click();
          next.focus();
          event.preventDefault();
          event.stopPropagation();
        },
      },
      text,
      element('span', { class: 'badge', hidden: true }),
    ),
  );
  bar.append(...tabs);
  const panes = Object.fromEntries(
    TABS.map(([name, text]) => [
      name,
      element('div', {
        id: `pane-${name}`,
        class: `pane ${name}`,
        role: 'tabpanel',
        'aria-labelledby': `tab-${name}`,
        title: null,
        'data-title': text,
      }),
    ]),
  );
  byId('panes').append(...Object.values(panes));

  const script = createScriptPane(panes.script, {
    line(file, line) {
      control.lightLine(file, line);
      control.showInEditor({ file, line, column: 1 });
    },
    show: control.showInEditor,
    linkTo: control.linkTo,
  });
  const params = createParamsPane(panes.params, app.server.live, {
    set: (name, text) => app.setParam(name, text),
    async write(name, text) {
      const answer = await app.server.post('write', { name, text });
      control.tell(answer.ok ? `The script now has ${name} = ${text}.` : `Not written: ${answer.message ?? 'the server refused'}.`, 5);
    },
    goTo: control.goTo,
  });
  const tree = createTree(byId('tree'), byId('search'), model, state, {
    toggle: control.toggle,
    toggleAll: control.toggleAll,
    isolate: control.isolate,
    zoom: control.zoom,
    goTo: control.goTo,
    color: (thing, text) => state.set({ colors: { ...state.get().colors, [thing.name]: text } }),
    choose: (thing) => selection.choose(thing.name),
    check: (check) => {
      state.set({ tab: 'checks', right: true });
      control.openCheck(check);
    },
    report: control.openReport,
    hover(name) {
      selection.over = name;
      selection.mark();
    },
    pick: (pick) => selection.take(pick),
    zoomTo: (pick) => control.zoomPoints([pick.point]),
    isPicked: (drawing, item) => selection.picks.some((pick) => pick.drawing === drawing && pick.item === item),
    pickedOf: (name) => selection.picks.filter(({ drawing }) => drawing.name === name).map(({ item }) => item),
    isChosen: (name) => selection.thing === name,
    isLit: (name) => selection.lit.has(name),
  });

  function drawPicked() {
    drawSelected(
      panes.selected,
      {
        picks: selection.picks,
        thing: model.thing(selection.thing),
        units: model.frame?.units ?? '',
        radius: app.stage.sphere().radius,
        measuring: selection.measuring,
      },
      {
        neighbour: (hit, item) => selection.pickNeighbour(hit, item),
        chooseName: (name) => selection.choose(name),
        zoom: control.zoom,
        isolate: control.isolate,
      },
    );
    badge('selected', selection.picks.length || '', '');
  }

  function badge(name, text, kind) {
    const mark = tabs[TABS.findIndex(([one]) => one === name)].querySelector('.badge');
    mark.textContent = String(text);
    mark.hidden = !text;
    mark.className = `badge ${kind}`;
  }

  /** Shows which panes and which tab are open. */
  function layout() {
    const { left, right, tab } = state.get();
    document.body.classList.toggle('no-left', !left);
    document.body.classList.toggle('no-right', !right);
    tabs.forEach((node, i) => {
      const on = TABS[i][0] === tab;
      node.setAttribute('aria-selected', String(on));
      node.tabIndex = on ? 0 : -1;
      panes[TABS[i][0]].hidden = !on;
    });
  }

  const results = {}; // What the panes of results show, as text.

  /** Makes those panes anew that would show something else. */
  function drawResults(frame) {
    const { diagnostics, checks, reports, pictures, outputs, units, sources } = frame;
    const files = sources.map(({ file }) => file);
    const draw = (name, shown, run) => {
      const next = JSON.stringify(frame.evaluating ? null : shown);
      if (results[name] === next) return;
      results[name] = next;
      if (frame.evaluating) panes[name].replaceChildren(element('p', { class: 'empty', text: 'Evaluating…' }));
      else run(panes[name], frame, { diagnostic: control.openDiagnostic, check: control.openCheck, goTo: control.goTo });
    };
    draw('problems', [diagnostics, files, units], drawProblems);
    draw('checks', checks, drawChecks);
    draw('reports', [reports, pictures, outputs], drawReports);
  }

  const drawTree = soon(() => tree.draw());
  const splitter = byId('splitter');
  const widen = (width) => {
    const bounded = Math.min(Math.max(width, 220), innerWidth * 0.6);
    document.body.style.setProperty('--right', `${bounded}px`);
    splitter.setAttribute('aria-valuenow', String(Math.round(bounded)));
  };
  splitter.addEventListener('pointerdown', (event) => {
    splitter.setPointerCapture(event.pointerId);
    const move = (e) => widen(innerWidth - e.clientX);
    splitter.addEventListener('pointermove', move);
    splitter.addEventListener('pointerup', () => splitter.removeEventListener('pointermove', move), { once: true });
  });
  splitter.addEventListener('keydown', (event) => {
    const step = { ArrowLeft: 24, ArrowRight: -24 }[event.key];
    if (!step) return;
    widen(byId('right').offsetWidth + step);
    event.preventDefault();
    event.stopPropagation();
  });

  return {
    script,
    layout,
    drawTree,
    drawSelected: soon(drawPicked),
    setFrame(frame) {
      script.setFrame(frame);
      params.setFrame(frame);
      for (const name of RESULTS) panes[name].setAttribute('aria-busy', String(Boolean(frame.partial)));
      drawResults(frame);
      drawPicked();
      const errors = frame.diagnostics.filter((d) => d.severity === 'error').length;
      const failed = frame.checks.filter((check) => !check.pass).length;
      badge(
        'problems',
        frame.diagnostics.length,
        errors ? 'error' : frame.diagnostics.some((d) => d.severity === 'warning') ? 'warning' : '',
      );
      badge('checks', failed || '', 'error');
      const grey = frame.partial ? frame.things.some((thing) => thing.stale && model.isShown(thing)) : frame.stale;
      byId('stale').hidden = !grey;
      byId('stale').classList.toggle('running', Boolean(frame.partial));
      byId('stale').textContent = frame.partial
        ? 'The script is being evaluated; what is grey is drawn as it was before.'
        : errors
          ? `The script has ${errors === 1 ? 'an error' : `${errors} errors`}; what is grey is drawn as it was before.`
          : 'What is grey is drawn as it was before.';
    },
    scrollToReport(name) {
      panes.reports.querySelector(`[data-report="${CSS.escape(name)}"]`)?.scrollIntoView({ block: 'start' });
    },
  };
}
