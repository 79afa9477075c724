// Reference: the definition. The page handles gestures with one finger, the view those with two.
import assert from "node:assert/strict";
import { test } from "node:test";
import { keep_level, leave_scrolling } from "../../../../paper_figures/viewer/src/input.js";

function panel() {
    const element = Object.assign(new EventTarget(), { style: { touchAction: "none" } });
    leave_scrolling(element);
    return element;
}

// Whether the page is prevented from scrolling and zooming.
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

test("one finger leaves the tilt as it is, two are free, and so is a mouse", () => {
    const element = new EventTarget();
    const controls = { angle: 1, minPolarAngle: 0, maxPolarAngle: Math.PI, update() {}, getPolarAngle() { return this.angle; } };
    keep_level(element, controls);
    const after = (change, pointerId, pointerType = "touch") => {
        element.dispatchEvent(Object.assign(new Event(change), { pointerId, pointerType }));
        return [controls.minPolarAngle, controls.maxPolarAngle];
    };
    const free = [0, Math.PI];
    assert.deepEqual(after("pointerdown", 1), [1, 1]);
    assert.deepEqual(after("pointerdown", 2), free);
    controls.angle = 2;
    assert.deepEqual(after("pointerup", 1), [2, 2]);
    assert.deepEqual(after("pointercancel", 2), free);
    assert.deepEqual(after("pointerdown", 3, "mouse"), free);
});
