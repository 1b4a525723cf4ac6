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

/// The word whose meaning was written last.
let explained = null;

function explain(word) {
  explained = word;
  meaningBox.replaceChildren(html("strong", {}, word.dataset.word), ` – ${meanings.get(word.dataset.word)}`);
  meaningBox.hidden = false;
  const [at, own] = [word.getBoundingClientRect(), meaningBox.getBoundingClientRect()];
  const left = Math.max(8, Math.min(at.left, document.documentElement.clientWidth - own.width - 8));
  const below = at.bottom + 6 + own.height < window.innerHeight;
  meaningBox.style.left = `${left}px`;
  meaningBox.style.top = `${(below ? at.bottom + 6 : Math.max(4, at.top - own.height - 6))}px`;
}

const glossOf = (event) => (event.target instanceof Element ? event.target.closest(".gloss") : null);
// Whoever taps a word or reaches it by a key keeps its meaning when the mouse, which lies elsewhere, moves. A finger that rests
// too long on a word makes no click; it is lifted all the same.
let isKept = false;

function hideMeaning() {
  [meaningBox.hidden, isKept] = [true, false];
}

for (const name of ["mouseover", "focusin", "pointerup", "click"]) {
  document.addEventListener(name, (event) => {
    const word = glossOf(event);
    if (word) {
      isKept = name !== "mouseover" || (isKept && word === explained);
      explain(word);
    } else if (name === "click") hideMeaning();
  });
}
document.addEventListener("mouseout", (event) => {
  if (glossOf(event) && !isKept) hideMeaning();
});
document.addEventListener("focusout", (event) => {
  if (glossOf(event)) hideMeaning();
});
// It stands beside its word, which moves then.
window.addEventListener("resize", hideMeaning);
document.addEventListener("keydown", (event) => {
  if (event.key === "Escape") hideMeaning();
});
