// Diagnostics as a list, checks and reports as tables.

import { element, shortNumber } from './dom.js';

/** `on` has `diagnostic(d)`, `check(c)`, `goTo(place)`. */
export function drawProblems(holder, frame, on) {
  const order = { error: 0, warning: 1, note: 2 };
  const list = [...frame.diagnostics].sort((a, b) => order[a.severity] - order[b.severity]);
  const items = list.map((diagnostic) => {
    const [place] = diagnostic.places;
    const where = place ? `${frame.sources[place.file]?.file ?? ''}:${place.line}` : '';
    return element(
      'li',
      { class: `problem ${diagnostic.severity}` },
      element(
        'button',
        { type: 'button', onclick: () => on.diagnostic(diagnostic) },
        element(
          'span',
          { class: 'headline' },
          element('span', { class: 'code-name', text: diagnostic.code ?? '' }),
          element('span', { class: 'severity', text: diagnostic.severity }),
          element('span', { class: 'where', text: where }),
        ),
        element('span', { class: 'message', text: diagnostic.message }),
        diagnostic.size != null && element('span', { class: 'size', text: `size ${shortNumber(diagnostic.size)} ${frame.units}` }),
        diagnostic.help && element('span', { class: 'help', text: diagnostic.help }),
      ),
      diagnostic.places.length > 1 &&
        element(
          'ul',
          { class: 'others' },
          diagnostic.places.slice(1).map((other) =>
            element(
              'li',
              {},
              element('button', {
                type: 'button',
                onclick: () => on.goTo(other),
                text: `${frame.sources[other.file]?.file}:${other.line} ${other.label ?? ''}`,
              }),
            ),
          ),
        ),
    );
  });
  holder.replaceChildren(
    items.length ? element('ul', { class: 'problems' }, items) : element('p', { class: 'empty', text: 'No errors and no warnings.' }),
  );
}

export function drawChecks(holder, frame, on) {
  if (!frame.checks.length) {
    holder.replaceChildren(element('p', { class: 'empty', text: 'The script has no checks.' }));
    return;
  }
  const failed = frame.checks.filter((check) => !check.pass).length;
  const rows = [...frame.checks]
    .sort((a, b) => Number(a.pass) - Number(b.pass))
    .map((check) =>
      element(
        'tr',
        { class: check.pass ? 'pass' : 'fail' },
        element('td', {}, element('span', { class: `verdict ${check.pass ? 'pass' : 'fail'}`, text: check.pass ? 'kept' : 'failed' })),
        element(
          'td',
          {},
          element('button', { type: 'button', class: 'link', onclick: () => on.check(check), text: check.name || check.text }),
          check.name && check.name !== check.text && element('code', { text: check.text }),
        ),
        element('td', { class: 'found', text: check.found ?? '' }),
      ),
    );
  holder.replaceChildren(
    element('p', {
      class: 'summary',
      text: failed ? `${failed} of ${frame.checks.length} checks failed.` : `All ${frame.checks.length} checks pass.`,
    }),
    element(
      'table',
      {},
      element(
        'thead',
        {},
        element(
          'tr',
          {},
          ['', 'Check', 'Found'].map((text) => element('th', { scope: 'col', text })),
        ),
      ),
      element('tbody', {}, rows),
    ),
  );
}

export function drawReports(holder, frame, on) {
  const parts = frame.reports.flatMap((report) => [
    element(
      'h2',
      { dataset: { report: report.name } },
      element('button', { type: 'button', class: 'link', text: report.title || report.name, onclick: () => on.goTo(report.place) }),
    ),
    element(
      'div',
      { class: 'scroll', tabindex: '0', role: 'region', 'aria-label': report.title || report.name },
      element(
        'table',
        {},
        element(
          'thead',
          {},
          element(
            'tr',
            {},
            report.columns.map((name, i) =>
              element('th', { scope: 'col' }, name, report.units?.[i] && element('span', { class: 'unit', text: ` ${report.units[i]}` })),
            ),
          ),
        ),
        element(
          'tbody',
          {},
          report.rows.map((row) =>
            element(
              'tr',
              {},
              row.map((cell) =>
                element('td', {
                  class: typeof cell === 'number' ? 'number' : '',
                  text: typeof cell === 'number' ? shortNumber(cell, 6) : (cell ?? '–'),
                }),
              ),
            ),
          ),
        ),
      ),
    ),
  ]);
  const files = [...frame.outputs, ...frame.pictures];
  if (files.length)
    parts.push(
      element('h2', { text: 'Files that the script writes' }),
      element(
        'ul',
        { class: 'written' },
        files.map((file) =>
          element('li', {}, element('button', { type: 'button', class: 'link', text: file.path, onclick: () => on.goTo(file.place) })),
        ),
      ),
    );
  holder.replaceChildren(...(parts.length ? parts : [element('p', { class: 'empty', text: 'The script has no reports.' })]));
}
