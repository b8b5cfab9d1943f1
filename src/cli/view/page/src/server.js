// The connection with `loft view`: frames, buffers, events and requests. An older frame never follows a newer one.

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
    if (!answer.ok) return { ok: false, message: `the server answered ${answer.status}` };
    const text = await answer.text();
    return text ? JSON.parse(text) : { ok: true };
  } catch {
    return { ok: false, message: 'no connection' };
  }
}

function fromServer({ onFrame, onWork, onGone, onCursor, onConnection }) {
  const base = location.pathname.replace(/[^/]*$/, '');
  const tab = Math.random().toString(36).slice(2, 10);
  let newest = -1; // The number of the newest frame that was taken.
  let asked = false; // Whether another frame came while one was fetched.
  let fetching = false;
  let heard = 0; // When the event came that the frame follows.
  let wait = 250;

  async function fetchFrame() {
    if (fetching) {
      asked = true;
      return;
    }
    fetching = true;
    do {
      asked = false;
      const began = performance.now();
      try {
        const answer = await fetch(`${base}frame`, { cache: 'no-store' });
        if (answer.ok) {
          const frame = await answer.json();
          if (frame.number > newest) {
            newest = frame.number;
            // A frame is shown before the next is fetched, so that fast saves still move the picture.
            await onFrame(frame, { heard: heard || began, fetched: performance.now() });
          }
        }
      } catch {
        // The events tell that the connection is lost, and a frame is fetched when it is back.
      }
    } while (asked);
    fetching = false;
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
      fetchFrame();
    });
    events.addEventListener('error', () => {
      // A server that starts again has another count of frames, so the next one is taken whatever its number is.
      onConnection(false);
      quiet();
      newest = -1;
      setTimeout(listen, wait);
      wait = Math.min(wait * 2, 4000);
    });
    on('frame', ({ number }) => {
      if (number <= newest) return;
      heard = performance.now();
      fetchFrame();
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
    /** The bytes of a buffer. */
    async buffer(key) {
      const answer = await fetch(`${base}buffer/${key}`);
      if (!answer.ok) throw new Error(`buffer ${key}: ${answer.status}`);
      return answer.arrayBuffer();
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
    async buffer(key) {
      return unpack(model.buffers[key]);
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
