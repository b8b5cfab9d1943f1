// The bar below: connection, what is under the cursor, counts, units and times; and long work with its stop button.

import { button, coordinate, element, shortNumber } from './dom.js';

export function createStatus(holder, work, onStop) {
  const part = (name, attributes = {}) => element('span', { class: name, ...attributes });
  const link = part('link-state', { role: 'status' });
  const under = part('under');
  const at = part('coordinates');
  const counts = part('counts');
  const units = part('units');
  const time = part('time');
  holder.append(link, under, at, element('span', { class: 'space' }), counts, units, time);

  const phase = element('span', { class: 'phase' });
  const meter = element('progress', { max: '1', 'aria-label': 'Share done' });
  const stop = button('Stop', 'stop', onStop, { class: 'stop' });
  work.append(phase, meter, stop);

  return {
    connection(connected, live) {
      link.textContent = !live ? 'one file' : connected ? 'live' : 'connection lost, trying again';
      link.className = `link-state ${connected ? 'on' : 'lost'}`;
    },
    under(title, point, radius) {
      under.textContent = title ?? '';
      at.textContent = point ? point.map((p) => coordinate(p, radius)).join('  ') : '';
    },
    counts(triangles, calls, bytes) {
      counts.textContent = `${triangles.toLocaleString('en')} triangles · ${calls} draw call${calls === 1 ? '' : 's'} · ${(bytes / 1e6).toFixed(1)} MB`;
    },
    frame(frame, times) {
      units.textContent = frame.units;
      time.title = '';
      time.textContent = 'evaluating';
      if (frame.partial) return;
      time.textContent = `made in ${shortNumber(frame.seconds * 1000, 3)} ms · shown in ${Math.round(times.shown - times.heard)} ms`;
      time.title = 'Evaluation of the script; from the news of the frame to its picture';
    },
    /** `comparing` tells that the other state of a comparison is awaited. */
    work(event, comparing = false) {
      work.hidden = !event || event.phase === null || event.phase === undefined;
      if (work.hidden) return;
      phase.textContent = `${comparing ? 'Comparing: ' : ''}${event.phase}${event.of ? ` ${event.done} of ${event.of}` : ''}${event.seconds > 0.5 ? ` · ${event.seconds.toFixed(1)} s` : ''}`;
      if (event.of) meter.value = event.done / event.of;
      else meter.removeAttribute('value');
    },
  };
}
