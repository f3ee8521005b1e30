// Instances of the module in workers. A run that nobody waits for any more is ended with its worker; the compiled module is kept.

// The compiled module: from the page itself, or from the file beside it.
async function compiled() {
  const embedded = document.getElementById("module");
  if (!embedded) return WebAssembly.compileStreaming(fetch("gudgeon.wasm")).catch(() => fetch("gudgeon.wasm").then((r) => r.arrayBuffer()).then((b) => WebAssembly.compile(b)));
  const raw = atob(embedded.textContent.trim()), bytes = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; i++) bytes[i] = raw.charCodeAt(i);
  embedded.remove();
  const plain = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return WebAssembly.compile(await new Response(plain).arrayBuffer());
}

class Engine {
  constructor(module) {
    this.module = module;
    this.source = URL.createObjectURL(new Blob([document.getElementById("worker").textContent], { type: "text/javascript" }));
    this.start();
  }
  start() {
    this.waiting = new Map();
    this.next = 0;
    this.worker = new Worker(this.source);
    this.worker.postMessage({ module: this.module });
    this.worker.onmessage = ({ data }) => {
      const take = this.waiting.get(data.id);
      this.waiting.delete(data.id);
      if (data.broken) this.stop();
      if (take) take(Object.assign(JSON.parse(data.text), { ms: data.ms }));
    };
  }
  get busy() { return this.waiting.size > 0; }
  // The answer; `null` when it was stopped before.
  ask(request) {
    return new Promise((take) => {
      const id = this.next++;
      this.waiting.set(id, take);
      this.worker.postMessage({ id, request });
    });
  }
  stop() {
    const open = [...this.waiting.values()];
    this.worker.terminate();
    this.start();
    for (const take of open) take(null);
  }
}
