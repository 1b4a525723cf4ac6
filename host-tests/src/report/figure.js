// Draws a model beside a record: the Allan deviation over the averaging time, and below it the residual
// over the same times. The data contain the spans and the ticks.
"use strict";

const SVG = "http://www.w3.org/2000/svg";

/// An element of a drawing, or of the page, with attributes and children; text is never markup.
function make(namespace, name, attributes, children) {
  const element = namespace ? document.createElementNS(namespace, name) : document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (value !== null && value !== false) element.setAttribute(key, value === true ? "" : value);
  }
  element.append(...children.filter((child) => child !== null));
  return element;
}

const draw = (name, attributes, ...children) => make(SVG, name, attributes, children);

/// The layout of a drawing of this width: the positions and sizes of its panels, and the size of its text.
function layout(width) {
  const narrow = width < 560;
  const left = narrow ? 62 : 84;
  const curve = { top: 10, height: narrow ? 260 : 340 };
  const residual = { top: curve.top + curve.height + 18, height: narrow ? 120 : 150 };
  return { left, right: width - 8, inset: narrow ? 8 : 14, curve, residual,
    height: residual.top + residual.height + 48, size: narrow ? 11.5 : 12.5 };
}

/// The part of a line that lies between the heights 0 and 1, or nothing.
function inside([x0, y0], [x1, y1]) {
  if (!Number.isFinite(y0) || !Number.isFinite(y1)) return null;
  if (Math.max(y0, y1) < 0 || Math.min(y0, y1) > 1) return null;
  const at = (x, y) => {
    const up = Math.min(1, Math.max(0, y));
    return [up === y ? x : x0 + ((up - y0) / (y1 - y0)) * (x1 - x0), up];
  };
  return [at(x0, y0), at(x1, y1)];
}

/// Draws a view of an axis. `unit` is one of the axis' units, and `width` is in pixels. The octave with the
/// largest residual is marked if that exceeds two standard errors.
function drawFigure(axis, view, unit, width) {
  const { left, right, inset, curve, residual, height, size } = layout(width);
  const { figure } = view;
  const log = (value, [low, high]) => Math.log(value / low) / Math.log(high / low);
  const x = (across) => left + inset + across * (right - left - 2 * inset);
  const across = figure.tau_s.map((tau) => log(tau, axis.tau_s));
  const up = (sigma) => log(sigma, axis.sigma);
  const y = (panel, share) => panel.top + (1 - share) * panel.height;
  const zUp = (z) => 0.5 * (z / view.z + 1);
  const bottom = residual.top + residual.height;

  const svg = draw("svg", { class: "figure", viewBox: `0 0 ${width} ${height}`, role: "img",
    "font-size": size, "aria-label": `Allan deviation and residual, ${view.model}: ${view.words}` });
  const line = (x1, y1, x2, y2, name) => svg.append(draw("line", { x1, y1, x2, y2, class: name }));
  const text = (at, attributes, words) =>
    svg.append(draw("text", { x: at[0], y: at[1], ...attributes }, words));

  const [low, high] = [zUp(-2), zUp(2)].map((share) => y(residual, share));
  svg.append(draw("rect", { x: left, y: high, width: right - left, height: low - high, class: "band" }));
  let free = 0;
  for (const [tau, label] of axis.times) {
    const place = x(log(tau, axis.tau_s));
    for (const panel of [curve, residual]) {
      line(place, panel.top, place, panel.top + panel.height, "rule");
    }
    const half = 0.3 * size * label.length;
    if (place - half < free || place + half > width) continue;
    free = place + half + size;
    line(place, bottom, place, bottom + 5, "tick");
    text([place, bottom + 19], { "text-anchor": "middle", class: "pale" }, label);
  }
  const level = (panel, share, label) => {
    const place = y(panel, share);
    line(left, place, right, place, "rule");
    line(left - 5, place, left, place, "tick");
    text([left - 9, place + 4], { "text-anchor": "end", class: "pale" }, label);
  };
  for (const [sigma, label] of unit.ticks) level(curve, up(sigma / unit.factor), label);
  for (const [z, label] of view.residuals) level(residual, zUp(z), label);
  line(left, y(residual, 0.5), right, y(residual, 0.5), "zero");
  for (const { top, height: tall } of [curve, residual]) {
    svg.append(draw("rect", { x: left, y: top, width: right - left, height: tall, class: "frame" }));
  }
  const upright = (panel, words) => {
    const middle = panel.top + panel.height / 2;
    text([0, 0], { transform: `translate(${size} ${middle}) rotate(-90)`, "text-anchor": "middle" }, words);
  };
  upright(curve, `Allan deviation σ, ${unit.name}`);
  upright(residual, "residual, std. errors");
  text([(left + right) / 2, bottom + 41], { "text-anchor": "middle" }, "averaging time τ");

  const path = (sigma, name) => {
    let data = "";
    for (let k = 1; k < sigma.length; k += 1) {
      const part = inside([across[k - 1], up(sigma[k - 1])], [across[k], up(sigma[k])]);
      if (!part) continue;
      const [from, to] = part.map(([a, b]) => `${x(a).toFixed(2)} ${y(curve, b).toFixed(2)}`);
      data += `M${from}L${to}`;
    }
    svg.append(draw("path", { d: data, class: name }));
  };
  for (const share of figure.shares) path(share.sigma, `line effect-${share.colour}`);
  path(figure.model, "line model");

  const clamp = (share) => Math.min(1, Math.max(0, share));
  const stem = (panel, k, from, to) =>
    line(x(across[k]), y(panel, clamp(from)), x(across[k]), y(panel, clamp(to)), "bar");
  const dot = (panel, k, share, name) => svg.append(
    draw("circle", { cx: x(across[k]), cy: y(panel, share), r: name === "worst" ? 8 : 3.5, class: name }));
  figure.measured.forEach((sigma, k) => {
    stem(curve, k, up(figure.lower[k]), up(figure.upper[k]));
    dot(curve, k, up(sigma), "dot");
    stem(residual, k, 0.5, zUp(figure.z[k]));
    dot(residual, k, zUp(figure.z[k]), "dot");
  });
  const z = figure.z[view.worst];
  if (Math.abs(z) > 2) {
    const k = view.worst;
    dot(curve, k, up(figure.measured[k]), "worst");
    dot(residual, k, zUp(z), "worst");
    // The label is on the side of the ring that has more room.
    const begin = across[k] < 0.6;
    const place = [x(across[k]) + (begin ? 13 : -13), y(residual, zUp(z)) + 4];
    text(place, { "text-anchor": begin ? "start" : "end", class: "worst-label" },
      `worst: ${z > 0 ? "+" : "−"}${Math.abs(z).toFixed(0)} std. errors`);
  }
  return svg;
}
