// Shades: groups, meshes of parts of a thing, curvature with sharp places.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { colorsAt, state, until } from './browser.mjs';
import { mesh, surface } from './fake_buffers.mjs';
import { frame, thing } from './fake_models.mjs';
import { over, picture } from './harness.mjs';

const shade = (name, more = '') => ({ hash: `#left=false&right=false&shade=${name}${more}` });
const fromAbove = '&view=0,1.57,4,1.5,0.5,0';
// The plane leans, so that no depth is a round number.
const onPlane = (x, y) => [x, y, 0.3713 * x + 0.2137 * y];
const square = (x) => (u, v) => onPlane(x + u, v);
const inside = (x) =>
  [0.11, 0.38, 0.52, 0.83].flatMap((u) =>
    [0.13, 0.37, 0.61, 0.87].map((v) => onPlane(x + u, v)),
  );

/** How much colour there is, 0 for a grey. */
const saturation = ([r, g, b]) => (Math.max(r, g, b) - Math.min(r, g, b)) / Math.max(r, g, b);
const mean = (colors) => [0, 1, 2].map((k) => colors.reduce((sum, c) => sum + c[k], 0) / colors.length);
/** Whether a lit colour is one of the legend: the same shares of red, green and blue. */
const isLike = (seen, text) => {
  const n = parseInt(text.slice(1), 16);
  const wanted = [(n >> 16) & 255, (n >> 8) & 255, n & 255];
  const scaled = (c) => c.map((x) => x / Math.max(...c));
  return scaled(seen).every((x, k) => Math.abs(x - scaled(wanted)[k]) < 0.12);
};
const rgbOf = (style) => `#${style.match(/\d+/g).map((x) => Number(x).toString(16).padStart(2, '0')).join('')}`;

/** The entries of the legend, name to colour. */
const legend = async (page) => {
  await page.locator('#legend li').first().waitFor();
  const entries = await page
    .locator('#legend li')
    .evaluateAll((all) => all.map((one) => [one.textContent.trim(), getComputedStyle(one.querySelector('.swatch')).backgroundColor]));
  return entries.map(([name, style]) => [name, rgbOf(style)]);
};

/** A part of three faces in a row, of which two are meshed; one of these and one more are in groups of the script. */
function part({ groups = true } = {}) {
  const names = [0, 1, 2].map((k) => `part.faces[${k}]`);
  const faces = surface('part', [0, 1, 2].map(square), { names, cells: [5, 7] });
  const net = mesh((u, v) => onPlane(2 * u, v), 8, 4, [0, 0, 0], 0, {
    faces: names.slice(0, 2),
    groups: [
      { name: 'part.faces[0]', elements: [0, 8, 16, 24].map((first) => [first + 1, first + 4]), nodes: [] },
      { name: 'part.faces[1]', elements: [0, 8, 16, 24].map((first) => [first + 5, first + 8]), nodes: [] },
      ...(groups ? [{ name: 'east', elements: [0, 8, 16, 24].map((first) => [first + 5, first + 8]), nodes: [] }] : []),
    ],
  });
  return frame(
    1,
    [...faces, net],
    [
      thing('part', 'surface', faces, 7),
      thing('net', 'mesh', [net], 9, { of: names.slice(0, 2) }),
      ...(groups
        ? [
            thing('east', 'group', [], 9, { of: names.slice(1, 2), surfaces: names.slice(1, 2) }),
            thing('far', 'group', [], 9, { of: names.slice(2), surfaces: names.slice(2) }),
            thing('nothing', 'group', [], 9),
          ]
        : []),
    ],
  );
}

test('surfaces have the colours of their groups: those of the script, then those of meshes, fainter', async () => {
  await over(
    part(),
    async ({ page }) => {
      const entries = await legend(page);
      assert.deepEqual(
        entries.map(([name]) => name),
        ['east', 'far', 'part.faces[0]'],
      );
      const seen = await Promise.all([1, 2, 0].map(async (x) => mean(await colorsAt(page, inside(x)))));
      entries.forEach(([name, color], k) => assert.ok(isLike(seen[k], color), `${name}: ${seen[k]} for ${color}`));
      assert.ok(saturation(seen[2]) < 0.7 * saturation(seen[1]), `${seen}`);
      await picture(page, 'page-groups');
    },
    shade('group', fromAbove),
  );
});

test('elements have the colour of a group of the script where they are in one, also of the mesh alone', async () => {
  await over(
    part(),
    async ({ page }) => {
      const entries = new Map(await legend(page));
      assert.deepEqual([...entries.keys()], ['east', 'part.faces[0]']);
      const east = mean(await colorsAt(page, inside(1)));
      assert.ok(isLike(east, entries.get('east')), `${east}`);
    },
    shade('group', `${fromAbove}&only=${encodeURIComponent('["net"]')}`),
  );
});

test('without groups of the script the groups of meshes have their full colours', async () => {
  await over(
    part({ groups: false }),
    async ({ page }) => {
      const entries = await legend(page);
      assert.deepEqual(
        entries.map(([name]) => name),
        ['part.faces[0]', 'part.faces[1]'],
      );
      for (const [k, [, color]] of entries.entries()) assert.ok(isLike(mean(await colorsAt(page, inside(k))), color));
    },
    shade('group', fromAbove),
  );
});

test('of a part the faces that are meshed give way to their mesh, the others stay', async () => {
  await over(
    part(),
    async ({ page }) => {
      await until(page, (now) => now.drawn.includes('net:mesh') && now.drawn.includes('part:faces'), 'mesh and part');
      const under = (points) =>
        page.evaluate((all) => all.map((p) => window.loftView.pick(...window.loftView.toScreen(p).slice(0, 2)).thing), points);
      const [west, far] = [await under(inside(0)), await under(inside(2))];
      assert.ok(west.every((name) => name === 'net') && far.every((name) => name === 'part'), `${west} ${far}`);
      // A surface is bluer than a mesh.
      const blue = async (x) => (await colorsAt(page, inside(x))).map(([r, , b]) => b - r);
      const [meshed, bare] = [await blue(0), await blue(2)];
      assert.ok(Math.max(...meshed) < Math.min(...bare), `${meshed} ${bare}`);
      await picture(page, 'page-part-meshed');
      // With another shade, and where a person shows it, the part is whole.
      await page.selectOption('#shade', 'plain');
      await page.waitForTimeout(150);
      assert.ok((await under(inside(0))).every((name) => name === 'part'));
    },
    shade('mesh', fromAbove),
  );
});

test('a mesh that is shown with its surface is before it', async () => {
  await over(
    part(),
    async ({ page }) => {
      await until(page, (now) => now.drawn.includes('net:mesh') && now.drawn.includes('part:faces'), 'mesh and part');
      const blue = (await colorsAt(page, inside(0))).map(([r, , b]) => b - r);
      const bare = (await colorsAt(page, inside(2))).map(([r, , b]) => b - r);
      assert.ok(Math.max(...blue) < Math.min(...bare), `${blue} ${bare}`);
    },
    shade('plain', `&view=0.3,0.5,4,1.5,0.5,0&shown=${encodeURIComponent('{"net":true}')}`),
  );
});

test('a few sharp places do not take all colours of curvature', async () => {
  // The sharp patch has as many points as the other one, and a thousandth of its area.
  const bow = [square(0), (u, v) => onPlane(1 + 0.001 * u, v), square(1.1)];
  const bends = [
    [0.02, 0.1],
    [500, 40],
    [0, 0],
  ];
  const faces = surface('bow', bow, { cells: [12, 12], bends });
  await over(
    frame(1, faces, [thing('bow', 'surface', faces, 7)]),
    async ({ page }) => {
      for (const [name, size] of [
        ['gauss', 0.02],
        ['mean', 0.1],
      ]) {
        await page.selectOption('#shade', name);
        await page.waitForTimeout(150);
        const ends = await page.locator('#legend .ends span').allInnerTexts();
        assert.ok(Math.abs(Number(ends[2]) - size) < 0.001 * size, `${name}: ${ends}`);
        const [bent, flat] = [mean(await colorsAt(page, inside(0))), mean(await colorsAt(page, inside(1.1)))];
        assert.ok(saturation(bent) > 0.6 && saturation(flat) < 0.1, `${bent} ${flat}`);
      }
      assert.equal((await state(page)).settings.shade, 'mean');
    },
    shade('gauss', fromAbove),
  );
});
