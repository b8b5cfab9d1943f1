// The script beside the picture: its lines with marks of diagnostics, and the chain of lines that made what is picked.

import { element } from './dom.js';

const WORDS =
  /(\/\/.*$)|("(?:[^"\\]|\\.)*")|(\b\d[\d_]*(?:\.\d+)?(?:e[+-]?\d+)?(?:[a-zA-Z%°]+\d?)?)|\b(and|as|check|curve|else|export|false|fn|for|group|if|import|in|let|mesh|modeling|near|none|not|of|on|or|param|picture|point|report|shell|snap|surface|then|to|tolerance|true|units|use|within)\b/g;

/** `on` has `line(file, line)`, `goTo(place)` and `linkTo(place)`. */
export function createScriptPane(holder, on) {
  let frame = null;
  let shown = 0;
  let chain = [];
  let drawn = []; // The lines that are in the document, each as its text and its node.
  const picker = element('select', {
    'aria-label': 'Source file',
    onchange: () => {
      shown = Number(picker.value);
      drawLines();
    },
  });
  const chainList = element('ol', { class: 'chain', hidden: true, 'aria-label': 'Lines that made it' });
  const lines = element('div', { class: 'code', role: 'list', tabindex: '0', 'aria-label': 'Script' });
  lines.addEventListener('click', ({ target }) => {
    const number = target.closest('.line')?.dataset.line;
    if (number) on.line(shown, Number(number));
  });
  holder.append(element('div', { class: 'files' }, picker), chainList, lines);

  function setFrame(next) {
    const same =
      frame &&
      frame.sources.length === next.sources.length &&
      frame.sources.every((source, i) => source.text === next.sources[i].text && source.file === next.sources[i].file) &&
      ['diagnostics', 'checks'].every((name) => JSON.stringify(frame[name]) === JSON.stringify(next[name]));
    frame = next;
    if (same) return;
    shown = Math.min(shown, Math.max(frame.sources.length - 1, 0));
    picker.replaceChildren(...frame.sources.map((source, i) => element('option', { value: String(i), text: source.file })));
    picker.value = String(shown);
    picker.parentElement.hidden = frame.sources.length < 2;
    drawLines();
  }

  function drawLines() {
    picker.value = String(shown);
    const source = frame.sources[shown];
    const marks = new Map();
    for (const diagnostic of frame.diagnostics) {
      for (const place of diagnostic.places.slice(0, 1)) {
        if (place.file !== shown) continue;
        if (!marks.has(place.line) || diagnostic.severity === 'error') marks.set(place.line, diagnostic);
      }
    }
    for (const check of frame.checks)
      if (!check.pass && check.place?.file === shown && !marks.has(check.place.line))
        marks.set(check.place.line, { severity: 'error', code: 'check', message: `${check.text} — found ${check.found ?? 'otherwise'}` });
    const texts = (source?.text ?? '').split('\n');
    lines.style.setProperty('--digits', String(texts.length).length);
    putLines(texts);
    drawn.forEach(({ node }, i) => {
      const mark = marks.get(i + 1);
      const [kind, title] = [`line ${mark?.severity ?? ''}`, mark ? `${mark.code}: ${mark.message}` : ''];
      if (node.className !== kind) node.className = kind;
      if (node.title !== title) node.title = title;
    });
    light();
  }

  /** Puts lines into the place of those that are there; what is the same at the start and at the end stays. */
  function putLines(texts) {
    const least = Math.min(drawn.length, texts.length);
    let start = 0;
    while (start < least && drawn[start].text === texts[start]) start++;
    let end = 0; // Counted from the end.
    while (end < least - start && drawn[drawn.length - 1 - end].text === texts[texts.length - 1 - end]) end++;
    const made = texts.slice(start, texts.length - end).map((text) => ({
      text,
      node: element('div', { role: 'listitem' }, element('span', { class: 'number' }), element('code', {}, coloured(text))),
    }));
    const kept = drawn.slice(drawn.length - end);
    for (const { node } of drawn.slice(start, drawn.length - end)) node.remove();
    const added = document.createDocumentFragment();
    added.append(...made.map(({ node }) => node));
    lines.insertBefore(added, kept[0]?.node ?? null);
    drawn = [...drawn.slice(0, start), ...made, ...kept];
    drawn.forEach(({ node }, i) => {
      const number = String(i + 1);
      if (node.dataset.line !== number) node.dataset.line = node.firstChild.textContent = number;
    });
  }

  function coloured(text) {
    const parts = [];
    let from = 0;
    for (const match of text.matchAll(WORDS)) {
      parts.push(
        text.slice(from, match.index),
        element('span', { class: match[1] ? 'c' : match[2] ? 's' : match[3] ? 'n' : 'k', text: match[0] }),
      );
      from = match.index + match[0].length;
    }
    parts.push(text.slice(from));
    return parts;
  }

  /** Shows a chain of places: the first is the line a person would name. */
  function setChain(places, scroll = true) {
    chain = places ?? [];
    chainList.hidden = chain.length === 0;
    chainList.replaceChildren(
      ...chain.map((place, i) => {
        const source = frame.sources[place.file];
        const text = (source?.text ?? '').split('\n')[place.line - 1]?.trim() ?? '';
        return element(
          'li',
          {},
          element(
            'button',
            { type: 'button', class: 'place', onclick: () => goTo(place, true), title: text },
            element('span', { class: 'where', text: `${source?.file ?? '?'}:${place.line}` }),
            element('span', { class: 'what', text: place.label ?? text }),
          ),
          element('a', {
            href: on.linkTo(place),
            class: 'editor',
            text: 'open',
            title: 'Open in the editor',
            'aria-label': `Open ${source?.file} line ${place.line} in the editor`,
            onclick: () => on.show(place),
          }),
        );
      }),
    );
    if (chain.length && scroll) goTo(chain[0], false);
    else light();
  }

  function goTo(place, tell) {
    if (!frame?.sources[place?.file]) return;
    if (place.file !== shown) {
      shown = place.file;
      drawLines();
    }
    light(place);
    const line = lines.querySelector(`[data-line="${place.line}"]`);
    line?.scrollIntoView({ block: 'center', behavior: 'instant' });
    if (tell) on.show(place);
  }

  function light(at = null) {
    for (const line of lines.querySelectorAll('.of-chain, .at')) line.classList.remove('of-chain', 'at');
    for (const place of chain) {
      if (place.file !== shown) continue;
      for (let n = place.line; n <= Math.min(place.end_line ?? place.line, place.line + 200); n++)
        lines.querySelector(`[data-line="${n}"]`)?.classList.add('of-chain');
    }
    if (at) lines.querySelector(`[data-line="${at.line}"]`)?.classList.add('at');
  }

  return { setFrame, setChain, goTo, lightLine: (file, line) => file === shown && light({ line }) };
}
