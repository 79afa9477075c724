// Fingers on a panel: one up or down scrolls the page, sideways it turns the view; two turn and zoom it.
// OrbitControls would keep the page from scrolling; the second finger keeps it from scrolling and zooming the page itself.
export function leave_scrolling(element) {
    element.style.touchAction = "pan-y";
    const keep = (event) => { if (event.touches.length > 1 && event.cancelable) event.preventDefault(); };
    for (const gesture of ["touchstart", "touchmove"]) element.addEventListener(gesture, keep, { passive: false });
}
