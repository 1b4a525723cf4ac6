// The page: it takes files, runs the program on them in a worker, and shows what the program printed and wrote.
"use strict";

const byId = (id) => document.getElementById(id);

/** The program, which is compiled once. */
const program = (async () => {
  const packed = Uint8Array.from(atob(byId("program").textContent.trim()), (one) => one.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  return WebAssembly.compile(await new Response(stream).arrayBuffer());
})();
const worker = URL.createObjectURL(new Blob([byId("worker").textContent], { type: "text/javascript" }));
let running = null;

/** The words of a line, in which quotation marks keep blanks together. */
function words(line) {
  const found = line.match(/"[^"]*"|'[^']*'|[^\s"']+/g) ?? [];
  return found.map((word) => word.replace(/^(["'])(.*)\1$/, "$2"));
}

/** Runs one command. A later call ends an earlier one. */
async function run(args, files) {
  const module = await program;
  running?.terminate();
  const mine = new Worker(worker);
  running = mine;
  return new Promise((resolve) => {
    mine.onmessage = ({ data }) => {
      if ("share" in data) {
        byId("progress").value = data.share;
        return;
      }
      mine.terminate();
      resolve(data);
    };
    mine.onerror = (event) => resolve({ status: 2, output: "", errors: event.message, files: [] });
    mine.postMessage({ module, args, files });
  });
}

function show(id, text) {
  byId(id).textContent = text;
  byId(id).hidden = text === "";
}

async function go() {
  const chosen = Array.from(byId("logs").files);
  if (chosen.length === 0) return;
  const files = chosen.map((file) => [file.name, file]);
  const names = files.map(([name]) => name);
  const command = byId("command").value;
  const options = words(byId("options").value);
  const forms = {
    report: ["--output", "report.html"],
    export: options.includes("--format") ? [] : ["--format", "json"],
  };
  // A page and an export are of one file; the others take all.
  const inputs = command in forms ? names.slice(0, 1) : names;
  const args = ["allanite", command, ...inputs, ...options, ...(forms[command] ?? [])];
  byId("line").textContent = args.map((word) => (/^[\w.,:=/+-]+$/.test(word) ? word : `"${word}"`)).join(" ");
  for (const id of ["output", "errors", "files", "report"]) byId(id).hidden = true;
  byId("progress").hidden = false;
  byId("progress").removeAttribute("value");
  byId("status").textContent = `reading ${inputs.join(", ")} …`;
  const begun = performance.now();
  const done = await run(args, files);
  const seconds = ((performance.now() - begun) / 1000).toFixed(1);
  byId("progress").hidden = true;
  byId("status").textContent = done.status === 0 ? `done in ${seconds} s` : `ended with status ${done.status}, after ${seconds} s`;
  // What a report prints is sentences; the others print tables.
  byId("output").classList.toggle("words", command === "report");
  show("output", done.output);
  show("errors", done.errors);
  const links = done.files.map(([name, bytes]) => {
    const link = document.createElement("a");
    const isPage = name.endsWith(".html");
    link.href = URL.createObjectURL(new Blob([bytes], { type: isPage ? "text/html" : "application/octet-stream" }));
    link.download = name;
    link.textContent = `save ${name}`;
    const item = document.createElement("li");
    item.append(link);
    if (isPage) {
      byId("report").srcdoc = new TextDecoder().decode(bytes);
      byId("report").hidden = false;
    }
    return item;
  });
  byId("files").replaceChildren(...links);
  byId("files").hidden = links.length === 0;
}

byId("logs").addEventListener("change", () => {
  const names = Array.from(byId("logs").files, (file) => file.name);
  byId("names").textContent = names.join(", ");
  byId("go").disabled = names.length === 0;
  go();
});
byId("ask").addEventListener("submit", (event) => {
  event.preventDefault();
  go();
});
const drop = byId("drop");
for (const kind of ["dragenter", "dragover"]) {
  addEventListener(kind, (event) => {
    event.preventDefault();
    drop.classList.add("over");
  });
}
addEventListener("dragleave", () => drop.classList.remove("over"));
addEventListener("drop", (event) => {
  event.preventDefault();
  drop.classList.remove("over");
  byId("logs").files = event.dataTransfer.files;
  byId("logs").dispatchEvent(new Event("change"));
});
