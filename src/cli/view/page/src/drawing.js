// What stands in the picture for one buffer of one thing: an object of three.js with uniforms of its own, one draw call.

import {
  DataTexture,
  DoubleSide,
  GLSL3,
  Mesh,
  NearestFilter,
  NormalBlending,
  Points,
  RawShaderMaterial,
  RGBAFormat,
  UnsignedByteType,
  Vector2,
  Vector4,
} from 'three';
import { onlyFaces, release } from './geometry.js';
import * as solids from './shaders_faces.js';
import * as lines from './shaders_lines.js';
import { colorOf, theme } from './theme.js';

/** Uniforms that all materials share. */
export const shared = {
  cut: { value: new Vector4(0, 0, 0, 1) },
  cutColor: { value: colorOf('#d1242f') },
  accent: { value: colorOf('#f08a00') },
  ink: { value: colorOf('#2b3440') },
  rim: { value: colorOf('#ffffff') },
  screen: { value: new Vector2(1, 1) },
  flatView: { value: false },
  nearPlane: { value: 0.1 },
};

export function updateShared() {
  shared.cutColor.value.copy(colorOf(theme.cut));
  shared.accent.value.copy(colorOf(theme.accent));
  shared.ink.value.copy(colorOf(theme.ink));
  shared.rim.value.copy(colorOf(theme.rim));
}

const NONE = 0xffffffff;
const empty = new DataTexture(new Uint8Array(4), 1, 1);

function material(vertexShader, fragmentShader, uniforms, more) {
  return new RawShaderMaterial({
    glslVersion: GLSL3,
    vertexShader,
    fragmentShader,
    uniforms: {
      ...shared,
      glow: { value: 0 },
      stale: { value: 0 },
      opacity: { value: 1 },
      color: { value: colorOf('#888888') },
      mode: { value: 0 },
      colors: { value: empty },
      ...uniforms,
    },
    side: DoubleSide,
    ...more,
  });
}

/** Faces lie behind lines, and behind the elements of a mesh of them. */
const behind = (steps) => ({ polygonOffset: true, polygonOffsetFactor: steps, polygonOffsetUnits: steps });

const KINDS = {
  faces: (buffer) =>
    new Mesh(
      buffer.geometry,
      material(
        solids.FACE_VERTEX,
        solids.FACE_FRAGMENT,
        { range: { value: new Vector2(0, 1) }, which: { value: 0 }, hovered: { value: NONE }, chosen: { value: NONE } },
        behind(2),
      ),
    ),
  mesh: (buffer) =>
    new Mesh(
      buffer.geometry,
      material(
        solids.MESH_VERTEX,
        solids.MESH_FRAGMENT,
        {
          sides: { value: 0.55 },
          triangleCount: { value: (buffer.arrays.triangles?.length ?? 0) / 3 },
          hovered: { value: -1 },
          chosen: { value: -1 },
        },
        behind(1),
      ),
    ),
  points: (buffer) =>
    new Points(
      buffer.geometry,
      material(
        lines.POINT_VERTEX,
        lines.POINT_FRAGMENT,
        { width: { value: 9 }, nearer: { value: 1.6e-3 }, hovered: { value: -1 }, chosen: { value: -1 } },
        { transparent: true },
      ),
    ),
};

function lineObject(geometry, width, nearer) {
  return new Mesh(
    geometry,
    material(
      lines.LINE_VERTEX,
      lines.LINE_FRAGMENT,
      { width: { value: width }, nearer: { value: nearer }, hovered: { value: NONE }, chosen: { value: NONE } },
      { transparent: true, depthWrite: true },
    ),
  );
}

export class Drawing {
  /** `role` is that of the buffer, or `bars` for the line elements of a mesh. */
  constructor(name, buffer, role) {
    Object.assign(this, { name, buffer, role });
    if (role === 'edges' || role === 'lines')
      this.object = lineObject(buffer.geometry, role === 'lines' ? 2.4 : 1.3, role === 'lines' ? 1.1e-3 : 6e-4);
    else if (role === 'bars') this.object = lineObject(buffer.bars.geometry, 2.2, 9e-4);
    else this.object = KINDS[role](buffer);
    this.object.matrixAutoUpdate = false;
    this.object.renderOrder = role === 'points' ? 4 : role === 'lines' ? 3 : this.isLine ? 2 : 1;
    this.uniforms = this.object.material.uniforms;
    this.texture = null;
    this.shownFaces = '';
  }

  get isLine() {
    return this.role === 'edges' || this.role === 'lines' || this.role === 'bars';
  }

  get isSolid() {
    return this.role === 'faces' || this.role === 'mesh';
  }

  /** Puts the object where it is relative to the scene's origin. */
  place(origin) {
    this.object.matrix.setPosition(...this.buffer.origin.map((o, i) => o - origin[i]));
    this.object.matrixWorldNeedsUpdate = true;
  }

  set(values) {
    for (const [name, value] of Object.entries(values)) {
      if (!(name in this.uniforms)) continue;
      if (name === 'color') this.uniforms.color.value.copy(colorOf(value));
      else if (name === 'range') this.uniforms.range.value.set(...value);
      else this.uniforms[name].value = value;
    }
    if ('opacity' in values && this.isSolid) {
      const clear = values.opacity < 1;
      this.object.material.transparent = clear;
      this.object.material.depthWrite = !clear;
      this.object.material.blending = NormalBlending;
    }
  }

  /** Draws the faces alone of which `isKept` is true, or all of them; `key` tells whether they are those of the call before. */
  showFaces(key = '', isKept = null) {
    if (this.shownFaces === key) return;
    if (this.shownFaces) release(this.object.geometry);
    this.object.geometry = isKept ? onlyFaces(this.buffer, isKept) : this.buffer.geometry;
    this.shownFaces = key;
  }

  mark(which, item) {
    const none = this.role === 'points' || this.role === 'mesh' ? -1 : NONE;
    this.uniforms[which].value = item ?? none;
  }

  /** Colours by number of face, edge or element; `fill(bytes)` writes four bytes per item. */
  setColors(count, fill) {
    const width = this.role === 'mesh' ? 2048 : 1024;
    const height = Math.max(1, Math.ceil(count / width));
    if (!this.texture || this.texture.image.height !== height) {
      this.texture?.dispose();
      this.texture = new DataTexture(new Uint8Array(width * height * 4), width, height, RGBAFormat, UnsignedByteType);
      this.texture.magFilter = this.texture.minFilter = NearestFilter;
    }
    fill(this.texture.image.data);
    this.texture.needsUpdate = true;
    this.uniforms.colors.value = this.texture;
  }

  dispose() {
    this.object.removeFromParent();
    this.showFaces();
    this.object.material.dispose();
    if (this.ownGeometry) this.object.geometry.dispose();
    this.texture?.dispose();
  }
}
