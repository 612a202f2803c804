"use strict";
(() => {
  document.documentElement.classList.add("js");
  const rows = [...document.querySelectorAll("tr.claim")];
  const buttons = [...document.querySelectorAll("button.verdict")];
  const filter = document.getElementById("claim-filter");
  const count = document.getElementById("claim-count");

  // Shown are claims that hold every word and, when verdicts are pressed, one of those.
  function apply() {
    const words = filter.value.toLowerCase().split(/\s+/).filter(Boolean);
    const pressed = buttons.filter((button) => button.getAttribute("aria-pressed") === "true").map((button) => button.dataset.verdict);
    let shown = 0;
    for (const row of rows) {
      const text = row.textContent.toLowerCase();
      row.hidden = !words.every((word) => text.includes(word)) || (pressed.length > 0 && !pressed.includes(row.dataset.verdict));
      shown += !row.hidden;
    }
    count.textContent = words.length || pressed.length ? `${shown} of ${rows.length}` : "";
    for (const section of document.querySelectorAll("main > section")) {
      section.hidden = !section.querySelector("tr.claim:not([hidden])");
    }
  }
  filter.addEventListener("input", apply);
  for (const button of buttons) {
    button.addEventListener("click", () => {
      button.setAttribute("aria-pressed", button.getAttribute("aria-pressed") !== "true");
      apply();
    });
  }
  const target = location.hash && document.getElementById(decodeURIComponent(location.hash.slice(1)));
  if (target && target.matches("tr.claim")) target.querySelector("details").open = true;
})();
