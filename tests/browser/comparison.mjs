// Comparing with another state: what is said while it is evaluated, and where there is none.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { canvasBox, ready, state, until } from './browser.mjs';
import { partial, roof } from './fake_models.mjs';
import { over, picture } from './harness.mjs';

const chosen = (page) => page.locator('#compare').inputValue();
const message = (page) => page.locator('#message');

test('while the other state is evaluated the page says so, and the model can be turned', async () => {
  await over(roof(1), async ({ page, fake }) => {
    await page.selectOption('#compare', 'revision:HEAD');
    await until(page, () => fake.posts.some((post) => post.what === 'compare' && post.with === 'revision:HEAD'), 'the request');
    assert.match(await message(page).innerText(), /model of the last commit is evaluated/);
    fake.send('work', { number: 3, phase: 'curves', done: 3, of: 25, seconds: 1.2 });
    await page.getByText('Comparing: curves 3 of 25 · 1.2 s').waitFor();
    await picture(page, 'page-comparing');
    // The model of today stays, moves, and may come again before the other one is there.
    const before = (await state(page)).pictures;
    const box = await canvasBox(page);
    await page.mouse.move(box.x + 300, box.y + 300);
    await page.mouse.down();
    await page.mouse.move(box.x + 380, box.y + 330, { steps: 5 });
    await page.mouse.up();
    await until(page, (now) => now.pictures > before, 'a new picture');
    fake.show(partial(roof(2), { before: fake.model }));
    await ready(page, 2);
    assert.equal(await chosen(page), 'revision:HEAD');
    assert.equal(await message(page).isVisible(), true);
    fake.show(roof(3, { compare: 'revision:HEAD' }));
    fake.send('work', { number: 3, phase: null });
    await until(page, (now) => now.number === 3 && now.compared > 0, 'the other state');
    assert.equal(await message(page).isVisible(), false);
    assert.equal(await page.locator('#work').isVisible(), false);
    assert.equal(await chosen(page), 'revision:HEAD');
    // A param was moved: today's model comes alone, then with the other one under the same params.
    fake.show(roof(4));
    await ready(page, 4);
    assert.equal(await chosen(page), 'revision:HEAD');
    fake.show(roof(5, { compare: 'revision:HEAD' }));
    await until(page, (now) => now.number === 5 && now.compared > 0, 'the other state again');
    await page.selectOption('#compare', '');
    fake.show(roof(6));
    await until(page, (now) => now.number === 6 && now.compared === 0, 'no other state');
    assert.equal(await chosen(page), '');
  });
});

test('a state that cannot be made is told once, with the reason', async () => {
  const failing = (number) => {
    const model = roof(number);
    model.frame.compare = { with: 'golden', things: [], failed: 'no commit holds roof.golden' };
    return model;
  };
  await over(roof(1), async ({ page, fake }) => {
    await page.selectOption('#compare', 'golden');
    await until(page, () => fake.posts.some((post) => post.what === 'compare'), 'the request');
    fake.show(failing(2));
    await ready(page, 2);
    assert.equal(await message(page).innerText(), 'Nothing to compare with in the golden: no commit holds roof.golden.');
    await page.evaluate(() => (document.querySelector('#message').textContent = ''));
    fake.show(failing(3));
    await ready(page, 3);
    assert.equal(await message(page).innerText(), '');
  });
});

test('Stop ends a comparison that is evaluated', async () => {
  await over(roof(1), async ({ page, fake }) => {
    await page.selectOption('#compare', 'golden');
    fake.send('work', { number: 2, phase: 'curves', done: 0, of: 0, seconds: 0.5 });
    await page.getByRole('button', { name: 'Stop' }).click();
    await until(page, () => fake.posts.at(-1)?.what === 'compare' && fake.posts.at(-1).with === null, 'no comparison');
    assert.ok(fake.posts.some((post) => post.what === 'stop'));
    assert.equal(await chosen(page), '');
    assert.equal(await message(page).isVisible(), false);
  });
});
