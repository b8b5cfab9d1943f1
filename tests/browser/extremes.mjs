// Models and windows at their limits: nothing at all, one point, huge and tiny, long lists, narrow windows.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { contrasts } from './accessibility.mjs';
import { canvasBox, ready, shareDrawn, state, until } from './browser.mjs';
import { curve, points, surface } from './fake_buffers.mjs';
import { frame, roof, thing } from './fake_models.mjs';
import { clickAt, over, picture, tab } from './harness.mjs';

const KEYS = ['f', '1', '2', '3', '0', 'o', 's', 's', 'o', 'f', '+', '-', 'm', 'Escape'];

/** Goes through what works on any model. */
async function useAll(page) {
  await page.locator('#picture').focus();
  for (const key of KEYS) await page.keyboard.press(key);
  for (const value of await page.locator('#shade option').evaluateAll((all) => all.map((one) => one.value))) {
    await page.selectOption('#shade', value);
    await page.waitForTimeout(15);
  }
  await page.selectOption('#shade', 'plain');
  for (const name of ['script', 'params', 'problems', 'checks', 'reports', 'selected']) await tab(page, name);
  const camera = await page.evaluate(() => window.loftView.camera());
  assert.ok([camera.yaw, camera.pitch, camera.height, ...camera.target].every(Number.isFinite), JSON.stringify(camera));
}

test('a model of nothing', async () => {
  await over(frame(1, [], []), async ({ page, fake }) => {
    assert.match(await page.locator('#tree').innerText(), /declares nothing/);
    await useAll(page);
    const box = await canvasBox(page);
    await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
    // The first shapes are fitted, as nobody has seen anything yet.
    fake.show(roof(2));
    await ready(page, 2);
    assert.ok((await shareDrawn(page)) > 0.05);
  });
});

for (const [what, at] of [
  ['at the origin', [0, 0, 0]],
  ['far away', [1e6, -2e6, 3e5]],
]) {
  test(`a model of one point ${what}`, async () => {
    const one = points(['P'], [[0, 0, 0]], at);
    await over(frame(1, [one], [thing('P', 'point', [one], 5)]), async ({ page }) => {
      await useAll(page);
      await page.keyboard.press('f');
      await clickAt(page, at);
      assert.equal((await state(page)).picks[0]?.thing, 'P');
      await picture(page, 'page-point');
    });
  });
}

for (const size of [1e9, 1e-9]) {
  test(`a model of size ${size}`, async () => {
    const bow = (u, v) => [size * u, size * v, 0.2 * size * Math.sin(Math.PI * u)];
    const faces = surface('bow', [bow], { cells: [24, 24] });
    const rim = curve('rim', (t) => bow(t, 0));
    const made = frame(1, [...faces, rim], [thing('bow', 'surface', faces, 7), thing('rim', 'curve', [rim], 6)], { chord_error: size / 4000 });
    await over(made, async ({ page }) => {
      assert.ok((await shareDrawn(page)) > 0.1, `${await shareDrawn(page)} drawn`);
      await useAll(page);
      await page.keyboard.press('0');
      await clickAt(page, bow(0.5, 0.5));
      const [hit] = (await state(page)).picks;
      assert.equal(hit?.thing, 'bow');
      bow(0.5, 0.5).forEach((x, i) => assert.ok(Math.abs(hit.point[i] - x) < 0.02 * size, `${hit.point}`));
      await page.mouse.move(...(await middleOf(page)));
      const told = await page.locator('#status .coordinates').innerText();
      assert.ok(told.length < 60 && told.split(/\s+/).some((text) => Number(text) !== 0), told);
      const height = () => page.evaluate(() => window.loftView.camera().height);
      const before = await height();
      for (let i = 0; i < 4; i++) await page.mouse.wheel(0, -400);
      await page.waitForTimeout(100);
      assert.ok((await height()) < before / 5, 'zoomed in');
      const { width, height: high } = await canvasBox(page);
      const seen = await page.evaluate(([x, y]) => window.loftView.pick(x, y), [width / 2, high / 2]);
      assert.equal(seen.thing, 'bow');
      await picture(page, `page-size-${size}`);
    });
  });
}

async function middleOf(page) {
  const box = await canvasBox(page);
  return [box.x + box.width / 2, box.y + box.height / 2];
}

/** A list of `count` surfaces, a row each. */
function list(number, count) {
  const members = Array.from({ length: count }, (_, i) =>
    surface(`bay[${i}]`, [(u, v) => [i + 0.9 * u, 3 * v, Math.sin(u + i)]], { cells: [4, 4] }),
  );
  return frame(
    number,
    members.flat(),
    members.map((buffers, i) => thing(`bay[${i}]`, 'surface', buffers, 7)),
  );
}

test('sixty members of a list: a row each, rows that nothing changes stay', async () => {
  await over(list(1, 60), async ({ page, fake }) => {
    assert.equal(await page.locator('#tree .thing').count(), 60);
    await page.locator('[data-key="bay[59]"]').click();
    await until(page, (now) => now.chosen === 'bay[59]', 'the last one chosen');
    await page.evaluate(() => (document.querySelector('[data-key="bay[30]"]').dataset.same = 'yes'));
    const next = list(2, 60);
    next.frame.sources[0].text = `${next.frame.sources[0].text}// more\n`;
    fake.show(next);
    await ready(page, 2);
    assert.equal(await page.locator('[data-key="bay[30]"]').getAttribute('data-same'), 'yes');
    await page.getByRole('button', { name: 'Hide bay[3]', exact: true }).click();
    await until(page, (now) => !now.drawn.includes('bay[3]:faces') && now.drawn.includes('bay[30]:faces'), 'one hidden');
    await page.fill('#search', 'bay[5');
    assert.equal(await page.locator('#tree .thing').count(), 11);
  });
});

test('five thousand members: one row, which opens some rows at a time', async (t) => {
  const list = (name, count) => Array.from({ length: count }, (_, i) => `${name}[${i}]`);
  const names = list('bay', 5000);
  const at = (i) => [i % 100, Math.floor(i / 100), 0];
  // Without the edges, which a browser that draws by software is slow with.
  const [bays] = surface(
    'bay',
    names.map((_, i) => (u, v) => [at(i)[0] + 0.8 * u, at(i)[1] + 0.8 * v, 0]),
    { names, cells: [1, 1] },
  );
  const dots = points(
    list('dot', 60),
    list('dot', 60).map((_, i) => [i, -3, 0]),
  );
  const ribs = curve('rib[7]', (t) => [99 * t, -2, 0]);
  const facts = (count) => ({ facts: [['members', String(count)]] });
  const things = [
    thing('bay', 'surface', [bays], 7, facts(5000)),
    thing('dot', 'point', [dots], 5, facts(60)),
    thing('rib', 'curve', [ribs], 6, facts(1)),
  ];
  await over(frame(1, [bays, dots, ribs], things), async ({ page, fake }) => {
    const members = page.locator('#tree .member:not(.more)');
    assert.equal(await page.locator('#tree [role=treeitem]').count(), 6);
    await page.locator('[data-key="bay"]').focus();
    await page.keyboard.press('ArrowRight');
    assert.equal(await members.count(), 200);
    assert.equal(await page.locator('[data-key="bay"]').getAttribute('aria-expanded'), 'true');
    await page.locator('[data-key="member bay[150]"]').click();
    const [hit] = (await state(page)).picks;
    assert.deepEqual([hit.thing, hit.kind, hit.item], ['bay', 'face', 150]);
    at(150).forEach((low, k) => assert.ok(hit.point[k] >= low - 1e-5 && hit.point[k] <= low + 0.8, `${hit.point}`));
    assert.equal(await page.locator('[data-key="member bay[150]"]').getAttribute('aria-selected'), 'true');
    await page.getByText('200 more of 4800').click();
    assert.equal(await members.count(), 400);
    // What nothing changes stays, and a frame leaves open what is open.
    await page.evaluate(() => (document.querySelector('[data-key="member bay[399]"]').dataset.same = 'yes'));
    const next = frame(2, [bays, dots, ribs], things);
    fake.show(next);
    await ready(page, 2);
    assert.equal(await page.locator('[data-key="member bay[399]"]').getAttribute('data-same'), 'yes');
    await page.locator('[data-key="dot"] .turn').click();
    await page.locator('[data-key="member dot[59]"]').click();
    assert.deepEqual((await state(page)).picks[0].point, [59, -3, 0]);
    await page.locator('[data-key="rib"] .turn').click();
    await page.locator('[data-key="member rib[7]"]').click();
    assert.equal((await state(page)).picks[0].kind, 'edge');
    const ms = await page.evaluate(() => {
      const field = document.getElementById('search');
      const began = performance.now();
      field.value = 'bay[499';
      field.dispatchEvent(new Event('input'));
      return performance.now() - began;
    });
    assert.deepEqual(await members.allInnerTexts(), ['bay[499]', ...list('bay', 5000).slice(4990)]);
    t.diagnostic(`a search among 5000 members: ${ms.toFixed(1)} ms`);
    assert.ok(ms < 300, `${ms}`);
    await page.fill('#search', '');
    await page.locator('[data-key="bay"]').focus();
    await page.keyboard.press('ArrowLeft');
    assert.equal(await page.locator('[data-key^="member bay"]').count(), 0);
  });
});

test('lines of the script that are the same stay; numbers, marks and clicks are those of the new text', async () => {
  await over(roof(1), async ({ page, fake }) => {
    await page.evaluate(() => (document.querySelector('.line[data-line="7"]').dataset.same = 'yes'));
    const text = (await page.locator('.line code').allTextContents()).join('\n');
    const script = text.replace('fn profile', '// one more\n// and another\nfn profile');
    fake.show(roof(2, { script }));
    await ready(page, 2);
    assert.equal((await page.locator('.line code').allTextContents()).join('\n'), script);
    const count = script.split('\n').length;
    assert.deepEqual(
      await page.locator('.line .number').allTextContents(),
      Array.from({ length: count }, (_, i) => String(i + 1)),
    );
    assert.equal(await page.locator('.line[data-line="9"]').getAttribute('data-same'), 'yes');
    fake.show(roof(3, { script, rise: 0.8, broken: true }));
    await ready(page, 3);
    assert.equal(await page.locator('.line.error').count(), 2);
    await page.locator('.line[data-line="7"]').click();
    await until(page, (now) => now.lit.includes('roof'), 'what line 7 made');
    fake.show(roof(4, { script: 'units m' }));
    await ready(page, 4);
    assert.deepEqual(await page.locator('.line').allTextContents(), ['1units m']);
    assert.equal(await page.locator('.line.error').count(), 0);
  });
});

for (const colorScheme of ['light', 'dark']) {
  test(`a window of 400 pixels in ${colorScheme}: everything is reached, nothing is covered`, async () => {
    await over(
      roof(1, { broken: true }),
      async ({ page }) => {
        await picture(page, `page-narrow-${colorScheme}`);
        assert.ok((await shareDrawn(page)) > 0.05);
        const wide = await page.evaluate(() => document.documentElement.scrollWidth);
        assert.ok(wide <= 400, `the page is ${wide} wide`);
        for (const selector of ['#stale', '#tabs', '#status', '#toolbar', '#picture']) {
          const box = await page.locator(selector).boundingBox();
          assert.ok(box.x >= 0 && box.x + box.width <= 400.5 && box.width > 100, `${selector}: ${JSON.stringify(box)}`);
        }
        for (const name of ['script', 'params', 'problems', 'checks', 'reports', 'selected']) {
          await tab(page, name);
          const { unnamed, poor } = await contrasts(page);
          assert.deepEqual([unnamed, poor], [[], []], name);
        }
        await page.selectOption('#shade', 'patch');
        await page.keyboard.press('s');
        const boxes = await Promise.all(['#legend', '.section-bar', '#stale'].map((name) => page.locator(name).boundingBox()));
        boxes.forEach((one, i) => {
          assert.ok(one.x >= 0 && one.x + one.width <= 400.5 && one.width > 200, JSON.stringify(one));
          const other = boxes[(i + 1) % boxes.length];
          const apart = one.y >= other.y + other.height || other.y >= one.y + one.height;
          assert.ok(apart, `${JSON.stringify(one)} and ${JSON.stringify(other)}`);
        });
        await picture(page, `page-narrow-section-${colorScheme}`);
        await page.keyboard.press('s');
        await page.getByRole('button', { name: 'Tree', exact: true }).click();
        await page.locator('[data-key="roof"]').click();
        assert.equal((await state(page)).chosen, 'roof');
        await page.getByRole('button', { name: 'Tree', exact: true }).click();
        await until(page, (now) => now.settings.left === false, 'the tree closed');
        await page.getByRole('button', { name: 'Script and tables' }).click();
        await until(page, (now) => now.settings.right === false, 'the panes closed');
        await picture(page, `page-narrow-alone-${colorScheme}`);
      },
      { width: 400, height: 720, colorScheme },
    );
  });
}
