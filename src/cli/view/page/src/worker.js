// What is done beside the page, in a worker: trees for picking, element measures, distances between two states.

import { BufferAttribute, BufferGeometry, Vector3 } from 'three';
import { MeshBVH } from 'three-mesh-bvh';
import { measureElements, openSides } from './quality.js';

const TASKS = {
  /** A bounding volume hierarchy over triangles, which leaves their order as it is. */
  tree({ positions, index }) {
    const tree = treeOf(positions, index);
    const { roots, indirectBuffer } = MeshBVH.serialize(tree, { cloneBuffers: false });
    return { result: { roots, indirectBuffer, version: 1 }, moved: [...roots, indirectBuffer.buffer] };
  },
  quality({ measure, mesh }) {
    const result = measureElements(measure, mesh);
    return { result, moved: [result.buffer] };
  },
  sides({ mesh }) {
    const result = openSides(mesh);
    return { result, moved: [result.ends.buffer, result.counts.buffer] };
  },
  /** The distance of every point from the nearest point of the other state, whose origin lies at `shift`. */
  distances({ points, positions, index, shift }) {
    const tree = treeOf(positions, index);
    const result = new Float32Array(points.length / 3);
    const at = new Vector3();
    const hit = {};
    for (let i = 0; i < result.length; i++) {
      at.set(points[3 * i] - shift[0], points[3 * i + 1] - shift[1], points[3 * i + 2] - shift[2]);
      result[i] = tree.closestPointToPoint(at, hit)?.distance ?? NaN;
    }
    return { result, moved: [result.buffer] };
  },
};

function treeOf(positions, index) {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(positions, 3));
  geometry.setIndex(new BufferAttribute(index, 1));
  return new MeshBVH(geometry, { indirect: true });
}

/** Answers messages `{ task, input }` with `{ result }` or `{ failed }`, one after the other. */
export function startWorker() {
  self.addEventListener('message', ({ data: { task, input } }) => {
    try {
      const { result, moved } = TASKS[task](input);
      self.postMessage({ result }, moved);
    } catch (error) {
      self.postMessage({ failed: String(error?.message ?? error) });
    }
  });
}
