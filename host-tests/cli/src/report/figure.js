// Draws a model beside one record or several: the curve, and below it the residuals over the same axis. The data have the
// spans, the ticks and the positions of the residuals; a part of an axis has its own spans and ticks.
"use strict";

/// A scale: positions from 0 to 1 of the values of a span, logarithmic or linear.
class Scale {
  constructor(span, isLinear) {
    Object.assign(this, { span, isLinear });
  }

  at(value) {
    const [low, high] = this.span;
    return this.isLinear ? (value - low) / (high - low) : Math.log(value / low) / Math.log(high / low);
  }

  value(share) {
    const [low, high] = this.span;
    return this.isLinear ? low + share * (high - low) : low * (high / low) ** share;
  }
}

/// What is seen of a figure: all of its horizontal axis or a part `x`, and whether the axes are linear.
const wholeView = () => ({ x: null, linearAcross: false, linearUp: false });

/// The horizontal scale of a view.
const scaleAcross = (frame, view) => new Scale(view.x ?? frame.x, view.linearAcross);

/// The vertical scale of a view. The heights follow the part that is seen.
function scaleUp(frame, view, scene) {
  if (!view.x) return new Scale(view.linearUp ? [0, frame.y[1]] : frame.y, view.linearUp);
  const [from, to] = view.x;
  const seen = (x) => x >= from && x <= to;
  const values = [];
  for (const { points, expected } of scene.records) {
    points.x.forEach((x, k) => {
      if (seen(x)) values.push(points.measured[k], points.upper[k], expected[k]);
    });
  }
  for (const piece of scene.model) values.push(...piece.filter(([x]) => seen(x)).map(([, value]) => value));
  const positive = values.filter((value) => value > 0);
  if (positive.length === 0) return new Scale(frame.y, view.linearUp);
  const [low, high] = [Math.min(...positive), Math.max(...positive)];
  if (view.linearUp) {
    const margin = 0.08 * (high - low || high);
    return new Scale([Math.max(0, low - margin), high + margin], true);
  }
  const [middle, half] = [Math.sqrt(low * high), Math.max(1.15, 1.05 * Math.sqrt(high / low))];
  return new Scale([middle / half, middle * half], false);
}

/// The labelled ticks of a figure under a view: [value, label], the heights in the unit of the record.
function figureTicks(frame, unit, across, up) {
  const isWhole = (scale, span) => !scale.isLinear && scale.span === span;
  const heights = isWhole(up, frame.y) ? unit.ticks : labelledTicks(up.span.map((end) => unit.factor * end), up.isLinear, false);
  return {
    across: isWhole(across, frame.x) ? frame.ticks : labelledTicks(across.span, across.isLinear, frame.coordinate[1] === "s"),
    up: heights.map(([value, label]) => [value / unit.factor, label]),
  };
}

/// A residual in words: `+5.3 std. errors`.
function standardErrors(z, digits) {
  return `${z < 0 ? "−" : "+"}${Math.abs(z).toFixed(digits)} std. errors`;
}

/// Index of the largest residual of a record.
const worstOf = (record) => record.z.reduce((worst, z, k) => (Math.abs(z) > Math.abs(record.z[worst]) ? k : worst), 0);

/// The line of an effect in CSS.
const effectLine = (share) => `line effect-${share.colour}${share.twin > 0 ? ` twin-${share.twin}` : ""}`;

/// The name of an effect's line. Lines and resonances are told apart by their frequency.
const effectName = (share) => `${plain(share.effect)}${share.frequency_hz === null ? "" : ` at ${number(share.frequency_hz)} Hz`}`;

/// Draws a scene in its frame, and returns the drawing with the places in it. `scene` has a title, the lines of the
/// model, of an earlier one and of the effects, a finer measurement if there is one, and the records, of which the first is the
/// fitted one. `unit` is one of the
/// frame's units, and `width` is in pixels. A brief drawing has the curve alone, of a given height. The point with the
/// largest residual is marked if that exceeds two standard errors.
function drawFigure(frame, scene, unit, width, { view = wholeView(), brief = 0, heights = width < 560 ? [240, 130] : [320, 150] } = {}) {
  const [curveHeight, residualHeight] = brief ? [brief, 0] : heights;
  // The words about the worst point of a brief drawing are above it.
  const curve = { top: brief ? 24 : 10, height: curveHeight };
  const residual = brief ? null : { top: curve.top + curve.height + 18, height: residualHeight };
  const panels = residual ? [curve, residual] : [curve];
  const last = panels[panels.length - 1];
  const sheet = new Sheet(frame.quantity, scene.title, width, last.top + last.height + 48);
  const [across, up] = [scaleAcross(frame, view), scaleUp(frame, view, scene)];
  const place = ([x, value]) => [across.at(x), up.at(value)];
  const ticks = figureTicks(frame, unit, across, up);
  if (residual) {
    const [low, high] = frame.band.map((share) => sheet.y(residual, share));
    sheet.add("rect", { x: sheet.left, y: high, width: sheet.right - sheet.left, height: low - high, class: "band" });
  }
  sheet.ticks(panels, ticks.across.map(([value, label]) => [across.at(value), label]), frame.across);
  sheet.frame(curve, ticks.up.map(([value, label]) => [up.at(value), label]), `${frame.up}, ${unit.name}`);
  if (residual) {
    sheet.frame(residual, frame.residuals, "residual, std. errors");
    sheet.line(sheet.left, sheet.y(residual, 0.5), sheet.right, sheet.y(residual, 0.5), "zero");
  }
  // A straight line between logarithms is curved on a linear scale.
  const bent = view.linearAcross || view.linearUp ? (pieces) => pieces.map(refined) : (pieces) => pieces;
  if (scene.fine) sheet.path(curve, [scene.fine], place, "line fine");
  for (const share of scene.shares) sheet.path(curve, bent(share.line), place, effectLine(share));
  if (scene.before) sheet.path(curve, bent(scene.before), place, "line before");
  sheet.path(curve, bent(scene.model), place, "line model");
  const positions = { sheet, curve, residual, across, up };
  // The fitted record comes last, so that it lies on top.
  for (const record of [...scene.records].reverse()) drawRecord(positions, record);
  markWorst(positions, frame, scene.records[0]);
  return { svg: sheet.svg, ...positions };
}

/// A line with points in between, which are on the straight lines between the logarithms.
function refined(piece) {
  const parts = 12;
  return piece.flatMap(([x, value], k) => {
    const next = piece[k + 1];
    if (!next) return [[x, value]];
    return Array.from({ length: parts }, (_, part) => [x * (next[0] / x) ** (part / parts), value * (next[1] / value) ** (part / parts)]);
  });
}

/// Draws the dots of a record with their bars. The fitted record has filled dots, the others have rings.
function drawRecord({ sheet, curve, residual, across, up }, { points, up: heights, colour }) {
  const { x, measured, lower, upper } = points;
  const shown = x.map((value) => across.at(value)).map((at) => at > -0.001 && at < 1.001);
  // More dots than there is room for are smaller.
  const small = 8 * shown.filter((one) => one).length > sheet.right - sheet.left;
  const mark = (panel, at, height) => {
    if (colour === 0) return sheet.dot(panel, at, height, small ? "small" : "dot");
    return sheet.add("circle", { cx: sheet.x(at), cy: sheet.y(panel, clamp(height)), r: small ? 2.2 : 3.6, class: `other record-${colour}` });
  };
  x.forEach((value, k) => {
    if (!shown[k]) return;
    const at = across.at(value);
    sheet.stem(curve, at, up.at(lower[k]), up.at(upper[k]), colour === 0 ? "bar" : `other-bar record-${colour}`);
    mark(curve, at, up.at(measured[k]));
    if (!residual) return;
    if (colour === 0) sheet.stem(residual, at, 0.5, heights[k], "bar");
    mark(residual, at, heights[k]);
  });
}

/// Marks the largest residual of a record with rings and in words, if it exceeds two standard errors.
function markWorst({ sheet, curve, residual, across, up }, frame, record) {
  const worst = worstOf(record);
  const z = record.z[worst];
  if (!(Math.abs(z) > 2)) return;
  const at = across.at(record.points.x[worst]);
  if (at < -0.001 || at > 1.001) return;
  const height = up.at(record.points.measured[worst]);
  sheet.dot(curve, at, height, "worst");
  const x = record.points.x[worst];
  const where = frame.coordinate[1] === "s" ? timeInWords(Number(x.toPrecision(3))) : `${Number(x.toPrecision(3))} ${frame.coordinate[1]}`;
  const words = `worst ${frame.point}, ${where}: ${standardErrors(z, 0)}`;
  const half = 0.31 * sheet.size * words.length;
  const middle = Math.min(sheet.right - half - 4, Math.max(sheet.left + half + 4, sheet.x(at)));
  // The label is at the edge of the panel that is farther from the ring, where few dots are, and inside the frame.
  const edge = !residual ? curve.top - 8 : record.up[worst] > 0.6 ? residual.top + residual.height - 7 : residual.top + 15;
  if (residual) sheet.dot(residual, at, record.up[worst], "worst");
  sheet.text([middle, edge], { "text-anchor": "middle", class: "worst-label" }, words);
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
      if (strip.errors.length > 0) sheet.stem(panel, at, up(value - strip.errors[k]), up(value + strip.errors[k]), "bar");
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
  return sheet;
}
