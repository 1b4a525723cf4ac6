// The points of a figure as a table, and as a file for spreadsheets.
"use strict";

/// A field of a table in text. A spreadsheet takes text that begins with one of these signs for a formula, which an apostrophe
/// prevents; a number stays a number.
function csvField(value) {
  if (typeof value === "number") return Number.isFinite(value) ? `${value}` : "";
  const isNumber = /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i.test(value);
  const safe = /^\s*[=+\-@\t\r]/.test(value) && !isNumber ? `'${value}` : value;
  return /[",;\r\n]/.test(safe) ? `"${safe.replaceAll('"', '""')}"` : safe;
}

/// Rows as text (RFC 4180).
const csvText = (rows) => rows.map((row) => `${row.map(csvField).join(",")}\r\n`).join("");

/// Lets the browser keep a text as a file.
function keep(text, file, type) {
  const link = html("a", { href: URL.createObjectURL(new Blob([text], { type })), download: file });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

/// A name of a file from any words.
const fileNameOf = (words) => words.replace(/[^\p{L}\p{N}_.-]+/gu, "-").replace(/^[.-]+|[.-]+$/g, "") || "axis";

/// The table of a figure, closed at first. Its rows are made when it is opened.
class PointTable {
  constructor(axis) {
    Object.assign(this, { axis, shown: null });
    this.name = html("span", {});
    this.rows = html("div", { class: "rows", tabindex: 0, role: "region" });
    this.save = html("button", { type: "button", class: "tool" }, "Download as CSV");
    this.save.addEventListener("click", () => this.download());
    this.root = html("details", { class: "points" }, html("summary", {}, this.name), this.save, this.rows);
    this.root.addEventListener("toggle", () => this.fill());
  }

  set(frame, scene, unit) {
    this.shown = { frame, scene, unit };
    const { length } = scene.records[0].points.x;
    const words = `Table: ${length} ${{ octave: "octaves", bin: "bins" }[frame.point]} of the ${frame.name}`;
    this.name.textContent = words;
    this.rows.setAttribute("aria-label", words);
    this.save.setAttribute("aria-label", `Download the ${frame.name} as CSV`);
    this.fill();
  }

  /// The points of every record in the unit that is shown.
  points() {
    const { scene, unit } = this.shown;
    return scene.records.flatMap(({ name, points, expected, z }) => points.x.map((x, k) => {
      const values = [points.measured[k], points.lower[k], points.upper[k], expected[k]];
      return { name, x, values: values.map((value) => Number((unit.factor * value).toPrecision(6))), z: z[k] };
    }));
  }

  fill() {
    if (!this.root.open || !this.shown) return;
    const { frame, unit, scene } = this.shown;
    const several = scene.records.length > 1;
    const head = [...(several ? ["record"] : []), `${frame.coordinate[0]}, ${frame.coordinate[1]}`, `${frame.up}, ${unit.name}`, "± standard error", "model", "residual"];
    const worst = scene.records[0].points.x[worstOf(scene.records[0])];
    const row = ({ name, x, values: [measured, lower, upper, expected], z }) => html("tr", { class: x === worst && Math.abs(z) > 2 ? "failing" : null },
      several ? html("th", { scope: "row" }, name) : null,
      ...[number(x), number(measured), `${number(lower)} … ${number(upper)}`, number(expected), `${z < 0 ? "−" : "+"}${Math.abs(z).toFixed(1)} σ`]
        .map((words) => html("td", { class: "number" }, words)));
    this.rows.replaceChildren(html("table", {},
      html("thead", {}, html("tr", {}, ...head.map((words, at) => html("th", { scope: "col", class: several && at === 0 ? null : "number" }, words)))),
      html("tbody", {}, ...this.points().map(row))));
  }

  /// The table as text.
  text() {
    const { frame, scene, unit } = this.shown;
    const head = ["record", "model", { octave: "tau_s", bin: "frequency_hz" }[frame.point], "unit", "measured", "lower", "upper", "expected", "residual_sigma"];
    const row = ({ name, x, values, z }) => [name, scene.model_name, x, unit.name, ...values, z];
    return csvText([head, ...this.points().map(row)]);
  }

  download() {
    const { frame } = this.shown;
    keep(this.text(), `${fileNameOf(this.axis())}-${{ octave: "octaves", bin: "bins" }[frame.point]}.csv`, "text/csv");
  }
}
