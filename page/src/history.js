// Undo and redo by the browser's own buttons: every committed change is an entry, its state in the link.
import { fragmentOf, holdsState, stateOf } from './link.js';

export function makeHistory({ show, fail }) {
  let index = 0;
  let last = 0;
  let writing = Promise.resolve();
  const buttons = () => ({ undo: index > 0, redo: index < last });
  let changed = () => {};

  addEventListener('popstate', async (event) => {
    index = event.state?.index ?? index + 1;
    last = Math.max(last, index);
    changed(buttons());
    if (!holdsState(location.hash)) return;
    try {
      show(await stateOf(location.hash));
    } catch (error) {
      fail(error.message);
    }
  });

  /** In the order of the calls, although packing takes a moment. */
  const write = (state, put) => {
    writing = writing.then(async () => {
      const fragment = await fragmentOf(state);
      if (fragment === location.hash) return;
      put(fragment);
      changed(buttons());
    });
    return writing;
  };

  return {
    onchange(listener) { changed = listener; listener(buttons()); },
    /** The state of the link that the page was opened with, or nothing. */
    async first() { return holdsState(location.hash) ? stateOf(location.hash) : null; },
    replace: (state) => write(state, (fragment) => history.replaceState({ index }, '', fragment)),
    push: (state) => write(state, (fragment) => {
      last = ++index;
      history.pushState({ index }, '', fragment);
    }),
    /** When what was pushed so far stands in the address. */
    settled: () => writing,
  };
}
