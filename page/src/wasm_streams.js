// A WebAssembly module as streams of like bytes (instructions here, offsets there …) and back: LZMA packs them a tenth
// smaller than the mixture. It takes the instructions that the program has, no vectors or threads.

// The streams. What follows an instruction lies by that; a number, and which variable is read, by the instruction behind.
const [rest, instructions, locals, offsets, constants, kinds] = Array(6).keys();
const of = (instruction) => kinds + instruction;
const numbersFor = (next) => kinds + 256 + next;
const readFor = (next) => kinds + 512 + next;
const count = kinds + 768;

const code = 10; // the section of the functions' bodies
const end = 0x0b;
const delegate = 0x18;
const isBlock = (instruction) => instruction >= 0x02 && instruction <= 0x06 && instruction !== 0x05;

/** What to move behind each instruction that has operands, most into its own stream. */
const operands = Array(256);
const put = (first, last, move) => operands.fill(move, first, last + 1);
const one = (way, own) => way.whole(own);
const two = (way, own) => { way.whole(own); way.whole(own); };
const number = (way) => way.whole(numbersFor(way.next()));
put(0x02, 0x04, one); // block, loop, if
put(0x06, 0x09, one); // try, catch, throw, rethrow
put(0x0c, 0x0d, one); // branches
put(0x0e, 0x0e, (way, own) => { for (let others = way.whole(own); others >= 0; --others) way.whole(own); });
put(0x10, 0x10, one); // call
put(0x11, 0x11, two);
put(delegate, delegate, one);
put(0x1c, 0x1c, (way, own) => way.bytes(own, way.whole(own)));
put(0x20, 0x20, (way) => way.whole(readFor(way.next())));
put(0x21, 0x22, (way) => way.whole(of(0x21))); // a variable that is set, which of both ways is alike
put(0x23, 0x24, one);
put(0x28, 0x3e, (way, own) => { way.whole(own); way.whole(offsets); }); // loads and stores, their alignment first
put(0x3f, 0x40, one);
put(0x41, 0x42, number);
put(0x43, 0x43, (way) => way.bytes(constants, 4));
put(0x44, 0x44, (way) => way.bytes(constants, 8));
put(0xfc, 0xfc, (way, own) => { const which = way.whole(own); way.bytes(own, which < 8 ? 0 : which === 10 ? 2 : 1); });

function moveFunction(way) {
  for (let groups = way.whole(locals); groups > 0; --groups) two(way, locals);
  for (let depth = 1; depth > 0;) {
    const instruction = way.byte(instructions);
    operands[instruction]?.(way, of(instruction));
    if (isBlock(instruction)) ++depth;
    if (instruction === end || instruction === delegate) --depth;
  }
}

function moveModule(way) {
  way.bytes(rest, 8);
  while (way.more()) {
    if (way.byte(rest) === code) way.sized(() => { for (let left = way.whole(rest); left > 0; --left) way.sized(() => moveFunction(way)); });
    else way.bytes(rest, way.whole(rest));
  }
}

/** A way of moving a module's bytes, by how it moves one. */
function wayOf(byte, others) {
  const bytes = (stream, count) => { for (; count > 0; --count) byte(stream); };
  /** A whole number in LEB128, of which the value serves where it counts something. */
  const whole = (stream) => {
    let value = 0;
    for (let shift = 0; ; shift += 7) {
      const part = byte(stream);
      value |= (part & 127) << shift;
      if (part < 128) return value;
    }
  };
  return { byte, bytes, whole, ...others };
}

/** The streams of a module, behind its size and their lengths. */
export function streamsOf(module) {
  const streams = Array.from({ length: count }, () => []);
  let at = 0;
  moveModule(wayOf((stream) => { streams[stream].push(module[at]); return module[at++]; }, {
    more: () => at < module.length,
    next: () => { let past = at; while (module[past++] > 127); return module[past]; },
    sized: (move) => { while (module[at++] > 127); move(); }, // the size is known once that is moved
  }));
  const head = new Uint32Array([module.length, ...streams.map((stream) => stream.length)]);
  return Uint8Array.from([...new Uint8Array(head.buffer), ...streams.flat()]);
}

/** The module of these streams. */
export function moduleOf(packed) {
  const [size, ...lengths] = new Uint32Array(packed.slice(0, 4 * (count + 1)).buffer);
  const places = new Uint32Array(count + 1).fill(4 * (count + 1));
  lengths.forEach((length, i) => { places[i + 1] = places[i] + length; });
  const endOfRest = places[rest + 1];
  const module = new Uint8Array(size);
  let at = 0;
  moveModule(wayOf((stream) => (module[at++] = packed[places[stream]++]), {
    more: () => places[rest] < endOfRest,
    next: () => packed[places[instructions]],
    sized: (move) => {
      const begin = at;
      move();
      const bytes = [];
      let left = at - begin;
      for (; left > 127; left >>= 7) bytes.push(left & 127 | 128);
      bytes.push(left);
      module.copyWithin(begin + bytes.length, begin, at);
      module.set(bytes, begin);
      at += bytes.length;
    },
  }));
  return module;
}
