// From a frame to what stands in the picture. All buffers of a frame are fetched first, then everything changes at once.

import { Buffers } from './buffers.js';
import { Drawing } from './drawing.js';
import { FaceNames } from './face_names.js';

/** Shades that say something about meshes only; with one of them meshes are shown instead of their surfaces. */
export const MESH_SHADES = new Set(['mesh', 'quality-angle', 'quality-jacobian', 'quality-length', 'decided']);

export class Model {
  constructor(stage, state) {
    this.stage = stage;
    this.state = state;
    this.buffers = new Buffers();
    this.frame = null;
    this.byName = new Map();
    this.fitted = null; // The camera that was fitted to shapes, while the first evaluation runs.
    this.whole = null; // The last frame whose evaluation had ended.
    this.drawings = [];
    this.faces = new FaceNames([]);
    this.meshed = new Map(); // Drawing to its faces of which there is a mesh.
    this.compared = []; // Drawings of the other state of the model.
    this.newest = 0;
    this.times = {};
    // What has left is let go after the next picture: its successor then finds the shaders still compiled.
    this.leaving = [];
    stage.after.push(() => {
      for (const drawing of this.leaving.splice(0)) drawing.dispose();
      this.buffers.growTreesSoon();
    });
  }

  /**
   * Shows a frame; gives false where a newer one came meanwhile. `number` counts the calls, so that what was asked
   * first and came last is dropped.
   */
  async show(frame, server) {
    const turn = ++this.newest;
    const rows = rowsOf(frame);
    await this.buffers.load(rows, (keys) => server.buffers(keys));
    if (turn !== this.newest) return false;
    this.frame = frame;
    this.byName = new Map(frame.things.map((thing) => [thing.name, thing]));
    if (!frame.partial) this.whole = frame;
    if (this.stage.setBox(frame.partial ? grown(this.stage.box, frame.box) : frame.box)) this.moved = true;
    this.drawings = this.renew(this.drawings, frame.things);
    this.faces = new FaceNames(this.drawings);
    this.meshed = this.meshedFaces();
    this.compared = this.renew(this.compared, frame.compare?.things ?? []);
    for (const drawing of this.compared) drawing.ghost = true;
    // What a partial frame leaves out may come again with the whole one.
    this.buffers.keep([...rows, ...(frame.partial && this.whole ? rowsOf(this.whole) : [])].map(({ key }) => key));
    this.fitFirst(frame);
    return true;
  }

  /**
   * Fits the camera to the first frame, and again where the rest of the first evaluation is larger than the shapes that came
   * before it. A camera that somebody moved, or that the address brought, stays.
   */
  fitFirst(frame) {
    const { view } = this.state.get();
    const isOwn = this.fitted !== null && (view === this.fitted.view || this.stage.aim === this.fitted.view);
    if (frame.box && (!view || (isOwn && !isWithin(this.stage.box, this.fitted.box))))
      this.fitted = { view: this.stage.fit(), box: this.stage.box };
    if (!frame.partial) this.fitted = null;
  }

  /** Keeps drawings whose thing still has the same buffer, makes the new ones and drops the rest. */
  renew(old, things) {
    const byName = new Map(old.map((drawing) => [drawing.id, drawing]));
    const made = [];
    for (const thing of things) {
      for (const { key } of thing.buffers ?? []) {
        const buffer = this.buffers.get(key);
        const roles = buffer.role === 'mesh' ? [buffer.geometry && 'mesh', buffer.bars && 'bars'].filter(Boolean) : [buffer.role];
        for (const role of roles) {
          const id = `${thing.name}\n${role}\n${key}`;
          let drawing = byName.get(id);
          if (drawing) byName.delete(id);
          else {
            drawing = new Drawing(thing.name, buffer, role);
            drawing.id = id;
            this.stage.scene.add(drawing.object);
          }
          drawing.thing = thing;
          // A shell lies on the surfaces that it holds: these are before it.
          if (thing.kind === 'shell' && drawing.isSolid)
            drawing.object.material.polygonOffsetFactor = drawing.object.material.polygonOffsetUnits = 3;
          drawing.place(this.stage.origin);
          made.push(drawing);
        }
      }
    }
    for (const drawing of byName.values()) {
      drawing.object.removeFromParent();
      this.leaving.push(drawing);
    }
    const surfaces = new Map(made.filter((drawing) => drawing.role === 'faces').map((drawing) => [drawing.name, drawing]));
    for (const drawing of made) {
      const faces = surfaces.get(drawing.name);
      drawing.faceName = (n) => faces?.buffer.header.faces?.[n]?.name ?? null;
    }
    return made;
  }

  /** The faces that belong to a thing, as `{ drawing, faces }`: its own, where `faces` is null, and those that other things draw. */
  partsOf(thing) {
    const own = this.faces.drawingsOf(thing.name);
    const others = new Map();
    for (const name of thing.surfaces ?? [])
      for (const [drawing, faces] of this.faces.of(name))
        if (!own.includes(drawing)) others.set(drawing, new Set([...(others.get(drawing) ?? []), ...faces]));
    return [...own.map((drawing) => ({ drawing, faces: null })), ...[...others].map(([drawing, faces]) => ({ drawing, faces }))];
  }

  thing(name) {
    return this.byName.get(name) ?? null;
  }

  /** Whether a thing is shown: as a person said, else as the shade and the frame say. */
  isShown(thing) {
    const { shown, only, shade } = this.state.get();
    if (only) return only.includes(thing.name);
    if (thing.name in shown) return shown[thing.name];
    const meshed = this.frame.things.some((other) => other.kind === 'mesh');
    if (MESH_SHADES.has(shade) && meshed) {
      if (thing.kind === 'mesh') return true;
      if (thing.kind === 'surface' || thing.kind === 'shell') return !this.isMeshed(thing);
    }
    return thing.visible !== false;
  }

  /** Faces of which there is a mesh, by their drawing. */
  meshedFaces() {
    const found = new Map();
    for (const { role, thing, buffer } of this.drawings) {
      if ((role !== 'mesh' && role !== 'bars') || thing.unmade) continue;
      for (const { name } of buffer.header.faces ?? [])
        for (const [drawing, faces] of this.faces.of(name)) {
          if (!found.has(drawing)) found.set(drawing, new Set());
          for (const face of faces) found.get(drawing).add(face);
        }
    }
    return found;
  }

  /** Whether meshes are there of all faces of a thing. */
  isMeshed(thing) {
    const parts = this.partsOf(thing);
    return parts.length > 0 && parts.every(({ drawing, faces }) => this.areMeshed(drawing, faces ?? facesOf(drawing)));
  }

  areMeshed(drawing, faces) {
    const meshed = this.meshed.get(drawing);
    return Boolean(meshed) && [...faces].every((face) => meshed.has(face));
  }

  /** The faces that a drawing leaves out because their mesh is shown instead, or null where it leaves out none. */
  leftOut(drawing) {
    const { shown, only, shade } = this.state.get();
    if (!MESH_SHADES.has(shade) || only || drawing.name in shown || drawing.role !== 'faces') return null;
    return this.meshed.get(drawing) ?? null;
  }

  visible() {
    return this.drawings.filter((drawing) => drawing.object.visible);
  }

  /** The box of things by name, from the boxes of their buffers; groups count what they hold. */
  boxOf(names) {
    const wanted = new Set(names);
    for (const thing of this.frame?.things ?? []) {
      if (wanted.has(thing.name) && !(thing.buffers?.length > 0)) for (const name of thing.of ?? []) wanted.add(name);
    }
    let box = null;
    for (const { name, buffer } of this.drawings) {
      const own = buffer.header.box;
      if (!wanted.has(name) || !own) continue;
      box = box ? [box[0].map((l, i) => Math.min(l, own[0][i])), box[1].map((h, i) => Math.max(h, own[1][i]))] : own;
    }
    return box;
  }

  /** Names of the things whose chain of lines has this line. */
  thingsAt(file, line) {
    return (this.frame?.things ?? [])
      .filter((thing) =>
        (thing.chain ?? []).some((place) => place.file === file && line >= place.line && line <= (place.end_line ?? place.line)),
      )
      .map((thing) => thing.name);
  }
}

const facesOf = (drawing) => (drawing.buffer.header.faces ?? []).keys();

/** Whether a thing is still to be made and was not there before. */
export const isAwaited = (thing) => Boolean(thing.pending) && !(thing.buffers?.length > 0);

const rowsOf = ({ things, compare }) => [...things, ...(compare?.things ?? [])].flatMap((thing) => thing.buffers ?? []);

const isWithin = (box, other) => [0, 1, 2].every((i) => box[0][i] >= other[0][i] && box[1][i] <= other[1][i]);

/** While an evaluation runs the box only grows, so that depth and section do not jump. */
function grown(old, box) {
  if (!old || !box) return box ?? old;
  const apart = [0, 1, 2].some((i) => box[0][i] > old[1][i] || box[1][i] < old[0][i]);
  return apart ? box : [box[0].map((low, i) => Math.min(low, old[0][i])), box[1].map((high, i) => Math.max(high, old[1][i]))];
}
