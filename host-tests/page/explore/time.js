// The record over time, and the parts of the log that are left out.
"use strict";

/// The part that is chosen, in seconds from the first sample that is shown; `null` if there is none.
let chosen = null;
let drawnTime = null;

function drawTime() {
  const { course } = data.records[state.record];
  byId("time").hidden = !course;
  const width = Math.round(byId("course").clientWidth);
  if (!course || width < 100) return;
  const key = JSON.stringify([sessions, state.record, width]);
  if (drawnTime?.key !== key) {
    const sheet = drawCourse(course, width);
    sheet.svg.classList.add("cuts");
    drawnTime = { key, sheet, course };
    byId("course").replaceChildren(sheet.svg);
    byId("spectrogram").replaceChildren(...spectrogramOf(data.records[state.record], width));
  }
  showChosen();
}

/// The levels of a cell, from the lowest.
const LEVELS = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
/// Colours from dark to bright whose lightness rises evenly, so that they are told apart without seeing hues.
const SHADES = [[24, 15, 61], [68, 15, 118], [114, 31, 129], [158, 47, 127], [205, 64, 113], [241, 96, 93], [253, 149, 103], [254, 201, 141], [252, 253, 191]];

function shadeOf(level) {
  const at = (level / (LEVELS.length - 1)) * (SHADES.length - 1);
  const below = Math.min(SHADES.length - 2, Math.floor(at));
  return SHADES[below].map((from, part) => Math.round(from + (at - below) * (SHADES[below + 1][part] - from)));
}

/// The picture of the cells, one pixel each, and a bar of the shades.
function cellsAsPicture({ cells, rows }) {
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [cells.length / rows, rows];
  const context = canvas.getContext("2d");
  const picture = context.createImageData(canvas.width, canvas.height);
  for (let cell = 0; cell < cells.length; cell += 1) {
    const level = LEVELS.indexOf(cells[cell]);
    const at = 4 * ((rows - 1 - (cell % rows)) * canvas.width + Math.floor(cell / rows));
    if (level >= 0) picture.data.set([...shadeOf(level), 255], at);
  }
  context.putImageData(picture, 0, 0);
  return canvas.toDataURL();
}

/// The spectrogram below the course, over the same times.
function spectrogramOf({ spectrogram, course, unit }, width) {
  if (!spectrogram) return [];
  const { cells, rows, column_s: columnTime, row_hz: rowWidth, low, high } = spectrogram;
  const [columns, top] = [cells.length / rows, rows * rowWidth];
  const sheet = new Sheet("spectrogram", `Spectrogram: density over time, up to ${number(top)} Hz`, width, 290);
  const panel = { top: 10, height: 230 };
  const [begin, end] = course.span;
  const along = (time_s) => (time_s - begin) / (end - begin);
  sheet.ticks([panel], course.times.map(([at, label]) => [along(at), label]), course.across);
  const [left, right] = [sheet.x(0), sheet.x(along(begin + columns * columnTime))];
  sheet.add("image", { href: cellsAsPicture(spectrogram), x: left, y: sheet.y(panel, 1), width: right - left, height: sheet.y(panel, 0) - sheet.y(panel, 1), preserveAspectRatio: "none" });
  sheet.frame(panel, linearTicks([0, top]).map((value) => [value / top, plainNumber(value)]), "frequency, Hz");
  const words = `Spectrogram: from ${number(low)} (dark) to ${number(high)} ${unit}/√Hz (bright), on a logarithmic scale; a column is ${number(columnTime)} s and a row ${number(rowWidth)} Hz. A line that drifts, or a motor that runs for a while, is seen here.`;
  return [sheet.svg, html("p", { class: "hint" }, words)];
}

/// Marks the chosen part in the figure and in the fields.
function showChosen() {
  const { sheet, course } = drawnTime;
  sheet.svg.querySelector(".chosen")?.remove();
  for (const id of ["cut-keep", "cut-drop"]) byId(id).disabled = chosen === null;
  byId("cut-none").hidden = cutOptions().length === 0;
  if (chosen === null) return;
  const [from, to] = chosen.map((time_s) => sheet.x(clamp((time_s - course.span[0]) / (course.span[1] - course.span[0]))));
  sheet.add("rect", { x: from, y: 10, width: Math.max(1, to - from), height: sheet.height - 58, class: "chosen" });
}

function choose(ends, isDragged) {
  const [low, high] = drawnTime.course.span;
  const [from, to] = ends.map((time_s) => Math.min(high, Math.max(low, time_s))).sort((one, other) => one - other);
  chosen = Number.isFinite(from) && to > from ? [from, to] : null;
  // A time to the hundredth of what is seen of it.
  const shown = (time_s) => Number(time_s.toPrecision(6));
  if (isDragged && chosen) [byId("cut-from").value, byId("cut-to").value] = chosen.map(shown);
  showChosen();
}

let dragged = null;
const timeOf = (event) => {
  const { sheet, course } = drawnTime;
  const box = sheet.svg.getBoundingClientRect();
  const x = ((event.clientX - box.left) * sheet.width) / box.width;
  return course.span[0] + ((x - sheet.x(0)) / (sheet.x(1) - sheet.x(0))) * (course.span[1] - course.span[0]);
};
byId("course").addEventListener("pointerdown", (event) => {
  if (event.button !== 0 || !drawnTime) return;
  byId("course").setPointerCapture(event.pointerId);
  dragged = timeOf(event);
});
byId("course").addEventListener("pointermove", (event) => {
  if (dragged !== null) choose([dragged, timeOf(event)], true);
});
for (const name of ["pointerup", "pointercancel"]) {
  byId("course").addEventListener(name, () => { dragged = null; });
}
for (const id of ["cut-from", "cut-to"]) {
  byId(id).addEventListener("input", () => {
    const ends = ["cut-from", "cut-to"].map((one) => (byId(one).value === "" ? NaN : Number(byId(one).value)));
    if (drawnTime) choose(ends, false);
  });
}

/// The options that leave parts out, among those of the command line.
const cutOptions = () => [...byId("options").value.matchAll(/--(?:from|to|drop)[ =]\S+/g)].map(([option]) => option);

/// The time of the log's first row before the first sample that is shown: what an earlier cut left out.
function beginOfCuts() {
  const [, from] = /--from[ =]([\d.]+)s/.exec(cutOptions().join(" ")) ?? [];
  return from === undefined ? 0 : Number(from);
}

byId("cut").addEventListener("submit", (event) => {
  event.preventDefault();
  if (chosen === null) return;
  const begin = beginOfCuts();
  const [from, to] = chosen.map((time_s) => `${Number((begin + time_s).toPrecision(9))}s`);
  const isKept = event.submitter?.value === "keep";
  const earlier = isKept ? cutOptions().filter((option) => option.startsWith("--drop")) : cutOptions();
  recut([...earlier, ...(isKept ? [`--from ${from}`, `--to ${to}`] : [`--drop ${from}..${to}`])]);
});
byId("cut-none").addEventListener("click", () => recut([]));

/// Reads the log again with these cuts, or says the command that does where the page does not have the log.
function recut(cuts) {
  const without = byId("options").value.replaceAll(/\s*--(?:from|to|drop)[ =]\S+/g, "").trim();
  const options = [without, ...cuts].filter((one) => one).join(" ");
  if (byId("logs").files.length === 0) {
    const { input } = data.records[state.record];
    byId("cut-said").textContent = `This page has no log. Drop it above to cut it here; on the command line: allanite explore ${input} ${options}`;
    return;
  }
  byId("options").value = options;
  byId("command").value = "explore";
  chosen = null;
  byId("cut").reset();
  byId("cut-said").textContent = cuts.length > 0 ? `Cut: ${cuts.join(" ")}` : "The whole log.";
  go();
}
