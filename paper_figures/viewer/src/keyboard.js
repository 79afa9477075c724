// Handles keys while the focus is inside the viewer. A control that uses a key itself keeps it.

export const help = "Keys inside the viewer: space plays, comma and full stop step a frame, Home and End go to the first and last; "
    + "s, v, e, i colour by skin, volume ratio, error, inverted tets; k rendered skin or tets; b bones; c cut, [ and ] move it; "
    + "r the first view. In a panel: arrows turn, with shift they shift the view, + and \u2212 zoom. Mouse or fingers: drag turns (one "
    + "finger: sideways; up and down it scrolls the page; two turn any way, or shift after the button \u201ctwo fingers shift\u201d), "
    + "wheel or pinch zooms, right button shifts; all panels move together.";

const colours = { s: "skin", v: "ratio", e: "error", i: "inverted" };
const turns = { ArrowLeft: [-8, 0], ArrowRight: [8, 0], ArrowUp: [0, 8], ArrowDown: [0, -8] };

export function listen(root, actions) {
    root.addEventListener("keydown", (event) => {
        if (event.ctrlKey || event.metaKey || event.altKey) return;
        const { target, key } = event;
        if (target.matches("select") || (target.matches("button") && [" ", "Enter"].includes(key))) return;
        if (target.matches("input[type=range]") && (key in turns || ["Home", "End"].includes(key))) return;
        if (act(event, target.matches(".vw-view"), actions)) event.preventDefault();
    });
}

// Whether the key has a function here.
function act({ key, shiftKey }, in_panel, actions) {
    if (in_panel && key in turns && shiftKey) return run(() => actions.shift(...turns[key].map((degrees) => degrees / 160)));
    if (in_panel && key in turns) return run(() => actions.turn(...turns[key]));
    if (in_panel && "+=-".includes(key)) return run(() => actions.zoom(key === "-" ? 1.15 : 1 / 1.15));
    if (key in colours) return run(() => actions.colour(colours[key]));
    const plain = {
        " ": actions.play, ",": () => actions.step(-1), ".": () => actions.step(1), Home: actions.first, End: actions.last,
        k: actions.rendered, b: actions.bones, c: actions.cut, "[": () => actions.move_cut(-1), "]": () => actions.move_cut(1),
        r: actions.reset,
    };
    return Object.hasOwn(plain, key) && run(plain[key]);
}

function run(action) {
    action();
    return true;
}
