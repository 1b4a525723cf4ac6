// Files that are dropped on the page, the command that is run on them, and what it printed and wrote.
"use strict";

/// The worker that reads logs.
const reading = new Runner();

/// The words of a line, in which quotation marks keep blanks together.
function wordsOf(line) {
  const found = line.match(/"[^"]*"|'[^']*'|[^\s"']+/g) ?? [];
  return found.map((word) => word.replace(/^(["'])(.*)\1$/, "$2"));
}

function showText(id, text) {
  byId(id).textContent = text;
  byId(id).hidden = text === "";
}

async function go() {
  const chosen = Array.from(byId("logs").files);
  if (chosen.length === 0) return;
  const files = chosen.map((file) => [file.name, file]);
  const names = files.map(([name]) => name);
  const command = byId("command").value;
  const options = wordsOf(byId("options").value);
  const forms = {
    explore: ["--session"],
    report: ["--output", "report.html"],
    export: options.includes("--format") ? [] : ["--format", "json"],
  };
  // A page and an export are of one file; the others take all.
  const inputs = ["report", "export"].includes(command) ? names.slice(0, 1) : names;
  const args = ["allanite", command, ...inputs, ...options, ...(forms[command] ?? [])];
  const line = args.filter((word) => word !== "--session");
  byId("line").textContent = line.map((word) => (/^[\w.,:=/+-]+$/.test(word) ? word : `"${word}"`)).join(" ");
  for (const id of ["output", "errors", "files", "report"]) byId(id).hidden = true;
  byId("progress").hidden = false;
  byId("progress").removeAttribute("value");
  byId("status").textContent = `reading ${inputs.join(", ")} …`;
  const begun = performance.now();
  // A later command ends an earlier one.
  reading.end();
  const done = await reading.run(args, files, (share) => { byId("progress").value = share; });
  const seconds = ((performance.now() - begun) / 1000).toFixed(1);
  byId("progress").hidden = true;
  byId("status").textContent = done.status === 0 ? `done in ${seconds} s` : `ended with status ${done.status}, after ${seconds} s`;
  showText("errors", done.errors);
  if (command === "explore" && done.status === 0) {
    byId("take").open = false;
    openSession(done.output);
    return;
  }
  byId("explore").hidden = true;
  document.body.classList.remove("exploring");
  // What a report prints is sentences; the others print tables.
  byId("output").classList.toggle("words", command === "report");
  showText("output", done.output);
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
  // A model in the address is that of an earlier log, and so are its cuts.
  history.replaceState(null, "", location.pathname + location.search);
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

// A page that `explore` wrote has its records already.
if (byId("session").textContent !== "") {
  byId("take").open = false;
  openSession(byId("session").textContent);
}
