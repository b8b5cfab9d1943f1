// The connection with `loft view`: frames, buffers, events and requests. An older frame never follows a newer one.

import { parted } from './together.js';
import { unpack } from './wire.js';

/** Where the model comes from: the server, or the element #model of the one-file page. */
export function connect(handlers) {
  const inside = document.getElementById('model');
  return inside ? fromDocument(JSON.parse(inside.textContent), handlers) : fromServer(handlers);
}

async function post(path, body) {
  try {
    const answer = await fetch(path, {
      method: 'POST',
      headers: { 'Content-Type': 'application/json' },
      body: JSON.stringify(body),
    });
    const said = await answer.json().catch(() => null);
    return said ?? { ok: answer.ok, message: `the server answered ${answer.status}` };
  } catch {
    return { ok: false, message: 'no connection' };
  }
}

function fromServer({ onFrame, onWork, onGone, onCursor, onConnection }) {
  const base = location.pathname.replace(/[^/]*$/, '');
  const tab = Math.random().toString(36).slice(2, 10);
  let newest = -1; // The number of the newest frame that was taken.
  let next = null; // The newest frame that was told and is not taken yet.
  let taking = false;
  let wait = 250;

  async function fetchFrame() {
    const answer = await fetch(`${base}frame`, { cache: 'no-store' });
    return answer.ok ? answer.json() : null;
  }

  /** Takes what was told last. A frame is shown before the next is taken, so that fast saves still move the picture. */
  async function take() {
    if (taking) return;
    taking = true;
    while (next) {
      const { frame: told, heard } = next;
      next = null;
      try {
        // A large frame does not stand in its event.
        const frame = told ?? (await fetchFrame());
        if (frame?.number > newest) {
          newest = frame.number;
          await onFrame(frame, { heard, fetched: performance.now() });
        }
      } catch {
        // The events tell that the connection is lost, and what the newest frame is when it is back.
      }
    }
    taking = false;
  }

  let events = null;

  // A page that nobody sees leaves its place to others: a browser has only some connections to a server.
  function listen() {
    if (events || document.visibilityState === 'hidden') return;
    events = new EventSource(`${base}events?tab=${tab}&last=${Math.max(newest, 0)}`);
    const on = (name, handle) => events.addEventListener(name, (event) => handle(JSON.parse(event.data)));
    events.addEventListener('open', () => {
      wait = 250;
      onConnection(true);
    });
    events.addEventListener('error', () => {
      // A server that starts again has another count of frames, so the next one is taken whatever its number is.
      onConnection(false);
      quiet();
      newest = -1;
      next = null;
      setTimeout(listen, wait);
      wait = Math.min(wait * 2, 4000);
    });
    on('frame', ({ number, frame }) => {
      if (number <= newest) return;
      next = { frame, heard: performance.now() };
      take();
    });
    on('work', onWork);
    on('gone', onGone);
    on('cursor', onCursor);
  }

  function quiet() {
    events?.close();
    events = null;
  }

  document.addEventListener('visibilitychange', () => (document.visibilityState === 'hidden' ? quiet() : listen()));
  listen();

  return {
    live: true,
    /** The bytes of buffers by key, without those that the server no longer has. */
    async buffers(keys) {
      const answer = await fetch(`${base}buffers/${keys.join('+')}`);
      if (answer.status === 404) return new Map();
      if (!answer.ok) throw new Error(`the server answered ${answer.status}`);
      return parted(keys, answer.headers.get('Part-Lengths'), await answer.arrayBuffer());
    },
    post: (what, body = {}) => post(`${base}${what}`, body),
  };
}

function fromDocument(model, { onFrame, onConnection }) {
  queueMicrotask(async () => {
    onConnection(true);
    const now = performance.now();
    onFrame(model.frame, { heard: now, fetched: now });
  });
  return {
    live: false,
    async buffers(keys) {
      return new Map(await Promise.all(keys.map(async (key) => [key, await unpack(model.buffers[key])])));
    },
    post: async () => ({ ok: false, message: 'this page holds a model that is not running' }),
  };
}

/** Sends values one at a time: while a request runs only the last value of each name is kept. */
export function throttled(send) {
  const waiting = new Map();
  let running = false;
  return async function put(name, value) {
    waiting.set(name, value);
    if (running) return;
    running = true;
    while (waiting.size > 0) {
      const [first, last] = waiting.entries().next().value;
      waiting.delete(first);
      await send(first, last);
    }
    running = false;
  };
}
