// What the lines and marks of a figure mean.
"use strict";

/// An entry with its marks.
const legendEntry = (words, ...marks) => html("li", {}, draw("svg", { width: 34, height: 14, "aria-hidden": "true" }, ...marks),
  typeof words === "string" ? gloss(words) : words);
const legendLine = (name) => draw("line", { x1: 1, y1: 7, x2: 33, y2: 7, class: name });

/// The entries of the figures of a model: the measured points, what else is drawn, and the effects, each of them once.
function legendEntries(shares, measured, ...others) {
  const effects = new Map(shares.map((share) => [effectLine(share), share]));
  return [
    legendEntry(measured.endsWith("± standard error") ? html("span", {}, measured.replace("standard error", ""), gloss("standard error")) : measured, draw("line", { x1: 17, y1: 0, x2: 17, y2: 14, class: "bar" }), draw("circle", { cx: 17, cy: 7, r: 3.5, class: "dot" })),
    legendEntry("model", legendLine("line model")), ...others,
    ...[...effects.values()].map((share) => legendEntry(gloss(plain(share.effect), effectName(share)), legendLine(effectLine(share)))),
    legendEntry("within ± 2 standard errors", draw("rect", { x: 1, y: 1, width: 32, height: 12, class: "band" })),
  ];
}
