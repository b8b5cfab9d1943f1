// What a person can do, by name: commands of keys and buttons, and the ways from a table to the picture.

import { closedBodies } from './bodies.js';
import { STANDARD_VIEWS } from './camera.js';
import { isView } from './navigation.js';
import { keepsUpper } from './section.js';

export function createControl(app, byId) {
  const { state, stage, model } = app;
  const message = byId('message');
  let messageTimer = 0;

  function tell(text, seconds = 0) {
    clearTimeout(messageTimer);
    messageTimer = 0;
    message.textContent = text ?? '';
    message.hidden = !text;
    if (text && seconds) messageTimer = setTimeout(() => tell(null), seconds * 1000);
  }

  /** Takes away what stands until the next frame; what goes by itself stays its time. */
  function settle() {
    if (!messageTimer) tell(null);
  }

  const chosenNames = () => (app.selection.thing ? [app.selection.thing] : []);

  const COMMANDS = {
    fit: () => stage.fit(visibleBox()),
    'fit-chosen': () => zoom(chosenNames()),
    flat: () => stage.setView({ ...stage.view, flat: !stage.view.flat }),
    section: () => (state.get().cut ? state.set({ cut: null }) : cut({})),
    measure() {
      app.selection.measuring = !app.selection.measuring;
      model.measuring = app.selection.measuring;
      if (app.selection.measuring) {
        state.set({ tab: 'selected' });
        tell('Pick two places: faces, edges, sides or nodes.', 4);
      }
      app.selection.changed();
    },
    isolate: () => (app.selection.thing || state.get().only ? isolate(app.selection.thing) : null),
    hide: () => model.thing(app.selection.thing) && toggle(model.thing(app.selection.thing), false),
    clear() {
      if (byId('help').open) byId('help').close();
      app.selection.clear();
      if (app.selection.measuring) COMMANDS.measure();
    },
    search() {
      state.set({ left: true });
      byId('search').focus();
    },
    help: () => (byId('help').open ? byId('help').close() : byId('help').showModal()),
    theme: () => state.set({ theme: document.documentElement.dataset.theme === 'dark' ? 'light' : 'dark' }),
    // `left` and `right` are views.
    tree: () => state.set({ left: !state.get().left }),
    tables: () => state.set({ right: !state.get().right }),
  };

  function run(name) {
    if (isView(name)) {
      const [yaw, pitch] = STANDARD_VIEWS[name];
      stage.fit(visibleBox(), { yaw, pitch });
    } else COMMANDS[name]?.();
    app.toolbar.update(app.section.plane ? undefined : '');
    app.recolor();
  }

  /** Changes the section; one across another axis keeps what lies behind it. */
  function cut(patch) {
    const next = { axis: 'x', share: 0.5, ...state.get().cut, ...patch };
    if (patch.axis || !state.get().cut) next.flip = keepsUpper(next.axis, stage.view);
    state.set({ cut: next });
  }

  const visibleBox = () =>
    model.boxOf(model.frame?.things.filter((thing) => model.isShown(thing)).map((thing) => thing.name) ?? []) ?? stage.box;

  function zoom(names) {
    const box = model.boxOf(names) ?? (names.length ? null : visibleBox());
    if (box) stage.fit(box);
  }

  function zoomPoints(points, size) {
    const low = [0, 1, 2].map((i) => Math.min(...points.map((p) => p[i])));
    const high = [0, 1, 2].map((i) => Math.max(...points.map((p) => p[i])));
    const { radius } = stage.sphere();
    const margin = Math.max((size ?? 0) * 1.5, Math.hypot(...low.map((l, i) => high[i] - l)), radius * 0.02);
    stage.fit([low.map((l) => l - margin), high.map((h) => h + margin)]);
  }

  /** Groups pass it on to what they hold. */
  function toggle(thing, to) {
    const shown = { ...state.get().shown, [thing.name]: to };
    if (thing.kind === 'group') for (const name of thing.of ?? []) shown[name] = to;
    state.set({ shown, only: null });
  }

  function isolate(name) {
    const { only } = state.get();
    if (!name || only?.includes(name)) state.set({ only: null });
    else {
      const thing = model.thing(name);
      state.set({ only: [name, ...(thing?.kind === 'group' || !thing?.buffers?.length ? (thing?.of ?? []) : [])] });
    }
  }

  const absolute = (place) => model.frame.sources[place.file]?.path ?? '';

  function openThings(names) {
    const there = (names ?? []).filter((name) => model.thing(name));
    app.selection.light(there);
    zoom(there);
    return there.length > 0;
  }

  /** Where facets have become visible, finer display triangles are asked for: half a pixel of error where one looks. */
  let refineTimer = 0;
  function refineSoon() {
    clearTimeout(refineTimer);
    refineTimer = setTimeout(() => {
      const { frame } = model;
      if (frame?.partial) return refineSoon(); // When the evaluation has ended.
      if (!app.server.live || !frame?.chord_error || !frame.box) return;
      const pixel = stage.view.height / stage.size.height;
      if (frame.chord_error > 1.5 * pixel) app.refine('refine', Math.max(pixel / 2, stage.sphere().radius * 1e-6));
    }, 350);
  }

  return {
    refineSoon,
    run,
    cut,
    tell,
    settle,
    zoom,
    zoomPoints,
    toggle,
    isolate,
    toggleAll(things, to) {
      const shown = { ...state.get().shown };
      for (const thing of things) shown[thing.name] = to;
      state.set({ shown, only: null });
    },
    linkTo: (place) => `vscode://file${encodeURI(absolute(place).replace(/^(?!\/)/, '/'))}:${place.line}:${place.column}`,
    showInEditor(place) {
      if (app.server.live) app.show('place', { file: absolute(place), line: place.line, column: place.column });
    },
    /** The line under the cursor of an editor, or one clicked in the script pane. */
    lightLine(file, line) {
      const { sources } = model.frame ?? { sources: [] };
      const index =
        typeof file === 'number'
          ? file
          : sources.findIndex((source) => source.file === file || source.path === file || file.endsWith(`/${source.file}`));
      if (index < 0) return;
      app.panes.script.lightLine(index, line);
      app.selection.thing = null;
      app.selection.picks = [];
      app.selection.light(model.thingsAt(index, line));
    },
    openDiagnostic(diagnostic) {
      if (diagnostic.places.length) {
        app.panes.script.setChain([]);
        state.set({ tab: state.get().tab === 'problems' ? 'problems' : 'script' });
        app.panes.script.goTo(diagnostic.places[0], true);
      }
      if (diagnostic.points?.length) {
        app.selection.light((diagnostic.things ?? []).filter((name) => model.thing(name)));
        zoomPoints(diagnostic.points, diagnostic.size);
      } else openThings(diagnostic.things);
    },
    openCheck(check) {
      app.panes.script.goTo(check.place, true);
      openThings(check.things);
    },
    goTo(place) {
      state.set({ tab: 'script' });
      app.panes.script.goTo(place, true);
    },
    openReport(report) {
      state.set({ tab: 'reports', right: true });
      app.panes.scrollToReport(report.name);
    },
    /** Caps go on closed bodies that are shown and cut. */
    async updateCaps() {
      const bodies = app.section.plane ? await closedBodies(model) : [];
      const isThere = ({ drawing }) => model.drawings.includes(drawing) && drawing.object.visible;
      app.section.setCapped(bodies.filter((body) => body.parts.every(isThere)));
      stage.invalidate();
    },
  };
}
