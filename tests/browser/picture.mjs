// The picture: drawing, picking, shades, section, places far from the origin.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { canvasBox, open, ready, shareDrawn, state, until } from './browser.mjs';
import { roof } from './fake_models.mjs';
import { startFake } from './fake_server.mjs';
import { browser, clickAt, over, picture, tab } from './harness.mjs';

test('the roof is drawn, one call a buffer, and nothing is drawn while nothing changes', async () => {
  await over(roof(1), async ({ page, requests }) => {
    const now = await state(page);
    assert.equal(now.drawCalls, now.drawn.length);
    assert.equal(now.buffers, 9);
    assert.ok((await shareDrawn(page)) > 0.1);
    assert.equal(requests.filter((url) => url.includes('/buffers/')).length, 1);
    await page.waitForTimeout(200);
    const before = (await state(page)).pictures;
    await page.waitForTimeout(400);
    assert.equal((await state(page)).pictures, before);
    await picture(page, 'page-roof');
  });
});

test('a browser without WebGL2 is told so', async () => {
  const fake = await startFake(roof(1));
  const context = await browser.newContext();
  const page = await context.newPage();
  await page.addInitScript(() => {
    HTMLCanvasElement.prototype.getContext = () => null;
  });
  await page.goto(fake.address);
  await page.getByRole('alert').filter({ hasText: 'WebGL2' }).waitFor();
  await context.close();
  await fake.close();
});

test('a click picks, opens the chain of lines and asks the editor; a second one measures', async () => {
  await over(roof(1), async ({ page, fake }) => {
    await clickAt(page, [5.75, 1.25, 0.5]); // The top of the tank.
    let now = await state(page);
    assert.equal(now.picks[0].thing, 'tank');
    assert.equal(now.picks[0].kind, 'face');
    assert.ok(Math.abs(now.picks[0].point[2] - 0.5) < 1e-4);
    const chain = await page.locator('.chain .where').allTextContents();
    assert.deepEqual(chain, ['roof.loft:8', 'roof.loft:2']);
    assert.equal(await page.locator('.chain a').first().getAttribute('href'), 'vscode://file/models/roof.loft:8:1');
    await until(page, () => fake.posts.some((post) => post.what === 'show' && post.line === 8), 'the request to show the line');
    await page.keyboard.down('Shift');
    await clickAt(page, [1, 0, 1.2 * Math.sin(Math.PI / 4)]); // The curve `south`.
    await page.keyboard.up('Shift');
    now = await state(page);
    assert.equal(now.picks.length, 2);
    assert.equal(now.picks[1].kind, 'edge');
    assert.match(await page.locator('#pane-selected').innerText(), /distance\s+[\d.]+ m/);
    await picture(page, 'page-measure');
    await page.keyboard.press('Escape');
    assert.equal((await state(page)).picks.length, 0);
    await clickAt(page, [4, 0, 0]);
    assert.equal((await state(page)).picks[0].kind, 'point');
  });
});

test('elements and nodes of a mesh are picked; quality has a histogram that filters', async () => {
  await over(roof(1), async ({ page }) => {
    await page.selectOption('#shade', 'quality-angle');
    let now = await until(
      page,
      (s) => s.drawn.includes('plate:mesh') && !s.drawn.includes('roof:faces'),
      'the mesh instead of its surface',
    );
    await page.locator('.histogram').waitFor();
    assert.match(await page.locator('#legend').innerText(), /210 elements/);
    const box = await canvasBox(page);
    const [x, y] = await page.evaluate(() => window.loftView.toScreen([2.45, 0.45, 1.25]));
    const hit = await page.evaluate(([a, b]) => window.loftView.pick(a, b), [x, y]);
    assert.equal(hit.thing, 'plate');
    assert.ok(['element', 'side', 'node'].includes(hit.kind));
    await page.mouse.click(box.x + x, box.y + y);
    await tab(page, 'selected');
    assert.match(await page.locator('#pane-selected').innerText(), /plate, (element|side|node) \d+/);
    const bars = await page.locator('.histogram').boundingBox();
    await page.mouse.move(bars.x + bars.width * 0.5, bars.y + 30);
    await page.mouse.down();
    await page.mouse.move(bars.x + bars.width * 0.75, bars.y + 30, { steps: 4 });
    await page.mouse.up();
    await page.getByText(/\d+ of 210 elements/).waitFor();
    await picture(page, 'page-quality');
    for (const shade of [
      'quality-jacobian',
      'quality-length',
      'decided',
      'mesh',
      'patch',
      'group',
      'gauss',
      'mean',
      'zebra',
      'side',
      'edges',
      'plain',
    ]) {
      await page.selectOption('#shade', shade);
      await page.waitForTimeout(120);
      now = await state(page);
      assert.equal(now.settings.shade, shade);
      assert.ok((await shareDrawn(page)) > 0.08, shade);
      await picture(page, `page-shade-${shade}`);
    }
  });
});

test('a section plane cuts, closed bodies are capped, and picks go past what is cut', async () => {
  await over(roof(1), async ({ page }) => {
    await page.locator('#picture').focus();
    await page.keyboard.press('s');
    await until(page, (s) => s.caps === 1 && s.drawCalls === s.drawn.length + 2, 'the cap of the tank, in two calls');
    await page.getByRole('slider', { name: 'Place of the section plane' }).fill('0.88');
    await page.waitForTimeout(200);
    await picture(page, 'page-section');
    const x = await page.evaluate(() => {
      const [sx, sy] = window.loftView.toScreen([6.5, 1.25, -0.25]);
      return window.loftView.pick(sx, sy);
    });
    assert.ok(!x.point || x.point[0] < 5.8, JSON.stringify(x));
    await page.keyboard.press('Escape');
    await page.getByRole('button', { name: 'Section off' }).click();
    await until(page, (s) => s.caps === 0, 'no cap');
  });
});

test('the other state of a compare is laid over, and what moved is coloured', async () => {
  await over(roof(1, { compare: 'golden' }), async ({ page }) => {
    const calls = (await state(page)).drawCalls;
    assert.equal(calls, (await state(page)).drawn.length + 2);
    await page.selectOption('#shade', 'moved');
    await page.locator('.scale.rise').waitFor();
    await page.waitForTimeout(200);
    await picture(page, 'page-compare');
  });
});

test('a model 1e6 m from the origin does not jitter and is picked to the millimetre', async () => {
  const origin = [1e6, -1e6, 5e5];
  await over(roof(1, { origin }), async ({ page }) => {
    const camera = await page.evaluate(() => window.loftView.camera());
    assert.ok(Math.abs(camera.origin[0] - 1e6) < 10);
    assert.ok((await shareDrawn(page)) > 0.1);
    await clickAt(page, [origin[0] + 5.75, origin[1] + 1.25, origin[2] + 0.5]);
    const [hit] = (await state(page)).picks;
    assert.equal(hit.thing, 'tank');
    assert.ok(Math.abs(hit.point[2] - origin[2] - 0.5) < 1e-3);
    await picture(page, 'page-far');
    // Far away the picture is that of the same model at the origin.
    const near = await startFake(roof(1));
    const other = await open(browser, near.address);
    await ready(other.page, 1);
    await page.keyboard.press('Escape');
    await page.mouse.move(2, 2);
    const shares = await Promise.all([shareDrawn(page), shareDrawn(other.page)]);
    assert.ok(Math.abs(shares[0] - shares[1]) < 0.002, String(shares));
    await other.close();
    await near.close();
  });
});

test('touch turns with one finger and zooms with two', async () => {
  await over(roof(1), async ({ page }) => {
    const before = await page.evaluate(() => window.loftView.camera());
    const touch = (type, points) =>
      page.evaluate(
        ([name, list]) => {
          const canvas = document.getElementById('picture');
          const box = canvas.getBoundingClientRect();
          canvas.setPointerCapture = () => {};
          for (const [id, x, y] of list)
            canvas.dispatchEvent(
              new PointerEvent(name, {
                pointerId: id,
                pointerType: 'touch',
                clientX: box.left + x,
                clientY: box.top + y,
                bubbles: true,
                buttons: 1,
              }),
            );
        },
        [type, points],
      );
    await touch('pointerdown', [[1, 200, 200]]);
    await touch('pointermove', [
      [1, 220, 210],
      [1, 260, 230],
    ]);
    await touch('pointerup', [[1, 260, 230]]);
    const turned = await page.evaluate(() => window.loftView.camera());
    assert.notEqual(turned.yaw, before.yaw);
    await touch('pointerdown', [
      [1, 200, 200],
      [2, 300, 200],
    ]);
    await touch('pointermove', [
      [1, 150, 200],
      [2, 350, 200],
    ]);
    await touch('pointerup', [
      [1, 150, 200],
      [2, 350, 200],
    ]);
    assert.ok((await page.evaluate(() => window.loftView.camera())).height < before.height * 0.7);
  });
});
