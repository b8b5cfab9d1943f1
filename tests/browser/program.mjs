// The program itself, where LOFT names it: every example is opened, drawn, picked and kept as a picture.

import assert from 'node:assert/strict';
import { readdirSync } from 'node:fs';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { canvasBox, open, PICTURES, ready, shareDrawn } from './browser.mjs';
import { browser, serve } from './harness.mjs';

const { LOFT, LOFT_ACCEPT: ACCEPT } = process.env;
const EXAMPLES = fileURLToPath(new URL('../../examples/', import.meta.url));
// LOFT_ACCEPT=1 makes the pictures of the guide anew.
const GUIDE = fileURLToPath(new URL('../../docs/guide/pictures/view/', import.meta.url));

if (LOFT) {
  for (const file of readdirSync(EXAMPLES)
    .filter((name) => name.endsWith('.loft'))
    .sort()) {
    const name = file.replace(/\.loft$/, '');
    test(`example ${name}`, { timeout: 240_000 }, async (t) => {
      const { address, stop } = await serve(EXAMPLES + file);
      const { page, complaints, close } = await open(browser, address, { width: 1120, height: 700 });
      try {
        const now = await ready(page, undefined, 150);
        const drawn = await shareDrawn(page);
        assert.ok(drawn > 0.01, `${(100 * drawn).toFixed(2)} % of the picture is drawn`);
        const box = await canvasBox(page);
        const hit = await page.evaluate(
          ([width, height]) => {
            // The middle may be a hole: the places around it are asked too.
            for (let ring = 0; ring < 12; ring++)
              for (let k = 0; k < 8; k++) {
                const [x, y] = [
                  width / 2 + ring * 0.035 * width * Math.cos((k * Math.PI) / 4),
                  height / 2 + ring * 0.035 * height * Math.sin((k * Math.PI) / 4),
                ];
                const found = window.loftView.pick(x, y);
                if (found.thing) return { ...found, x, y };
              }
            return null;
          },
          [box.width, box.height],
        );
        assert.ok(hit, 'a thing is picked near the middle');
        await page.mouse.click(box.x + hit.x, box.y + hit.y);
        await page.locator('.chain li').first().waitFor();
        const picture = { type: 'jpeg', quality: 48 };
        await page.screenshot({ ...picture, path: `${PICTURES}${name}.jpg` });
        if (ACCEPT) await page.screenshot({ ...picture, path: `${GUIDE}${name}.jpg` });
        t.diagnostic(
          `${now.triangles} triangles, ${now.drawCalls} draw calls, ${(now.bytes / 1e6).toFixed(2)} MB, ${Math.round(now.times.shown - now.times.heard)} ms to the picture, pick ${hit.ms.toFixed(2)} ms`,
        );
        assert.deepEqual(complaints, []);
      } finally {
        await close();
        await stop();
      }
    });
  }
}
