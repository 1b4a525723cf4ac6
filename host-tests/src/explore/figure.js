// Draws a model beside one record or several: the curve, and below it the residuals over the same axis.
"use strict";

/// Draws a figure in its frame. `records` are the fitted one and those that judge the model, each as `drawn` and
/// with the number of its colour; `before` is the line of an earlier model, or null.
function drawRecords(frame, { model, before, records, words }, unit, width) {
  const heights = width < 560 ? [240, 130] : [320, 150];
  const { sheet, curve, residual, across, up, place } = drawPanels(frame, unit, `${frame.up} and residual: ${words}`, heights, width);
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
