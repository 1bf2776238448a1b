// The calculator beside the page, for what takes longer than a moment.
import { openCore } from './core.js';

/** The script began in a worker: it takes the program, then a request. */
export function work() {
  let core = null;
  globalThis.onmessage = async ({ data }) => {
    try {
      if (data.program) {
        core = openCore(data.program);
        return;
      }
      const call = await core;
      postMessage({ answer: call(data.request, data.files) });
    } catch (error) {
      postMessage({ failed: String(error?.message ?? error) });
    }
  };
}
