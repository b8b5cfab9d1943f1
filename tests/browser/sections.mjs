// Sections: what is seen of the plane, pixel by pixel.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { colorsAt, state, until } from './browser.mjs';
import { boxMesh, surface } from './fake_buffers.mjs';
import { box, frame, thing } from './fake_models.mjs';
import { over, picture } from './harness.mjs';

const LOW = [40, 10, 5];
const SIZE = [20, 12, 8];
const middle = LOW.map((low, i) => low + SIZE[i] / 2);
const section = (axis, share, flip) => `#left=false&right=false&cut=${encodeURIComponent(JSON.stringify({ axis, share, flip }))}`;

/** Faces of a box as surfaces of their own, each about an origin of its own; every second one shows its back outwards. */
function faces(meeting = 1) {
  return box(LOW, SIZE).map((at, k) => {
    const origin = at(0.5, 0.5);
    const turned = k % 2 ? (u, v) => at(v, u) : at;
    const own = (u, v) => turned(u, v).map((x, i) => x - origin[i]);
    return surface(`wall[${k}]`, [own], { origin, cells: [3, 3], meeting });
  });
}

/** A shell of six surfaces that are drawn by themselves: it has only its edges. */
function tank({ meeting = 2, of = 6, shown = true } = {}) {
  const walls = faces();
  const edges = surface('tank', box(LOW, SIZE), { meeting })[1];
  const names = walls.slice(0, of).map((_, k) => `wall[${k}]`);
  const things = walls.map((buffers, k) => thing(`wall[${k}]`, 'surface', buffers, 7, { visible: shown || k !== 2 }));
  return frame(1, [...walls.flat(), edges], [...things, thing('tank', 'shell', [edges], 8, { of: names, surfaces: names })]);
}

/** Places of the plane `p[axis] = at`, `reach` of the way from the middle of the box to its sides. */
function places(axis, at, reach) {
  const k = 'xyz'.indexOf(axis);
  const found = [];
  for (let a = -6; a <= 6; a++)
    for (let b = -6; b <= 6; b++) {
      const shares = [(a / 6) * reach, (b / 6) * reach];
      if (reach > 1 && Math.max(Math.abs(shares[0]), Math.abs(shares[1])) < 1.15) continue;
      found.push(middle.map((m, i) => (i === k ? at : m + (shares.shift() * SIZE[i]) / 2)));
    }
  return found;
}

const isCap = ([r, g, b]) => r - g > 12 && g - b > 15 && r - b < 90;
const isRed = ([r, g, b]) => r - g > 90 && r - b > 90;
const share = (colors, is) => colors.filter(is).length / colors.length;

/** Asks that the cap fills the section of the box and nothing else. */
async function isFilled(page, axis, at) {
  const inside = share(await colorsAt(page, places(axis, at, 0.88)), isCap);
  const outside = share(await colorsAt(page, places(axis, at, 1.35)), isCap);
  assert.ok(inside > 0.98 && outside < 0.01, `${axis} = ${at}: cap on ${inside} of the inside, on ${outside} of the outside`);
}

for (const [axis, flip] of [
  ['x', false],
  ['y', true],
  ['z', false],
]) {
  test(`the section of a shell of six surfaces across ${axis} is filled, wherever the shell is`, async () => {
    await over(
      tank(),
      async ({ page }) => {
        await until(page, (now) => now.caps === 1, 'the cap of the shell');
        const k = 'xyz'.indexOf(axis);
        await isFilled(page, axis, LOW[k] + SIZE[k] * 0.4);
        await picture(page, `page-section-${axis}`);
      },
      { hash: section(axis, 0.4, flip) },
    );
  });
}

test('a closed mesh is filled, about whatever origin its numbers are', async () => {
  const net = boxMesh(LOW, SIZE);
  await over(
    frame(1, [net], [thing('net', 'mesh', [net], 9, { visible: true })]),
    async ({ page }) => {
      await until(page, (now) => now.caps === 1, 'the cap of the mesh');
      await isFilled(page, 'x', LOW[0] + SIZE[0] * 0.4);
    },
    { hash: section('x', 0.4, false) },
  );
});

for (const [what, model] of [
  ['of which a surface is hidden', tank({ shown: false })],
  ['of which a surface is missing', tank({ meeting: 1, of: 5 })],
  ['in which three faces meet on an edge', tank({ meeting: 3 })],
]) {
  test(`a shell ${what} has no inside`, async () => {
    await over(
      model,
      async ({ page }) => {
        await page.waitForTimeout(300);
        assert.equal((await state(page)).caps, 0);
        const seen = share(await colorsAt(page, places('x', LOW[0] + SIZE[0] * 0.4, 0.93)), isCap);
        assert.ok(seen < 0.01, `${seen}`);
      },
      { hash: section('x', 0.4, false) },
    );
  });
}

test('a cap goes with its body: hidden, shown again, and replaced by a new frame', async () => {
  await over(
    tank(),
    async ({ page, fake }) => {
      await until(page, (now) => now.caps === 1, 'the cap');
      const seen = async () => share(await colorsAt(page, places('x', LOW[0] + SIZE[0] * 0.4, 0.93)), isCap);
      await page.evaluate(() => (location.hash += '&left=true'));
      await page.getByRole('button', { name: 'Hide wall[2]', exact: true }).click();
      await until(page, (now) => now.caps === 0, 'no cap');
      assert.ok((await seen()) < 0.01);
      await page.getByRole('button', { name: 'Show wall[2]', exact: true }).click();
      await until(page, (now) => now.caps === 1, 'the cap again');
      await page.waitForTimeout(100);
      await isFilled(page, 'x', LOW[0] + SIZE[0] * 0.4);
      const next = tank();
      next.frame.number = 2;
      fake.show(next);
      await until(page, (now) => now.number === 2 && now.caps === 1, 'the next frame');
      await page.waitForTimeout(100);
      await isFilled(page, 'x', LOW[0] + SIZE[0] * 0.4);
    },
    { hash: section('x', 0.4, false) },
  );
});

// The upper half and the lower one, cut where the box ends or begins: the face in the plane stays as it is.
for (const [cut, flip] of [
  [1, false],
  [0, true],
]) {
  test(`a face in the plane is drawn without noise: ${cut}`, async () => {
    await over(
      tank(),
      async ({ page }) => {
        await page.waitForTimeout(300);
        const at = LOW[0] + SIZE[0] * cut;
        if (cut === 0) {
          await page.locator('#picture').focus();
          await page.evaluate(() => (location.hash = location.hash.replace(/&view=[^&]*/, '') + '&view=-1.2,0.4,30,50,16,9'));
          await page.waitForTimeout(300);
        }
        const colors = await colorsAt(page, places('x', at, 0.9));
        const spread = [0, 1, 2].map((k) => Math.max(...colors.map((c) => c[k])) - Math.min(...colors.map((c) => c[k])));
        assert.ok(Math.max(...spread) < 24, `colours of one face differ by ${spread}`);
        assert.ok(share(colors, isRed) === 0 && share(colors, isCap) === 0, 'no cut and no cap');
        await picture(page, `page-section-on-face-${cut}`);
        const hit = await page.evaluate((point) => window.loftView.pick(...window.loftView.toScreen(point).slice(0, 2)), [
          at,
          middle[1] + 0.3,
          middle[2] + 0.2,
        ]);
        assert.ok(hit.point && Math.abs(hit.point[0] - at) < 1e-3, JSON.stringify(hit));
      },
      { hash: section('x', cut, flip) },
    );
  });
}

/** Cuts across each axis by the button and asks that the whole cap is seen. */
async function areSeen(page) {
  for (const axis of ['y', 'z', 'x']) {
    await page.getByRole('button', { name: `Section across ${axis}` }).click();
    await page.waitForTimeout(250);
    await picture(page, `page-section-away-${axis}`);
    const k = 'xyz'.indexOf(axis);
    await isFilled(page, axis, LOW[k] + SIZE[k] * 0.5);
  }
}

test('a section keeps the half away from the eye, so that the cut is seen', async () => {
  await over(
    tank(),
    async ({ page }) => {
      await page.locator('#picture').focus();
      await page.keyboard.press('s');
      await areSeen(page);
      // From behind it is the other one.
      await page.evaluate(() => (location.hash = `${location.hash.replace(/&?view=[^&]*/, '')}&view=3.7,-0.6,36,50,16,9`));
      await areSeen(page);
      const { flip } = (await state(page)).settings.cut;
      await page.getByRole('button', { name: 'Other side' }).click();
      assert.equal((await state(page)).settings.cut.flip, !flip);
    },
    { hash: '#left=false&right=false' },
  );
});
