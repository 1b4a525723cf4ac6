// The program in the page: it is unpacked and compiled once, and runs in workers, so that the page answers while a log is read.
"use strict";

const program = (async () => {
  const packed = Uint8Array.from(atob(byId("program").textContent.trim()), (one) => one.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  return WebAssembly.compile(await new Response(stream).arrayBuffer());
})();
const workerSource = URL.createObjectURL(new Blob([byId("worker").textContent], { type: "text/javascript" }));

/// A worker that runs one command of the program after the other.
class Runner {
  constructor() {
    Object.assign(this, { worker: null, asked: new Map(), count: 0 });
  }

  /// Runs a command on files, each a name with a File or with bytes. Gives its status, what it printed, and the files that it
  /// wrote. `told` is called with the share of a file that has been read.
  async run(args, files, told = () => {}) {
    const module = await program;
    if (!this.worker) {
      this.worker = new Worker(workerSource);
      this.worker.onmessage = ({ data: { id, share, ended } }) => {
        const one = this.asked.get(id);
        if (!one) return;
        if (share !== undefined) return one.told(share);
        this.asked.delete(id);
        one.resolve(ended);
      };
      this.worker.onerror = (event) => this.end(event.message);
      this.worker.postMessage({ module });
    }
    this.count += 1;
    const id = this.count;
    return new Promise((resolve) => {
      this.asked.set(id, { resolve, told });
      this.worker.postMessage({ id, args, files });
    });
  }

  /// Ends what runs. Who waits for it is told so.
  end(words = "the command was ended") {
    this.worker?.terminate();
    this.worker = null;
    for (const { resolve } of this.asked.values()) resolve({ status: 2, output: "", errors: words, files: [] });
    this.asked.clear();
  }
}
