// Words that explain themselves: one points at them, moves the focus to them or taps them. Their meanings are those of the
// glossary of the manual.
"use strict";

const meanings = new Map();

/// Takes the words of the glossary, each with its names.
function takeGlossary(words) {
  for (const { names, meaning } of words) for (const name of names) meanings.set(name, meaning);
}

/// A word of the glossary, shown as it is or by another text.
function gloss(word, shown = word) {
  if (!meanings.has(word)) return html("span", {}, shown);
  return html("button", { type: "button", class: "gloss", "data-word": word, "aria-describedby": "meaning" }, shown);
}

/// What is written about the word that is asked for.
const meaningBox = html("div", { id: "meaning", role: "tooltip", hidden: true });
document.body.append(meaningBox);

function explain(word) {
  meaningBox.replaceChildren(html("strong", {}, word.dataset.word), ` – ${meanings.get(word.dataset.word)}`);
  meaningBox.hidden = false;
  const [at, own] = [word.getBoundingClientRect(), meaningBox.getBoundingClientRect()];
  const left = Math.max(8, Math.min(at.left, document.documentElement.clientWidth - own.width - 8));
  const below = at.bottom + 6 + own.height < window.innerHeight;
  meaningBox.style.left = `${left}px`;
  meaningBox.style.top = `${(below ? at.bottom + 6 : Math.max(4, at.top - own.height - 6))}px`;
}

const glossOf = (event) => (event.target instanceof Element ? event.target.closest(".gloss") : null);
// A finger that rests too long on a word makes no click; it is lifted all the same.
for (const name of ["mouseover", "focusin", "pointerup", "click"]) {
  document.addEventListener(name, (event) => {
    const word = glossOf(event);
    if (word) explain(word);
    else if (name === "click") meaningBox.hidden = true;
  });
}
for (const name of ["mouseout", "focusout"]) {
  document.addEventListener(name, (event) => {
    if (glossOf(event)) meaningBox.hidden = true;
  });
}
// It stands beside its word, which moves then.
window.addEventListener("resize", () => { meaningBox.hidden = true; });
document.addEventListener("keydown", (event) => {
  if (event.key === "Escape") meaningBox.hidden = true;
});
