// The page's one script, which is that of its workers, too.
import { work } from './worker.js';

const script = globalThis.document?.currentScript.textContent;
// The program is behind it: in between, gzip would lose sight of the text before.
if (script) addEventListener('DOMContentLoaded', () => import('./main.js').then(({ start }) => start(script)));
else work();
