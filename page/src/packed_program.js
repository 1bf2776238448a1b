// The WebAssembly program as bundle.mjs packs it into the page: its streams with LZMA, a third smaller than with gzip,
// which is all that browsers unpack themselves.
/*! js-lzma 0.1.0, (c) 2011 Juan Mellado, MIT license: https://github.com/Magister/js-lzma */
import { decompressFile } from 'js-lzma';
import { moduleOf } from './wasm_streams.js';

function unpacked(packed) {
  // A .lzma file begins with one byte of properties, four of the dictionary's size, eight of the whole size.
  const out = new Uint8Array(Number(new DataView(packed.buffer).getBigUint64(5, true)));
  let read = 0;
  let written = 0;
  decompressFile({ readByte: () => packed[read++] }, { writeByte: (byte) => { out[written++] = byte; } });
  return out;
}

/** The program out of its element in the page, compiled once for the page and its workers. */
export function packedProgram(element) {
  const letters = atob(element.textContent);
  element.remove();
  const packed = new Uint8Array(letters.length); // from() takes ten times as long
  for (let i = 0; i < packed.length; ++i) packed[i] = letters.charCodeAt(i);
  return WebAssembly.compile(moduleOf(unpacked(packed)));
}
