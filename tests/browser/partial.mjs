// Partial frames: shapes that come while the evaluation still runs.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { open, ready, state, until } from './browser.mjs';
import { partial, plateNode, roof } from './fake_models.mjs';
import { startFake } from './fake_server.mjs';
import { browser, clickAt, middle, over, picture, tab } from './harness.mjs';

const camera = (page) => page.evaluate(() => window.loftView.camera());
const text = (page, selector) => page.locator(selector).innerText();

test('on first open shapes come before the rest, and nothing is said of success', async () => {
  await over(partial(roof(1)), async ({ page, fake }) => {
    const now = await state(page);
    assert.equal(now.partial, true);
    assert.ok(now.drawn.includes('roof:faces'));
    assert.equal(await page.title(), '… roof.loft');
    assert.equal(await text(page, '#status .time'), 'evaluating');
    for (const name of ['problems', 'checks', 'reports']) {
      await tab(page, name);
      assert.equal(await text(page, `#pane-${name}`), 'Evaluating…');
      assert.equal(await page.locator(`#pane-${name}`).getAttribute('aria-busy'), 'true');
      assert.equal(await page.locator(`#tab-${name} .badge`).isVisible(), false);
    }
    assert.equal(await page.locator('[data-key="section checks"]').count(), 0);
    await picture(page, 'page-partial');
    fake.show(roof(2, { rise: 0.8 }));
    await ready(page, 2);
    assert.equal(await page.title(), '● roof.loft');
    assert.match(await text(page, '#status .time'), /made in 4 ms/);
    await tab(page, 'checks');
    assert.match(await text(page, '#pane-checks'), /1 of 2 checks failed/);
    assert.equal(await page.locator('#pane-checks').getAttribute('aria-busy'), 'false');
    assert.match(await page.locator('.line[data-line="10"]').getAttribute('title'), /rise > 1m/);
  });
});

/** A frame whose model reaches farther than its shapes. */
function wider(model) {
  model.frame.box = [
    [-9, -9, -9],
    [9, 9, 9],
  ];
  return model;
}

test('the camera is fitted again where the rest of the first evaluation is larger than its shapes, and never after', async () => {
  await over(partial(roof(1)), async ({ page, fake }) => {
    const shapes = await camera(page);
    fake.show(wider(roof(2)));
    await ready(page, 2);
    const whole = await camera(page);
    assert.ok(whole.height > 2 * shapes.height, `${whole.height} after ${shapes.height}`);
    assert.deepEqual(whole.target, [0, 0, 0]);
    const larger = wider(roof(3, { rise: 2 }));
    larger.frame.box[1] = [90, 90, 90];
    fake.show(larger);
    await ready(page, 3);
    assert.deepEqual(await camera(page), whole);
  });
});

test('the camera is fitted again while it still flies to the shapes', async () => {
  await over(
    partial(roof(1)),
    async ({ page, fake }) => {
      const shapes = await camera(page);
      fake.show(partial(wider(roof(2))));
      await ready(page, 2);
      fake.show(wider(roof(3)));
      await ready(page, 3);
      await page.waitForTimeout(500);
      assert.ok((await camera(page)).height > 2 * shapes.height);
    },
    { reducedMotion: 'no-preference' },
  );
});

test('a key of the view that is pressed during the first evaluation is not undone', async () => {
  const isTop = async (page) => assert.ok((await camera(page)).pitch > 1.5, JSON.stringify(await camera(page)));
  await over(
    partial(roof(1)),
    async ({ page, fake }) => {
      await page.locator('#picture').focus();
      await page.keyboard.press('2');
      fake.show(wider(roof(2)));
      await ready(page, 2);
      await page.waitForTimeout(500);
      await isTop(page);
      assert.ok((await camera(page)).height < 12);
    },
    { reducedMotion: 'no-preference' },
  );
  // Before anything is drawn.
  const fake = await startFake(partial(roof(1)));
  fake.delays.set(1, 1500);
  const { page, complaints, close } = await open(browser, fake.address);
  await page.locator('#picture').focus();
  await page.keyboard.press('2');
  await page.keyboard.press('o');
  assert.equal((await state(page)).number, null);
  await ready(page, 1);
  await isTop(page);
  const { flat, height } = await camera(page);
  assert.ok(flat && height > 3 && height < 9, `${height}`);
  assert.deepEqual(complaints, []);
  await close();
  await fake.close();
});

test('a camera that was moved, or that the address brings, is not fitted again', async () => {
  await over(partial(roof(1)), async ({ page, fake }) => {
    await page.locator('#picture').focus();
    await page.keyboard.press('ArrowLeft');
    const moved = await camera(page);
    fake.show(wider(roof(2)));
    await ready(page, 2);
    assert.deepEqual(await camera(page), moved);
  });
  const hash = '#view=0.5,0.4,12,1,2,3';
  await over(
    partial(roof(1)),
    async ({ page, fake }) => {
      fake.show(wider(roof(2)));
      await ready(page, 2);
      const { height, target } = await camera(page);
      assert.deepEqual([height, target], [12, [1, 2, 3]]);
    },
    { hash },
  );
});

test('a mesh that is still to be made is listed in grey, and its surface stays in shades of meshes', async () => {
  await over(partial(roof(1), { listed: true }), async ({ page, fake }) => {
    assert.equal(await page.locator('[data-key="plate"]').getAttribute('title'), 'plate: not made yet');
    await page.selectOption('#shade', 'mesh');
    await until(page, (now) => now.drawn.includes('roof:faces'), 'the surface');
    await page.locator('[data-key="plate"]').click();
    await tab(page, 'selected');
    assert.match(await text(page, '#pane-selected'), /Not made yet/);
    fake.show(roof(2));
    const now = await ready(page, 2);
    assert.ok(now.drawn.includes('plate:mesh') && !now.drawn.includes('roof:faces'));
    assert.equal(now.chosen, 'plate');
    assert.equal(await page.locator('[data-key="plate"]').getAttribute('title'), 'plate');
  });
});

test('a partial frame keeps checks, tables, compare, camera, selection and what is hidden of the frame before', async () => {
  const first = roof(1, { compare: 'golden' });
  await over(first, async ({ page, fake }) => {
    await page.selectOption('#shade', 'mesh');
    await page.getByRole('button', { name: 'Hide wall' }).click();
    await page.getByRole('button', { name: 'Section plane (S)' }).click();
    await clickAt(page, middle(plateNode(2, 5), plateNode(3, 6)));
    const old = await until(page, (now) => now.picks.length === 1 && now.caps === 1, 'the pick');
    const [view, cut] = [await camera(page), await text(page, '.section-bar .at')];
    const same = async (number, more) => {
      const now = await ready(page, number);
      for (const name of ['picks', 'chosen', 'compared', 'drawn']) assert.deepEqual(now[name], old[name], name);
      assert.deepEqual(await camera(page), view);
      assert.equal(await text(page, '.section-bar .at'), cut);
      return more?.();
    };
    const told = async () => {
      assert.equal(await page.title(), '… roof.loft');
      assert.match(await text(page, '#stale'), /is being evaluated/);
      assert.equal(await page.locator('#stale').evaluate((node) => node.classList.contains('running')), true);
      assert.equal(await page.locator('[aria-label="Checks"]').getAttribute('aria-busy'), 'true');
      await tab(page, 'checks');
      assert.match(await text(page, '#pane-checks'), /All 2 checks pass/);
      await tab(page, 'reports');
      assert.match(await text(page, '#pane-reports'), /wall\s+3\.25[\s\S]*roof\.svg/);
      assert.equal(await page.locator('#pane-reports').getAttribute('aria-busy'), 'true');
    };
    const next = { compare: 'golden', rise: 1.2 };
    fake.show(partial(roof(2, next), { before: first }));
    await same(2, told);
    // A mesh that is not there for a moment comes again with its pick, and is not fetched again.
    const gone = partial(roof(3, next));
    gone.frame.box = [
      [0, 0, 0],
      [1, 1, 1],
    ];
    fake.show(gone);
    const now = await ready(page, 3);
    assert.equal(now.chosen, 'plate');
    assert.deepEqual(now.picks, old.picks);
    assert.ok(!now.drawn.includes('plate:mesh'));
    assert.deepEqual(await camera(page), view);
    await page.keyboard.press('h');
    const asked = fake.asked.length;
    fake.show(roof(4, next));
    await same(4);
    assert.equal(fake.asked.slice(asked).filter((path) => path.includes('/buffers/')).length, 0);
    assert.equal(await page.locator('#stale').isVisible(), false);
    assert.equal(await page.locator('[aria-label="Checks"]').getAttribute('aria-busy'), null);
  });
});

test('files that have other numbers in a partial frame keep their marks', async () => {
  await over(roof(1, { broken: true }), async ({ page, fake }) => {
    const next = partial(roof(2));
    next.frame.sources.unshift({ file: 'profiles.loft', path: '/models/profiles.loft', text: 'units m\n' });
    fake.show(next);
    const now = await ready(page, 2);
    assert.ok(now.marks >= 4);
    await tab(page, 'problems');
    assert.match(await text(page, '#pane-problems'), /roof\.loft:8/);
    await page.locator('.problem button').first().click();
    fake.show(roof(3));
    await until(page, (s) => s.number === 3 && s.marks === 0, 'the marks gone');
  });
});

test('a partial frame asks for no finer triangles before the whole one is there', async () => {
  await over(partial(roof(1)), async ({ page, fake }) => {
    await page.locator('#picture').focus();
    for (let i = 0; i < 12; i++) await page.keyboard.press('+');
    await page.waitForTimeout(900);
    const refined = () => fake.posts.some((post) => post.what === 'refine');
    assert.equal(refined(), false);
    fake.show(roof(2));
    await until(page, refined, 'the finer error');
  });
});
