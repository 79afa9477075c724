// What the page says about the data: its colours with their legend, the recorded numbers, and the notes below.
import { element } from "./controls.js";
import { ratio_of } from "./data.js";
import { draws_surface } from "./state.js";

// Colours as red green blue in [0, 1]. The page contains the tables, which are the same as in the figures.
export function rgb_of(hex) {
    return [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16) / 255);
}

// The shade of a value between low and high; beyond, the last shade.
export function shade_of(shades, low, high, value) {
    const share = Math.min(1, Math.max(0, (value - low) / (high - low || 1)));
    return shades[Math.round(share * (shades.length - 1))];
}

// The page's tables, parsed.
export function palette_of(colours) {
    return { ratio: { ...colours.ratio, shades: colours.ratio.shades.map(rgb_of) },
             error: { shades: colours.error.shades.map(rgb_of) },
             contact: { touching: rgb_of(colours.contact.touching), shades: colours.contact.shades.map(rgb_of) },
             skin: rgb_of(colours.skin), inverted: rgb_of(colours.inverted) };
}

// The colour of a tet for each code.
export function ratio_shades(palette, steps) {
    const { low, high, shades } = palette.ratio;
    return Array.from({ length: 256 },
                      (_, code) => code === 0 ? palette.inverted : shade_of(shades, low, high, ratio_of(code, steps)));
}

// Three significant digits; a dash if nothing is recorded.
export function shown(value) {
    if (value === null || value === undefined || Number.isNaN(value)) return "\u2013";
    if (value === 0) return "0";
    const text = Math.abs(value) >= 100 ? String(Math.round(value)) : String(Number(value.toPrecision(3)));
    return text.replace("-", "\u2212");
}

export function signed(value) {
    return value > 0 ? `+${shown(value)}` : shown(value);
}

// The meaning of the colours, with the numbers of the scale and of the record.
const what = {
    skin: "plain skin: the boundary of the tets, smoothly shaded",
    ratio: "volume ratio of a tet, deformed over rest [1]",
    error: "distance of a vertex from the reference [mm on a body of 1.7 m]; one in a hundred is farther than the "
        + "scale",
    contact: "depth of the skin in other flesh [mm], and skin that touches other skin",
    inverted: "inverted tets, volume ratio \u2264 0; the rest of the body is seen through",
};

const on_the_surface = {
    ...what, skin: "the rendered surface, carried by the tets",
    ratio: "volume ratio of the tet that carries the skin there, deformed over rest [1]",
    error: "distance of the skin from the reference [mm on a body of 1.7 m]; one in a hundred vertices is farther than "
        + "the scale",
};

export function draw_legend(place, { colours }, run, state) {
    const { low, high, shades } = colours.ratio, most = run.difference_mm;
    const parts = {
        skin: () => [swatch(colours.skin, "skin")],
        ratio: () => [bar(shades, [low, (low + high) / 2, high]), swatch(colours.inverted, "inverted")],
        error: () => [bar(colours.error.shades, [0, most / 2, most])],
        contact: () => [bar(colours.contact.shades, [0, run.deepest_mm / 2, run.deepest_mm]),
                        swatch(colours.contact.touching, "touching")],
        inverted: () => [swatch(colours.inverted, "inverted")],
    };
    const caption = (draws_surface(run, state) ? on_the_surface : what)[state.colour] + without_errors(run, state);
    place.replaceChildren(...parts[state.colour](), element("span", { class: "vw-caption" }, caption));
}

// The panels that have no distance in this frame.
function without_errors(run, { colour, panels, at }) {
    const grey = colour === "error" ? panels.filter((label) => !run.has_errors(label, at)) : [];
    if (grey.length && !run.labels.includes(run.reference)) return "; grey: no distance, for this run has no FEM";
    return grey.length
        ? `; grey: no distance, for ${grey.length === panels.length ? "FEM" : "it"} did not reach this frame's pose`
        : "";
}

function bar(shades, numbers) {
    return element("span", { class: "vw-bar" },
                   element("span",
                           { class: "vw-strip", style: `background: linear-gradient(to right, ${shades.join(", ")})` }),
                   element("span", { class: "vw-marks" },
                           ...numbers.map((number) => element("span", { "data-value": number }, shown(number)))));
}

function swatch(colour, name) {
    return element("span", { class: "vw-swatch" }, element("span", { style: `background: ${colour}` }), name);
}

// Shows the recorded numbers of the frame under each panel.
const lines = [
    { column: "volume_change_pct", name: "volume change", unit: "%", text: signed },
    { column: "inverted_tets", name: "inverted tets", unit: "", text: shown },
    { column: "j_min", name: "smallest ratio", unit: "", text: shown },
    { column: "error_joint_pct", name: "error at joints", unit: "%", text: shown },
    { column: "skin_rms_mm", name: "distance of the skin, rms", unit: "mm", text: shown },
    { column: "error_linf_m", name: "largest distance", unit: "mm",
      text: (value, run) => shown(value && run.mm_per_m * value) },
];

// The numbers of the frame that come first: the distance of the skin from the reference and the volume.
export function first_numbers(run, label, at) {
    const away_mm = run.has_errors(label, at) ? run.figure(label, "skin_rms_mm", at) : null;
    const volume_pct = run.figure(label, "volume_change_pct", at);
    const parts = [label === run.reference ? "the reference" : away_mm === null ? ""
                   : `${shown(away_mm)}\u202fmm from the reference`,
                   volume_pct === null ? "" : `volume ${signed(volume_pct)}\u202f%`];
    return parts.filter(Boolean).join(", ");
}

export function draw_figures(place, run, label, at) {
    const is_reference = label === run.reference;
    place.replaceChildren(...lines.filter(({ column }) => run.has_figure(column))
                              .flatMap(({ column, name, unit, text }) => {
const value = run.figure(label, column, at), is_error = /^error|^skin/.test(column);
const mark = is_error && run.masked_share_pct(at) > 0 ? " *" : "";
const recorded = text(value, run) + (unit && value !== null ? `\u202f${unit}` : "") + mark;
return [element("dt", {}, name), element("dd", { "data-column": column, "data-value": value ?? "" },
is_reference && is_error ? "reference" : recorded)];
}));
}

// Notes on the frame that is shown: the kind of FEM, the number of stored frames, their rounding, and the origin of the
// body.
const locking = "The FEM shown has linear elements (P1), which lock: they are stiffer than the material. The study "
    + "work_precision measures how far they are from quadratic ones, and the reference\u2019s own error. ";

export function note_of(run, every, at) {
    const masked_pct = run.masked_share_pct(at);
    const mark = masked_pct > 0 ? "* In this frame distances leave out "
        + `${masked_pct.toPrecision(2)} % of the volume, where the FEM reference is creased or overlaps itself. ` : "";
    const kept = every === 1 ? "every recorded frame" : `one in ${every} recorded frames`;
    const step_um = shown(1e6 * run.step_m);
    const of_reference = run.labels.includes(run.reference) ? locking : "";
    return `${mark}${of_reference}${run.vertices} vertices, ${run.tets} tets${carried_by(run)}; ${kept}. Positions are `
        + `rounded to steps of ${step_um} \u00b5m: each coordinate of a vertex is within half a step of the record's; `
        + "volume ratios to 1/127 up to 2; the numbers are the records' own. Millimetres are those of a body whose "
        + "largest extent is 1.7 m. A cut goes through the body at rest, so that every panel and frame shows the same "
        + `tets. ${run.rights}`;
}

function carried_by({ surface, step_m }) {
    if (!surface) return "";
    const within_um = Math.ceil(0.5e6 * step_m * surface.largest_sum);
    const points = `, which carry the ${surface.points} points of the rendered surface`;
    const left_out = surface.of_joints
        ? `; ${surface.of_joints} of these points follow joints without flesh, and are not drawn here` : "";
    return `${points}, each coordinate within ${within_um} \u00b5m of the record's${left_out}`;
}
