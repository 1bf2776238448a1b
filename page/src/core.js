// The calculator: a WebAssembly program.
import instantiate from 'tethercalc-program';

/** call(request text, {name: bytes}) → answer text, of a compiled program. */
export const openCore = (program) => instantiate(program);
