// Comparing with another state: what is told while it is evaluated, where there is none, and in other tabs.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { canvasBox, open, ready, state, until } from './browser.mjs';
import { partial, roof } from './fake_models.mjs';
import { browser, over, picture } from './harness.mjs';

const chosen = (page) => page.locator('#compare').inputValue();
const note = (page) => page.locator('#comparison');

/** A frame whose other state is evaluated next, or has failed. */
function without(number, other, failed = null) {
  const model = roof(number);
  model.frame.compare = { with: other, pending: failed === null, things: [], failed };
  return model;
}

const asked = (page, fake, other) => until(page, () => fake.posts.some((post) => post.what === 'compare' && post.with === other), 'the request');

test('while the other state is evaluated the page says so, and the model can be turned', async () => {
  await over(roof(1), async ({ page, fake }) => {
    await page.selectOption('#compare', 'revision:HEAD');
    await asked(page, fake, 'revision:HEAD');
    assert.match(await note(page).innerText(), /model of the last commit is evaluated/);
    fake.show(without(2, 'revision:HEAD'));
    await ready(page, 2);
    fake.send('work', { number: 3, phase: 'curves', done: 3, of: 25, seconds: 1.2 });
    await page.getByText('Comparing: curves 3 of 25 · 1.2 s').waitFor();
    await picture(page, 'page-comparing');
    await page.selectOption('#shade', 'moved');
    await page.getByText('The other state is being evaluated.').waitFor();
    await page.selectOption('#shade', 'plain');
    // The model of today stays, moves, and may come again before the other one is there.
    const before = (await state(page)).pictures;
    const box = await canvasBox(page);
    await page.mouse.move(box.x + 300, box.y + 300);
    await page.mouse.down();
    await page.mouse.move(box.x + 380, box.y + 330, { steps: 5 });
    await page.mouse.up();
    await until(page, (now) => now.pictures > before, 'a new picture');
    fake.show(partial(roof(3), { before: fake.model }));
    await ready(page, 3);
    assert.equal(await chosen(page), 'revision:HEAD');
    assert.equal(await note(page).isVisible(), true);
    fake.show(roof(4, { compare: 'revision:HEAD' }));
    fake.send('work', { number: 4, phase: null });
    await until(page, (now) => now.number === 4 && now.compared > 0, 'the other state');
    assert.equal(await note(page).isVisible(), false);
    assert.equal(await page.locator('#work').isVisible(), false);
    assert.equal(await chosen(page), 'revision:HEAD');
    // A param was moved: today's model comes alone, then with the other one under the same params.
    fake.show(without(5, 'revision:HEAD'));
    await ready(page, 5);
    assert.equal(await chosen(page), 'revision:HEAD');
    assert.equal(await note(page).isVisible(), true);
    fake.show(roof(6, { compare: 'revision:HEAD' }));
    await until(page, (now) => now.number === 6 && now.compared > 0, 'the other state again');
    await page.selectOption('#compare', '');
    await asked(page, fake, null);
    fake.show(roof(7));
    await until(page, (now) => now.number === 7 && now.compared === 0, 'no other state');
    assert.equal(await chosen(page), '');
  });
});

test('tabs follow a comparison that another one asks for or ends', async () => {
  await over(roof(1), async ({ page, fake }) => {
    const second = await open(browser, fake.address);
    await ready(second.page, 1);
    await page.selectOption('#compare', 'golden');
    await asked(page, fake, 'golden');
    fake.show(without(2, 'golden'));
    const tabs = [page, second.page];
    for (const tab of tabs) {
      await ready(tab, 2);
      assert.deepEqual([await chosen(tab), await note(tab).isVisible()], ['golden', true]);
    }
    await second.page.selectOption('#compare', '');
    await asked(page, fake, null);
    fake.show(roof(3));
    fake.send('work', { number: 4, phase: 'curves', done: 0, of: 0, seconds: 0.3 });
    for (const tab of tabs) {
      await ready(tab, 3);
      await tab.locator('#work .phase').waitFor();
      assert.deepEqual([await chosen(tab), await note(tab).isVisible()], ['', false]);
      assert.equal(await tab.locator('#work .phase').innerText(), 'curves');
    }
    assert.deepEqual(second.complaints, []);
    await second.close();
  });
});

test('a frame of before the request does not end what was asked for', async () => {
  await over(roof(1), async ({ page, fake }) => {
    fake.answers.compare = { ok: true, from: 4 };
    await page.selectOption('#compare', 'golden');
    await asked(page, fake, 'golden');
    fake.show(roof(2));
    await ready(page, 2);
    assert.deepEqual([await chosen(page), await note(page).isVisible()], ['golden', true]);
    // Another tab was faster.
    fake.show(without(4, 'revision:HEAD'));
    await ready(page, 4);
    assert.equal(await chosen(page), 'revision:HEAD');
  });
});

test('why there is no other state is told until the comparison succeeds or is changed', async () => {
  await over(roof(1), async ({ page, fake }) => {
    await page.selectOption('#compare', 'golden');
    await asked(page, fake, 'golden');
    for (const number of [2, 3]) {
      fake.show(without(number, 'golden', 'no commit holds roof.golden'));
      await ready(page, number);
      assert.equal(await note(page).innerText(), 'Not compared with the golden: no commit holds roof.golden');
      await page.locator('#picture').focus();
      await page.keyboard.press('m');
      await page.getByText('Pick two places').waitFor();
      assert.equal(await note(page).isVisible(), true);
      await page.keyboard.press('m');
    }
    fake.show(roof(4, { compare: 'golden' }));
    await ready(page, 4);
    assert.equal(await note(page).isVisible(), false);
    fake.show(without(5, 'golden', 'no commit holds roof.golden'));
    await ready(page, 5);
    assert.equal(await note(page).isVisible(), true);
    await page.selectOption('#compare', '');
    assert.equal(await note(page).isVisible(), false);
  });
});

test('a revision is typed; a wrong one is told', async () => {
  await over(roof(1), async ({ page, fake }) => {
    const field = page.getByLabel('Revision to compare with');
    assert.equal(await field.isVisible(), false);
    await page.selectOption('#compare', { label: 'with a revision…' });
    await page.keyboard.press('Enter');
    assert.equal(await field.isVisible(), true);
    await page.keyboard.type('  feature/hull ');
    await page.keyboard.press('Enter');
    await asked(page, fake, 'revision:feature/hull');
    assert.deepEqual([await field.isVisible(), await chosen(page)], [false, 'revision:feature/hull']);
    assert.equal(await page.locator('#compare option:checked').innerText(), 'with feature/hull');
    fake.show(without(2, 'revision:feature/hull', 'there is no revision `feature/hull`'));
    await ready(page, 2);
    assert.equal(await note(page).innerText(), 'Not compared with feature/hull: there is no revision `feature/hull`');
    // What was typed can be put right.
    await page.selectOption('#compare', { label: 'with a revision…' });
    assert.equal(await field.inputValue(), '  feature/hull ');
    await page.keyboard.press('Escape');
    assert.deepEqual([await field.isVisible(), await chosen(page)], [false, 'revision:feature/hull']);
    fake.answers.compare = { ok: false, message: 'a revision is named by a branch, a tag or a commit' };
    await page.selectOption('#compare', { label: 'with a revision…' });
    await field.fill('--output=x');
    await field.press('Enter');
    await page.getByText('Not compared with --output=x: a revision is named by').waitFor();
    assert.equal(await chosen(page), 'revision:feature/hull');
    assert.equal(fake.posts.filter((post) => post.what === 'compare').length, 2);
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
    assert.equal(await note(page).isVisible(), false);
  });
});
