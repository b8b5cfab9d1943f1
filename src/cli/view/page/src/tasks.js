// The page's end of the worker. The worker runs the page's own script, taken from the document, so nothing is loaded.
// One task is sent at a time, so that what a newer frame has made needless is never done.

let worker = null;
let running = null;
const waiting = [];

/** `source` is the text of the page's script. */
export function startTasks(source) {
  const address = URL.createObjectURL(new Blob([source], { type: 'text/javascript' }));
  worker = new Worker(address);
  worker.addEventListener('message', ({ data: { result, failed } }) => {
    const { resolve, reject } = running;
    running = null;
    if (failed === undefined) resolve(result);
    else reject(new Error(failed));
    next();
  });
  worker.addEventListener('error', (event) => {
    running?.reject(new Error(event.message || 'the worker failed'));
    running = null;
    next();
  });
}

/**
 * Asks the worker; the promise ends with its result, or fails where `wanted` says no when its turn comes. `input` is
 * called then, and its typed arrays are copied.
 */
export function ask(task, input, wanted = () => true) {
  return new Promise((resolve, reject) => {
    waiting.push({ task, input, wanted, resolve, reject });
    next();
  });
}

function next() {
  while (!running && waiting.length > 0) {
    const first = waiting.shift();
    if (!first.wanted()) {
      first.reject(new Error('no longer wanted'));
      continue;
    }
    running = first;
    worker.postMessage({ task: first.task, input: first.input() });
  }
}
