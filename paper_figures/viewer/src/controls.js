// The bars above the panels: run, time, colouring, cut, skeleton. Every control is a native one, with a name for screen
// readers.
import { colourings, draws_surface, no_surface_because } from "./state.js";

export const colour_names = { skin: "skin", error: "difference", contact: "contact", ratio: "volume ratio",
                              inverted: "inverted tets" };

const what_rendered_does = "show the rendered surface in place of the tets' boundary";
const cut_names = [["", "no cut"], ["x", "across x"], ["y", "across y"], ["z", "across z"]];

export class Controls {
    constructor(runs, actions) {
        this.run = select("recorded run", runs.map((run) => [run.name, run.title]), actions.run);
        this.play = button("\u25b6 play", "play the frames", actions.play);
        this.time = slider("frame", actions.at);
        this.clock = element("output", { class: "vw-time" });
        this.colours = colourings.map((name) => button(colour_names[name], `colour by ${colour_names[name]}`,
                                                       () => actions.colour(name)));
        this.rendered = button("rendered skin", what_rendered_does, actions.rendered);
        this.bones = button("bones", "show the skeleton", actions.bones);
        this.follow = button("follow", "the camera follows the body", actions.follow);
        this.shifting = button("two fingers shift", "two fingers shift the view instead of turning it",
                               actions.shifting);
        this.shifting.classList.add("vw-fingers");
        this.axis = select("cut the tets by a plane", cut_names, actions.cut_axis);
        this.cut_at = slider("where the cut is, in the body at rest", actions.cut_at);
        this.side = button("other side", "show the other side of the cut", actions.cut_side);
        this.cut_text = element("output", { class: "vw-cut" });
        const first_view = button("first view", "the camera where it began", actions.reset);
        const back = button("\u2039", "one frame back", () => actions.step(-1));
        const on = button("\u203a", "one frame on", () => actions.step(1));
        this.link = button("copy link", "copy a link that opens this view again", actions.link);
        const fewer = button("\u2212", "one panel fewer", () => actions.panels(-1));
        const more = button("+", "one panel more", () => actions.panels(1));
        this.first_bar = element("div", { class: "vw-bars" }, this.play, this.time, this.clock,
                                 group("colour", ...this.colours));
        this.other_bars = [
            element("div", { class: "vw-bars" }, group("run", this.run), back, on, group("panels", fewer, more),
                    this.link),
            element("div", { class: "vw-bars" }, group("show", this.rendered, this.bones, this.follow, this.shifting,
                                                       first_view),
                    group("cut", this.axis, this.cut_at, this.side, this.cut_text)),
        ];
    }

    update(run, now) {
        this.run.value = run.name;
        this.play.textContent = now.playing ? "\u2016 pause" : "\u25b6 play";
        this.play.setAttribute("aria-label", now.playing ? "pause" : "play the frames");
        this.time.max = run.frames.length - 1;
        this.time.value = now.at;
        this.clock.setAttribute("aria-live", now.playing ? "off" : "polite");
        this.clock.textContent = clock_of(run, now.at);
        this.time.setAttribute("aria-valuetext", this.clock.textContent);
        const pressed = [...this.colours.map((made, at) => [made, colourings[at] === now.colour]),
                         [this.rendered, draws_surface(run, now)], [this.bones, now.bones], [this.follow, now.follow],
                         [this.shifting, now.shifting]];
        for (const [made, is_on] of pressed) made.setAttribute("aria-pressed", String(is_on));
        const refused = no_surface_because(run, now);
        this.rendered.disabled = refused !== null;
        this.rendered.title = refused ?? what_rendered_does;
        const contact = this.colours[colourings.indexOf("contact")];
        contact.disabled = !run.has_contact();
        contact.title = contact.disabled ? "these frames were written without contact" : "colour by contact";
        this.update_cut(run, now.cut);
    }

    update_cut(run, cut) {
        this.axis.value = cut?.axis ?? "";
        for (const control of [this.cut_at, this.side, this.cut_text]) control.classList.toggle("vw-hidden", !cut);
        if (!cut) return;
        const [low, high] = run.rest_range(cut.axis);
        Object.assign(this.cut_at, { min: low, max: high, step: (high - low) / 100 });
        this.cut_at.value = cut.at_m;
        this.cut_text.textContent =
            `${cut.axis} ${cut.above ? ">" : "\u2264"} ${Number(cut.at_m.toPrecision(3))} m at rest`;
    }
}

function clock_of(run, at) {
    const angle = run.figure(run.labels[0], "angle_deg", at);
    const time = angle === null ? `${run.times_s[at].toFixed(2)} s` : `${Math.round(angle)}\u00b0`;
    return `frame ${run.frames[at]}${at === run.frames.length - 1 ? " (last)" : ""}, ${time}`;
}

export function element(tag, attributes = {}, ...children) {
    const made = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) {
        if (name.startsWith("on")) made.addEventListener(name.slice(2), value);
        else if (value !== undefined && value !== false) made.setAttribute(name, value === true ? "" : value);
    }
    made.append(...children);
    return made;
}

export function select(name, options, on_choice) {
    return element("select", { "aria-label": name, onchange: (event) => on_choice(event.target.value) },
                   ...options.map(([value, text]) => element("option", { value }, text)));
}

export function button(text, name, on_press) {
    return element("button", { type: "button", "aria-label": name, title: name, onclick: on_press }, text);
}

export function slider(name, on_move) {
    return element("input",
                   { type: "range", "aria-label": name, oninput: (event) => on_move(Number(event.target.value)) });
}

export function group(name, ...children) {
    return element("fieldset", {}, element("legend", {}, name), ...children);
}
