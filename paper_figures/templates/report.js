"use strict";
(() => {
  const all = (selector, root = document) => [...root.querySelectorAll(selector)];
  document.documentElement.classList.add("js");

  // Every picture is in the page once; other places borrow its bytes.
  for (const image of all("img[data-same]")) {
    const source = document.getElementById(image.dataset.same);
    if (source) image.src = source.src;
  }

  // Links into folded parts unfold them.
  function reveal() {
    const target = location.hash && document.getElementById(decodeURIComponent(location.hash.slice(1)));
    if (!target) return;
    all(".record.target").forEach((record) => record.classList.remove("target"));
    if (target.matches("details.record")) {
      target.hidden = false;
      target.open = true;
      target.classList.add("target");
    }
    const group = target.matches(".record-row") && target.closest("tbody");
    if (group) unfold(group, true);
    target.scrollIntoView();
  }
  function unfold(group, open) {
    group.classList.toggle("open", open);
    group.querySelector(".expand").setAttribute("aria-expanded", open);
  }
  for (const button of all(".expand")) {
    button.setAttribute("aria-expanded", "false");
    button.addEventListener("click", () => {
      const group = button.closest("tbody");
      unfold(group, !group.classList.contains("open"));
    });
  }
  addEventListener("hashchange", reveal);
  document.addEventListener("click", (event) => {
    const link = event.target.closest && event.target.closest('a[href^="#"]');
    if (link && link.getAttribute("href") === location.hash) reveal();
  });

  // Tables: a click on a header sorts whole groups of rows; empty values stay at the end.
  for (const table of all("table.sortable")) {
    all("thead th", table).forEach((header, column) => {
      const button = document.createElement("button");
      button.type = "button";
      button.className = "sorter";
      button.append(...header.childNodes);
      header.append(button);
      button.addEventListener("click", () => sort(table, header, column));
    });
  }
  function sort(table, header, column) {
    const descending = header.getAttribute("aria-sort") === "ascending";
    all("thead th", table).forEach((other) => other.removeAttribute("aria-sort"));
    header.setAttribute("aria-sort", descending ? "descending" : "ascending");
    const keyed = [...table.tBodies].map((body) => {
      const cell = body.rows[0].cells[column];
      const number = cell.dataset.sort === undefined ? NaN : Number(cell.dataset.sort);
      return { body, number, text: cell.textContent.trim() };
    });
    const numeric = keyed.some((row) => !Number.isNaN(row.number));
    keyed.sort((a, b) => {
      if (!numeric) return (descending ? -1 : 1) * a.text.localeCompare(b.text, "en", { numeric: true });
      if (Number.isNaN(a.number) || Number.isNaN(b.number)) return Number.isNaN(a.number) - Number.isNaN(b.number);
      return (descending ? -1 : 1) * (a.number - b.number);
    });
    table.append(...keyed.map((row) => row.body));
  }

  // Copy buttons.
  for (const button of all(".copy")) {
    button.addEventListener("click", async () => {
      const code = button.parentElement.querySelector("code");
      try {
        await navigator.clipboard.writeText(code.textContent);
        button.textContent = "Copied";
        setTimeout(() => (button.textContent = "Copy"), 1500);
      } catch {
        getSelection().selectAllChildren(code);
      }
    });
  }

  // Filter of the records.
  const filter = document.getElementById("record-filter");
  const records = all("details.record");
  const count = document.getElementById("record-count");
  if (filter) filter.addEventListener("input", () => {
    const words = filter.value.toLowerCase().split(/\s+/).filter(Boolean);
    let shown = 0;
    for (const record of records) {
      const text = record.querySelector("summary").textContent.toLowerCase() + " " + record.querySelector(".facts").textContent.toLowerCase();
      record.hidden = !words.every((word) => text.includes(word));
      shown += !record.hidden;
    }
    count.textContent = words.length ? `${shown} of ${records.length}` : "";
  });

  // The entry of the contents list that is being read.
  const entries = new Map(all('.contents a[href^="#"]').map((link) => [link.getAttribute("href").slice(1), link]));
  const seen = new IntersectionObserver((changes) => {
    for (const change of changes) {
      if (!change.isIntersecting) continue;
      entries.forEach((link) => link.classList.remove("here"));
      entries.get(change.target.id).classList.add("here");
    }
  }, { rootMargin: "0px 0px -75% 0px" });
  entries.forEach((link, id) => seen.observe(document.getElementById(id)));

  // Viewer: the pictures of one row side by side, under one zoom and one position.
  const viewer = document.getElementById("viewer");
  const panes = document.getElementById("viewer-panes");
  const rows = all(".panel .row").filter((row) => row.querySelector(".zoom"));
  const view = { row: 0, scale: 1, x: 0, y: 0, images: [] };
  const limits = { least: 1 / 16, most: 64 };

  function draw() {
    for (const { image, width, height } of view.images) {
      image.style.transform = `scale(${view.scale}) translate(${-width / 2 - view.x}px, ${-height / 2 - view.y}px)`;
    }
    document.getElementById("viewer-scale").textContent = `${Math.round(view.scale * 100)} %`;
  }
  function clampPosition() {
    const width = Math.max(...view.images.map((image) => image.width));
    const height = Math.max(...view.images.map((image) => image.height));
    view.x = Math.min(width / 2, Math.max(-width / 2, view.x));
    view.y = Math.min(height / 2, Math.max(-height / 2, view.y));
  }
  // Keeps the point (dx, dy), in screen pixels from the middle of a pane, where it is.
  function zoom(factor, dx = 0, dy = 0) {
    const scale = Math.min(limits.most, Math.max(limits.least, view.scale * factor));
    view.x += dx / view.scale - dx / scale;
    view.y += dy / view.scale - dy / scale;
    view.scale = scale;
    clampPosition();
    draw();
  }
  function pan(dx, dy) {
    view.x -= dx / view.scale;
    view.y -= dy / view.scale;
    clampPosition();
    draw();
  }
  function fit() {
    const pane = panes.firstElementChild.getBoundingClientRect();
    const scales = view.images.map((image) => Math.min(pane.width / image.width, pane.height / image.height));
    const scale = Math.min(...scales);
    Object.assign(view, { x: 0, y: 0, scale: scale >= 1 ? Math.floor(scale) : scale });
    draw();
  }
  function show(index) {
    view.row = (index + rows.length) % rows.length;
    const row = rows[view.row];
    document.getElementById("viewer-title").textContent = row.dataset.title;
    panes.replaceChildren();
    view.images = all(".cell", row).filter((cell) => cell.querySelector("img")).map((cell) => {
      const source = cell.querySelector("img");
      const pane = document.createElement("div");
      const image = new Image();
      const label = document.createElement("span");
      pane.className = "pane";
      image.src = source.src;
      image.alt = source.alt;
      const width = Number(source.getAttribute("width")), height = Number(source.getAttribute("height"));
      image.style.width = `${width}px`;
      image.style.height = `${height}px`;
      label.textContent = cell.querySelector(".label").textContent;
      pane.append(image, label);
      panes.append(pane);
      return { image, width, height };
    });
    arrange();
  }
  function arrange() {
    const count = view.images.length;
    const upright = innerHeight > innerWidth;
    const columns = upright ? Math.min(2, count) : count <= 4 ? count : Math.ceil(count / 2);
    panes.style.gridTemplateColumns = `repeat(${columns}, minmax(0, 1fr))`;
    panes.style.gridTemplateRows = `repeat(${Math.ceil(count / columns)}, minmax(0, 1fr))`;
    fit();
  }
  rows.forEach((row, index) => {
    for (const button of all(".zoom", row)) {
      button.addEventListener("click", () => {
        viewer.showModal();
        show(index);
        panes.focus();
      });
    }
  });
  const actions = {
    previous: () => show(view.row - 1),
    next: () => show(view.row + 1),
    in: () => zoom(1.5),
    out: () => zoom(1 / 1.5),
    fit,
    actual: () => { view.scale = 1; clampPosition(); draw(); },
    close: () => viewer.close(),
  };
  for (const button of all("[data-do]", viewer)) button.addEventListener("click", actions[button.dataset.do]);
  const keys = {
    "+": actions.in, "=": actions.in, "-": actions.out, "0": actions.fit, "1": actions.actual,
    PageUp: actions.previous, PageDown: actions.next,
    ArrowLeft: () => pan(60, 0), ArrowRight: () => pan(-60, 0), ArrowUp: () => pan(0, 60), ArrowDown: () => pan(0, -60),
  };
  viewer.addEventListener("keydown", (event) => {
    const action = !event.ctrlKey && !event.metaKey && keys[event.key];
    if (!action) return;
    event.preventDefault();
    action();
  });
  function fromMiddle(event) {
    const pane = event.target.closest(".pane") || panes.firstElementChild;
    const box = pane.getBoundingClientRect();
    return [event.clientX - box.left - box.width / 2, event.clientY - box.top - box.height / 2];
  }
  panes.addEventListener("wheel", (event) => {
    event.preventDefault();
    zoom(Math.exp(-event.deltaY * (event.deltaMode === 1 ? 0.05 : 0.0016)), ...fromMiddle(event));
  }, { passive: false });
  const pointers = new Map();
  const spread = () => {
    const [a, b] = [...pointers.values()];
    return Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY);
  };
  panes.addEventListener("pointerdown", (event) => {
    pointers.set(event.pointerId, event);
    panes.setPointerCapture(event.pointerId);
    panes.classList.add("held");
  });
  panes.addEventListener("pointermove", (event) => {
    const last = pointers.get(event.pointerId);
    if (!last) return;
    const before = pointers.size === 2 ? spread() : 0;
    pointers.set(event.pointerId, event);
    if (pointers.size === 2 && before > 0) zoom(spread() / before);
    pan((event.clientX - last.clientX) / pointers.size, (event.clientY - last.clientY) / pointers.size);
  });
  for (const end of ["pointerup", "pointercancel"]) {
    panes.addEventListener(end, (event) => {
      pointers.delete(event.pointerId);
      if (!pointers.size) panes.classList.remove("held");
    });
  }
  addEventListener("resize", () => viewer.open && arrange());

  reveal();
})();
