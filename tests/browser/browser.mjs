// Starts the system's Chromium and opens pages in it; a page that writes to the console or asks another host fails.

import { existsSync, mkdirSync } from 'node:fs';
import { createRequire } from 'node:module';
import { fileURLToPath } from 'node:url';
import { inflateSync } from 'node:zlib';

// `run` installs the driver outside of the sources; `npm ci` here does as well.
const installed = new URL('../../target/browser/node_modules/', import.meta.url);
const { chromium } = createRequire(existsSync(installed) ? installed : import.meta.url)('playwright-core');

const PLACES = [process.env.CHROMIUM, '/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'];
export const PICTURES = fileURLToPath(new URL('../../target/browser/pictures/', import.meta.url));

export async function startBrowser() {
  mkdirSync(PICTURES, { recursive: true });
  const executablePath = PLACES.find((path) => path && existsSync(path));
  if (!executablePath) throw new Error('no Chromium: `tests/browser/run` installs it');
  return chromium.launch({
    executablePath,
    args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-background-networking'],
  });
}

/** Opens an address; `complaints` fills with what must not happen. */
export async function open(browser, address, { width = 1280, height = 800, ...more } = {}) {
  const context = await browser.newContext({ viewport: { width, height }, reducedMotion: 'reduce', colorScheme: 'light', ...more });
  const page = await context.newPage();
  const complaints = [];
  const requests = [];
  const host = new URL(address).host;
  page.on('console', (message) => complaints.push(`console: ${message.text()}`));
  page.on('pageerror', (error) => complaints.push(`error: ${error.stack ?? error}`));
  page.on('request', (request) => {
    const url = request.url();
    requests.push(url);
    if (!url.startsWith('blob:') && !url.startsWith('data:') && new URL(url).host !== host) complaints.push(`request to ${url}`);
  });
  await page.goto(address);
  return { page, context, complaints, requests, close: () => context.close() };
}

export const state = (page) => page.evaluate(() => window.loftView?.state());

/** Waits until the state of the page fulfils `fits`; gives the state. */
export async function until(page, fits, what, seconds = 20) {
  const end = Date.now() + seconds * 1000;
  let now = null;
  while (Date.now() < end) {
    now = await state(page);
    if (now && fits(now)) return now;
    await new Promise((done) => setTimeout(done, 25));
  }
  throw new Error(`waited ${seconds} s for ${what}; the state is ${JSON.stringify(now)}`);
}

export const ready = (page, number, seconds) =>
  until(
    page,
    (now) => now.number !== null && (number === undefined || now.number === number) && now.trees && now.times.shown,
    `frame ${number ?? ''}`,
    seconds,
  );

/** Where the canvas is in the page. */
export const canvasBox = (page) => page.locator('#picture').boundingBox();

/** The share of the pixels in the middle of the picture that differ from the background. */
export async function shareDrawn(page) {
  const box = await canvasBox(page);
  const clip = { x: box.x + box.width * 0.2, y: box.y + box.height * 0.15, width: box.width * 0.6, height: box.height * 0.7 };
  const { width, height, at } = readPng(await page.screenshot({ clip }));
  // The background goes from one colour above to another below: it has hardly any colour of its own and is pale.
  let drawn = 0;
  for (let y = 0; y < height; y++) {
    const share = y / Math.max(height - 1, 1);
    const [top, bottom] = [at(0, 0), at(0, height - 1)];
    for (let x = 0; x < width; x++) {
      const here = at(x, y);
      const far = Math.max(...here.map((c, k) => Math.abs(c - (top[k] + (bottom[k] - top[k]) * share))));
      if (far > 14) drawn++;
    }
  }
  return drawn / (width * height);
}

/** Colours at absolute points, as they stand in the picture. */
export async function colorsAt(page, points) {
  const box = await canvasBox(page);
  const places = await page.evaluate((all) => all.map((point) => window.loftView.toScreen(point)), points);
  const { at } = readPng(await page.screenshot({ clip: box }));
  return places.map(([x, y]) => at(Math.round(x), Math.round(y)));
}

/** Reads the pixels of a PNG of eight bits a channel, as a browser writes it. */
export function readPng(bytes) {
  const width = bytes.readUInt32BE(16);
  const height = bytes.readUInt32BE(20);
  const channels = bytes[25] === 6 ? 4 : 3;
  const parts = [];
  for (let at = 8; at < bytes.length;) {
    const length = bytes.readUInt32BE(at);
    if (bytes.toString('latin1', at + 4, at + 8) === 'IDAT') parts.push(bytes.subarray(at + 8, at + 8 + length));
    at += length + 12;
  }
  const raw = inflateSync(Buffer.concat(parts));
  const row = width * channels;
  const pixels = Buffer.alloc(row * height);
  for (let y = 0; y < height; y++) {
    const filter = raw[y * (row + 1)];
    for (let x = 0; x < row; x++) {
      const a = x >= channels ? pixels[y * row + x - channels] : 0;
      const b = y > 0 ? pixels[(y - 1) * row + x] : 0;
      const c = x >= channels && y > 0 ? pixels[(y - 1) * row + x - channels] : 0;
      const paeth = () => {
        const [pa, pb, pc] = [Math.abs(b - c), Math.abs(a - c), Math.abs(a + b - 2 * c)];
        return pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
      };
      const guess = [0, a, b, (a + b) >> 1, 0][filter];
      pixels[y * row + x] = raw[y * (row + 1) + 1 + x] + (filter === 4 ? paeth() : guess);
    }
  }
  return { width, height, at: (x, y) => [0, 1, 2].map((k) => pixels[y * row + x * channels + k]) };
}
