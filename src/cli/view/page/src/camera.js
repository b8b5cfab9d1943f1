// The camera as a person thinks of it: a point looked at, two angles, and the height of what is seen at that point.
// All lengths are model units in double precision; only differences from the scene's origin go to the graphics card.

import { OrthographicCamera, PerspectiveCamera, Vector3 } from 'three';

const OPENING = (32 * Math.PI) / 180;

/** Yaw turns about z (0 looks along +y, from the front), pitch is the height of the eye above the horizon. */
export const STANDARD_VIEWS = {
  front: [0, 0],
  back: [Math.PI, 0],
  right: [Math.PI / 2, 0],
  left: [-Math.PI / 2, 0],
  top: [0, Math.PI / 2],
  bottom: [0, -Math.PI / 2],
  iso: [Math.PI / 5, Math.asin(0.48)],
};

/** The three directions of a view: `eye` from the target to the camera, `right` and `up` on the screen. */
export function directions({ yaw, pitch }) {
  const [sy, cy, sp, cp] = [Math.sin(yaw), Math.cos(yaw), Math.sin(pitch), Math.cos(pitch)];
  return { eye: [sy * cp, -cy * cp, sp], right: [cy, sy, 0], up: [-sy * sp, cy * sp, cp] };
}

/** How far the eye is from the target. */
export const distanceOf = (view) => view.height / 2 / Math.tan(OPENING / 2);

/** A view of a whole box, `[[x, y, z], [x, y, z]]`. */
export function fitted(view, box, aspect) {
  const { eye, right, up } = directions(view);
  const target = box[0].map((low, i) => (low + box[1][i]) / 2);
  const half = box[0].map((low, i) => (box[1][i] - low) / 2);
  const slope = Math.tan(OPENING / 2);
  // The least distance, or height, at which each corner of the box is on the screen.
  let height = 0;
  for (let corner = 0; corner < 8; corner++) {
    const at = half.map((h, i) => (corner & (1 << i) ? h : -h));
    const along = (d) => d[0] * at[0] + d[1] * at[1] + d[2] * at[2];
    const needed = 2 * Math.max(Math.abs(along(up)), Math.abs(along(right)) / Math.max(aspect, 0.1));
    height = Math.max(height, view.flat ? needed : needed + 2 * slope * along(eye));
  }
  if (!(height > 0)) height = 1;
  return { ...view, target, height: height * 1.08 };
}

/** The cameras of three.js, set from a view. */
export class Camera {
  constructor() {
    this.perspective = new PerspectiveCamera();
    this.flat = new OrthographicCamera();
    for (const camera of [this.perspective, this.flat]) camera.matrixAutoUpdate = false;
  }

  /** Sets matrices for a view, relative to `origin`; near and far enclose the sphere about `center`. */
  set(view, aspect, origin, center, radius) {
    const { eye, right, up } = directions(view);
    const away = distanceOf(view);
    const at = view.target.map((t, i) => t + eye[i] * away - origin[i]);
    const toCenter = center.map((c, i) => c - origin[i] - at[i]);
    const depth = -(toCenter[0] * eye[0] + toCenter[1] * eye[1] + toCenter[2] * eye[2]);
    const camera = view.flat ? this.flat : this.perspective;
    const reach = Math.max(radius * 1.05, view.height * 1e-3);
    camera.far = Math.max(depth + reach, away * 1e-2);
    camera.near = view.flat ? depth - reach : Math.max(depth - reach, camera.far * 2e-5, away * 1e-4);
    if (view.flat) {
      camera.top = view.height / 2;
      camera.bottom = -camera.top;
      camera.right = camera.top * aspect;
      camera.left = -camera.right;
    } else {
      camera.fov = (OPENING * 180) / Math.PI;
      camera.aspect = aspect;
    }
    camera.updateProjectionMatrix();
    camera.matrix.makeBasis(new Vector3(...right), new Vector3(...up), new Vector3(...eye)).setPosition(...at);
    camera.matrix.decompose(camera.position, camera.quaternion, camera.scale);
    camera.matrixWorld.copy(camera.matrix);
    camera.matrixWorldInverse.copy(camera.matrix).invert();
    this.now = camera;
    this.at = at;
    return camera;
  }
}

/** The ray through a place of the screen (−1…1 each way): start and direction, absolute. */
export function rayThrough(view, aspect, x, y) {
  const { eye, right, up } = directions(view);
  const [h, w] = [(y * view.height) / 2, (x * view.height * aspect) / 2];
  const away = distanceOf(view);
  const onPlane = view.target.map((t, i) => t + right[i] * w + up[i] * h);
  if (view.flat) return { start: onPlane.map((p, i) => p + eye[i] * away), along: eye.map((e) => -e), point: onPlane };
  const start = view.target.map((t, i) => t + eye[i] * away);
  const along = onPlane.map((p, i) => p - start[i]);
  const length = Math.hypot(...along);
  return { start, along: along.map((a) => a / length), point: onPlane };
}

/** Zooms by a factor so that the point under the cursor stays there. */
export function zoomed(view, factor, aspect, x, y, point = null) {
  const height = Math.min(Math.max(view.height * factor, 1e-13), 1e12);
  const real = height / view.height;
  const held = point ?? rayThrough(view, aspect, x, y).point;
  return { ...view, height, target: view.target.map((t, i) => held[i] + (t - held[i]) * real) };
}

/** Moves the target by a part of the screen's height, right and up. */
export function panned(view, dx, dy) {
  const { right, up } = directions(view);
  return { ...view, target: view.target.map((t, i) => t - (right[i] * dx + up[i] * dy) * view.height) };
}

export function turned(view, dyaw, dpitch) {
  const limit = Math.PI / 2;
  return { ...view, yaw: view.yaw + dyaw, pitch: Math.min(limit, Math.max(-limit, view.pitch + dpitch)) };
}
