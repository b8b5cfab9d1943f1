// What a person has set in the page: kept by name over frames, and in the address over reloads.

const FRESH = {
  view: null, // { yaw, pitch, height, target: [x, y, z], flat }: null until the first fit.
  shown: {}, // Name to whether it is shown, where a person said so.
  colors: {}, // Name to colour, where a person chose one.
  only: null, // Names that alone are shown, or null.
  shade: 'plain',
  cut: null, // { axis: 'x'|'y'|'z', share: 0…1, flip }.
  tab: 'script',
  theme: null, // 'light', 'dark', or null as the system has it.
  closed: {}, // Sections of the tree that are closed.
  left: true,
  right: true,
  open: [], // Things of the tree whose members are shown.
};

/** The state with `get`, `set` and `subscribe`; each change goes into the address after a moment. */
export function createState() {
  const state = { ...structuredClone(FRESH), ...fromAddress(location.hash) };
  const listeners = [];
  let timer = 0;
  const save = () => {
    timer = 0;
    history.replaceState(null, '', toAddress(state) || location.pathname + location.search);
  };
  return {
    get: () => state,
    set(patch) {
      Object.assign(state, patch);
      for (const listener of listeners) listener(new Set(Object.keys(patch)));
      if (!timer) timer = setTimeout(save, 200);
    },
    subscribe: (listener) => listeners.push(listener),
  };
}

const round = (x) => Number(x.toPrecision(12));

/** The state as text after `#`: only what differs from a fresh page. */
export function toAddress(state) {
  const parts = [];
  const put = (name, text) => parts.push(`${name}=${encodeURIComponent(text).replace(/%2C/g, ',')}`);
  if (state.view) {
    const { yaw, pitch, height, target, flat } = state.view;
    put('view', [yaw, pitch, height, ...target].map(round).join(',') + (flat ? ',flat' : ''));
  }
  for (const [name, value] of Object.entries(state)) {
    if (name === 'view' || JSON.stringify(value) === JSON.stringify(FRESH[name])) continue;
    put(name, typeof value === 'string' ? value : JSON.stringify(value));
  }
  return parts.length ? `#${parts.join('&')}` : '';
}

/** Reads what `toAddress` wrote; parts that make no sense are left out. */
export function fromAddress(hash) {
  const state = {};
  for (const part of hash.replace(/^#/, '').split('&')) {
    const at = part.indexOf('=');
    const name = part.slice(0, at);
    if (at < 0 || !(name in FRESH)) continue;
    try {
      const text = decodeURIComponent(part.slice(at + 1));
      if (name === 'view') {
        const [yaw, pitch, height, x, y, z] = text.split(',').slice(0, 6).map(Number);
        const numbers = [yaw, pitch, height, x, y, z];
        if (numbers.every(Number.isFinite) && height > 0)
          state.view = { yaw, pitch, height, target: [x, y, z], flat: text.endsWith(',flat') };
      } else if (name === 'shade' || name === 'tab' || name === 'theme') {
        if (/^[a-z-]+$/.test(text)) state[name] = text;
      } else {
        const value = JSON.parse(text);
        if (FRESH[name] === null || typeof value === typeof FRESH[name]) state[name] = value;
      }
    } catch {
      // A part of the address that cannot be read is not used.
    }
  }
  if (state.cut && !(['x', 'y', 'z'].includes(state.cut.axis) && Number.isFinite(state.cut.share))) delete state.cut;
  for (const name of ['only', 'open']) if (state[name] && !Array.isArray(state[name])) delete state[name];
  return state;
}
