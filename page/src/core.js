// The calculator: a WebAssembly program, packed with gzip into the page.
import instantiate from 'tethercalc-program';

/** The program out of its element in the page, compiled once for the page and its workers. */
export async function programBytes(element) {
  const letters = atob(element.textContent);
  element.remove();
  const packed = Uint8Array.from(letters, (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'));
  return WebAssembly.compile(await new Response(stream).arrayBuffer());
}

/** call(request text, {name: bytes}) → answer text, of a compiled program. */
export const openCore = (program) => instantiate(program);
