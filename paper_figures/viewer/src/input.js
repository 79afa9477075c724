// Keys, while the focus is inside the viewer, and touch gestures. A control that uses a key itself keeps it.

export const help = "Keys inside the viewer: space plays, comma and full stop step a frame, Home and End go to the "
    + "first and last; s, e, t, v, i colour by skin, difference, contact, volume ratio, inverted tets; k rendered "
    + "skin or tets; b bones; c cut, [ and ] move it; r the first view. In a panel: arrows turn, with shift they "
    + "shift the view, + and \u2212 zoom. Mouse or fingers: drag turns (one finger: sideways; up and down it scrolls "
    + "the page; two turn any way, or shift after the button \u201ctwo fingers shift\u201d), wheel or pinch zooms, "
    + "right button shifts; all panels move together.";

const colours = { s: "skin", e: "error", t: "contact", v: "ratio", i: "inverted" };
const turns = { ArrowLeft: [-8, 0], ArrowRight: [8, 0], ArrowUp: [0, 8], ArrowDown: [0, -8] };

export function listen(root, actions) {
    root.addEventListener("keydown", (event) => {
        if (event.ctrlKey || event.metaKey || event.altKey) return;
        const { target, key } = event;
        if (target.matches("select") || (target.matches("button") && [" ", "Enter"].includes(key))) return;
        if (target.matches("input[type=range]") && (key in turns || ["Home", "End"].includes(key))) return;
        const action = action_of(event, target.matches(".vw-view"), actions);
        if (!action) return;
        action();
        event.preventDefault();
    });
}

// The action of a key; undefined if it has none here.
function action_of({ key, shiftKey }, in_panel, actions) {
    const turn = in_panel && turns[key];
    if (turn) return () => shiftKey ? actions.shift(...turn.map((degrees) => degrees / 160)) : actions.turn(...turn);
    if (in_panel && "+=-".includes(key)) return () => actions.zoom(key === "-" ? 1.15 : 1 / 1.15);
    if (key in colours) return () => actions.colour(colours[key]);
    return {
        " ": actions.play, ",": () => actions.step(-1), ".": () => actions.step(1), Home: actions.first,
        End: actions.last, k: actions.rendered, b: actions.bones, c: actions.cut, "[": () => actions.move_cut(-1),
        "]": () => actions.move_cut(1), r: actions.reset,
    }[key];
}

// Gestures on a panel: one finger up or down scrolls the page, sideways it turns the view; two fingers turn and zoom
// the view. OrbitControls would prevent the page from scrolling; the second finger prevents it from scrolling and
// zooming itself.
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
