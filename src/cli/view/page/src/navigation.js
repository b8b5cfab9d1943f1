// Mouse, touch and keyboard over the picture: turn, move, zoom to the cursor, standard views, picking.

import { panned, STANDARD_VIEWS, turned, zoomed } from './camera.js';

const CLICK_PIXELS = 4;

/** `on` has `hover(x, y)`, `click(x, y, again)`, `leave()` and `command(name)`; `pointUnder(x, y)` gives a point to zoom to. */
export function navigate(stage, on, pointUnder) {
  const { canvas } = stage;
  const pointers = new Map();
  let began = null; // Where the gesture began, while it may still be a click.
  let before = null; // Of two fingers: their middle and distance.
  let hovered = null;
  let held = null; // The point that a row of wheel steps zooms to.

  const place = (event) => {
    const box = canvas.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  };
  const toSquare = ({ x, y }) => [(2 * x) / stage.size.width - 1, 1 - (2 * y) / stage.size.height];

  canvas.addEventListener('contextmenu', (event) => event.preventDefault());

  canvas.addEventListener('pointerdown', (event) => {
    canvas.setPointerCapture(event.pointerId);
    canvas.focus({ preventScroll: true });
    const at = place(event);
    pointers.set(event.pointerId, at);
    began = pointers.size === 1 ? { ...at, button: event.button } : null;
    before = pointers.size === 2 ? pair() : null;
    stage.stopFlight();
    held = null;
  });

  const pair = () => {
    const [a, b] = [...pointers.values()];
    return { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, size: Math.hypot(a.x - b.x, a.y - b.y) };
  };

  canvas.addEventListener('pointermove', (event) => {
    const at = place(event);
    const last = pointers.get(event.pointerId);
    if (!last) {
      held = null;
      if (event.pointerType !== 'touch') askHover(at);
      return;
    }
    pointers.set(event.pointerId, at);
    if (pointers.size === 2) {
      const now = pair();
      let view = panned(stage.view, (now.x - before.x) / stage.size.height, (before.y - now.y) / stage.size.height);
      if (now.size > 0 && before.size > 0) view = zoomed(view, before.size / now.size, stage.aspect, ...toSquare(now));
      before = now;
      stage.setView(view);
      return;
    }
    if (began && Math.hypot(at.x - began.x, at.y - began.y) < CLICK_PIXELS) return;
    began = null;
    const [dx, dy] = [at.x - last.x, at.y - last.y];
    if ((event.buttons & 6) !== 0 || event.shiftKey || event.ctrlKey)
      stage.setView(panned(stage.view, dx / stage.size.height, -dy / stage.size.height));
    else stage.setView(turned(stage.view, (-dx / stage.size.height) * Math.PI, (dy / stage.size.height) * Math.PI));
  });

  const end = (event) => {
    if (began && began.button === 0 && event.type === 'pointerup') on.click(began.x, began.y, event.shiftKey);
    began = null;
    pointers.delete(event.pointerId);
    before = pointers.size === 2 ? pair() : null;
  };
  canvas.addEventListener('pointerup', end);
  canvas.addEventListener('pointercancel', end);
  canvas.addEventListener('pointerleave', () => {
    hovered = null;
    on.leave();
  });

  /** At most one pick for each picture, of the last place. */
  function askHover(at) {
    const waiting = hovered !== null;
    hovered = at;
    if (waiting) return;
    requestAnimationFrame(() => {
      const last = hovered;
      hovered = null;
      if (last) on.hover(last.x, last.y);
    });
  }

  canvas.addEventListener(
    'wheel',
    (event) => {
      event.preventDefault();
      stage.stopFlight();
      const at = place(event);
      const steps = event.deltaMode === 1 ? event.deltaY * 33 : event.deltaY;
      held ??= { point: stage.view.flat ? null : pointUnder(at.x, at.y) };
      stage.setView(zoomed(stage.view, Math.exp(Math.max(-400, Math.min(400, steps)) * 0.0015), stage.aspect, ...toSquare(at), held.point));
    },
    { passive: false },
  );

  canvas.addEventListener('dblclick', () => on.command('fit-chosen'));

  document.addEventListener('keydown', (event) => {
    if (event.target.closest?.('input, select, textarea') || event.altKey || event.metaKey || event.ctrlKey) return;
    const step = Math.PI / 24;
    const turns = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, step], ArrowDown: [0, -step] };
    const onPicture = event.target === canvas || event.target === document.body;
    if (onPicture && turns[event.key]) {
      const [a, b] = turns[event.key];
      if (event.shiftKey) stage.setView(panned(stage.view, -a / 3, b / 3));
      else stage.setView(turned(stage.view, a, b));
    } else if (onPicture && (event.key === '+' || event.key === '=')) stage.setView(zoomed(stage.view, 0.8, stage.aspect, 0, 0));
    else if (onPicture && event.key === '-') stage.setView(zoomed(stage.view, 1.25, stage.aspect, 0, 0));
    else if (KEYS[event.key]) on.command(KEYS[event.key]);
    else return;
    event.preventDefault();
  });
}

/** What keys do wherever the focus is, but for text fields. */
export const KEYS = {
  1: 'front',
  2: 'top',
  3: 'right',
  0: 'iso',
  4: 'back',
  5: 'bottom',
  6: 'left',
  f: 'fit',
  o: 'flat',
  s: 'section',
  m: 'measure',
  i: 'isolate',
  h: 'hide',
  Escape: 'clear',
  '/': 'search',
  '?': 'help',
};

export const isView = (command) => command in STANDARD_VIEWS;
