// The section plane: what lies before it is not drawn, and closed bodies get a cap where it goes through them.

import {
  AlwaysStencilFunc,
  DecrementWrapStencilOp,
  DoubleSide,
  GLSL3,
  IncrementWrapStencilOp,
  Mesh,
  NotEqualStencilFunc,
  PlaneGeometry,
  RawShaderMaterial,
  Vector3,
  ZeroStencilOp,
} from 'three';
import { shared } from './drawing.js';
import { CAP_FRAGMENT, STENCIL_VERTEX } from './shaders_lines.js';
import { colorOf, theme } from './theme.js';

const AXES = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] };

export class Section {
  constructor(stage, state) {
    this.stage = stage;
    this.state = state;
    this.caps = new Map(); // Drawing to its cap.
    this.plane = null;
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
    shared.cut.value.set(there.x, there.y, there.z, -there.dot(on));
  }

  /** Makes caps for these drawings, which are closed and visible, and takes all others away. */
  setCapped(drawings) {
    const wanted = new Set(this.plane ? drawings : []);
    for (const [drawing, cap] of this.caps) {
      if (wanted.has(drawing) && drawing.passes.length > 0) continue;
      drawing.dropPasses();
      cap.removeFromParent();
      cap.geometry.dispose();
      cap.material.dispose();
      this.caps.delete(drawing);
    }
    for (const drawing of wanted) {
      if (!this.caps.has(drawing)) this.addCap(drawing);
      this.placeCap(drawing);
    }
  }

  addCap(drawing) {
    const passes = drawing.stencilPasses(AlwaysStencilFunc, IncrementWrapStencilOp, DecrementWrapStencilOp);
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
        stencilFail: ZeroStencilOp,
        stencilZFail: ZeroStencilOp,
        stencilZPass: ZeroStencilOp,
      }),
    );
    cap.matrixAutoUpdate = false;
    cap.frustumCulled = false;
    this.caps.set(drawing, cap);
    // Each body is counted and capped before the next, so that bodies inside each other do not mix.
    const order = -1000 + this.caps.size * 2;
    for (const pass of passes) pass.renderOrder = order;
    cap.renderOrder = order + 1;
    for (const object of [...passes, cap]) this.stage.scene.add(object);
  }

  placeCap(drawing) {
    const cap = this.caps.get(drawing);
    const { center, radius } = this.stage.sphere();
    const normal = new Vector3(...this.plane.normal);
    const side = Math.abs(normal.z) > 0.5 ? new Vector3(1, 0, 0) : new Vector3(0, 0, 1);
    const other = new Vector3().crossVectors(normal, side);
    const size = radius * 2.5;
    const at = center.map((c, i) => (this.plane.normal[i] !== 0 ? this.at : c) - this.stage.origin[i]);
    cap.matrix.makeBasis(side.multiplyScalar(size), other.multiplyScalar(size), normal).setPosition(...at);
    cap.matrixWorldNeedsUpdate = true;
    cap.material.uniforms.color.value.copy(colorOf(drawing.capColor ?? theme.cap));
  }
}
