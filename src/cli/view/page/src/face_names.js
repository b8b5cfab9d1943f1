// Which drawing has the faces of a surface, by the name that meshes, shells and groups call it.

const withoutPatch = (name) => name.replace(/\.patches\[\d+\]$/, '');
const withoutNumber = (name) => name.replace(/\[\d+\]$/, '');

export class FaceNames {
  /** Where several drawings have a surface of one name, it is the first one's: the declared one. */
  constructor(drawings) {
    this.known = new Map();
    this.drawn = new Map();
    for (const drawing of drawings) {
      if (drawing.role !== 'faces') continue;
      this.drawn.set(drawing.name, [...(this.drawn.get(drawing.name) ?? []), drawing]);
      (drawing.buffer.header.faces ?? []).forEach(({ name }, face) => {
        for (const one of new Set([name, withoutPatch(name)])) {
          if (!this.known.has(one)) this.known.set(one, { drawing, faces: new Set() });
          const known = this.known.get(one);
          if (known.drawing === drawing) known.faces.add(face);
        }
      });
    }
  }

  /** The drawings of a thing's own faces. */
  drawingsOf(name) {
    return this.drawn.get(name) ?? [];
  }

  /** The faces of a surface or a patch as `[drawing, faces]`, none where it is not drawn. Meshes number surfaces of one name. */
  of(name) {
    const found = this.known.get(name) ?? this.known.get(withoutNumber(name));
    return found ? [[found.drawing, found.faces]] : [];
  }
}
