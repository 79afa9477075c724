// The bars above the panels: run, time, colouring, cut, skeleton.
import { colourings } from "./link.js";
import { draws_surface, no_surface_because } from "./state.js";
import { button, element, group, select, slider } from "./page.js";

export const colour_names = { skin: "skin", ratio: "volume ratio", error: "distance to FEM", inverted: "inverted tets" };

const what_rendered_does = "show the rendered surface in place of the tets' boundary";
const cut_names = [["", "no cut"], ["x", "across x"], ["y", "across y"], ["z", "across z"]];

export class Controls {
    constructor(runs, actions) {
        this.run = select("recorded run", runs.map((run) => [run.name, run.title]), actions.run);
        this.play = button("\u25b6 play", "play the frames", actions.play);
        this.time = slider("frame", actions.at);
        this.clock = element("output", { class: "vw-time" });
        this.colours = colourings.map((name) => button(colour_names[name], `colour by ${colour_names[name]}`, () => actions.colour(name)));
        this.rendered = button("rendered skin", what_rendered_does, actions.rendered);
        this.bones = button("bones", "show the skeleton", actions.bones);
        this.follow = button("follow", "the camera follows the body", actions.follow);
        this.shifting = button("two fingers shift", "two fingers shift the view instead of turning it", actions.shifting);
        this.shifting.classList.add("vw-fingers");
        this.axis = select("cut the tets by a plane", cut_names, actions.cut_axis);
        this.cut_at = slider("where the cut is, in the body at rest", actions.cut_at);
        this.side = button("other side", "show the other side of the cut", actions.cut_side);
        this.cut_text = element("output", { class: "vw-cut" });
        const first_view = button("first view", "the camera where it began", actions.reset);
        const back = button("\u2039", "one frame back", () => actions.step(-1));
        const on = button("\u203a", "one frame on", () => actions.step(1));
        this.bars = [
            element("div", { class: "vw-bars" }, group("run", this.run), back, this.play, on, this.time, this.clock),
            element("div", { class: "vw-bars" }, group("colour", ...this.colours),
                    group("show", this.rendered, this.bones, this.follow, this.shifting, first_view),
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
        this.colours.forEach((made, at) => {
            made.setAttribute("aria-pressed", String(colourings[at] === now.colour));
        });
        this.rendered.setAttribute("aria-pressed", String(draws_surface(run, now)));
        const refused = no_surface_because(run, now);
        this.rendered.disabled = refused !== null;
        this.rendered.title = refused ?? what_rendered_does;
        this.bones.setAttribute("aria-pressed", String(now.bones));
        this.follow.setAttribute("aria-pressed", String(now.follow));
        this.shifting.setAttribute("aria-pressed", String(now.shifting));
        this.update_cut(run, now.cut);
    }

    update_cut(run, cut) {
        this.axis.value = cut?.axis ?? "";
        for (const control of [this.cut_at, this.side, this.cut_text]) control.classList.toggle("vw-hidden", !cut);
        if (!cut) return;
        const [low, high] = run.rest_range(cut.axis);
        Object.assign(this.cut_at, { min: low, max: high, step: (high - low) / 100 });
        this.cut_at.value = cut.at_m;
        this.cut_text.textContent = `${cut.axis} ${cut.above ? ">" : "\u2264"} ${cut.at_m.toFixed(2)} m at rest`;
    }
}

function clock_of(run, at) {
    const angle = run.figure(run.labels[0], "angle_deg", at);
    const time = angle === null ? `${run.times_s[at].toFixed(2)} s` : `${Math.round(angle)}\u00b0`;
    return `frame ${run.frames[at]}${at === run.frames.length - 1 ? " (last)" : ""}, ${time}`;
}
