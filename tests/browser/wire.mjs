// Reading of buffers, without a browser.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { readBuffer } from '../../src/cli/view/page/src/wire.js';
import { buffer, inSteps } from './fake_buffers.mjs';

const read = ({ bytes }) => readBuffer(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
const flat = (nodes, arrays) => buffer('mesh', [0, 0, 0], null, { positions: ['f32', 3, new Array(3 * nodes).fill(0)], ...arrays });

test('indices in steps are read as they were', () => {
  const triangles = [5, 0, 39, 2, 1, 0, 30, 31, 39];
  const quads = [0, 1, 12, 11, 39, 38, 27, 28];
  const made = flat(40, { triangles: inSteps(3, triangles), quads: inSteps(4, quads), lines: inSteps(2, [7, 3]) });
  const { header, arrays } = read(made);
  assert.deepEqual([header.arrays.triangles.coding, header.arrays.triangles.type], ['steps', 'i16']);
  assert.ok(arrays.triangles instanceof Uint32Array);
  assert.deepEqual([...arrays.triangles], triangles);
  assert.deepEqual([...arrays.quads], quads);
  assert.deepEqual([...arrays.lines], [7, 3]);
});

test('steps that leave the points, and codings that nobody knows, are refused', () => {
  assert.throws(() => read(flat(40, { lines: ['i16', 2, [7, -8], 'steps'] })), /lines name point/);
  assert.throws(() => read(flat(40, { lines: ['i16', 2, [7, 40], 'steps'] })), /lines name point 47 of 40/);
  assert.throws(() => read(flat(40, { lines: ['i16', 2, [7, 1], 'knots'] })), /coding knots/);
});

test('a million triangles in steps', (t) => {
  const n = 707;
  const triangles = [];
  for (let j = 0; j < n; j++)
    for (let i = 0; i < n; i++) {
      const a = j * (n + 1) + i;
      triangles.push(a, a + 1, a + n + 2, a, a + n + 2, a + n + 1);
    }
  const median = (array) => {
    const made = flat((n + 1) ** 2, { triangles: array });
    const times = Array.from({ length: 9 }, () => {
      const began = performance.now();
      read(made);
      return performance.now() - began;
    });
    return times.sort((a, b) => a - b)[4];
  };
  const [steps, plain] = [median(inSteps(3, triangles)), median(['u32', 3, triangles])];
  t.diagnostic(`reading of ${triangles.length / 3} triangles: ${steps.toFixed(1)} ms in steps, ${plain.toFixed(1)} ms plain`);
  assert.ok(steps < 200, String(steps));
});
