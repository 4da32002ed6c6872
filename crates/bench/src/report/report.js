// Overlays each image and its reference, with a slider between them. Without scripts they are shown side by side.
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
