// The section plane: what lies before it is not drawn, and closed bodies get a cap where it goes through them.

import {
  AlwaysStencilFunc,
  DoubleSide,
  GLSL3,
  InvertStencilOp,
  Mesh,
  NotEqualStencilFunc,
  PlaneGeometry,
  RawShaderMaterial,
  Vector3,
} from 'three';
import { directions, STANDARD_VIEWS } from './camera.js';
import { shared } from './drawing.js';
import { onlyFaces, release } from './geometry.js';
import { CAP_FRAGMENT, STENCIL_FRAGMENT, STENCIL_VERTEX } from './shaders_lines.js';
import { colorOf, theme } from './theme.js';

const AXES = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] };

// What lies in the plane is kept. By this share of the farthest length the plane gives way, more than its numbers are rounded.
const SLACK = 8e-6;

/** Whether a section across an axis keeps the upper half: it is the one away from the eye, so that the cut is seen. */
export function keepsUpper(axis, view) {
  const k = 'xyz'.indexOf(axis);
  const along = directions(view).eye[k];
  const [yaw, pitch] = STANDARD_VIEWS.iso;
  // From beside the plane both halves are seen alike.
  return (Math.abs(along) > 1e-3 ? along : directions({ yaw, pitch }).eye[k]) < 0;
}

export class Section {
  constructor(stage, state) {
    this.stage = stage;
    this.state = state;
    this.caps = new Map(); // By the key of the body: the body, its cap, and what counts its faces.
    this.plane = null;
    // Every face turns over what is marked: a place of the plane is inside where a ray from it meets an odd number of them.
    this.counting = new RawShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: STENCIL_VERTEX,
      fragmentShader: STENCIL_FRAGMENT,
      uniforms: { cut: shared.cut },
      side: DoubleSide,
      colorWrite: false,
      depthWrite: false,
      depthTest: false,
      stencilWrite: true,
      stencilFunc: AlwaysStencilFunc,
      stencilZPass: InvertStencilOp,
    });
    stage.before.push((camera) => this.toCamera(camera));
  }

  /** The plane as `{ normal, offset }`, absolute: points with normal · p + offset < 0 are cut away. */
  update() {
    const { cut } = this.state.get();
    const box = this.stage.box;
    if (!cut || !box) this.plane = null;
    else {
      const sign = cut.flip ? 1 : -1;
      const normal = AXES[cut.axis].map((a) => a * sign);
      const k = 'xyz'.indexOf(cut.axis);
      this.at = box[0][k] + (box[1][k] - box[0][k]) * cut.share;
      this.plane = { normal, offset: -sign * this.at };
    }
    this.stage.invalidate();
  }

  toCamera(camera) {
    if (!this.plane) {
      shared.cut.value.set(0, 0, 0, 1);
      return;
    }
    const { normal } = this.plane;
    const there = new Vector3(...normal).transformDirection(camera.matrixWorldInverse);
    // A point of the plane near the scene's origin, taken into the camera's frame.
    const k = normal.findIndex((n) => n !== 0);
    const on = new Vector3();
    on.setComponent(k, this.at - this.stage.origin[k]);
    on.applyMatrix4(camera.matrixWorldInverse);
    const { center, radius } = this.stage.sphere();
    const slack = SLACK * (radius + Math.hypot(...center.map((c, i) => c - this.stage.origin[i])) + Math.hypot(...this.stage.camera.at));
    shared.cut.value.set(there.x, there.y, there.z, slack - there.dot(on));
    this.plane.offset = slack - normal[k] * this.at;
    // A body of which something has left or is hidden since has no inside.
    for (const { body, cap, passes } of this.caps.values()) {
      const whole = body.parts.every(({ drawing }) => drawing.object.visible && drawing.object.parent);
      for (const object of [cap, ...passes]) object.visible = whole;
    }
  }

  /** Makes caps for these closed bodies, `{ key, parts: [{ drawing, faces }], color }`, and takes all others away. */
  setCapped(bodies) {
    const wanted = new Map((this.plane ? bodies : []).map((body) => [body.key, body]));
    for (const [key, made] of this.caps) {
      const parts = wanted.get(key)?.parts ?? [];
      if (made.body.parts.every(({ drawing }, i) => drawing === parts[i]?.drawing)) continue;
      this.drop(made);
      this.caps.delete(key);
    }
    // Each body is counted and capped before the next, so that bodies inside each other do not mix.
    let order = -2 * wanted.size;
    for (const [key, body] of wanted) {
      if (!this.caps.has(key)) this.caps.set(key, this.made(body));
      const { cap, passes } = this.caps.get(key);
      for (const pass of passes) pass.renderOrder = order;
      cap.renderOrder = order + 1;
      order += 2;
      this.placeCap(cap, body.color ?? theme.cap);
    }
  }

  made(body) {
    const passes = body.parts.map(({ drawing, faces }) => {
      const pass = new Mesh(faces ? onlyFaces(drawing.buffer, (face) => faces.has(face)) : drawing.buffer.geometry, this.counting);
      // It is where the drawing is, wherever that goes.
      pass.matrixAutoUpdate = false;
      pass.matrixWorldNeedsUpdate = true;
      drawing.object.add(pass);
      return pass;
    });
    const cap = new Mesh(
      new PlaneGeometry(1, 1),
      new RawShaderMaterial({
        glslVersion: GLSL3,
        vertexShader: STENCIL_VERTEX,
        fragmentShader: CAP_FRAGMENT,
        side: DoubleSide,
        polygonOffset: true,
        polygonOffsetFactor: 4,
        polygonOffsetUnits: 40, // The line of the section stays before it.
        uniforms: { color: { value: colorOf(theme.cap) } },
        stencilWrite: true,
        stencilRef: 0,
        stencilFunc: NotEqualStencilFunc,
      }),
    );
    cap.matrixAutoUpdate = false;
    cap.frustumCulled = false;
    cap.onAfterRender = (renderer) => renderer.clearStencil();
    this.stage.scene.add(cap);
    return { body, cap, passes };
  }

  drop({ body, cap, passes }) {
    passes.forEach((pass, i) => {
      pass.removeFromParent();
      if (body.parts[i].faces) release(pass.geometry);
    });
    cap.removeFromParent();
    cap.geometry.dispose();
    cap.material.dispose();
  }

  placeCap(cap, color) {
    const { center, radius } = this.stage.sphere();
    const normal = new Vector3(...this.plane.normal);
    const side = Math.abs(normal.z) > 0.5 ? new Vector3(1, 0, 0) : new Vector3(0, 0, 1);
    const other = new Vector3().crossVectors(normal, side);
    const size = radius * 2.5;
    const at = center.map((c, i) => (this.plane.normal[i] !== 0 ? this.at : c) - this.stage.origin[i]);
    cap.matrix.makeBasis(side.multiplyScalar(size), other.multiplyScalar(size), normal).setPosition(...at);
    cap.matrixWorldNeedsUpdate = true;
    cap.material.uniforms.color.value.copy(colorOf(color));
  }
}
