// A stand-in for `loft view`: the same addresses and events, with models made by hand. Tests change what it shows.

import { createServer } from 'node:http';
import { readFileSync } from 'node:fs';
import { gzipSync } from 'node:zlib';

export const PAGE = new URL('../../src/cli/view/page.html', import.meta.url);
const TOKEN = 'f'.repeat(32);

/** Starts it; `onSet(name, text)` may give a new model. */
export async function startFake(model, { onSet, page = readFileSync(PAGE, 'utf8') } = {}) {
  const fake = { model, asked: [], posts: [], streams: new Set(), inFlight: 0, mostInFlight: 0, delays: new Map(), answers: {} };
  const kept = new Map(model.buffers);

  // A frame stands in its event unless a test delays it, or it is large.
  const told = ({ frame }) => {
    const isLarge = JSON.stringify(frame).length > 65536;
    return { number: frame.number, ...(isLarge || fake.delays.get(frame.number) ? {} : { frame }) };
  };
  fake.send = (event, data) => {
    for (const stream of fake.streams) stream.write(`event: ${event}\ndata: ${JSON.stringify(data)}\n\n`);
  };
  fake.hold = (next) => {
    fake.model = next;
    for (const [key, bytes] of next.buffers) kept.set(key, bytes);
  };
  fake.show = (next) => {
    fake.hold(next);
    fake.send('frame', told(next));
  };

  const server = createServer(async (request, response) => {
    const path = request.url.split('?')[0];
    fake.asked.push(path);
    const answer = (status, type, body, more = {}) => response.writeHead(status, { 'Content-Type': type, ...more }).end(body);
    if (!path.startsWith(`/${TOKEN}/`)) return answer(404, 'text/plain', 'not here');
    const what = path.slice(TOKEN.length + 2);
    if (request.method === 'POST') {
      let body = '';
      for await (const part of request) body += part;
      const asked = { what, ...JSON.parse(body) };
      fake.posts.push(asked);
      if (what === 'set') {
        fake.inFlight++;
        fake.mostInFlight = Math.max(fake.mostInFlight, fake.inFlight);
        await new Promise((done) => setTimeout(done, 30));
        fake.inFlight--;
        const next = onSet?.(asked.name, asked.text);
        if (next) fake.show(next);
      }
      const usual = { show: { ok: false }, compare: { ok: true, from: fake.model.frame.number + 1 } };
      return answer(200, 'application/json', JSON.stringify(fake.answers[what] ?? usual[what] ?? { ok: true }));
    }
    if (what === '') return answer(200, 'text/html; charset=utf-8', page);
    if (what === 'frame') {
      const now = fake.model;
      await new Promise((done) => setTimeout(done, fake.delays.get(now.frame.number) ?? 0));
      return answer(200, 'application/json', gzipSync(JSON.stringify(now.frame)), { 'Content-Encoding': 'gzip' });
    }
    if (what.startsWith('buffers/')) {
      const keys = what.slice('buffers/'.length).split('+');
      const found = keys.map((key) => kept.get(key));
      const media = 'application/octet-stream';
      if (found.length > 1) {
        const lengths = found.map((bytes) => bytes?.length ?? '-').join(',');
        return answer(200, media, Buffer.concat(found.filter(Boolean)), { 'Part-Lengths': lengths });
      }
      return found[0]
        ? answer(200, media, found[0], { 'Cache-Control': 'immutable, max-age=31536000' })
        : answer(404, 'text/plain', 'no such buffer');
    }
    if (what === 'events') {
      response.writeHead(200, { 'Content-Type': 'text/event-stream', 'Cache-Control': 'no-store' });
      response.write(`event: frame\ndata: ${JSON.stringify(told(fake.model))}\n\n`);
      fake.streams.add(response);
      request.on('close', () => fake.streams.delete(response));
      return undefined;
    }
    return answer(404, 'text/plain', 'not here');
  });

  const listen = (port) => new Promise((done) => server.listen(port, '127.0.0.1', done));
  await listen(0);
  fake.port = server.address().port;
  fake.address = `http://127.0.0.1:${fake.port}/${TOKEN}/`;
  fake.dropStreams = () => {
    for (const stream of fake.streams) stream.destroy();
  };
  fake.close = () => {
    fake.dropStreams();
    server.closeAllConnections();
    return new Promise((done) => server.close(done));
  };
  fake.again = () => listen(fake.port);
  return fake;
}

/** The one-file page of a model. */
export function oneFile(model, page = readFileSync(PAGE, 'utf8')) {
  const buffers = Object.fromEntries([...model.buffers].map(([key, bytes]) => [key, gzipSync(bytes).toString('base64')]));
  const text = JSON.stringify({ frame: model.frame, buffers }).replaceAll('<', '\\u003c');
  return page.replace('<!--MODEL-->', () => `<script type="application/json" id="model">${text}</script>`);
}

// Run by hand it serves the roof: node fake_server.mjs
if (process.argv[1]?.endsWith('fake_server.mjs')) {
  const { roof } = await import('./fake_models.mjs');
  let number = 1;
  const fake = await startFake(roof(number), {
    onSet: (name, text) => (name === 'rise' ? roof(++number, { rise: parseFloat(text ?? '1.2'), set: text ? { rise: text } : {} }) : null),
  });
  console.log(fake.address);
}
