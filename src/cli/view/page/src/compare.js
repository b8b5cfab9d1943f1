// Comparing with another state of the model: what was asked for, and what is said until its frame is there.

const WORDS = { golden: 'the golden', 'revision:HEAD': 'the last commit' };

const wordsOf = (other) => WORDS[other] ?? other.replace(/^revision:/, '');

export class Comparison {
  constructor(app) {
    this.app = app;
    this.wanted = ''; // The state to compare with, or '' for none.
    this.awaited = null; // The same while no frame has it yet.
    this.said = false; // Whether the message of this is shown.
    this.failure = null; // Why the state cannot be made, where the page has said so.
  }

  /** What the page shows as the other state: the one that is wanted, even before it is there. */
  get shown() {
    return this.awaited ?? this.wanted;
  }

  /** Whether another state is being evaluated. */
  get running() {
    return Boolean(this.awaited);
  }

  /** Asks for another state, or for none. */
  async ask(other) {
    const { control, server, toolbar } = this.app;
    const before = this.wanted;
    this.end(other ?? '');
    this.awaited = this.wanted;
    this.failure = null;
    if (other) {
      control.tell(`The model of ${wordsOf(other)} is evaluated for the comparison; until then the picture shows today's alone.`);
      this.said = true;
    }
    toolbar.update();
    const answer = await server.post('compare', { with: other });
    if (answer.ok !== false || this.awaited !== (other ?? '')) return;
    this.end(before);
    this.refused(answer.message ?? 'the server refused');
  }

  /** Looks whether a frame has what is wanted. Today's model may come alone before, also when a param was moved. */
  took({ partial, compare }) {
    if (partial) return;
    const there = compare?.with ?? '';
    this.awaited ??= there || this.wanted;
    if (this.awaited === there) this.end(there);
    if (compare?.failed && compare.failed !== this.failure) this.refused(compare.failed, there);
    if (compare) this.failure = compare.failed;
  }

  /** Waits no longer. */
  end(wanted = this.app.model.frame?.compare?.with ?? '') {
    if (this.said) this.app.control.tell(null);
    this.said = false;
    this.wanted = wanted;
    this.awaited = null;
    this.app.toolbar.update();
  }

  refused(why, other) {
    this.app.control.tell(`Nothing to compare with${other ? ` in ${wordsOf(other)}` : ''}: ${why}.`.replace(/\.\.$/, '.'), 8);
  }
}
