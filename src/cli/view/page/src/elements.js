// Elements of a mesh by number, triangles first: their corners, their sides, and what lies beside a side.

import { Vector3 } from 'three';

export function cornersOf({ triangles, quads }, item) {
  const nt = (triangles?.length ?? 0) / 3;
  return item < nt ? [...triangles.subarray(3 * item, 3 * item + 3)] : [...quads.subarray(4 * (item - nt), 4 * (item - nt) + 4)];
}

/** The sides of an element, each as its two nodes. */
export function sidesOf(arrays, item) {
  const corners = cornersOf(arrays, item);
  return corners.map((node, k) => [node, corners[(k + 1) % corners.length]]);
}

/** Numbers of the elements that have this side. Only triangles near the middle of the side are looked at. */
export function elementsBeside(buffer, [a, b]) {
  const { arrays, index, tree } = buffer;
  const [from, to] = [a, b].map((node) => new Vector3().fromArray(arrays.positions, 3 * node));
  const middle = from.clone().add(to).multiplyScalar(0.5);
  const slack = from.distanceTo(to) * 1e-3;
  const found = new Set();
  const hasNode = (triangle, node) => [0, 1, 2].some((k) => index[3 * triangle + k] === node);
  tree.shapecast({
    intersectsBounds: (box) => box.distanceToPoint(middle) <= slack,
    intersectsTriangle(_, triangle) {
      if (!hasNode(triangle, a) || !hasNode(triangle, b)) return;
      const item = buffer.itemOf(triangle);
      if (sidesOf(arrays, item).some((side) => side.includes(a) && side.includes(b))) found.add(item);
    },
  });
  return [...found].sort((one, other) => one - other);
}

export const elementCount = ({ arrays }) => (arrays.triangles?.length ?? 0) / 3 + (arrays.quads?.length ?? 0) / 4;
