// Comparing with another state of the model: what was asked for, what frames say of it, and what is told until it is there.

const WORDS = { golden: 'the golden', 'revision:HEAD': 'the last commit' };

/** What a person calls another state. */
export const wordsOf = (other) => WORDS[other] ?? other.replace(/^revision:/, '');

export class Comparison {
  /** `note` is the element that tells how the comparison is going. */
  constructor(app, note) {
    this.app = app;
    this.note = note;
    this.asked = null; // What was asked for here, until a frame knows of it: { other, from }.
    this.refused = null; // What the server did not take, and why: { other, why }.
    this.now = null; // What the newest whole frame says.
    this.number = 0; // Its number.
  }

  /** The other state that is wanted, or '' for none. */
  get shown() {
    return this.asked?.other ?? this.now?.with ?? '';
  }

  /** Whether another state is being evaluated. */
  get running() {
    return this.asked ? this.asked.other !== '' : Boolean(this.now?.pending);
  }

  /** Asks for another state, or for none. */
  async ask(other) {
    const asked = { other: other ?? '', from: Infinity };
    this.asked = asked;
    this.refused = null;
    this.tell();
    const answer = await this.app.server.post('compare', { with: other });
    if (this.asked !== asked) return;
    if (answer.ok === false) {
      this.asked = null;
      this.refused = { other: asked.other, why: answer.message ?? 'the server refused' };
    } else asked.from = answer.from ?? 0;
    this.follow();
  }

  /** Takes what a frame says. Another tab may have asked for something else. */
  took({ partial, compare, number }) {
    if (partial) return;
    if ((compare?.with ?? '') !== (this.now?.with ?? '')) this.refused = null;
    this.now = compare;
    this.number = number;
    this.follow();
  }

  /** The connection is lost, and with it what was asked for. */
  lost() {
    this.asked = null;
    this.number = 0;
    this.tell();
  }

  /** Frames of before the server took a request do not know of it. */
  follow() {
    if (this.number >= this.asked?.from) this.asked = null;
    this.tell();
  }

  tell() {
    const { refused, now } = this;
    const failed = refused ?? (!this.asked && now?.failed ? { other: now.with, why: now.failed } : null);
    const text = failed
      ? `Not compared with ${wordsOf(failed.other)}: ${failed.why}`
      : this.running
        ? `The model of ${wordsOf(this.shown)} is evaluated for the comparison; until then the picture shows today's alone.`
        : '';
    if (this.note.textContent !== text) this.note.textContent = text;
    this.note.hidden = !text;
    this.app.toolbar?.update();
  }
}
