// Round numbers along an axis, and their labels: those of the whole axis come with the data, those of a part of it are
// found here, by the same rules.
"use strict";

/// The next number of the sequence 1, 2, 5, 10, … .
function roundUp(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return [1, 2, 5, 10].map((factor) => factor * power).find((round) => round >= value * (1 - 1e-9)) ?? 10 * power;
}

/// Multiples of a round step, at most seven.
function linearTicks([low, high]) {
  const step = roundUp((high - low) / 6);
  const first = Math.ceil(low / step - 1e-9);
  const last = Math.floor(high / step + 1e-9);
  return Array.from({ length: Math.max(0, last - first + 1) }, (_, k) => (first + k) * step);
}

/// Powers of ten; if there are few, 2 and 5 times a power of ten as well; on an axis of less than half a decade, multiples of a step.
function logarithmicTicks([low, high]) {
  if (high / low < 3) return linearTicks([low, high]);
  const between = (factors) => {
    const found = [];
    for (let power = Math.floor(Math.log10(low)); power <= Math.ceil(Math.log10(high)); power += 1) {
      found.push(...factors.map((factor) => factor * 10 ** power));
    }
    return found.filter((value) => value >= low * (1 - 1e-9) && value <= high * (1 + 1e-9));
  };
  const powers = between([1]);
  return powers.length >= 4 ? powers : between([1, 2, 5]);
}

/// A number as people write it: with its zeros if they are few, otherwise with a power of ten.
function plainNumber(value) {
  const size = Math.abs(value);
  if (size === 0 || (size >= 1e-3 && size < 1e5)) return `${Number(value.toPrecision(6))}`.replace("-", "−");
  const [factor, exponent] = value.toExponential(3).split("e");
  const raised = `10${exponent.replace("+", "").replace("-", "⁻").replace(/\d/g, (digit) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[digit])}`;
  return Number(factor) === 1 ? raised : `${Number(factor)}·${raised}`.replace("-", "−");
}

/// A length of time in µs, ms or s.
function timeInWords(seconds) {
  const [factor, unit] = seconds < 1e-3 ? [1e6, "µs"] : seconds < 1 ? [1e3, "ms"] : [1, "s"];
  return `${Number((factor * seconds).toPrecision(6))} ${unit}`;
}

/// The ticks of a span with their labels, as numbers or as times.
function labelledTicks(span, isLinear, isTime) {
  const ticks = isLinear ? linearTicks(span) : logarithmicTicks(span);
  return ticks.map((value) => [value, isTime ? timeInWords(value) : plainNumber(value)]);
}
