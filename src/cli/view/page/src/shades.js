// How the picture is coloured: what each shade writes into the drawings, and the legend that goes with it.

import { Drawing, updateShared } from './drawing.js';
import { lineGeometry, segmentsOf } from './geometry.js';
import { RULES } from './shade_rules.js';
import { rgb, theme } from './theme.js';

export const SHADES = [
  ['plain', 'Plain'],
  ['patch', 'By patch'],
  ['group', 'By group'],
  ['mesh', 'Mesh with edges'],
  ['quality-angle', 'Quality: least angle'],
  ['quality-jacobian', 'Quality: scaled Jacobian'],
  ['quality-length', 'Quality: edge length'],
  ['decided', 'What decided the size'],
  ['gauss', 'Gauss curvature'],
  ['mean', 'Mean curvature'],
  ['zebra', 'Zebra'],
  ['side', 'Side (inside out)'],
  ['edges', 'Free and three-face edges'],
  ['moved', 'Moved (compare)'],
];

/** Applies colours and visibility; `tell(legend)` is called when the legend is known. Later calls replace earlier ones. */
export class Shades {
  constructor(model, stage, state) {
    Object.assign(this, { model, stage, state, turn: 0, brush: null, sides: [] });
  }

  async apply(tell) {
    const turn = ++this.turn;
    const { shade, colors } = this.state.get();
    updateShared();
    const current = () => turn === this.turn;
    const legend = { shade, entries: null, histogram: null, scale: null, note: null };
    for (const drawing of this.model.drawings) {
      const { thing } = drawing;
      drawing.object.visible = this.model.isShown(thing);
      const leftOut = this.model.leftOut(drawing);
      drawing.filter = leftOut && ((face) => !leftOut.has(face));
      if (drawing.role === 'faces') drawing.showFaces(leftOut ? [...leftOut].join() : '', drawing.filter);
      const own = colors[thing.name] ?? thing.color;
      const base = drawing.isLine
        ? drawing.role === 'edges'
          ? theme.ink
          : (own ?? theme.curve)
        : drawing.role === 'points'
          ? (own ?? theme.point)
          : (own ?? (drawing.role === 'mesh' ? theme.mesh : theme.surface));
      drawing.capColor = own;
      drawing.set({ mode: 0, color: base, stale: thing.stale ? 0.8 : 0, opacity: 1 });
      if (drawing.role === 'edges') drawing.set({ width: shade === 'edges' ? 2.2 : 1.3 });
    }
    for (const drawing of this.model.compared)
      drawing.set({ mode: 0, color: theme.other, opacity: drawing.isSolid ? 0.35 : 0.8, sides: 0.2 });
    for (const drawing of this.sides.splice(0)) drawing.dispose();
    const made = RULES[shade.split('-')[0]]?.call(this, legend, shade, current);
    tell(legend);
    this.stage.invalidate();
    if (made) {
      try {
        await made;
      } catch (error) {
        // A newer frame has taken away what was measured.
        if (current()) legend.note = error.message;
      }
      if (!current()) return;
      tell(legend);
      this.stage.invalidate();
    }
  }

  solids(role) {
    return this.model.drawings.filter((drawing) => drawing.isSolid && (!role || drawing.role === role));
  }

  /** Lines over the sides of a mesh that one element has, or three and more. */
  drawSides(drawing, ends, counts) {
    const { points, starts } = segmentsOf(drawing.buffer.arrays.positions, ends);
    const made = new Drawing(
      drawing.name,
      { ...drawing.buffer, bars: { points, starts, geometry: lineGeometry(drawing.buffer.header, points, starts) } },
      'bars',
    );
    made.setColors(counts.length, (bytes) =>
      counts.forEach((n, i) => bytes.set([...rgb(n === 1 ? theme.loose : theme.triple).map((c) => c * 255), 190], 4 * i)),
    );
    made.set({ mode: 1 });
    made.ownGeometry = true;
    made.place(this.stage.origin);
    this.stage.scene.add(made.object);
    return made;
  }

  /** Sets what alone is drawn: values of the measure `[from, to]`, the name of an entry of the legend, or null for all. */
  setBrush(range) {
    this.brush = range;
  }
}
