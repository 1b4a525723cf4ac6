// What the address keeps behind `#`: the axis, the step that is shown of it, the units, and the part of each figure that is seen.
//
// A part after `axis=` is about that axis, and a part before the first of them about all. The last axis is the one in sight:
// `#unit=1&axis=2&step=1&spectrum=18.5~21&spectrum.across=linear`.
"use strict";

const FIGURES = ["deviation", "spectrum"];

/// What is seen of the figures, as parts of an address: what differs from the first view.
function viewParts(views) {
  const parts = [];
  for (const [name, { x, linearAcross, linearUp }] of Object.entries(views)) {
    if (x) parts.push(`${name}=${x.map((end) => Number(end.toPrecision(5))).join("~")}`);
    if (linearAcross) parts.push(`${name}.across=linear`);
    if (linearUp) parts.push(`${name}.up=linear`);
  }
  return parts;
}

/// Takes what a part of an address says about the views, if it is about one of them.
function takeViewPart(views, key, value) {
  const [figure, scale] = key.split(".");
  if (!FIGURES.includes(figure)) return;
  const ends = value.split("~").map(Number);
  if (scale === "across" && value === "linear") views[figure].linearAcross = true;
  if (scale === "up" && value === "linear") views[figure].linearUp = true;
  if (scale === undefined && ends.length === 2 && ends[0] > 0 && ends[1] > ends[0] && Number.isFinite(ends[1])) views[figure].x = ends;
}

const freshViews = () => Object.fromEntries(FIGURES.map((name) => [name, wholeView()]));

/// The text of a state: the number of the unit, the axis in sight, and the walks with what differs from the first view.
function addressOf({ unit, inSight, walks }) {
  const parts = unit > 0 ? [`unit=${unit}`] : [];
  const others = walks.filter(({ index }) => index !== inSight);
  for (const walk of [...others, ...walks.filter(({ index }) => index === inSight)]) {
    const own = [...(walk.step > 0 ? [`step=${walk.step}`] : []), ...viewParts(walk.views)];
    if (own.length > 0 || walk.index === inSight) parts.push(`axis=${walk.index}`, ...own);
  }
  return parts.length > 0 ? `#${parts.join("&")}` : "";
}

/// The state of an address with so many axes. What it does not understand is left out.
function stateOfAddress(hash, axes) {
  const fresh = () => ({ step: 0, views: freshViews() });
  const state = { unit: 0, inSight: null, walks: Array.from({ length: axes }, fresh) };
  let about = state.walks;
  for (const part of hash.replace(/^#/, "").split("&")) {
    const [, key, value] = /^([a-z.]+)=(.*)$/.exec(part) ?? [];
    if (/^(axis|step|unit)$/.test(key) && !/^\d{1,4}$/.test(value)) continue;
    if (key === "unit") state.unit = Math.min(1, Number(value));
    if (key === "step") about.forEach((walk) => { walk.step = Number(value); });
    if (key === "axis" && Number(value) < axes) {
      state.inSight = Number(value);
      about = [state.walks[state.inSight]];
    }
    for (const { views } of about) takeViewPart(views, key ?? "", value);
  }
  return state;
}
