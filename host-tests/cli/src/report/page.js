// The page of a report: the pictures beside the findings, the axes, the units, the address and the printing.
"use strict";

// The axes.

let inSight = null;
let keeping = 0;
const walks = [...document.querySelectorAll(".walk")].map((root) => new Walk(root, Number(root.dataset.axis), (walk) => keepAddress(walk.index)));

/// Writes what is seen into the address, once the changes rest: browsers refuse to do so at every move.
function keepAddress(axis) {
  inSight = axis;
  clearTimeout(keeping);
  keeping = setTimeout(() => {
    const address = addressOf({ unit: unitIndex, inSight, walks });
    history.replaceState(null, "", address || location.pathname + location.search);
  }, 120);
}

/// Shows what an address says. An address without a state, such as that of an axis, changes nothing.
function takeAddress() {
  if (!location.hash.includes("=")) return;
  const state = stateOfAddress(location.hash, walks.length);
  showUnit(state.unit);
  walks.forEach((walk) => walk.adopt(state.walks[walk.index]));
  inSight = state.inSight;
  if (inSight !== null) byId(`axis-${inSight}`).scrollIntoView();
}

// The units.

const units = byId("units");
units.hidden = false;

function showUnit(unit) {
  unitIndex = unit;
  units.querySelector(`[value="${unit}"]`).checked = true;
  walks.forEach((walk) => walk.update());
  drawSummary();
}

units.addEventListener("change", (event) => {
  showUnit(Number(event.target.value));
  keepAddress(inSight);
});

// The findings: beside each of them is the figure in which the five terms fail most, with the place marked.

function drawSummary() {
  for (const place of document.querySelectorAll(".summary .picture")) {
    const walk = walks[Number(place.dataset.axis)];
    const width = Math.round(place.clientWidth);
    if (!walk || width < 100) continue;
    const first = walk.axis.steps[0];
    // A narrow page has the figure in which the error is largest alone.
    const both = walk.axis.frames.map((_, at) => at);
    const shown = width < 560 ? [first.front] : both;
    const each = Math.floor((width - 12 * (shown.length - 1)) / shown.length);
    place.replaceChildren(...shown.map((at) => {
      const frame = walk.axis.frames[at];
      return drawFigure(frame, walk.scene(first, at), walk.unit(frame), each, { brief: 150 }).svg;
    }));
  }
}

for (const link of document.querySelectorAll(".summary a")) {
  link.addEventListener("click", (event) => {
    event.preventDefault();
    const axis = Number(link.dataset.axis);
    byId(`axis-${axis}`).scrollIntoView();
    walks[axis].tabs[walks[axis].step].focus({ preventScroll: true });
    keepAddress(axis);
  });
}
new ResizeObserver(drawSummary).observe(document.querySelector(".summary"));

// Paper.

const papers = walks.map((walk) => new Paper(walk));
const print = () => papers.forEach((paper) => paper.fill());
window.addEventListener("beforeprint", print);
window.matchMedia("print").addEventListener("change", ({ matches }) => matches && print());

drawSummary();
takeAddress();
window.addEventListener("hashchange", takeAddress);
