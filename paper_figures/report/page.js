"use strict";
// Shows the values of plots under the pointer, the finger, or by the arrow keys; a claim's link opens the data behind
// it.
const readout = document.getElementById("readout");
let shown = null;

function hide() {
  if (shown) shown.classList.remove("shown");
  shown = null;
  readout.hidden = true;
}

function show(circle) {
  hide();
  shown = circle;
  circle.classList.add("shown");
  const axes = circle.parentNode.dataset;
  readout.textContent = `${circle.dataset.value} (${[axes.x, axes.y].filter(Boolean).join(", ")})`;
  readout.hidden = false;
  const box = circle.getBoundingClientRect();
  const left = Math.min(box.right + 8, innerWidth - readout.offsetWidth - 8);
  readout.style.left = `${Math.max(8, left)}px`;
  readout.style.top = `${Math.max(8, box.top - readout.offsetHeight - 6)}px`;
}

// The circle nearest to a place in the window, among those within reach [px]; null if there is none.
const reach = 20;
function nearest(plot, x, y) {
  let best = null, least = reach;
  for (const panel of plot.querySelectorAll(".values")) {
    const to_window = panel.getScreenCTM();
    for (const circle of panel.querySelectorAll("circle")) {
      const place = new DOMPoint(circle.cx.baseVal.value, circle.cy.baseVal.value).matrixTransform(to_window);
      const distance = Math.hypot(place.x - x, place.y - y);
      if (distance <= least) [best, least] = [circle, distance];
    }
  }
  return best;
}

for (const plot of document.querySelectorAll("svg.plot")) {
  const steps = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 };
  for (const event of ["pointermove", "click"])
    plot.addEventListener(event, ({ clientX, clientY }) => {
      const circle = nearest(plot, clientX, clientY);
      if (circle !== shown) circle ? show(circle) : hide();
    });
  plot.addEventListener("pointerleave", hide);
  plot.addEventListener("blur", hide);
  plot.addEventListener("keydown", (event) => {
    if (event.key === "Escape") hide();
    const step = steps[event.key], circles = [...plot.querySelectorAll(".values circle")];
    if (!step || !circles.length) return;
    event.preventDefault();
    const place = shown ? circles.indexOf(shown) + step : 0;
    show(circles[(place + circles.length) % circles.length]);
  });
}
addEventListener("scroll", hide, { passive: true });

// Opens all that the target of the address is folded into, and the target itself.
function openTarget() {
  const target = /^#[\w-]+$/.test(location.hash) && document.querySelector(location.hash);
  if (!target) return;
  for (let part = target; part; part = part.parentElement) if (part.tagName === "DETAILS") part.open = true;
  const own = target.querySelector(":scope > details:not(.claim)");
  if (own) own.open = true;
  target.scrollIntoView();
}
// A print has everything.
let folded = [];
addEventListener("beforeprint", () => {
  folded = [...document.querySelectorAll("main details:not(.vw-more, [open])")];
  for (const part of folded) part.open = true;
});
addEventListener("afterprint", () => { for (const part of folded) part.open = false; });
// "See it move" scrolls to the viewer and moves the keyboard focus there.
function goToViewer() {
  const viewer = document.getElementById("frame-viewer") ?? document.getElementById("viewer");
  viewer.tabIndex = -1;
  viewer.focus({ preventScroll: true });
  viewer.scrollIntoView();
}
for (const link of document.querySelectorAll("a.pose")) link.addEventListener("click", goToViewer);
addEventListener("hashchange", openTarget);
openTarget();
