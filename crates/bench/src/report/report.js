// Overlays each image and its reference, with a slider between them. Without scripts they are shown side by side.
// Sorts tables by a column whose heading is clicked: ascending, descending, and as they were.
"use strict";
for (const pair of document.querySelectorAll(".pair")) {
  const [test, reference] = [".test", ".reference"].map((name) => pair.querySelector(name));
  const titles = [test, reference].map((figure) => figure.querySelector("figcaption").textContent);

  const stage = document.createElement("div");
  stage.className = "stage";
  const over = document.createElement("div");
  over.className = "over";
  over.append(test.querySelector("svg").cloneNode(true));
  stage.append(reference.querySelector("svg").cloneNode(true), over);

  const slider = document.createElement("input");
  Object.assign(slider, { type: "range", min: "0", max: "100", step: "0.5", value: "50" });
  slider.setAttribute("aria-label", `How much of ${titles[0]} covers ${titles[1]}, in percent`);
  const cut = (value) => {
    slider.value = value;
    stage.style.setProperty("--cut", `${slider.value}%`);
  };
  slider.addEventListener("input", () => cut(slider.value));
  const drag = (event) => {
    const box = stage.getBoundingClientRect();
    cut((100 * (event.clientX - box.left)) / box.width);
  };
  stage.addEventListener("pointerdown", (event) => {
    stage.setPointerCapture(event.pointerId);
    drag(event);
  });
  stage.addEventListener("pointermove", (event) => {
    if (stage.hasPointerCapture(event.pointerId)) drag(event);
  });

  const ends = document.createElement("figcaption");
  ends.className = "ends";
  ends.append(...titles.map((title) => Object.assign(document.createElement("span"), { textContent: title })));
  const stack = document.createElement("figure");
  stack.className = "stack";
  stack.append(stage, slider, ends);
  test.before(stack);
  pair.classList.add("sliding");
}

for (const table of document.querySelectorAll("table")) {
  const body = table.tBodies[0];
  const rows = [...body.rows];
  if (rows.length < 2) continue;
  const headings = [...table.tHead.rows[table.tHead.rows.length - 1].cells];

  // A number behind the text, one in the text (digits are grouped by narrow spaces), or the text itself; empty cells
  // are last.
  const key = (row, column) => {
    const cell = row.cells[column];
    const text = cell.textContent.trim();
    if (text === "") return { kind: 2, value: "" };
    const number = parseFloat(cell.dataset.value ?? text.replaceAll("\u202f", ""));
    const isNumber = cell.classList.contains("number") && Number.isFinite(number);
    return isNumber ? { kind: 0, value: number } : { kind: 1, value: text };
  };
  const compare = (a, b) =>
    a.kind !== b.kind ? a.kind - b.kind
      : a.kind === 1 ? a.value.localeCompare(b.value, "en", { numeric: true })
      : a.value - b.value || 0;

  const sort = (column, order) => {
    const keyed = rows.map((row, place) => ({ row, place, key: key(row, column) }));
    if (order !== "none") {
      const sign = order === "descending" ? -1 : 1;
      keyed.sort((a, b) => {
        const empty = (a.key.kind === 2) - (b.key.kind === 2);
        return empty || sign * compare(a.key, b.key) || a.place - b.place;
      });
    }
    body.append(...keyed.map(({ row }) => row));
    table.classList.toggle("sorted", order !== "none");
    headings.forEach((heading, place) => heading.setAttribute("aria-sort", place === column ? order : "none"));
  };

  headings.forEach((heading, column) => {
    const button = document.createElement("button");
    button.type = "button";
    button.append(...heading.childNodes);
    heading.append(button);
    heading.setAttribute("aria-sort", "none");
    const next = { none: "ascending", ascending: "descending", descending: "none" };
    button.addEventListener("click", () => sort(column, next[heading.getAttribute("aria-sort")]));
  });
}
