// The meaning of the colours, with the numbers of the scale and of the record.
import { shown as text } from "./numbers.js";
import { draws_surface } from "./state.js";

const what = {
    skin: "plain skin: the boundary of the tets, smoothly shaded",
    ratio: "volume ratio of a tet, deformed over rest [1]",
    error: "distance of a vertex to FEM [mm], on a scale of square roots; it ends at the largest on record in this run",
    inverted: "inverted tets, volume ratio \u2264 0; the rest of the body is seen through",
};

const on_the_surface = {
    ...what, skin: "the rendered surface, carried by the tets",
    ratio: "volume ratio of the tet that carries the skin there, deformed over rest [1]",
    error: "distance of a point of the skin to the same under FEM [mm], on a scale of square roots; it ends at the largest on record in "
        + "this run, of a vertex of the tets",
};

export function draw_legend(element, header, run, state) {
    const { colours } = header;
    const parts = [];
    if (state.colour === "ratio") {
        const { low, high, shades } = colours.ratio;
        parts.push(bar(shades, [low, (low + high) / 2, high]), swatch(colours.inverted, "inverted"));
    }
    if (state.colour === "error") {
        const most = run.largest_error_mm();
        parts.push(bar(colours.error.shades, [0, most / 4, most]));
    }
    if (state.colour === "inverted") parts.push(swatch(colours.inverted, "inverted"));
    if (state.colour === "skin") parts.push(swatch(colours.skin, "skin"));
    const caption = document.createElement("span");
    caption.className = "vw-caption";
    caption.textContent = (draws_surface(run, state) ? on_the_surface : what)[state.colour] + without_errors(run, state);
    element.replaceChildren(...parts, caption);
}

// The panels that have no distance in this frame.
function without_errors(run, { colour, panels, at }) {
    const grey = colour === "error" ? panels.filter((label) => !run.has_errors(label, at)) : [];
    return grey.length ? `; grey: no distance, for ${grey.length === panels.length ? "FEM" : "it"} did not reach this frame's pose` : "";
}

function bar(shades, numbers) {
    const whole = document.createElement("span"), strip = document.createElement("span"), marks = document.createElement("span");
    whole.className = "vw-bar";
    strip.className = "vw-strip";
    strip.style.background = `linear-gradient(to right, ${shades.join(", ")})`;
    marks.className = "vw-marks";
    marks.append(...numbers.map((number) => {
        const mark = document.createElement("span");
        mark.textContent = text(number);
        mark.dataset.value = number;
        return mark;
    }));
    whole.append(strip, marks);
    return whole;
}

function swatch(colour, name) {
    const whole = document.createElement("span"), patch = document.createElement("span");
    whole.className = "vw-swatch";
    patch.style.background = colour;
    whole.append(patch, name);
    return whole;
}
