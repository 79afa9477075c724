// Starts the viewer in #frame-viewer and sets window.viewer for tests and for interactive use:
//
//   viewer.data.runs                     the recorded runs, see data.js
//   viewer.state.now, viewer.state.set   the state, see state.js; set({ at: 3, colour: "error" })
//   viewer.drawn_positions(panel)        positions [m] as drawn, x y z of each vertex (of the rendered surface, if that
// is drawn);
//                                        nan where no face is visible
//   viewer.pixels(panel)                 red green blue alpha of a panel
//   viewer.ready                         resolves when the first frame is drawn
import style from "./style.css";
import { Controls, colour_names, element, select } from "./controls.js";
import { read_page } from "./data.js";
import { Meshes } from "./faces.js";
import { help, listen } from "./input.js";
import { draw_figures, draw_legend, first_numbers, note_of, palette_of, ratio_shades } from "./legend.js";
import { Panel } from "./panel.js";
import { State, hash_of, no_surface_because, panels_for, play, pose_of } from "./state.js";
import { Views, is_wide } from "./views.js";

// Connects the parts: state on one side; panels, legend and address on the other.
class Viewer {
    constructor(root, data) {
        this.root = root;
        this.data = data;
        this.palette = palette_of(data.colours);
        this.shades = ratio_shades(this.palette, data.ratio_steps);
        this.meshes = new Meshes();
        const first = data.runs.find((run) => run.name === data.first) ?? data.runs[0];
        const colour = first.labels.includes(first.reference) ? "error" : "skin";
        this.state = new State({ run: first.name, at: 0, panels: panels_for(first), colour, rendered: true,
                                 bones: false,
                                 cut: null, claim: null, playing: false, follow: true, shifting: false });
        this.build();
        this.state.on_change((now, changed) => this.update(now, changed));
        play(this.state, () => this.run, () => this.is_seen);
        this.update(this.state.now, new Set(Object.keys(this.state.now)));
        this.open(location.hash, false);
        window.addEventListener("hashchange", () => this.open(location.hash, true));
        const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
        if (!pose_of(location.hash) && !still) this.state.set({ playing: true });
    }

    get run() {
        return this.data.runs.find((run) => run.name === this.state.now.run);
    }

    build() {
        this.controls = new Controls(this.data.runs, this.actions());
        this.claim = element("p", { class: "vw-claim vw-hidden" });
        this.canvas = element("canvas", { "aria-hidden": "true" });
        this.panels_element = element("div", { class: "vw-panels" }, this.canvas);
        this.legend = element("div", { class: "vw-legend" });
        this.note = element("p", { class: "vw-small" });
        this.link_words = element("output", { class: "vw-small" });
        const more = element("details", { class: "vw-more" },
                             element("summary", {}, "more: other runs, cut, bones, numbers, link"),
                             ...this.controls.other_bars, this.link_words, links_to(this.data.poses), this.note,
                             element("p", { class: "vw-small" }, help));
        more.addEventListener("toggle", () => this.root.classList.toggle("vw-all", more.open));
        this.root.replaceChildren(this.claim, this.panels_element, this.controls.first_bar, this.legend, more);
        this.views = new Views(this.canvas, () => this.redraw());
        listen(this.root, this.actions());
        new ResizeObserver(() => this.redraw()).observe(this.panels_element);
        new IntersectionObserver(([seen]) => { this.is_seen = seen.isIntersecting; }).observe(this.panels_element);
        const take_colours = () => {
            this.views.take_colours(this.root);
            this.redraw();
        };
        take_colours();
        matchMedia("(prefers-color-scheme: dark)").addEventListener("change", take_colours);
        addEventListener("beforeprint", () => this.print());
    }

    // A print shows what is on the screen; browsers leave the canvas out.
    print() {
        this.views.draw();
        this.printed ??= this.panels_element.appendChild(element("img",
                                                                 { class: "vw-printed",
                                                                   alt: "the bodies as they are shown" }));
        this.printed.src = this.canvas.toDataURL();
    }

    // Makes one element per panel: choice of deformer, view, recorded numbers.
    build_panels(now) {
        for (const { whole } of this.panel_elements ?? []) whole.remove();
        const title_of = ({ label, title }) => (label === this.run.reference ? "reference: FEM" : title);
        const options = this.run.deformers.map((deformer) => [deformer.label, title_of(deformer)]);
        this.panel_elements = now.panels.map((label, at) => {
            const choose = (chosen) =>
                this.user({ panels: now.panels.map((shown, place) => place === at ? chosen : shown) });
            const choice = select(`deformer of panel ${at + 1}`, options, choose);
            choice.value = label;
            const { title, colour } = this.run.deformer(label);
            // Black, which is not visible on a dark page.
            const bar = label === this.run.reference ? "currentColor" : colour;
            const name = `${title}: arrows turn, plus and minus zoom`;
            const view = element("div", { class: "vw-view", tabindex: 0, role: "application", "aria-label": name });
            const numbers = element("dl", { "aria-label": `recorded numbers of ${title}` });
            const mark = element("p", { class: "vw-mark vw-hidden" }, "pose not reached"),
                first = element("p", { class: "vw-first" });
            const parts = [choice, view, mark, first, numbers];
            const whole = element("div", { class: "vw-panel", style: `border-top: 4px solid ${bar}` }, ...parts);
            this.panels_element.append(whole);
            return { whole, view, mark, first, numbers };
        });
        const wide = is_wide(this.run), panels = now.panels.length;
        this.panels_element.classList.toggle("vw-wide", wide);
        this.panels_element.classList.toggle("vw-four", panels === 4);
        this.panels_element.style.setProperty("--vw-columns", wide && panels === 4 ? 2 : panels);
        this.panels = now.panels.map(() => new Panel());
        this.views.show(this.panel_elements.map((made) => made.view), this.panels.map((panel) => panel.contents));
    }

    update(now, changed) {
        const { run } = this;
        if (changed.has("run") || changed.has("panels")) this.build_panels(now);
        const mesh = this.meshes.of(run, now.cut);
        now.panels.forEach((label, at) => {
            this.panels[at].update(mesh, label, now, this.palette, this.shades);
            this.panel_elements[at].mark.classList.toggle("vw-hidden", run.reached(label, now.at));
            this.panel_elements[at].mark.textContent = run.unreached_words(label, now.at);
            draw_figures(this.panel_elements[at].numbers, run, label, now.at);
            this.panel_elements[at].first.textContent = first_numbers(run, label, now.at);
        });
        if (changed.has("shifting") || changed.has("run") || changed.has("panels"))
            this.views.two_fingers(now.shifting);
        this.controls.update(run, now);
        draw_legend(this.legend, this.data, run, now);
        this.views.update(run, now, changed);
        for (const panel of this.panels) panel.stand_on_ground(run, now.at, this.views.middle, this.views.stage);
        this.note.textContent = note_of(run, this.data.every, now.at);
        this.show_claim(now.claim);
        this.redraw();
    }

    show_claim(claim) {
        const pose = this.data.poses.find((one) => one.claim === claim);
        this.claim.classList.toggle("vw-hidden", !claim);
        const what = pose ? ` Shown: ${pose.what}. Colour: ${colour_names[this.state.now.colour]}.` : "";
        this.claim.textContent = claim ? `${claim}. ${this.data.claims[claim] ?? ""}${what}` : "";
    }

    redraw() {
        this.waiting ??= requestAnimationFrame(() => {
            this.waiting = null;
            this.views.draw();
        });
    }

    // Applies a change by the user: the address follows it, and the claim's pose is left.
    user(changes) {
        this.state.set({ claim: null, ...changes });
        const { now } = this.state;
        if (!now.playing) history.replaceState(null, "", hash_of({ ...now, frame: this.run.frames[now.at] }));
    }

    // Shows the pose of an address; an address that only names a claim means the claim's own pose. A claim's pose shows
    // the rendered skin.
    open(hash, scroll) {
        const asked = pose_of(hash);
        if (!asked) return;
        const known = this.data.poses.find((pose) => pose.claim === asked.claim);
        const own = known ? { ...known, panels: known.panels ? known.panels.split(",") : undefined } : {};
        const pose = { ...(asked.run ? {} : own), ...asked };
        const run = this.data.runs.find((one) => one.name === pose.run) ?? this.run;
        this.state.set({ run: run.name, at: run.place_of(pose.frame ?? 0), panels: panels_for(run, pose.panels),
                         colour: pose.colour ?? "ratio", rendered: pose.rendered ?? Boolean(pose.claim),
                         bones: pose.bones ?? false, cut: pose.cut ?? null, claim: pose.claim ?? null,
                         playing: false });
        if (pose.view) this.views.see(pose.view);
        if (scroll) this.root.scrollIntoView({ block: "start" });
    }

    // The address opens the same view, with the camera. Where the browser does not let it be copied, it is shown.
    async copy_link() {
        const { now } = this.state, hash = hash_of({ ...now, frame: this.run.frames[now.at], view: this.views.seen() });
        this.state.set({ playing: false });
        history.replaceState(null, "", hash);
        this.link_words.textContent = await navigator.clipboard?.writeText(location.href)
            .then(() => "The link to this view is copied.", () => null)
            ?? `The address of this page opens this view: ${location.href}`;
    }

    actions() {
        const now = () => this.state.now, last = () => this.run.frames.length - 1;
        const go = (at) => this.user({ at: Math.min(last(), Math.max(0, at)), playing: false });
        const cut = (changes) => now().cut && this.user({ cut: { ...now().cut, ...changes } });
        const toggle = (key) => () => this.user({ [key]: !now()[key] });
        const moved = (action) => (...by) => {
            action(...by);
            this.redraw();
        };
        const cut_axis = (axis) => {
            if (!axis) return this.user({ cut: null });
            const [low, high] = this.run.rest_range(axis);
            this.user({ cut: { axis, at_m: (low + high) / 2, above: false } });
        };
        return {
            run: (name) => {
                const run = this.data.runs.find((one) => one.name === name);
                this.user({ run: name, at: 0, panels: panels_for(run), cut: null, playing: false });
            },
            at: go, step: (by) => go(now().at + by), first: () => go(0), last: () => go(last()),
            link: () => this.copy_link(),
            panels: (by) => {
                const { panels } = now(), next = this.run.labels.find((label) => !panels.includes(label));
                if (by < 0 && panels.length > 1) this.user({ panels: panels.slice(0, -1) });
                if (by > 0 && panels.length < 4 && next) this.user({ panels: [...panels, next] });
            },
            play: toggle("playing"), bones: toggle("bones"), follow: toggle("follow"), shifting: toggle("shifting"),
            colour: (colour) => (colour !== "contact" || this.run.has_contact()) && this.user({ colour }),
            rendered: () => no_surface_because(this.run, now()) === null && toggle("rendered")(),
            cut: () => cut_axis(now().cut ? "" : "z"), cut_axis,
            cut_at: (at_m) => cut({ at_m }), cut_side: () => cut({ above: !now().cut.above }),
            move_cut: (by) => cut({ at_m: this.run.stepped(now().cut, by) }),
            turn: moved((around, up) => this.views.turn(around, up)),
            shift: moved((right, up) => this.views.shift(right, up)), zoom: moved((factor) => this.views.zoom(factor)),
            reset: moved(() => this.views.first(this.run, now())),
        };
    }
}

function links_to(poses) {
    const links = poses.flatMap(({ claim, what }) => [" ", element("a", { href: `#claim=${claim}`, title: what },
                                                                   claim)]);
    return element("p", { class: "vw-small vw-poses" }, links.length ? "Poses of the claims:" : "", ...links);
}

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
