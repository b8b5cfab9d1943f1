// A partial frame comes while the evaluation still runs: it has shapes, and the rest is that of the last whole frame.

const NOTHING = { sources: [], checks: [], reports: [], diagnostics: [], pictures: [], outputs: [], compare: null };

/** The frame to show. `evaluating` is true where nothing but shapes is known yet. */
export function completed(frame, whole) {
  if (!frame.partial) return frame;
  const before = whole ?? NOTHING;
  // The same files may have other numbers now.
  const numbers = before.sources.map(({ path }) => frame.sources.findIndex((source) => source.path === path));
  const moved = (place) => place && { ...place, file: numbers[place.file] ?? -1 };
  const kept = (list) => list.map((one) => ({ ...one, place: moved(one.place) }));
  return {
    ...frame,
    title: frame.title ?? before.title ?? 'loft',
    checks: kept(before.checks),
    reports: kept(before.reports),
    pictures: kept(before.pictures),
    outputs: kept(before.outputs),
    diagnostics: before.diagnostics.map((one) => ({ ...one, places: one.places.map(moved).filter(({ file }) => file >= 0) })),
    compare: before.compare,
    evaluating: !whole,
  };
}
