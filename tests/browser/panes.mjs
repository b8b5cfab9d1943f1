// The panes: tree, params, tables, script; and whether everybody can use them.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { contrasts } from './accessibility.mjs';
import { state, until } from './browser.mjs';
import { roof } from './fake_models.mjs';
import { over, picture, tab } from './harness.mjs';

test('the tree hides, shows, isolates, searches and is walked by keys', async () => {
  await over(roof(1), async ({ page }) => {
    const drawn = async (name) => (await state(page)).drawn.some((one) => one.startsWith(`${name}:`));
    await page.getByRole('button', { name: 'Hide roof', exact: true }).click();
    assert.equal(await drawn('roof'), false);
    await page.getByRole('button', { name: 'Show roof', exact: true }).click();
    assert.equal(await drawn('roof'), true);
    await page.locator('[data-key="tank"]').focus();
    await page.keyboard.press('i');
    await until(page, (now) => now.drawn.every((one) => one.startsWith('tank:')), 'the tank alone');
    await page.keyboard.press('i');
    await until(page, (now) => now.drawn.length > 4, 'all again');
    await page.keyboard.press('ArrowUp');
    await page.keyboard.press('ArrowUp');
    assert.equal(await page.evaluate(() => document.activeElement.dataset.key), 'wall');
    await page.keyboard.press(' ');
    await until(page, (now) => !now.drawn.includes('wall:faces'), 'the wall hidden by the space bar');
    await page.fill('#search', 'pla');
    assert.deepEqual(await page.locator('#tree .thing .name').allTextContents(), ['plate']);
    await page.fill('#search', '');
    await page.getByRole('button', { name: 'Hide all_of_it' }).click();
    await until(page, (now) => !now.drawn.some((one) => one.startsWith('roof:')), 'what the group holds hidden');
    await page.locator('[data-key="tank"] input[type=color]').fill('#ff0000');
    assert.equal((await state(page)).settings.colors.tank, '#ff0000');
  });
});

test('a slider sets its param with one request at a time, the last value wins, and write goes to the script', async () => {
  let number = 1;
  const onSet = (name, text) => roof(++number, { rise: parseFloat(text ?? '1.2'), set: text ? { rise: text } : {} });
  await over(
    roof(1),
    async ({ page, fake }) => {
      await tab(page, 'params');
      const slider = page.getByRole('slider', { name: /^rise/ });
      await slider.focus();
      for (let i = 0; i < 30; i++) await page.keyboard.press('ArrowRight');
      const text = await page.locator('#param-rise').inputValue();
      await until(
        page,
        () => fake.posts.length > 0 && fake.posts.at(-1).text === text && fake.inFlight === 0,
        'the last value at the server',
      );
      assert.equal(fake.mostInFlight, 1);
      assert.ok(fake.posts.length < 30, `${fake.posts.length} requests for 30 steps`);
      assert.match(text, /^[\d.]+ m$/);
      await until(page, (now) => now.number === number, 'the last frame');
      await picture(page, 'page-params');
      await page.getByRole('button', { name: 'Write rise back' }).click();
      await page.getByText('The script now has').waitFor();
      assert.deepEqual(fake.posts.at(-1), { what: 'write', name: 'rise', text });
      await page.getByRole('button', { name: 'Reset rise' }).click();
      await until(page, () => fake.posts.at(-1).text === null, 'the default asked');
      await page.locator('#param-title').fill('"a house"');
      await page.keyboard.press('Enter');
      await until(page, () => fake.posts.at(-1).name === 'title', 'the text set');
    },
    { onSet },
  );
});

test('checks and reports are tables; a failed check zooms to its things', async () => {
  await over(roof(1, { rise: 0.8 }), async ({ page }) => {
    await tab(page, 'checks');
    assert.match(await page.locator('#pane-checks').innerText(), /1 of 2 checks failed/);
    await page.locator('#pane-checks tbody button').first().click();
    assert.deepEqual((await state(page)).lit, ['roof']);
    await tab(page, 'reports');
    assert.match(await page.locator('#pane-reports').innerText(), /wall\s+3\.25/);
    await picture(page, 'page-reports');
  });
});

test('the line under the cursor of an editor lights up what it made, and so does a click on it', async () => {
  await over(roof(1), async ({ page, fake }) => {
    fake.send('cursor', { file: 'roof.loft', line: 6 });
    await until(page, (now) => now.lit.includes('south') && !now.lit.includes('roof'), 'the curve lit');
    await page.locator('.line[data-line="7"]').click();
    await until(page, (now) => now.lit.includes('roof'), 'the roof lit');
    await picture(page, 'page-lit');
  });
});

test('long work shows its phase and can be stopped', async () => {
  await over(roof(1), async ({ page, fake }) => {
    fake.send('work', { number: 2, phase: 'meshing', done: 3, of: 25, seconds: 1.2 });
    await page.getByText('meshing 3 of 25').waitFor();
    await page.getByRole('button', { name: 'Stop' }).click();
    await until(page, () => fake.posts.some((post) => post.what === 'stop'), 'the stop');
    fake.send('work', { number: 2, phase: null });
    await page.locator('#work').waitFor({ state: 'hidden' });
  });
});

for (const colorScheme of ['light', 'dark']) {
  test(`accessibility basics in ${colorScheme}: names, focus, contrast`, async () => {
    await over(
      roof(1, { broken: true }),
      async ({ page }) => {
        await picture(page, `page-${colorScheme}`);
        for (const name of ['script', 'params', 'problems', 'checks', 'reports', 'selected']) {
          await tab(page, name);
          const { unnamed, poor } = await contrasts(page);
          assert.deepEqual(unnamed, [], name);
          assert.deepEqual(poor, [], name);
        }
        await page.evaluate(() => document.activeElement.blur());
        const reached = new Set();
        for (let i = 0; i < 60; i++) {
          await page.keyboard.press('Tab');
          reached.add(
            await page.evaluate(() => {
              const at = document.activeElement;
              if (at === document.body) return 'body';
              const visible = getComputedStyle(at).outlineStyle !== 'none';
              return `${at.closest('[role=treeitem]') ? 'tree' : at.id || at.getAttribute('aria-label') || at.textContent}${visible ? '' : ' (focus not seen)'}`;
            }),
          );
        }
        assert.ok(reached.has('picture') && reached.has('tree') && reached.has('search'), [...reached].join(', '));
        assert.deepEqual(
          [...reached].filter((name) => name.includes('focus not seen') && !name.startsWith(' ')),
          [],
        );
      },
      { colorScheme },
    );
  });
}
