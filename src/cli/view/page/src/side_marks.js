// Lines over the sides of elements that are hovered or picked: a mesh has no lines of its own for them.

import { Drawing } from './drawing.js';
import { lineGeometry } from './geometry.js';

const NONE = 0xffffffff;
const MOST = 3; // One under the cursor and two picks.

export class SideMarks {
  constructor(stage) {
    this.stage = stage;
    this.shown = 0;
    const geometry = lineGeometry({ origin: [0, 0, 0] }, new Float32Array(6 * MOST), [0, 2, 4, 6]);
    const drawing = new Drawing('', { bars: { geometry } }, 'bars');
    drawing.mark('hovered', 0);
    drawing.mark('chosen', 1);
    this.object = drawing.object;
    this.object.frustumCulled = false;
    this.object.visible = false;
    this.row = geometry.getAttribute('from').data;
    this.edge = geometry.getAttribute('edge');
    stage.scene.add(this.object);
  }

  /** `hits` are picks of sides: the first is the one under the cursor; null where there is none. */
  show(hits) {
    this.edge.array.fill(NONE);
    hits.forEach((hit, i) => {
      if (!hit) return;
      const { origin, arrays } = hit.drawing.buffer;
      hit.nodes.forEach((node, end) => {
        for (let k = 0; k < 3; k++)
          this.row.array[6 * i + 3 * end + k] = arrays.positions[3 * node + k] + (origin[k] - this.stage.origin[k]);
      });
      this.edge.array[2 * i] = i === 0 ? 0 : 1;
    });
    this.row.needsUpdate = this.edge.needsUpdate = true;
    this.shown = hits.filter(Boolean).length;
    this.object.visible = this.shown > 0;
  }
}
