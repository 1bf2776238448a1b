// The page's one script, which is that of its workers, too.
import { work } from './worker.js';

const script = globalThis.document?.currentScript.textContent;
if (script) import('./main.js').then(({ start }) => start(script));
else work();
