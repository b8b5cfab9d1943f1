// What tests may read of the page. Nothing here changes it.

export function seam({ state, stage, model, selection, marks, server, section, legend }) {
  const brief = (hit) =>
    hit && { thing: hit.drawing.name, kind: hit.kind, item: hit.item, point: hit.point, nodes: hit.nodes, elements: hit.elements };
  return Object.freeze({
    state() {
      const { info } = stage.renderer;
      return {
        number: model.frame?.number ?? null,
        partial: Boolean(model.frame?.partial),
        drawn: model.drawings.filter((drawing) => drawing.object.visible).map((drawing) => `${drawing.name}:${drawing.role}`),
        things: model.frame?.things.map((thing) => ({ name: thing.name, shown: model.isShown(thing) })) ?? [],
        pictures: stage.frames,
        drawCalls: info.render.calls,
        triangles: info.render.triangles,
        geometries: info.memory.geometries,
        textures: info.memory.textures,
        buffers: model.buffers.held.size,
        bytes: model.buffers.bytes(),
        fetched: model.buffers.fetched,
        trees: [...model.buffers.held.values()].filter((buffer) => buffer.index?.length > 0).every((buffer) => buffer.tree),
        compared: model.compared.length,
        chosen: selection.thing,
        hovered: brief(selection.hovered),
        sidesLit: selection.sides.shown,
        lit: [...selection.lit],
        picks: selection.picks.map(brief),
        marks: marks.marks.length,
        caps: section.caps.size,
        times: { ...model.times },
        drawMs: stage.drawMs,
        live: server.live,
        settings: structuredClone(state.get()),
      };
    },
    /** The pick at a place of the canvas, with the time that it took in milliseconds. */
    pick(x, y) {
      const began = performance.now();
      const hit = selection.at(x, y);
      const ms = performance.now() - began;
      return hit ? { ...brief(hit), ms } : { ms };
    },
    camera: () => ({ ...structuredClone(stage.view), origin: [...stage.origin] }),
    toScreen: (point) => stage.toScreen(point),
    legend: () => Boolean(legend.current()),
  });
}
