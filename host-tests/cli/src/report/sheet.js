// A drawing: its elements, its panels, and their ticks.
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

  dot(panel, across, up, name) {
    const r = { worst: 8, dot: 3.5, small: 2.3 }[name];
    this.add("circle", { cx: this.x(across), cy: this.y(panel, clamp(up)), r, class: name === "small" ? "dot" : name });
  }

  /// A vertical line, clipped to the panel.
  stem(panel, across, from, to, name) {
    const x = this.x(across);
    this.line(x, this.y(panel, clamp(from)), x, this.y(panel, clamp(to)), name);
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

/// The part of a line that lies inside the panel, from 0 to 1 both ways, or nothing (Liang & Barsky 1984).
function inside([x0, y0], [x1, y1]) {
  if (![x0, y0, x1, y1].every(Number.isFinite)) return null;
  let [from, to] = [0, 1];
  for (const [start, change] of [[x0, x1 - x0], [y0, y1 - y0]]) {
    if (change === 0 && (start < 0 || start > 1)) return null;
    if (change === 0) continue;
    const ends = [-start / change, (1 - start) / change].sort((one, other) => one - other);
    from = Math.max(from, ends[0]);
    to = Math.min(to, ends[1]);
  }
  if (from > to) return null;
  const at = (share) => [x0 + share * (x1 - x0), y0 + share * (y1 - y0)];
  return [at(from), at(to)];
}
