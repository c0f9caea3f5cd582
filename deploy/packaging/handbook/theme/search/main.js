// Searches the handbook. A page that is read from a folder may neither fetch an index nor start a worker, so the index is a
// script of its own (search/index.js, which make-handbook writes), and a query is answered here.
"use strict";

const most = 40;

// A section counts for a query when it has all of its words; those in the title count ten times.
function score(section, words) {
  const title = section.title.toLowerCase(), text = section.text.toLowerCase();
  let sum = 0;
  for (const word of words) {
    const found = 10 * (title.split(word).length - 1) + Math.min(5, text.split(word).length - 1);
    if (!found) return 0;
    sum += found;
  }
  return sum;
}

// The text around the first of the words.
function excerpt(text, words) {
  const places = words.map((word) => text.toLowerCase().indexOf(word)).filter((place) => place >= 0);
  const begin = Math.max(0, Math.min(...places, text.length) - 80);
  return (begin ? "… " : "") + text.slice(begin, begin + 240) + (begin + 240 < text.length ? " …" : "");
}

function article(section, words) {
  const link = document.createElement("a"), heading = document.createElement("h3"), text = document.createElement("p");
  link.href = section.location;
  link.textContent = section.title;
  heading.append(link);
  text.textContent = excerpt(section.text, words);
  const whole = document.createElement("article");
  whole.append(heading, text);
  return whole;
}

function answer(query) {
  const words = query.toLowerCase().split(/\s+/).filter(Boolean);
  const found = handbookIndex.map((section) => ({ section, score: words.length ? score(section, words) : 0 }))
    .filter((hit) => hit.score > 0).sort((a, b) => b.score - a.score).slice(0, most);
  const results = document.getElementById("mkdocs-search-results");
  results.replaceChildren(...found.map((hit) => article(hit.section, words)));
  if (!found.length) results.textContent = "No page has all of these words.";
}

const field = document.getElementById("mkdocs-search-query");
if (field) {
  field.value = new URLSearchParams(window.location.search).get("q") || "";
  field.addEventListener("input", () => answer(field.value));
  answer(field.value);
}
