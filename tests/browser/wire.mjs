// Reading of buffers, without a browser.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { grouped, parted } from '../../src/cli/view/page/src/together.js';
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

test('small buffers are asked for together, a large one alone, and no request for more than the server takes', () => {
  const rows = (sizes) => sizes.map((bytes, i) => ({ key: `k${i}`, bytes }));
  assert.deepEqual(grouped(rows([10, 300_000, 262_144, 10])), [['k0', 'k2', 'k3'], ['k1']]);
  assert.deepEqual(
    grouped(rows(new Array(9).fill(200_000))).map((keys) => keys.length),
    [5, 4],
  );
  assert.deepEqual(
    grouped(rows(new Array(150).fill(9))).map((keys) => keys.length),
    [64, 64, 22],
  );
  assert.deepEqual(grouped([]), []);
});

test('an answer to several is parted; one that is missing leaves the others', () => {
  const bytes = new Uint8Array([1, 2, 3, 4, 5]).buffer;
  const of = (lengths) => [...parted(['a', 'b', 'c'], lengths, bytes)].map(([key, part]) => [key, ...new Uint8Array(part)]);
  assert.deepEqual(of('2,-,3'), [
    ['a', 1, 2],
    ['c', 3, 4, 5],
  ]);
  assert.equal(parted(['a'], null, bytes).get('a'), bytes);
  for (const lengths of ['2,3', '2,-,4', '2,-,2', '2,x,3', '']) assert.throws(() => of(lengths), /does not fit/);
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
