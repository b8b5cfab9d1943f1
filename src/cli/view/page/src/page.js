// The page: puts the parts together. A frame comes in, the picture and the panes change, the state stays.

import { navigate } from './navigation.js';
import { Comparison } from './compare.js';
import { createControl } from './control.js';
import { createLegend } from './legend.js';
import { axes, Marks } from './marks.js';
import { Model } from './model.js';
import { createPanes } from './panes.js';
import { completed } from './partial.js';
import { Section } from './section.js';
import { Selection } from './selection.js';
import { connect, throttled } from './server.js';
import { Shades } from './shades.js';
import { Stage } from './stage.js';
import { createState, fromAddress } from './state.js';
import { createStatus } from './status.js';
import { setTheme } from './theme.js';
import { createToolbar } from './toolbar.js';
import { seam } from './seam.js';
import { soon } from './dom.js';

const byId = (id) => document.getElementById(id);

export function startPage() {
  const state = createState();
  if (innerWidth <= 820 && !location.hash) state.get().left = false;
  const canvas = byId('picture');
  let stage;
  try {
    stage = new Stage(canvas, state);
  } catch {
    byId('unable').hidden = false;
    document.body.classList.add('unable');
    return;
  }
  let awaited = null; // A frame whose panes are made as soon as its picture is drawn.
  const model = new Model(stage, state);
  const section = new Section(stage, state);
  const shades = new Shades(model, stage, state);
  const app = { state, stage, model, section, shades };
  app.selection = new Selection(app);
  app.control = createControl(app, byId);
  app.comparison = new Comparison(app, byId('comparison'));

  app.server = connect({
    onFrame: (frame, times) => takeFrame(frame, times),
    onWork: (event) => app.status.work(event, app.comparison.running),
    onGone: ({ file }) => app.control.tell(`${file} is not there now; the picture stays as it was.`),
    onCursor: ({ file, line }) => app.control.lightLine(file, line),
    onConnection(connected) {
      app.connected = connected;
      app.status.connection(connected, app.server?.live ?? true);
      if (!connected) {
        app.status.work(null);
        app.comparison.lost();
      }
      if (connected && !model.frame) app.control.tell('The script is evaluated; the picture comes when it is done.');
    },
  });
  app.setParam = throttled(async (name, text) => {
    const answer = await app.server.post('set', { name, text });
    if (answer.ok === false) app.control.tell(`${name} is not set: ${answer.message ?? 'the server refused'}.`, 5);
  });
  app.refine = throttled((name, error) => app.server.post(name, { error }));
  app.show = throttled((name, place) => app.server.post('show', place));

  app.status = createStatus(byId('status'), byId('work'), () => {
    app.server.post('stop');
    if (app.comparison.running) app.comparison.ask(null);
  });
  app.legend = createLegend(byId('legend'), (range) => {
    shades.setBrush(range);
    app.recolor();
  });
  app.marks = new Marks(stage, byId('marks'), (diagnostic) => app.control.openDiagnostic(diagnostic));
  app.panes = createPanes(app, byId);
  app.toolbar = createToolbar(byId('toolbar'), state, model, {
    run: (command) => app.control.run(command),
    shade(name) {
      shades.setBrush(null);
      state.set({ shade: name });
    },
    cut: (patch) => app.control.cut(patch),
    compare: (other) => app.comparison.ask(other),
    compared: () => app.comparison.shown,
    live: app.server.live,
  });
  byId('view').append(app.toolbar.bar);
  axes(stage, byId('axes'), (view) => app.control.run(view));

  app.recolor = soon(() => {
    if (!model.frame) return;
    section.update();
    shades.apply((legend) => app.legend.show(legend)).then(() => app.control.updateCaps());
    app.selection.mark();
    if (!awaited) app.panes.drawTree();
    app.toolbar.update(
      section.plane ? `${'xyz'['xyz'.indexOf(state.get().cut.axis)]} = ${section.at.toPrecision(5).replace(/\.?0+$/, '')}` : '',
    );
  });

  const systemDark = matchMedia('(prefers-color-scheme: dark)');
  const dress = () => {
    const chosen = state.get().theme;
    const dark = chosen ? chosen === 'dark' : systemDark.matches;
    document.documentElement.dataset.theme = dark ? 'dark' : 'light';
    setTheme(dark);
    app.recolor();
  };
  systemDark.addEventListener('change', dress);
  state.subscribe((changed) => {
    if (changed.has('theme')) dress();
    if (changed.has('view')) app.control.refineSoon();
    if (['shown', 'colors', 'only', 'shade', 'cut'].some((name) => changed.has(name))) app.recolor();
    if (changed.has('left') || changed.has('right') || changed.has('tab')) app.panes.layout();
    if (changed.has('left') || changed.has('right')) app.toolbar.update();
  });
  addEventListener('hashchange', () => {
    state.set(fromAddress(location.hash));
    stage.invalidate();
  });
  dress();
  app.panes.layout();
  app.toolbar.update();

  navigate(
    stage,
    {
      hover: (x, y) => app.selection.hover(x, y),
      leave: () => app.selection.hover(null),
      click: (x, y, again) => app.selection.click(x, y, again),
      command: (name) => app.control.run(name),
    },
    (x, y) => app.selection.at(x, y)?.point ?? null,
  );

  function drawPanes(frame) {
    app.panes.setFrame(frame);
    // Lines may have moved: the chain of what is chosen is that of the new text.
    const chosen = model.thing(app.selection.thing);
    if (chosen || (app.selection.thing && !frame.partial)) app.panes.script.setChain(chosen?.chain ?? [], false);
    app.panes.drawTree();
  }

  async function takeFrame(given, times) {
    const frame = completed(given, model.whole);
    try {
      if (!(await model.show(frame, app.server))) return;
    } catch (error) {
      // A buffer of a frame that is no longer the newest may be gone; the next frame brings its own.
      if (!frame.partial) app.control.tell(`Frame ${frame.number} could not be shown: ${error.message}`);
      return;
    }
    app.control.settle();
    app.comparison.took(frame);
    app.selection.renew();
    document.title = `${frame.partial ? '… ' : frame.ok ? '' : '● '}${frame.title}`;
    app.recolor();
    awaited = frame;
    app.marks.setDiagnostics(frame.diagnostics, frame.units);
    stage.invalidate();
    model.times = { ...times, loaded: performance.now(), number: frame.number };
  }

  stage.after.push(() => {
    const info = stage.renderer.info.render;
    app.status.counts(info.triangles, info.calls, model.buffers.bytes());
    if (model.times.number !== undefined && !model.times.shown) {
      model.times.shown = performance.now();
      app.status.frame(model.frame, model.times);
    }
    const frame = awaited;
    awaited = null;
    if (frame) drawPanes(frame);
  });
  window.loftView = seam(app);
}
