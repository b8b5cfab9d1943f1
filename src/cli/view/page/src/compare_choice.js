// The choice of a state to compare with: the golden, the last commit, or a revision that is typed.

import { element } from './dom.js';
import { wordsOf } from './compare.js';

const TYPED = 'typed'; // The choice that opens the field.

/** `ask(other)` asks for a state or for none; `shown()` gives the one that is wanted. */
export function createCompareChoice(ask, shown) {
  const option = (value, text) => element('option', { value, text });
  const choice = element(
    'select',
    {
      id: 'compare',
      'aria-label': 'Compare with',
      onchange() {
        field.hidden = choice.value !== TYPED;
        if (!field.hidden) field.focus();
        else ask(choice.value || null);
      },
    },
    option('', 'Compare…'),
    option('golden', 'with the golden'),
    option('revision:HEAD', 'with the last commit'),
    option(TYPED, 'with a revision…'),
  );
  const close = () => {
    field.hidden = true;
    update();
    choice.focus();
  };
  const field = element('input', {
    type: 'text',
    id: 'revision',
    hidden: true,
    maxlength: '200',
    placeholder: 'branch, tag or commit',
    'aria-label': 'Revision to compare with',
    autocomplete: 'off',
    autocapitalize: 'off',
    spellcheck: 'false',
    onkeydown(event) {
      const name = field.value.trim();
      if (event.key === 'Enter' && name) ask(`revision:${name}`);
      if (event.key === 'Escape' || (event.key === 'Enter' && name)) close();
    },
  });

  function update() {
    if (!field.hidden) return;
    const other = shown();
    if (![...choice.options].some(({ value }) => value === other)) choice.lastChild.before(option(other, `with ${wordsOf(other)}`));
    choice.value = other;
  }
  return { parts: [choice, field], update };
}
