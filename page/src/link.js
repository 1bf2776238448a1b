// The state of the page as the fragment of a link: JSON, deflated, in the letters of base64url.
// Fragments are not sent to servers.

const prefix = '#d=';

async function through(stream, bytes) {
  const writer = stream.writable.getWriter();
  // What is wrong with the bytes is told by the reader; the writer must not tell it again unheard.
  writer.write(bytes).catch(() => {});
  writer.close().catch(() => {});
  return new Uint8Array(await new Response(stream.readable).arrayBuffer());
}

export async function fragmentOf(state) {
  const packed = await through(new CompressionStream('deflate-raw'),
    new TextEncoder().encode(JSON.stringify(state)));
  let letters = '';
  for (const byte of packed) letters += String.fromCharCode(byte);
  return prefix + btoa(letters).replaceAll('+', '-').replaceAll('/', '_').replaceAll('=', '');
}

export const holdsState = (fragment) => fragment.startsWith(prefix);

/** The state in a fragment. Throws an Error in words for people where it is none. */
export async function stateOf(fragment) {
  const damaged = new Error('This link is damaged: only a part of it arrived, or it was changed on the way. ' +
    'Ask for it again, whole, or for the spec as a file. What the page showed before is still here.');
  let state;
  try {
    const letters = atob(fragment.slice(prefix.length).replaceAll('-', '+').replaceAll('_', '/'));
    const packed = Uint8Array.from(letters, (letter) => letter.charCodeAt(0));
    state = JSON.parse(new TextDecoder('utf-8', { fatal: true }).decode(
      await through(new DecompressionStream('deflate-raw'), packed)));
  } catch {
    throw damaged;
  }
  const text = (value) => typeof value === 'string';
  const files = state?.files ?? {};
  if (state === null || typeof state !== 'object' || !text(state.spec) ||
      !(state.pinned === null || state.pinned === undefined || text(state.pinned)) ||
      typeof files !== 'object' || !Object.values(files).every(text)) throw damaged;
  return { spec: state.spec, pinned: state.pinned ?? null, files, view: text(state.view) ? state.view : 'sizes' };
}

/** Unpacks gzip, as some loggers and browsers leave it. */
export async function unpacked(name, bytes) {
  if (!(bytes[0] === 0x1f && bytes[1] === 0x8b)) return { name, bytes };
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip'));
  return { name: name.replace(/\.gz$/i, ''), bytes: new Uint8Array(await new Response(stream).arrayBuffer()) };
}
