// Gestures on a panel: one finger up or down scrolls the page, sideways it turns the view; two fingers turn and zoom the view.
// OrbitControls would prevent the page from scrolling; the second finger prevents it from scrolling and zooming itself.
export function leave_scrolling(element) {
    element.style.touchAction = "pan-y";
    const keep = (event) => { if (event.touches.length > 1 && event.cancelable) event.preventDefault(); };
    for (const gesture of ["touchstart", "touchmove"]) element.addEventListener(gesture, keep, { passive: false });
}

// One finger does not tilt the view, since it scrolls the page vertically.
export function keep_level(element, controls) {
    const fingers = new Set();
    const count = (event) => {
        if (event.pointerType !== "touch") return;
        if (event.type === "pointerdown") fingers.add(event.pointerId);
        else fingers.delete(event.pointerId);
        Object.assign(controls, { minPolarAngle: 0, maxPolarAngle: Math.PI });
        controls.update();  // the camera may have been moved from another panel
        const angle = controls.getPolarAngle();
        if (fingers.size === 1) Object.assign(controls, { minPolarAngle: angle, maxPolarAngle: angle });
    };
    for (const change of ["pointerdown", "pointerup", "pointercancel"]) element.addEventListener(change, count);
}
