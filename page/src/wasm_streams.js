// A WebAssembly module as streams of like bytes (instructions here, indices of variables there …) and back: LZMA
// packs them a tenth smaller than the mixture. It takes the instructions that the program has, no vectors or threads.

// The streams. A variable that a load reads is an address; numbers lie by what the next instruction does with them.
const [rest, instructions, variables, addresses, functions, offsets, numbers, summands, stored, passed, labels, constants, count] = Array(13).keys();

const code = 10; // the section of the functions' bodies
const end = 0x0b;
const isBlock = (instruction) => instruction >= 0x02 && instruction <= 0x06 && instruction !== 0x05;
const isLoad = (instruction) => instruction >= 0x28 && instruction <= 0x35;
const isStore = (instruction) => instruction >= 0x36 && instruction <= 0x3e;
const add = 0x6a;
const call = 0x10;
const numbersFor = (next) => (next === add ? summands : isStore(next) ? stored : next === call ? passed : numbers);

/** What to move behind each instruction that has operands. */
const operands = Array(256);
const put = (first, last, move) => operands.fill(move, first, last + 1);
const label = (way) => way.whole(labels);
put(0x02, 0x04, label); // block, loop, if
put(0x06, 0x09, label); // try, catch, throw, rethrow
put(0x0c, 0x0d, label);
put(0x0e, 0x0e, (way) => { for (let others = way.whole(labels); others >= 0; --others) way.whole(labels); });
put(call, call, (way) => way.whole(functions));
put(0x11, 0x11, (way) => { way.whole(functions); way.whole(functions); });
put(0x18, 0x18, label); // delegate
put(0x1c, 0x1c, (way) => way.bytes(labels, way.whole(labels)));
put(0x20, 0x20, (way) => way.whole(isLoad(way.next()) ? addresses : variables));
put(0x21, 0x22, (way) => way.whole(variables));
put(0x23, 0x24, label);
put(0x28, 0x3e, (way) => { way.whole(instructions); way.whole(offsets); }); // the alignment goes with the instruction
put(0x3f, 0x40, label);
put(0x41, 0x41, (way) => way.whole(numbersFor(way.next())));
put(0x42, 0x42, (way) => way.whole(numbers));
put(0x43, 0x43, (way) => way.bytes(constants, 4));
put(0x44, 0x44, (way) => way.bytes(constants, 8));
put(0xfc, 0xfc, (way) => { const which = way.whole(instructions); way.bytes(labels, which < 8 ? 0 : which === 10 ? 2 : 1); });

function moveFunction(way) {
  for (let groups = way.whole(labels); groups > 0; --groups) { way.whole(labels); way.byte(labels); }
  for (let depth = 1; depth > 0;) {
    const instruction = way.byte(instructions);
    operands[instruction]?.(way);
    if (isBlock(instruction)) ++depth;
    if (instruction === end || instruction === 0x18) --depth;
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
