// All tests of the viewer in a real browser: `node --test tests/browser/test.mjs`, or `tests/browser/run`.

import './wire.mjs';
import './picture.mjs';
import './sections.mjs';
import './shades.mjs';
import './panes.mjs';
import './frames.mjs';
import './partial.mjs';
import './comparison.mjs';
import './extremes.mjs';
import './meshes.mjs';
import './program.mjs';
import './saves.mjs';
