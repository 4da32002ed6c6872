// Sorts tables by a column whose heading is clicked: ascending, descending, and as they were. Empty cells are last.
"use strict";
for (const table of document.querySelectorAll("table")) {
  const body = table.tBodies[0];
  const rows = [...body.rows];
  const headings = [...table.tHead.rows[table.tHead.rows.length - 1].cells];
  const compare = (a, b) =>
    a.dataset.value && b.dataset.value ? a.dataset.value - b.dataset.value
      : a.textContent.localeCompare(b.textContent, "en", { numeric: true });
  const sort = (column, order) => {
    const sign = order === "descending" ? -1 : 1;
    const cells = (row) => row.cells[column];
    const empty = (row) => cells(row).textContent === "";
    const by = (a, b) => empty(a) - empty(b) || sign * compare(cells(a), cells(b));
    body.append(...(order === "none" ? rows : [...rows].sort(by)));
    table.classList.toggle("sorted", order !== "none");
    headings.forEach((heading, place) => heading.setAttribute("aria-sort", place === column ? order : "none"));
  };
  headings.forEach((heading, column) => {
    const button = Object.assign(document.createElement("button"), { type: "button" });
    button.append(...heading.childNodes);
    heading.append(button);
    const next = { ascending: "descending", descending: "none" };
    button.addEventListener("click", () => sort(column, next[heading.getAttribute("aria-sort")] ?? "ascending"));
  });
}
