// The one script of the page. It runs twice: in the document it is the page, in a worker it does the long sums.

import { startPage } from './page.js';
import { startTasks } from './tasks.js';
import { startWorker } from './worker.js';

if (typeof document === 'undefined') {
  startWorker();
} else {
  startTasks(document.currentScript.textContent);
  startPage();
}
