// From a save to the changed picture, with the program itself where LOFT names it: medians over some saves, in milliseconds.

import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, renameSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { open, ready, until } from './browser.mjs';
import { browser, serve } from './harness.mjs';

const SAVES = 21;

const roof = (rise) => `units m
param bays = 3 in 1 to 8
curve south = arc((0, 0, 0), (4, 0, 0), through: (2, 0, ${rise}))
curve north = arc((0, 3, 0), (4, 3, 0), through: (2, 3, ${rise}))
curve west = line((0, 0, 0), (0, 3, 0))
curve east = line((4, 0, 0), (4, 3, 0))
surface roof = coons(south, east, north, west)
curve foot = line((0, 0, -2), (4, 0, -2))
surface wall = ruled(foot, line((0, 0, -1), (4, 0, -1)))
mesh fine of roof { size: 0.4 }
check "steep": ${rise} > 1
report "sizes": [{area: roof.area, length: south.length}]
`;

const porch = (rise) =>
  readFileSync(fileURLToPath(new URL('../../examples/porch.loft', import.meta.url)), 'utf8').replaceAll('(4, 6, 2)', `(4, 6, ${rise + 1})`);

/** Faces beside each other; the last is higher each time. */
const faces = (rise) =>
  Array.from({ length: 25 }, (_, i) => {
    const [x, y, z] = [(i % 5) * 5, Math.floor(i / 5) * 4, i === 24 ? rise : 1];
    const arc = (v) => `arc((${x}, ${y + v}, 0), (${x + 4}, ${y + v}, 0), through: (${x + 2}, ${y + v}, ${z}))`;
    return `curve low${i} = ${arc(0)}\ncurve high${i} = ${arc(3)}\nsurface face${i} = ruled(low${i}, high${i})\n`;
  }).reduce((text, face) => text + face, 'units m\n');

/** A mesh of 200 000 triangles, all of them moved by each save. */
const deck = (rise) => `units m
curve front = arc((0, 0, 0), (100, 0, 0), through: (50, 0, 12))
curve back = arc((0, 100, 0), (100, 100, 0), through: (50, 100, ${10 + rise}))
surface deck = ruled(front, back)
mesh net of deck { size: 0.32 elements: triangles }
`;

const middle = (values) => values.toSorted((a, b) => a - b)[values.length >> 1];

/** Saves as an editor does that renames, and waits for the picture; gives the times from the save on. */
async function saved(page, folder, text) {
  writeFileSync(join(folder, 'new'), text);
  const before = await page.evaluate(() => ({ number: window.loftView.state().number, offset: Date.now() - performance.now() }));
  await new Promise((done) => setTimeout(done, 150 + 40 * Math.random()));
  const at = Date.now() - before.offset;
  renameSync(join(folder, 'new'), join(folder, 'model.loft'));
  const { times, ...now } = await until(
    page,
    (s) => s.number > before.number && !s.partial && s.times.number === s.number && s.times.shown,
    'the next picture',
    60,
  );
  return { heard: times.heard - at, fetched: times.fetched - at, loaded: times.loaded - at, shown: times.shown - at, triangles: now.triangles };
}

/** `bound` is for the fastest save, on a loaded machine and with a program that is not optimized. */
async function measure(t, script, bound) {
  const folder = mkdtempSync(join(tmpdir(), 'loft-saves-'));
  writeFileSync(join(folder, 'model.loft'), script(1));
  const { address, stop } = await serve(join(folder, 'model.loft'));
  const { page, requests, complaints, close } = await open(browser, `${address}#shade=mesh`);
  try {
    await ready(page, undefined, 60);
    const all = [];
    let count = 0;
    for (let k = 1; k <= SAVES; k++) {
      const asked = requests.length;
      all.push(await saved(page, folder, script(1 + k / 50)));
      count = requests.slice(asked).filter((url) => url.startsWith('http')).length;
    }
    const of = (name) => middle(all.map((one) => one[name]));
    const seconds = await page.locator('#status .time').innerText();
    const least = Math.min(...all.map(({ shown }) => shown));
    t.diagnostic(
      `${of('triangles')} triangles, ${count} requests; event ${of('heard').toFixed(0)}, frame ${of('fetched').toFixed(0)}, buffers ${of('loaded').toFixed(0)}, picture ${of('shown').toFixed(0)} ms after the save, ${least.toFixed(0)} at best (${seconds})`,
    );
    assert.ok(least < bound, `${least} ms`);
    assert.deepEqual(complaints, []);
  } finally {
    await close();
    await stop();
    rmSync(folder, { recursive: true });
  }
}

if (process.env.LOFT) {
  for (const [name, script, bound] of [
    ['a roof', roof, 500],
    ['the porch', porch, 1000],
    ['one face of 25', faces, 500],
    ['200 000 triangles', deck, 4000],
  ])
    test(`a save of ${name}`, { timeout: 240_000 }, (t) => measure(t, script, bound));
}
