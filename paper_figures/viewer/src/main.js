// Starts the viewer in #frame-viewer and sets window.viewer for tests and for interactive use:
//
//   viewer.data.runs                     the recorded runs, see data.js
//   viewer.state.now, viewer.state.set   the state, see state.js; set({ at: 3, colour: "error" })
//   viewer.drawn_positions(panel)        positions [m] as drawn, x y z of each vertex (of the rendered surface, if that is drawn);
//                                        nan where no face is visible
//   viewer.pixels(panel)                 red green blue alpha of a panel
//   viewer.ready                         resolves when the first frame is drawn
import style from "./style.css";
import { read_page } from "./data.js";
import { element } from "./page.js";
import { Viewer } from "./viewer.js";

async function start(root) {
    document.head.append(element("style", {}, style));
    root.textContent = "The recorded frames are being unpacked \u2026";
    const viewer = new Viewer(root, await read_page());
    return {
        viewer, data: viewer.data, state: viewer.state,
        drawn_positions: (panel) => viewer.panels[panel].drawn_positions(),
        pixels: (panel) => viewer.views.pixels(panel),
    };
}

const root = document.getElementById("frame-viewer");
const ready = start(root);
window.viewer = { ready };
ready.then((hook) => Object.assign(window.viewer, hook)).catch((error) => {
    root.textContent = `The viewer could not start: ${error.message}. It needs WebGL 2.`;
    console.error(error);
});
