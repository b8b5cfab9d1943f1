// What is under the cursor, what is picked, and what is lit up from a line of the script.

import { describe } from './described.js';
import { coordinate } from './dom.js';
import { isAwaited } from './model.js';
import { pick } from './picking.js';
import { SideMarks } from './side_marks.js';

export class Selection {
  constructor(app) {
    this.app = app;
    this.hovered = null;
    this.picks = [];
    this.thing = null; // The name of the thing that is chosen, by a pick or in the tree.
    this.lit = new Set();
    this.measuring = false;
    this.sides = new SideMarks(app.stage);
  }

  at(x, y) {
    const { stage, model, section } = this.app;
    if (!stage.camera.now) return null;
    return pick(stage, model.visible(), x, y, section.plane);
  }

  hover(x, y) {
    const hit = x === null ? null : this.at(x, y);
    const before = this.hovered;
    this.hovered = hit;
    const description = hit && describe(hit, this.app.model.frame.units, this.app.stage.sphere().radius);
    this.app.status.under(description?.title, hit?.point, this.app.stage.sphere().radius);
    this.app.stage.canvas.classList.toggle('over', Boolean(hit));
    if (!isSame(before, hit)) this.mark();
  }

  /** A click picks; with Shift, or while measuring, a second pick is kept beside the first. */
  click(x, y, again) {
    const hit = this.at(x, y);
    if (!hit) {
      if (!again) this.clear();
      return;
    }
    const second = (again || this.measuring) && this.picks.length === 1;
    this.take(hit, second);
  }

  take(hit, second = false) {
    this.picks = second ? [this.picks[0], hit] : [hit];
    this.choose(hit.drawing.name, { keepPicks: true, tab: second ? 'selected' : undefined });
  }

  /** Chooses a thing by name: its chain of lines opens in the script pane and, where one is attached, in the editor. */
  choose(name, { keepPicks = false, tab } = {}) {
    const { model, panes, control, state } = this.app;
    if (!keepPicks) this.picks = [];
    this.thing = name;
    this.lit = new Set();
    const thing = model.thing(name);
    const now = state.get().tab;
    if (tab) state.set({ tab });
    else if (now !== 'script' && now !== 'selected') state.set({ tab: 'script' });
    panes.script.setChain(thing?.chain ?? []);
    if (thing?.chain?.length) control.showInEditor(thing.chain[0]);
    this.changed();
  }

  pickNeighbour(hit, item) {
    const { buffer } = hit.drawing;
    if (hit.kind !== 'face') return;
    const triangle = buffer.arrays.face.indexOf(item);
    if (triangle < 0) return;
    const p = buffer.arrays.positions;
    const point = buffer.origin.map((o, k) => o + [0, 1, 2].reduce((sum, c) => sum + p[3 * buffer.index[3 * triangle + c] + k] / 3, 0));
    this.picks = [{ ...hit, item, triangle, point }];
    this.changed();
  }

  light(names) {
    this.lit = new Set(names);
    this.changed();
  }

  clear() {
    this.picks = [];
    this.thing = null;
    this.lit = new Set();
    this.app.panes.script.setChain([]);
    this.changed();
  }

  /**
   * After a new frame: picks stay where their buffer is still there, the chosen thing by its name. What a partial frame
   * leaves out is waited for.
   */
  renew() {
    const { model } = this.app;
    const { partial } = model.frame;
    if (!this.isDrawn(this.hovered)) this.hovered = null;
    this.picks = this.picks.filter((hit) => {
      const drawing = model.drawings.find((one) => one.id === hit.drawing.id);
      if (drawing) hit.drawing = drawing;
      const thing = model.thing(hit.drawing.name);
      return drawing || (partial && (!thing || isAwaited(thing)));
    });
    if (partial) return;
    if (this.thing && !model.thing(this.thing)) this.thing = null;
    this.lit = new Set([...this.lit].filter((name) => model.thing(name)));
  }

  isDrawn(hit) {
    return Boolean(hit) && this.app.model.drawings.includes(hit.drawing) && hit.drawing.object.visible;
  }

  changed() {
    this.mark();
    this.app.panes.drawSelected();
    this.app.panes.drawTree();
  }

  /** Names that are lit, with what groups and shells hold. */
  litNames() {
    const { model } = this.app;
    const names = new Set(this.lit);
    if (this.thing && this.picks.length === 0) names.add(this.thing);
    if (this.over) names.add(this.over);
    for (const name of [...names])
      for (const one of model.thing(name)?.of ?? []) if (!(model.thing(name).buffers?.length > 0)) names.add(one);
    return names;
  }

  /** Writes hover, picks and lit things into the picture. */
  mark() {
    const { model, stage, marks } = this.app;
    const lit = this.litNames();
    for (const drawing of model.drawings) {
      const mine = (hit) => hit && hit.drawing === drawing && hit.kind !== 'side';
      drawing.mark('hovered', mine(this.hovered) ? this.hovered.item : null);
      const chosen = [...this.picks].reverse().find(mine);
      drawing.mark('chosen', chosen ? chosen.item : null);
      drawing.set({ glow: lit.has(drawing.name) ? (drawing.isSolid ? 0.45 : 0.85) : 0 });
    }
    this.sides.show([this.hovered, ...this.picks].map((hit) => (hit?.kind === 'side' && this.isDrawn(hit) ? hit : null)));
    const [a, b] = this.picks;
    const step = a && b && Math.hypot(...a.point.map((p, i) => b.point[i] - p));
    marks?.setMeasure(
      this.picks.length || this.measuring ? a : null,
      b,
      b ? `${coordinate(step, stage.sphere().radius)} ${model.frame.units}` : '',
    );
    stage.invalidate();
  }
}

const isSame = (one, other) =>
  ['drawing', 'kind', 'item', 'node'].every((name) => one?.[name] === other?.[name]) && `${one?.nodes}` === `${other?.nodes}`;
