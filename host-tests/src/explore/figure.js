// Draws a model beside one record or several: the curve, and below it the residuals over the same axis.
"use strict";

/// Draws a figure in its frame. `records` are the fitted one and those that judge the model, each as `drawn` and
/// with the number of its colour; `before` is the line of an earlier model, or null.
function drawRecords(frame, { model, before, records, words }, unit, width) {
  const narrow = width < 560;
  const curve = { top: 10, height: narrow ? 240 : 320 };
  const residual = { top: curve.top + curve.height + 18, height: narrow ? 130 : 150 };
  const sheet = new Sheet(frame.quantity, `${frame.up} and residual: ${words}`, width, residual.top + residual.height + 48);
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
  for (const share of model.shares) sheet.path(curve, share.line, place, `line effect-${share.colour}`);
  if (before) sheet.path(curve, before, place, "line before");
  sheet.path(curve, model.model, place, "line model");
  // The fitted record comes last, so that it lies on top.
  for (const { drawn, colour } of [...records].reverse()) drawRecord(sheet, curve, residual, drawn, colour, across, up);
  return sheet.svg;
}

/// Draws the dots of a record with their bars. The fitted record has filled dots, the others have rings.
function drawRecord(sheet, curve, residual, drawn, colour, across, up) {
  const { x, measured, lower, upper } = drawn.measured;
  const small = 8 * x.length > sheet.right - sheet.left;
  const mark = (panel, at, height) => {
    if (colour === 0) return sheet.dot(panel, at, height, small ? "small" : "dot");
    return sheet.add("circle", { cx: sheet.x(at), cy: sheet.y(panel, clamp(height)), r: small ? 2.2 : 3.6,
      class: `other record-${colour}` });
  };
  const stem = (panel, at, from, to) => {
    if (colour === 0) return sheet.stem(panel, at, from, to);
    const place = sheet.x(at);
    return sheet.line(place, sheet.y(panel, clamp(from)), place, sheet.y(panel, clamp(to)), `other-bar record-${colour}`);
  };
  x.forEach((value, k) => {
    const at = across(value);
    if (at < -0.001 || at > 1.001) return;
    stem(curve, at, up(lower[k]), up(upper[k]));
    mark(curve, at, up(measured[k]));
    if (colour === 0) sheet.stem(residual, at, 0.5, drawn.up[k]);
    mark(residual, at, drawn.up[k]);
  });
}
