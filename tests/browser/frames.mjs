// Frames: what stays when one comes, what must not happen when many come, and the one-file page.

import assert from 'node:assert/strict';
import { writeFileSync } from 'node:fs';
import { test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { canvasBox, open, PICTURES, ready, shareDrawn, state, until } from './browser.mjs';
import { large, roof } from './fake_models.mjs';
import { oneFile } from './fake_server.mjs';
import { browser, over, picture, tab } from './harness.mjs';

test('a reload keeps camera, visibility and shade; a frame keeps them too', async () => {
  await over(roof(1), async ({ page, fake }) => {
    const box = await canvasBox(page);
    await page.mouse.move(box.x + 300, box.y + 300);
    await page.mouse.down();
    await page.mouse.move(box.x + 380, box.y + 330, { steps: 5 });
    await page.mouse.up();
    await page.mouse.wheel(0, -300);
    await page.keyboard.press('o');
    await page.getByRole('button', { name: 'Hide wall' }).click();
    await page.selectOption('#shade', 'zebra');
    await page.waitForTimeout(400);
    const camera = () => page.evaluate(() => window.loftView.camera());
    const before = await camera();
    assert.equal(before.flat, true);
    fake.show(roof(2, { rise: 1.5 }));
    await ready(page, 2);
    assert.deepEqual(await camera(), before);
    await page.reload();
    const now = await ready(page, 2);
    const again = await camera();
    for (const name of ['yaw', 'pitch', 'height']) assert.ok(Math.abs(again[name] - before[name]) < 1e-9, name);
    assert.ok(!now.drawn.includes('wall:faces'));
    assert.equal(now.settings.shade, 'zebra');
  });
});

test('a broken script keeps what it cannot make, greyed, and shows its gap', async () => {
  await over(roof(1), async ({ page, fake }) => {
    fake.show(roof(2, { broken: true }));
    const now = await ready(page, 2);
    assert.ok(now.marks >= 4);
    await page.getByText('what is grey is drawn as it was before').waitFor();
    await tab(page, 'problems');
    assert.match(await page.locator('#pane-problems').innerText(), /E501[\s\S]*gap of 0.12 m/);
    assert.match(await page.locator('.line.error').getAttribute('title'), /E501/);
    const far = (await page.evaluate(() => window.loftView.camera())).height;
    await page.locator('.problem button').first().click();
    await page.waitForTimeout(300);
    assert.ok((await page.evaluate(() => window.loftView.camera())).height < far / 3);
    await page.getByText('E501 · 0.12 m').waitFor();
    assert.match(await page.locator('[data-key="porch"]').innerText(), /not made/);
    await picture(page, 'page-broken');
    fake.show(roof(3));
    await until(page, (s) => s.number === 3 && s.marks === 0, 'the marks gone');
  });
});

test('zooming in asks for finer display triangles', async () => {
  await over(roof(1), async ({ page, fake }) => {
    await page.locator('#picture').focus();
    for (let i = 0; i < 12; i++) await page.keyboard.press('+');
    await until(page, () => fake.posts.some((post) => post.what === 'refine' && post.error < 0.01), 'the finer error');
  });
});

test('two tabs show the same frames and keep their own cameras', async () => {
  await over(roof(1), async ({ page, fake }) => {
    const second = await open(browser, fake.address);
    await ready(second.page, 1);
    await second.page.locator('#picture').focus();
    await second.page.keyboard.press('2');
    fake.show(roof(2, { rise: 2 }));
    await Promise.all([ready(page, 2), ready(second.page, 2)]);
    const [a, b] = await Promise.all([page, second.page].map((one) => one.evaluate(() => window.loftView.camera().pitch)));
    assert.ok(Math.abs(a - b) > 0.5);
    assert.deepEqual(second.complaints, []);
    await second.close();
  });
});

test('a lost connection is told, and is taken up again', async () => {
  await over(roof(1), async ({ page, fake, complaints }) => {
    await fake.close();
    await page.getByText('connection lost').waitFor();
    fake.hold(roof(1, { rise: 2 })); // A server that starts again counts from 1.
    await fake.again();
    await page.locator('.link-state.on').waitFor();
    await page.waitForTimeout(300);
    // The browser itself writes of refused connections; the page does not.
    for (let i = complaints.length - 1; i >= 0; i--)
      if (/ERR_(CONNECTION_REFUSED|INCOMPLETE_CHUNKED_ENCODING|EMPTY_RESPONSE|CONNECTION_RESET)/.test(complaints[i]))
        complaints.splice(i, 1);
  });
});

test('200 frames in 10 s: the last is shown, an older never follows a newer, nothing is left behind', async (t) => {
  await over(roof(1), async ({ page, fake }) => {
    const start = await state(page);
    await page.evaluate(() => {
      window.seen = [];
      const look = () => {
        const { number } = window.loftView.state();
        if (window.seen.at(-1) !== number) window.seen.push(number);
        requestAnimationFrame(look);
      };
      look();
    });
    for (let number = 2; number <= 200; number++) {
      fake.delays.set(number, number % 7 === 0 ? 90 : 0);
      fake.show(roof(number, { rise: 1 + 0.005 * number }));
      await page.waitForTimeout(45);
    }
    const now = await ready(page, 200);
    const seen = await page.evaluate(() => window.seen);
    assert.deepEqual(
      seen,
      [...seen].sort((a, b) => a - b),
    );
    await page.waitForTimeout(300);
    const end = await state(page);
    assert.equal(end.geometries, start.geometries);
    assert.equal(end.buffers, start.buffers);
    assert.equal(end.textures, start.textures);
    t.diagnostic(
      `${seen.length} of 200 frames shown; ${Math.round(now.times.shown - now.times.heard)} ms from the news of the last to its picture`,
    );
  });
});

test('only buffers that are not in memory are fetched', async () => {
  await over(roof(1), async ({ page, fake, requests }) => {
    const before = requests.filter((url) => url.includes('/buffers/')).length;
    const next = roof(1);
    next.frame.number = 2;
    fake.show(next);
    await ready(page, 2);
    assert.equal(requests.filter((url) => url.includes('/buffers/')).length, before);
  });
});

test('a million triangles: hover, pick, draw calls and bytes', async (t) => {
  await over(large(1), async ({ page }) => {
    const now = await state(page);
    assert.ok(now.triangles > 999_000);
    const box = await canvasBox(page);
    const times = await page.evaluate(({ width, height }) => {
      const all = [];
      for (let i = 0; i < 200; i++)
        all.push(window.loftView.pick(width * (0.3 + 0.4 * ((i * 0.618) % 1)), height * (0.35 + 0.3 * ((i * 0.414) % 1))));
      return { hits: all.filter((hit) => hit.thing).length, ms: all.map((hit) => hit.ms).sort((a, b) => a - b) };
    }, box);
    t.diagnostic(
      `${now.triangles} triangles, ${now.drawCalls} draw calls, ${(now.bytes / 1e6).toFixed(1)} MB on the wire; pick: median ${times.ms[100].toFixed(2)} ms, longest ${times.ms.at(-1).toFixed(2)} ms; from the news to the picture ${Math.round(now.times.shown - now.times.heard)} ms`,
    );
    assert.ok(times.hits > 150);
    assert.ok(times.ms[100] < 20 && times.ms[190] < 50, String(times.ms[190]));
    assert.ok(now.drawCalls <= 2);
    await picture(page, 'page-million');
  });
});

test('one file opens from the disk without any request', async () => {
  const path = `${PICTURES}one.html`;
  writeFileSync(path, oneFile(roof(1)));
  const opened = await open(browser, pathToFileURL(path).href);
  const now = await ready(opened.page, 1);
  assert.equal(now.live, false);
  assert.ok((await shareDrawn(opened.page)) > 0.1);
  assert.deepEqual(
    opened.requests.filter((url) => !url.startsWith('blob:') && !url.startsWith('data:')),
    [pathToFileURL(path).href],
  );
  await tab(opened.page, 'params');
  assert.equal(await opened.page.getByRole('slider', { name: /^rise/ }).isDisabled(), true);
  assert.deepEqual(opened.complaints, []);
  await opened.close();
});
