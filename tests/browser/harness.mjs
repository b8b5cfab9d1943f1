// What the tests of the page share: one browser, a stand-in server for each test, and what a person does.

import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { createInterface } from 'node:readline';
import { after, before } from 'node:test';
import { canvasBox, open, PICTURES, ready, startBrowser } from './browser.mjs';
import { startFake } from './fake_server.mjs';

export let browser;
before(async () => {
  browser = await startBrowser();
});
after(() => browser.close());

/** Runs `body` over a page that shows a model, and asks at the end that nothing was said in the console. */
export async function over(model, body, settings = {}) {
  const fake = await startFake(model, settings);
  const opened = await open(browser, fake.address + (settings.hash ?? ''), settings);
  try {
    await ready(opened.page, model.frame.number);
    await body({ ...opened, fake });
    assert.deepEqual(opened.complaints, []);
  } finally {
    await opened.close();
    await fake.close();
  }
}

export const picture = (page, name) => page.screenshot({ path: `${PICTURES}${name}.png` });
export const tab = (page, name) => page.click(`#tab-${name}`);

export const middle = (a, b) => a.map((x, i) => (x + b[i]) / 2);

/** Clicks where an absolute point is on the screen. */
export async function clickAt(page, point) {
  const box = await canvasBox(page);
  const [x, y] = await page.evaluate((p) => window.loftView.toScreen(p), point);
  await page.mouse.click(box.x + x, box.y + y);
}

/** Starts `loft view` of the program that LOFT names and gives its address, which it prints on a line of its own. */
export async function serve(file) {
  const child = spawn(process.env.LOFT, ['view', file, '--no-open', '--port', '0'], { stdio: ['ignore', 'pipe', 'pipe'] });
  let said = '';
  child.stderr.on('data', (data) => (said += data));
  const address = await new Promise((done, failed) => {
    createInterface({ input: child.stdout }).on('line', (line) => {
      const found = line.match(/http:\/\/127\.0\.0\.1:\d+\/[0-9a-f]{32}\//);
      if (found) done(found[0]);
    });
    child.on('exit', (code) => failed(new Error(`loft view ended with ${code}: ${said}`)));
    setTimeout(() => failed(new Error(`loft view printed no address in 60 s: ${said}`)), 60_000).unref();
  });
  const stop = () =>
    new Promise((done) => {
      child.removeAllListeners('exit');
      child.on('exit', done);
      child.kill('SIGINT');
    });
  return { address, stop, child };
}
