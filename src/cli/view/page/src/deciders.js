// What decided the sizes of a mesh: `decided` names for each node one of the header's `deciders`.

export const NOT_KNOWN = 'not known';

/** The number of the decider at a node, or −1 where nothing is known of its size. */
export function deciderAt({ header, arrays }, node) {
  const { decided } = arrays;
  if (!decided) return -1;
  const name = header.deciders?.[decided[node]] ?? NOT_KNOWN;
  return name === NOT_KNOWN ? -1 : decided[node];
}

/** The decider of each element: that of most of its corners, among equals the one that asks the least length. */
export function decidersOf(buffer) {
  if (buffer.decidedElements) return buffer.decidedElements;
  const { triangles, quads, asked } = buffer.arrays;
  const nt = (triangles?.length ?? 0) / 3;
  const nq = (quads?.length ?? 0) / 4;
  const made = new Int32Array(nt + nq);
  const own = [-1, -1, -1, -1];
  const decide = (ids, at, corners) => {
    for (let k = 0; k < corners; k++) own[k] = deciderAt(buffer, ids[at + k]);
    let [best, most, least] = [-1, 0, Infinity];
    for (let k = 0; k < corners; k++) {
      if (own[k] < 0) continue;
      let votes = 0;
      for (let j = 0; j < corners; j++) if (own[j] === own[k]) votes++;
      const length = asked && Number.isFinite(asked[ids[at + k]]) ? asked[ids[at + k]] : Infinity;
      if (votes > most || (votes === most && length < least)) [best, most, least] = [own[k], votes, length];
    }
    return best;
  };
  for (let t = 0; t < nt; t++) made[t] = decide(triangles, 3 * t, 3);
  for (let q = 0; q < nq; q++) made[nt + q] = decide(quads, 4 * q, 4);
  buffer.decidedElements = made;
  return made;
}

/** What is shown of the size asked at some nodes: who decided it and the mean length. */
export function askedFacts(buffer, nodes, length) {
  const { header, arrays } = buffer;
  const facts = [];
  if (arrays.decided) {
    const numbers = nodes.map((node) => deciderAt(buffer, node)).filter((n) => n >= 0);
    const names = [...new Set(numbers)].map((n) => header.deciders[n]);
    facts.push(['size decided by', names.join('; ') || NOT_KNOWN]);
  }
  if (arrays.asked) {
    const known = nodes.map((node) => arrays.asked[node]).filter(Number.isFinite);
    const mean = known.reduce((sum, one) => sum + one, 0) / known.length;
    facts.push(['asked edge length', known.length ? length(mean) : NOT_KNOWN]);
  }
  return facts;
}
