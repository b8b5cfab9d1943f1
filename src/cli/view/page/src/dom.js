// Small helpers for the document: elements are made by calls, text is never read as HTML.

/** Makes an element. `attributes` may hold `on…` handlers, `class`, `text`, `dataset` and plain attributes. */
export function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (name.startsWith('on')) made.addEventListener(name.slice(2), value);
    else if (name === 'text') made.textContent = value;
    else if (name === 'class') made.className = value;
    else if (name === 'dataset') Object.assign(made.dataset, value);
    else if (name === 'value') made.value = value;
    else if (name === 'style') made.style.cssText = value;
    else made.setAttribute(name, value === true ? '' : value);
  }
  for (const child of children.flat(Infinity)) {
    if (child !== null && child !== undefined && child !== false) made.append(child);
  }
  return made;
}

const DRAWINGS = {
  fit: 'M3 6V3h3M10 3h3v3M13 10v3h-3M6 13H3v-3M6 6h4v4H6z',
  cut: 'M2 11l6 3 6-3M2 8l6 3 6-3-6-3zM8 2v3',
  measure: 'M2 10.5L10.5 2 14 5.5 5.5 14zM5 7.5l1.5 1.5M7.5 5L9 6.5M10 2.5',
  eye: 'M1.5 8S4 3.5 8 3.5 14.5 8 14.5 8 12 12.5 8 12.5 1.5 8 1.5 8zM8 6a2 2 0 100 4 2 2 0 000-4z',
  hidden:
    'M2 2l12 12M4.5 4.6C2.6 5.8 1.5 8 1.5 8S4 12.5 8 12.500c1.2 0 2.2-.4 3.1-.900M6.5 3.700A6 6 0 018 3.500c4 0 6.5 4.5 6.5 4.500s-.6 1.2-1.8 2.4',
  only: 'M8 2v3M8 11v3M2 8h3M11 8h3M8 6.500a1.5 1.5 0 100 3 1.5 1.5 0 000-3z',
  sun: 'M8 5a3 3 0 100 6 3 3 0 000-6zM8 1v1.500M8 13.500V15M1 8h1.500M13.5 8H15M3 3l1 1M12 12l1 1M3 13l1-1M12 4l1-1',
  box: 'M8 1.500l5.5 3v7L8 14.500l-5.5-3v-7zM2.5 4.500L8 7.500l5.5-3M8 7.500v7',
  left: 'M2 3h12v10H2zM6 3v10',
  right: 'M2 3h12v10H2zM10 3v10',
  stop: 'M4 4h8v8H4z',
  close: 'M4 4l8 8M12 4l-8 8',
  flip: 'M5 2v12M5 2L2.5 5M5 2l2.5 3M11 14V2M11 14l-2.5-3M11 14l2.5-3',
  open: 'M6 4l4 4-4 4',
  compare: 'M2 4h7v7H2zM6 6h8v8H6z',
  help: 'M6 6a2 2 0 114 0c0 1.5-2 1.5-2 3M8 11.500v.500M8 1.500a6.5 6.5 0 100 13 6.5 6.5 0 000-13z',
};

/** A small line drawing for a button; the button itself has the label. */
export function icon(name) {
  const svg = document.createElementNS('http://www.w3.org/2000/svg', 'svg');
  svg.setAttribute('viewBox', '0 0 16 16');
  svg.setAttribute('aria-hidden', 'true');
  svg.setAttribute('class', 'icon');
  const path = document.createElementNS('http://www.w3.org/2000/svg', 'path');
  path.setAttribute('d', DRAWINGS[name] ?? '');
  svg.append(path);
  return svg;
}

/** A button with an icon, or a text where no such icon is there. */
export function button(label, picture, onclick, attributes = {}) {
  return element(
    'button',
    { type: 'button', title: label, 'aria-label': label, onclick, ...attributes },
    DRAWINGS[picture] ? icon(picture) : picture,
  );
}

/** A number for reading: up to `digits` significant digits, no exponent where it can be avoided. */
export function shortNumber(value, digits = 5) {
  if (value === null || value === undefined || !Number.isFinite(value)) return '–';
  if (value === 0) return '0';
  const size = Math.abs(value);
  if (size >= 10 ** 9 || size < 1e-6) return value.toExponential(3);
  const places = Math.max(0, Math.min(9, digits - 1 - Math.floor(Math.log10(size))));
  const text = value.toFixed(places);
  return text.includes('.') ? text.replace(/0+$/, '').replace(/\.$/, '') : text;
}

/** A coordinate, rounded to what a buffer of a model of this size holds. */
export function coordinate(value, radius) {
  const places = Math.max(0, Math.min(16, 6 - Math.ceil(Math.log10(Math.max(radius, 1e-12)))));
  const text = value.toFixed(places);
  return text.includes('.') ? text.replace(/0+$/, '').replace(/\.$/, '').replace(/^-0$/, '0') : text;
}

/** Calls `run` once in the next turn, however often it was asked. */
export function soon(run) {
  let waiting = false;
  return () => {
    if (waiting) return;
    waiting = true;
    queueMicrotask(() => {
      waiting = false;
      run();
    });
  };
}
