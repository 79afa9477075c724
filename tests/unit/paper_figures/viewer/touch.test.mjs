// Truth: the definition. One finger is left to the page, two are the view's own.
import assert from "node:assert/strict";
import { test } from "node:test";
import { leave_scrolling } from "../../../../paper_figures/viewer/src/touch.js";

function panel() {
    const element = Object.assign(new EventTarget(), { style: { touchAction: "none" } });
    leave_scrolling(element);
    return element;
}

// Whether the page is kept from scrolling and zooming.
function is_kept(gesture, fingers, cancelable = true) {
    const event = Object.assign(new Event(gesture, { cancelable }), { touches: Array(fingers).fill({}) });
    panel().dispatchEvent(event);
    return event.defaultPrevented;
}

test("the page may scroll up and down under one finger", () => {
    assert.equal(panel().style.touchAction, "pan-y");
    for (const gesture of ["touchstart", "touchmove"]) assert.equal(is_kept(gesture, 1), false, gesture);
});

test("under two fingers it stays", () => {
    for (const gesture of ["touchstart", "touchmove"]) assert.equal(is_kept(gesture, 2), true, gesture);
});

test("a scrolling that has begun is not stopped", () => assert.equal(is_kept("touchmove", 2, false), false));
