// Draws a model beside a record: a curve, and below it the residual over the same axis. The data contain the
// spans, the ticks and the positions of the residuals.
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
const clamp = (share) => Math.min(1, Math.max(0, Number.isNaN(share) ? 0 : share));

/// A drawing of some width, with panels whose positions are shares of their width and height. The margins inside the
/// frame are larger than a mark, so that none reaches over it.
class Sheet {
  constructor(name, label, width, height) {
    const narrow = width < 560;
    Object.assign(this, { width, height, narrow, left: narrow ? 62 : 84, right: width - 8, size: narrow ? 11.5 : 12.5 });
    this.svg = draw("svg", { class: `figure ${name}`, viewBox: `0 0 ${width} ${height}`, role: "img",
      "font-size": this.size, "aria-label": label });
  }

  x(across) {
    const inset = this.narrow ? 10 : 14;
    return this.left + inset + across * (this.right - this.left - 2 * inset);
  }

  y(panel, up) {
    return panel.top + 9 + (1 - up) * (panel.height - 18);
  }

  add(name, attributes, ...children) {
    this.svg.append(draw(name, attributes, ...children));
  }

  line(x1, y1, x2, y2, name) {
    this.add("line", { x1, y1, x2, y2, class: name });
  }

  text([x, y], attributes, words) {
    this.add("text", { x, y, ...attributes }, words);
  }

  /// A dot, which shows these words while the pointer is on it.
  dot(panel, across, up, name, words = null) {
    const r = { worst: 8, dot: 3.5, small: 2.3 }[name];
    const tooltip = words === null ? null : draw("title", {}, words);
    this.add("circle", { cx: this.x(across), cy: this.y(panel, clamp(up)), r, class: name === "small" ? "dot" : name }, tooltip);
  }

  /// A vertical line, clipped to the panel.
  stem(panel, across, from, to) {
    const x = this.x(across);
    this.line(x, this.y(panel, clamp(from)), x, this.y(panel, clamp(to)), "bar");
  }

  /// Vertical rules through panels, with the labels for which there is room below the last one.
  ticks(panels, ticks, title) {
    const last = panels[panels.length - 1];
    const bottom = last.top + last.height;
    let free = 0;
    for (const [across, label] of ticks) {
      const place = this.x(across);
      for (const { top, height } of panels) this.line(place, top, place, top + height, "rule");
      const half = 0.3 * this.size * label.length;
      if (place - half < free || place + half > this.width) continue;
      free = place + half + this.size;
      this.line(place, bottom, place, bottom + 5, "tick");
      this.text([place, bottom + 19], { "text-anchor": "middle", class: "pale across" }, label);
    }
    this.text([(this.left + this.right) / 2, bottom + 41], { "text-anchor": "middle" }, title);
  }

  /// The frame of a panel with labelled ticks on its left and an upright title.
  frame(panel, ticks, title) {
    let free = Infinity;
    for (const [up, label] of [...ticks].sort((one, other) => one[0] - other[0])) {
      const place = this.y(panel, up);
      this.line(this.left, place, this.right, place, "rule");
      if (place > free) continue;
      free = place - 1.1 * this.size;
      this.line(this.left - 5, place, this.left, place, "tick");
      this.text([this.left - 9, place + 4], { "text-anchor": "end", class: "pale up" }, label);
    }
    this.add("rect", { x: this.left, y: panel.top, width: this.right - this.left, height: panel.height, class: "frame" });
    const middle = panel.top + panel.height / 2;
    this.text([0, 0], { transform: `translate(${this.size} ${middle}) rotate(-90)`, "text-anchor": "middle" }, title);
  }

  /// A line in pieces, clipped to the panel.
  path(panel, pieces, place, name) {
    let data = "";
    for (const piece of pieces) {
      let end = null;
      for (let k = 1; k < piece.length; k += 1) {
        const part = inside(place(piece[k - 1]), place(piece[k]));
        if (!part) {
          end = null;
          continue;
        }
        const [from, to] = part.map(([a, b]) => `${this.x(a).toFixed(2)} ${this.y(panel, b).toFixed(2)}`);
        data += from === end ? `L${to}` : `M${from}L${to}`;
        end = to;
      }
    }
    this.add("path", { d: data, class: name });
  }
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

/// Draws the empty panels of a figure, the curve and below it the residuals, with these heights. Returns them with the
/// functions that place a value in them.
function drawPanels(frame, unit, title, [curveHeight, residualHeight], width) {
  const curve = { top: 10, height: curveHeight };
  const residual = { top: curve.top + curve.height + 18, height: residualHeight };
  const sheet = new Sheet(frame.quantity, title, width, residual.top + residual.height + 48);
  const log = (value, [low, high]) => Math.log(value / low) / Math.log(high / low);
  const across = (x) => log(x, frame.x);
  const up = (value) => log(value, frame.y);
  const place = ([at, value]) => [across(at), up(value)];

  const [low, high] = frame.band.map((share) => sheet.y(residual, share));
  sheet.add("rect", { x: sheet.left, y: high, width: sheet.right - sheet.left, height: low - high, class: "band" });
  sheet.ticks([curve, residual], frame.ticks.map(([value, label]) => [across(value), label]), frame.across);
  sheet.frame(curve, unit.ticks.map(([value, label]) => [up(value / unit.factor), label]), `${frame.up}, ${unit.name}`);
  sheet.frame(residual, frame.residuals, "residual, std. errors");
  sheet.line(sheet.left, sheet.y(residual, 0.5), sheet.right, sheet.y(residual, 0.5), "zero");
  return { sheet, curve, residual, across, up, place };
}

/// A residual in words: `+5.3 std. errors`.
function standardErrors(z, digits) {
  return `${z < 0 ? "−" : "+"}${Math.abs(z).toFixed(digits)} std. errors`;
}

/// Draws a figure of a view in its frame. `unit` is one of the frame's units, and `width` is in pixels. The point with
/// the largest residual is marked if that exceeds two standard errors.
function drawFigure(frame, view, figure, unit, width) {
  const heights = width < 560 ? [260, 140] : [340, 160];
  const title = `${frame.up} and residual, ${view.model}: ${view.words}`;
  const { sheet, curve, residual, across, up, place } = drawPanels(frame, unit, title, heights, width);
  const { x, measured, lower, upper } = figure.measured ?? frame.measured;
  // More dots than there is room for are smaller.
  const dot = 8 * x.length > sheet.right - sheet.left ? "small" : "dot";
  for (const share of figure.shares) sheet.path(curve, share.line, place, `line effect-${share.colour}`);
  sheet.path(curve, figure.model, place, "line model");
  x.forEach((at, k) => {
    const [value, low, high] = [measured, lower, upper].map((values) => number(unit.factor * values[k]));
    const [name, of] = frame.coordinate;
    const words = `${name}: ${number(at)} ${of}\n${frame.up}: ${value} ${unit.name} (${low} … ${high})\n` +
      `residual: ${standardErrors(figure.z[k], 1)}`;
    sheet.stem(curve, across(at), up(lower[k]), up(upper[k]));
    sheet.dot(curve, across(at), up(measured[k]), dot, words);
    sheet.stem(residual, across(at), 0.5, figure.up[k]);
    sheet.dot(residual, across(at), figure.up[k], dot, words);
  });
  const z = figure.z[figure.worst];
  if (Math.abs(z) > 2) {
    const at = across(x[figure.worst]);
    sheet.dot(curve, at, up(measured[figure.worst]), "worst");
    sheet.dot(residual, at, figure.up[figure.worst], "worst");
    const words = `worst ${frame.point}: ${standardErrors(z, 0)}`;
    // The label is at the edge of the panel that is farther from the ring, where few dots are, and inside the frame.
    const half = 0.31 * sheet.size * words.length;
    const middle = Math.min(sheet.right - half - 4, Math.max(sheet.left + half + 4, sheet.x(at)));
    const edge = figure.up[figure.worst] > 0.6 ? residual.top + residual.height - 7 : residual.top + 15;
    sheet.text([middle, edge], { "text-anchor": "middle", class: "worst-label" }, words);
  }
  return sheet.svg;
}

/// Draws the record over time: the rate, the noise and the recorded columns, with numbered events.
function drawCourse(course, width) {
  const narrow = width < 560;
  const panels = [];
  let top = 24;
  for (const _ of course.strips) {
    const height = panels.length === 0 ? (narrow ? 160 : 200) : (narrow ? 110 : 120);
    panels.push({ top, height });
    top += height + 14;
  }
  const events = course.events.map((event) => event.words).join("; ") || "no events";
  const sheet = new Sheet("rate", `Rate over time: ${events}`, width, top - 14 + 48);
  const linear = (value, [low, high]) => (value - low) / (high - low);
  sheet.ticks(panels, course.times.map(([at, label]) => [linear(at, course.span), label]), course.across);
  course.strips.forEach((strip, number) => {
    const panel = panels[number];
    const up = (value) => linear(value, strip.span);
    sheet.frame(panel, strip.ticks.map(([value, label]) => [up(value), label]), strip.title);
    strip.values.forEach((value, k) => {
      const at = linear(course.at_s[k], course.span);
      if (strip.errors.length > 0) sheet.stem(panel, at, up(value - strip.errors[k]), up(value + strip.errors[k]));
      sheet.dot(panel, at, up(value), "dot");
    });
  });
  let free = 0;
  course.events.forEach((event, number) => {
    const place = sheet.x(linear(event.at_s, course.span));
    sheet.line(place, panels[0].top, place, top - 14, "event");
    // Two events at one time have their numbers beside each other.
    const above = Math.max(place, free);
    free = above + 14;
    sheet.text([above, 17], { "text-anchor": "middle", class: "event-number" }, `${number + 1}`);
  });
  return sheet.svg;
}
