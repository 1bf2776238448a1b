// The calculator for JavaScript: `const call = await loadCalculator(bytes)`, then
// `call(request, files)` is the answer to a JSON text as a JSON text. `bytes` are those of
// page_program.wasm, or a WebAssembly.Module of it; `files` maps names to Uint8Arrays.
async function loadCalculator(bytes) {
  const compiled = bytes instanceof WebAssembly.Module ? bytes : await WebAssembly.compile(bytes);
  // The loader waits for ever where an instance fails; this promise does not.
  const fresh = () => new Promise((resolve, reject) => {
    const instantiateWasm = (imports, receive) => {
      WebAssembly.instantiate(compiled, imports).then((made) => receive(made, compiled)).catch(reject);
      return {};
    };
    createProgram({ instantiateWasm }).then(resolve, reject);
  });
  let program = await fresh();
  // What an exception leaves behind is not cleaned up: cmake/page_program.cmake has why.
  let problems = 0;
  const renewAfterProblems = () => {
    if (++problems % 256 === 0) fresh().then((made) => { program = made; }, () => {});
  };
  const encoder = new TextEncoder();
  const decoder = new TextDecoder();
  // Memory may grow with every allocation, which moves HEAPU8.
  const put = (data) => {
    const place = program._malloc(data.length || 1);
    if (place === 0) throw new RangeError("the memory does not suffice for a file of " + data.length + " bytes");
    program.HEAPU8.set(data, place);
    return place;
  };
  return function call(request, files = {}) {
    const places = [];
    const keep = (data) => {
      const place = put(data);
      places.push(place);
      return place;
    };
    try {
      for (const [name, data] of Object.entries(files)) {
        const text = encoder.encode(name);
        program._name_file(keep(text), text.length, keep(data), data.length);
      }
      const text = encoder.encode(request);
      program._call_page(keep(text), text.length);
      const begin = program._answer_text();
      const answer = decoder.decode(program.HEAPU8.subarray(begin, begin + program._answer_size()));
      if (answer.startsWith('{"problems"')) renewAfterProblems();
      return answer;
    } catch (error) {
      const message = error instanceof RangeError ? error.message : "the calculation broke off: " + error;
      return JSON.stringify({ problems: [{ pointer: null, line: null, where: "memory", message }] });
    } finally {
      program._forget();
      places.forEach((place) => program._free(place));
    }
  };
}
