// The picture: canvas, scene and the rule that a frame is drawn only when something has changed.

import { Scene, Vector3, WebGLRenderer } from 'three';
import { Camera, fitted, STANDARD_VIEWS } from './camera.js';
import { shared } from './drawing.js';

const START = { yaw: STANDARD_VIEWS.iso[0], pitch: STANDARD_VIEWS.iso[1], height: 10, target: [0, 0, 0], flat: false };

export class Stage {
  /** `state` keeps the view; `canvas` fills its parent. Throws where the browser has no WebGL2. */
  constructor(canvas, state) {
    this.canvas = canvas;
    this.state = state;
    this.renderer = new WebGLRenderer({ canvas, antialias: true, stencil: true, alpha: true, powerPreference: 'high-performance' });
    this.renderer.setClearColor(0x000000, 0);
    this.renderer.info.autoReset = false;
    // Asking for the messages of each shader makes the page wait for the driver.
    this.renderer.debug.checkShaderErrors = false;
    this.renderer.sortObjects = true;
    this.scene = new Scene();
    this.scene.matrixAutoUpdate = false;
    this.camera = new Camera();
    this.origin = [0, 0, 0];
    this.first = {}; // Direction of the first picture, where somebody chose one before there was a model.
    this.aim = null; // The view that the camera flies to.
    this.box = null;
    this.frames = 0; // Pictures drawn since the page was opened.
    this.before = []; // Called before each picture: section plane, labels.
    this.after = [];
    this.size = { width: 1, height: 1 };
    this.waiting = false;
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    this.resize();
    canvas.addEventListener('webglcontextlost', (event) => event.preventDefault());
    canvas.addEventListener('webglcontextrestored', () => this.invalidate());
  }

  get view() {
    return this.state.get().view ?? { ...START, ...this.first };
  }

  setView(view) {
    this.stopFlight();
    const { yaw, pitch, flat } = view;
    if (this.box || this.state.get().view) this.state.set({ view });
    else this.first = { yaw, pitch, flat };
    this.invalidate();
  }

  get aspect() {
    return this.size.width / this.size.height;
  }

  resize() {
    const { clientWidth, clientHeight } = this.canvas.parentElement;
    this.size = { width: Math.max(clientWidth, 1), height: Math.max(clientHeight, 1) };
    this.renderer.setPixelRatio(Math.min(devicePixelRatio || 1, 2));
    this.renderer.setSize(this.size.width, this.size.height, false);
    // A new size empties the canvas, so the picture is drawn at once.
    if (this.started) this.draw();
    else this.invalidate();
  }

  /** Tells how large the model is. The origin of the scene moves only where the model has gone far from it. */
  setBox(box) {
    this.box = box;
    if (!box) return false;
    const center = box[0].map((low, i) => (low + box[1][i]) / 2);
    const size = Math.hypot(...box[0].map((low, i) => box[1][i] - low));
    const away = Math.hypot(...center.map((c, i) => c - this.origin[i]));
    if (away <= 4 * size) return false;
    this.origin = center;
    return true;
  }

  /** Moves the camera so that a box is seen whole; gives the view that it moves to. */
  fit(box = this.box, direction = {}) {
    if (!box) {
      Object.assign(this.first, direction);
      return null;
    }
    const view = fitted({ ...this.view, ...direction }, box, this.aspect);
    this.flyTo(view);
    return view;
  }

  /** Moves to a view in a quarter of a second, or at once where a person wants no motion. */
  flyTo(view) {
    const from = this.state.get().view;
    if (!from || matchMedia('(prefers-reduced-motion: reduce)').matches) {
      this.setView(view);
      return;
    }
    this.stopFlight();
    this.aim = view;
    const began = performance.now();
    const turn = Math.atan2(Math.sin(view.yaw - from.yaw), Math.cos(view.yaw - from.yaw));
    const step = () => {
      const share = Math.min((performance.now() - began) / 220, 1);
      const s = share * share * (3 - 2 * share);
      const mix = (a, b) => a + (b - a) * s;
      const between = {
        ...view,
        yaw: from.yaw + turn * s,
        pitch: mix(from.pitch, view.pitch),
        height: Math.exp(mix(Math.log(from.height), Math.log(view.height))),
        target: view.target.map((t, i) => mix(from.target[i], t)),
      };
      this.flight = share < 1 ? requestAnimationFrame(step) : 0;
      this.state.set({ view: share < 1 ? between : view });
      this.invalidate();
    };
    step();
  }

  stopFlight() {
    if (this.flight) cancelAnimationFrame(this.flight);
    this.flight = 0;
    this.aim = null;
  }

  invalidate() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.draw();
    });
  }

  /** The centre and radius of what is drawn. */
  sphere() {
    const [low, high] = this.box ?? [
      [-1, -1, -1],
      [1, 1, 1],
    ];
    return { center: low.map((l, i) => (l + high[i]) / 2), radius: Math.hypot(...low.map((l, i) => high[i] - l)) / 2 || 1 };
  }

  draw() {
    this.started = true;
    const began = performance.now();
    const { center, radius } = this.sphere();
    const camera = this.camera.set(this.view, this.aspect, this.origin, center, radius);
    const ratio = this.renderer.getPixelRatio();
    shared.screen.value.set(this.size.width, this.size.height);
    shared.flatView.value = Boolean(this.view.flat);
    shared.nearPlane.value = camera.near;
    for (const run of this.before) run(camera);
    this.renderer.info.reset();
    this.renderer.render(this.scene, camera);
    this.frames++;
    this.drawMs = performance.now() - began;
    this.pixelRatio = ratio;
    for (const run of this.after) run(camera);
  }

  /** Where an absolute point is on the screen, in pixels of the page from the canvas's corner; null behind the eye. */
  toScreen(point) {
    const camera = this.camera.now;
    if (!camera) return null;
    const at = new Vector3(...point.map((p, i) => p - this.origin[i])).applyMatrix4(camera.matrixWorldInverse);
    if (!this.view.flat && at.z > -camera.near * 0.5) return null;
    at.applyMatrix4(camera.projectionMatrix);
    return [(at.x * 0.5 + 0.5) * this.size.width, (0.5 - at.y * 0.5) * this.size.height, at.z];
  }

  /** Length of a pixel at a point, in model units. */
  pixelAt(point) {
    const { view } = this;
    if (view.flat) return view.height / this.size.height;
    const eye = this.camera.at.map((a, i) => a + this.origin[i]);
    const away = Math.hypot(...point.map((p, i) => p - eye[i]));
    const whole = Math.hypot(...view.target.map((t, i) => t - eye[i]));
    return (view.height / this.size.height) * (away / whole);
  }
}
