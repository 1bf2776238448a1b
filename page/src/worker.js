// The calculator beside the page, for what takes longer than a moment.
import { openCore } from './core.js';

let core = null;
onmessage = async ({ data }) => {
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
