// Meshes: sides of elements as picks, and what decided the sizes.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { measureElements } from '../../src/cli/view/page/src/quality.js';
import { contrasts } from './accessibility.mjs';
import { canvasBox, readPng, state, until } from './browser.mjs';
import { largeMesh, plateNode, roof } from './fake_models.mjs';
import { clickAt, middle, over, picture, tab } from './harness.mjs';

const side = (from, to) => middle(plateNode(...from), plateNode(...to));
const numbers = (list) => list.map((item) => item + 1);

/** Shows the mesh of the roof alone, from above. */
async function plateAlone(page, shade = 'mesh') {
  await page.selectOption('#shade', shade);
  await page.locator('[data-key="plate"]').focus();
  await page.keyboard.press('i');
  await page.locator('#picture').focus();
  const { pictures } = await state(page);
  await page.keyboard.press('2');
  await until(page, (now) => now.drawn.join() === 'plate:mesh' && now.pictures > pictures, 'the mesh alone from above');
}

const pickAt = (page, point) => page.evaluate((p) => window.loftView.pick(...window.loftView.toScreen(p).slice(0, 2)), point);

test('sides of elements are picked, with what lies beside them', async () => {
  await over(roof(1), async ({ page }) => {
    await plateAlone(page);
    const inner = await pickAt(page, side([2, 3], [3, 3]));
    assert.equal(inner.kind, 'side');
    assert.deepEqual(numbers(inner.nodes), [48, 49]);
    assert.equal(inner.elements.length, 2);
    assert.equal((await pickAt(page, side([2, 3], [3, 4]))).kind, 'side'); // Two triangles meet there.
    assert.equal((await pickAt(page, side([10, 3], [11, 4]))).kind, 'element'); // The middle of a quadrangle.
    const free = await pickAt(page, side([2, 0], [3, 0]).map((x, i) => x + (i === 1 ? 0.01 : 0)));
    assert.deepEqual([free.kind, free.elements], ['side', [4]]);
    const mixed = await pickAt(page, side([7, 3], [7, 4])); // A triangle and a quadrangle.
    assert.deepEqual([mixed.kind, mixed.elements[1] - 140], ['side', 21]);
    assert.equal((await pickAt(page, plateNode(3, 3))).kind, 'node');
  });
});

test('a side is hovered, highlighted, described and measured', async () => {
  await over(roof(1), async ({ page }) => {
    await plateAlone(page);
    const box = await canvasBox(page);
    const at = side([2, 3], [3, 3]);
    const [x, y] = await page.evaluate((p) => window.loftView.toScreen(p), at);
    const pixel = async () => {
      const clip = { x: box.x + Math.round(x), y: box.y + Math.round(y), width: 1, height: 1 };
      return readPng(await page.screenshot({ clip })).at(0, 0);
    };
    const isAccent = ([r, g, b]) => r - b > 90 && r > g;
    assert.ok(!isAccent(await pixel()));
    await page.mouse.move(box.x + x, box.y + y + 2);
    let now = await until(page, (s) => s.hovered?.kind === 'side' && s.sidesLit === 1, 'the side under the cursor');
    assert.equal(await page.locator('#status .under').innerText(), 'plate, side 48–49');
    await page.waitForTimeout(100);
    assert.ok(isAccent(await pixel()), String(await pixel()));
    await page.mouse.move(box.x + x, box.y + y + 9);
    await until(page, (s) => s.hovered?.kind === 'element' && s.sidesLit === 0, 'the element under the cursor');
    await clickAt(page, at);
    await tab(page, 'selected');
    const told = await page.locator('#pane-selected').innerText();
    assert.match(told, /plate, side 48–49/);
    assert.match(told, /length\s+0\.\d+ m/);
    assert.match(told, /size decided by\s+size 0.2 near \(0, 0, 0\)/);
    assert.match(told, /asked edge length\s+0\.2 m/);
    assert.match(told, /between elements\s+34, 47/);
    await page.keyboard.down('Shift');
    await clickAt(page, side([4, 5], [4, 6]));
    await page.keyboard.up('Shift');
    now = await state(page);
    assert.deepEqual(
      now.picks.map((hit) => hit.kind),
      ['side', 'side'],
    );
    const [along, across] = [
      [plateNode(2, 3), plateNode(3, 3)],
      [plateNode(4, 5), plateNode(4, 6)],
    ].map(([a, b]) => b.map((x, i) => (x - a[i]) / Math.hypot(...b.map((y, k) => y - a[k]))));
    const angle = (180 / Math.PI) * Math.acos(Math.abs(along.reduce((sum, x, i) => sum + x * across[i], 0)));
    const measured = await page.locator('#pane-selected').innerText();
    assert.match(measured, /distance\s+0\.9537\d* m/);
    assert.ok(Math.abs(Number(measured.match(/angle\s+([\d.]+)°/)[1]) - angle) < 0.01, measured);
    assert.ok(now.sidesLit >= 2); // Both, and the one under the cursor.
    await picture(page, 'page-sides');
    await clickAt(page, side([2, 0], [3, 0]).map((p, i) => p + (i === 1 ? 0.01 : 0)));
    assert.match(await page.locator('#pane-selected').innerText(), /free side of element\s+5/);
    await page.keyboard.press('Escape');
    assert.equal((await state(page)).picks.length, 0);
  });
});

test('a mesh of a million triangles: nodes, sides and elements are picked in 5 ms', async (t) => {
  await over(largeMesh(1), async ({ page }) => {
    const box = await canvasBox(page);
    const pickMany = () =>
      page.evaluate(({ width, height }) => {
        const all = [];
        for (let i = 0; i < 300; i++)
          all.push(window.loftView.pick(width * (0.3 + 0.4 * ((i * 0.618) % 1)), height * (0.35 + 0.3 * ((i * 0.414) % 1))));
        const kinds = {};
        for (const { kind } of all) kinds[kind] = (kinds[kind] ?? 0) + 1;
        const mean = all.reduce((sum, { ms }) => sum + ms, 0) / all.length;
        return { kinds, mean, ms: all.map((hit) => hit.ms).sort((a, b) => a - b) };
      }, box);
    const told = (name, { kinds, mean, ms }) => {
      const [most, longest] = [ms[296].toFixed(2), ms.at(-1).toFixed(2)];
      t.diagnostic(`${name}: ${JSON.stringify(kinds)}, mean ${mean.toFixed(2)} ms, 99 % below ${most} ms, longest ${longest} ms`);
    };
    const far = await pickMany();
    told('the whole mesh', far);
    await page.locator('#picture').focus();
    for (let i = 0; i < 18; i++) await page.keyboard.press('+');
    await page.waitForTimeout(300);
    const near = await pickMany();
    told('zoomed in', near);
    assert.ok(near.kinds.side > 20 && near.kinds.element > 20, JSON.stringify(near.kinds));
    for (const { mean, ms } of [far, near]) assert.ok(mean < 5 && ms[285] < 10, String(ms[285]));
    await picture(page, 'page-mesh-million');
  });
});

test('what decided the size: shares in the legend, a click shows these elements alone, unknown ones are apart', async () => {
  await over(roof(1), async ({ page }) => {
    await plateAlone(page, 'decided');
    const entries = page.locator('#legend li button');
    await entries.first().waitFor();
    // 14 by 10 cells: seven columns of triangles, of which four and a half are small, and of the last one nothing is known.
    assert.deepEqual(
      (await entries.allInnerTexts()).map((entry) => entry.replace(/\s+/g, ' ')),
      ['the size 52.4 %', 'size 0.2 near (0, 0, 0) 42.9 %', 'not known 4.76 %'],
    );
    assert.match(await page.locator('#legend').innerText(), /210 elements/);
    await picture(page, 'page-decided');
    const unknown = side([13, 4], [14, 5]);
    assert.equal((await pickAt(page, unknown)).kind, 'element');
    await entries.filter({ hasText: 'near' }).click();
    await page.getByText('90 of 210 elements').waitFor();
    assert.equal(await entries.filter({ hasText: 'near' }).getAttribute('aria-pressed'), 'true');
    assert.equal((await pickAt(page, unknown)).kind, undefined);
    assert.equal((await pickAt(page, side([2, 3], [3, 3]))).kind, 'side');
    assert.deepEqual(await contrasts(page), { unnamed: [], poor: [] });
    await picture(page, 'page-decided-one');
    await entries.filter({ hasText: 'near' }).click();
    await page.getByText('210 elements', { exact: true }).waitFor();
    await clickAt(page, plateNode(14, 5).map((x, i) => x - (i === 0 ? 0.01 : 0)));
    await tab(page, 'selected');
    let told = await page.locator('#pane-selected').innerText();
    assert.match(told, /plate, node 90[\s\S]*size decided by\s+not known[\s\S]*asked edge length\s+not known/);
    await clickAt(page, plateNode(3, 3));
    told = await page.locator('#pane-selected').innerText();
    assert.match(told, /plate, node 49[\s\S]*size decided by\s+size 0.2 near[\s\S]*asked edge length\s+0\.2 m/);
  });
});

test('the asked length of a side is that of its ends of which it is known', () => {
  const positions = [0, 0, 0, 3, 0, 0, 3, 4, 0];
  const [ratio, of] = [(...asked) => measureElements('length', { positions, triangles: [0, 1, 2], asked })[0], Math.fround];
  assert.equal(ratio(2, 2, 2), 2);
  assert.equal(ratio(2, NaN, NaN), of((3 + 5) / 4));
  assert.equal(ratio(2, 4, NaN), of(12 / (3 + 4 + 2)));
  assert.ok(Number.isNaN(ratio(NaN, NaN, NaN)));
});

test('edge lengths against the asked ones leave out what is not known', async () => {
  await over(roof(1), async ({ page }) => {
    await plateAlone(page, 'quality-length');
    await page.getByText('10 more are grey').waitFor();
    assert.match(await page.locator('#legend').innerText(), /200 elements/);
    await page.getByRole('spinbutton', { name: 'Shown from' }).fill('0.1');
    await page.keyboard.press('Enter');
    await page.getByText('200 of 200 elements').waitFor();
    assert.equal((await pickAt(page, side([13, 4], [14, 5]))).kind, undefined);
  });
});
