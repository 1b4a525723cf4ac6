// χ² as bars and as stairs, on a logarithmic scale with labelled decades, so that a factor of 1000 is seen as one.
"use strict";

/// A power of ten as a label.
const decadeLabel = (decade) => (decade < 4 ? `${10 ** decade}` : `10${`${decade}`.replace(/\d/g, (digit) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[digit])}`);

/// The number of decades from 1 that all of these values of χ² need.
function decadesOf(fits) {
  const values = fits.flatMap(({ chi2, dof }) => [chi2 ?? 1, 2 * dof]);
  return Math.max(1, Math.ceil(Math.log10(Math.max(...values, 1)) - 1e-9));
}

/// What falls from step to step of a diagnosis: χ², with what a later step subtracts.
const errorsOf = (steps) => steps.map(({ error, dof }) => ({ chi2: error, dof }));

/// The decades that are labelled: all of them, or every second one, third one, ….
const labelledDecades = (decades) => Array.from({ length: decades + 1 }, (_, decade) => decade).filter((decade) => decade % Math.ceil(decades / 6) === 0);

/// Bars of χ² with one scale, and its axis. Positions are attributes of a drawing, which every policy allows.
function logarithmicBars(fits) {
  const decades = decadesOf(fits);
  const along = (value) => 100 * Math.min(1, Math.max(0.01, Math.log10(Math.max(1, value)) / decades));
  const rules = Array.from({ length: Math.max(0, decades - 1) }, (_, decade) => (100 * (decade + 1)) / decades);
  return {
    bar: (chi2, dof) => draw("svg", { class: "track", width: "100%", height: 14, "aria-hidden": "true" },
      draw("rect", { x: 0, y: 2, width: "100%", height: 10, rx: 3, class: "back" }),
      draw("rect", { x: 0, y: 2, width: `${along(chi2 ?? 1)}%`, height: 10, rx: 3, class: "fill" }),
      ...rules.map((x) => draw("line", { x1: `${x}%`, y1: 2, x2: `${x}%`, y2: 12, class: "decade" })),
      dof > 0 ? draw("rect", { x: `${along(dof)}%`, y: 0, width: 3, height: 14, class: "dof" }) : null),
    axis: () => draw("svg", { class: "decades", width: "100%", height: 18, role: "img", "aria-label": `The bars reach from 1 to ${10 ** decades}` },
      ...labelledDecades(decades).map((decade) => draw("text", { x: `${(100 * decade) / decades}%`, y: 13,
        "text-anchor": decade === 0 ? "start" : decade === decades ? "end" : "middle" }, decadeLabel(decade)))),
  };
}

/// By how much χ² changed, as a factor.
function fallInWords(before, now) {
  if (!(before > 0) || !(now > 0)) return "";
  const factor = Math.max(before / now, now / before);
  if (factor < 1.005) return "as before";
  const words = factor < 10 ? factor.toFixed(2) : factor < 100 ? factor.toFixed(1) : Math.round(factor).toLocaleString("en").replaceAll(",", " ");
  return now < before ? `÷ ${words}` : `× ${words}`;
}

/// Draws χ² from one model to the next as stairs, which fall where a change explains more. The last one is the model that
/// is shown.
function drawStairs(fits, width) {
  const decades = decadesOf(fits);
  const height = 120;
  const [left, right, top, bottom] = [44, width - 8, 12, height - 26];
  const y = (value) => bottom - (bottom - top) * Math.min(1, Math.max(0, Math.log10(Math.max(1, value)) / decades));
  const tread = (right - left) / fits.length;
  const last = fits[fits.length - 1];
  const words = fits.map(({ chi2 }) => tenth(chi2)).join(", then ");
  const svg = draw("svg", { class: "figure stairs", viewBox: `0 0 ${width} ${height}`, role: "img", "font-size": 11.5,
    "aria-label": `χ² of the models so far: ${words}; degrees of freedom: ${last.dof}` });
  for (const decade of labelledDecades(decades)) {
    const at = y(10 ** decade);
    svg.append(draw("line", { x1: left, y1: at, x2: right, y2: at, class: "rule" }),
      draw("text", { x: left - 6, y: at + 4, "text-anchor": "end", class: "pale" }, decadeLabel(decade)));
  }
  svg.append(draw("line", { x1: left, y1: y(last.dof), x2: right, y2: y(last.dof), class: "dof-line" }));
  const path = fits.map(({ chi2 }, k) => `${k === 0 ? "M" : "L"}${(left + k * tread).toFixed(1)} ${y(chi2 ?? 1).toFixed(1)}H${(left + (k + 1) * tread).toFixed(1)}`);
  svg.append(draw("path", { d: path.join(""), class: "stair" }));
  const end = left + (fits.length - 0.5) * tread;
  svg.append(draw("circle", { cx: end, cy: y(last.chi2 ?? 1), r: 4, class: "stair-now" }));
  const label = `χ² ${tenth(last.chi2)} ${fits.length > 1 ? fallInWords(fits[0].chi2, last.chi2) : ""}`.trim();
  const at = y(last.chi2 ?? 1);
  svg.append(draw("text", { x: right, y: at + 18 < bottom ? at + 18 : at - 7, "text-anchor": "end", class: "stair-label" }, label));
  svg.append(draw("text", { x: left, y: height - 6, class: "pale" }, `models: ${fits.length}`),
    draw("text", { x: right, y: height - 6, "text-anchor": "end", class: "pale" }, `dashed: ${last.dof} degrees of freedom`));
  return svg;
}
