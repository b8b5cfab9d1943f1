// Closed bodies in the picture, which a section caps: a mesh, a surface, or a shell with the surfaces that it holds.

// On each edge of a closed body an even number of faces meet; where three do, inside and outside are not told apart.
const isEven = (n) => n > 0 && n % 2 === 0;

/** Those of which everything is shown, as `{ key, parts: [{ drawing, faces }], color }`; `faces` is null for all of a drawing. */
export async function closedBodies(model) {
  const bodies = new Map();
  for (const drawing of model.visible()) {
    const parts =
      drawing.role === 'mesh'
        ? (await isWatertight(drawing)) && [{ drawing, faces: null }]
        : drawing.role === 'edges' && isClosed(drawing) && model.partsOf(drawing.thing);
    if (!parts || !parts.length || !parts.every((part) => isWhole(part.drawing))) continue;
    const key = parts.map((part) => `${part.drawing.id} ${part.faces ? [...part.faces].join() : ''}`).join('\n');
    // A shell of one closed surface is the body that the surface is.
    const color = drawing.capColor ?? parts.find((part) => part.drawing.capColor)?.drawing.capColor;
    if (!bodies.has(key)) bodies.set(key, { key, parts, color });
  }
  return [...bodies.values()];
}

const isWatertight = async (drawing) => (await drawing.buffer.find('sides')).counts.every(isEven);

function isClosed(edges) {
  const meeting = edges.buffer.arrays.faces;
  return Boolean(meeting?.length) && meeting.every(isEven);
}

/** Whether nothing of a drawing is hidden, and nothing of its thing is missing in it. */
const isWhole = ({ object, filter, thing }) => object.visible && !filter && !thing.facts?.some(([name]) => name === 'not drawn');
