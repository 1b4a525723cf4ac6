// What every page needs: elements, and numbers in words.
"use strict";

const html = (name, attributes, ...children) => make(null, name, attributes, children);
const byId = (id) => document.getElementById(id);
const plain = (name) => name.replaceAll("_", " ");
const tenth = (value) => (value === null ? "unknown" : value.toFixed(1));

/// Four significant digits, as the program prints them.
function number(value) {
  if (value === null || !Number.isFinite(value)) return "∞";
  if (value === 0) return "0";
  const exponent = Math.floor(Math.log10(Math.abs(value)));
  if (exponent >= -3 && exponent <= 4) return value.toFixed(Math.max(0, 3 - exponent));
  return value.toExponential(3).replace("e+", "e");
}
