"use strict";
// Holds one instance of the module and answers questions one after the other, so that the page never waits.
let ready;

async function start(module) {
  const { exports } = await WebAssembly.instantiate(module, {});
  exports.initialise();
  return exports;
}

function read(exports, length) {
  return new TextDecoder().decode(new Uint8Array(exports.memory.buffer, exports.answer(), length));
}

function ask(exports, request) {
  const question = new TextEncoder().encode(JSON.stringify(request));
  const at = exports.allocate(question.length);
  new Uint8Array(exports.memory.buffer, at, question.length).set(question);
  return read(exports, exports.ask());
}

onmessage = async ({ data }) => {
  if (data.module) { ready = start(data.module); return; }
  const exports = await ready, begin = performance.now();
  try {
    const text = ask(exports, data.request);
    postMessage({ id: data.id, text, ms: performance.now() - begin });
  } catch (e) {
    // A trap leaves the memory as it was: this instance answers no more.
    const length = exports.panicked();
    const why = length ? read(exports, length) : String(e);
    postMessage({ id: data.id, text: JSON.stringify({ failed: "the program broke off: " + why }), broken: true });
  }
};
