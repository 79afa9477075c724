// The state of the view, and the functions that are called when it changes.
//
// run, at        the name of the run, and the index of the frame
// panels         labels of the deformers that are shown
// colour         skin, error, contact, ratio or inverted
// rendered       the rendered surface instead of the tets' boundary, if the run has one and nothing is cut
// bones, cut     whether the skeleton is shown; { axis, at_m, above } or null
// claim          the claim whose pose this is, or null
// playing, follow, shifting: two fingers shift the view instead of turning it

export class State {
    constructor(first) {
        this.now = first;
        this.listeners = [];
    }

    on_change(listener) {
        this.listeners.push(listener);
    }

    set(changes) {
        const changed = Object.keys(changes).filter((key) => this.now[key] !== changes[key]);
        if (changed.length === 0) return;
        this.now = { ...this.now, ...changes };
        for (const listener of this.listeners) listener(this.now, new Set(changed));
    }
}

// The reason why the rendered surface cannot be shown; null if it can.
export function no_surface_because(run, now) {
    if (!run.surface) return "this body has no rendered surface but its tets' boundary";
    return now.cut ? "no rendered surface while the tets are cut" : null;
}

// Whether the rendered surface is drawn.
export function draws_surface(run, now) {
    return now.rendered && no_surface_because(run, now) === null;
}

// The panels that a run can show: the wanted ones that it has, at most four, or without any LBS, PBS and the reference,
// filled up to three with its others in order.
export function panels_for(run, wanted = []) {
    const kept = wanted.filter((label) => run.labels.includes(label));
    if (kept.length) return [...new Set(kept)].slice(0, 4);
    const usual = ["lbs", "pbs", run.reference].filter((label) => run.labels.includes(label));
    return [...new Set([...usual, ...run.labels])].slice(0, 3);
}

// The nearest and farthest distance [m] that a camera draws which is this far from the middle of a run, whose points
// lie within the radius: both follow the size of the model, from millimetres to kilometres. Nearer than a thousandth of
// the farthest, depths could not be distinguished.
export function range_of_sight(distance_m, radius_m) {
    const far = distance_m + radius_m;
    return { near: Math.max(distance_m - radius_m, far / 1000), far };
}

// Plays the recorded frames in a loop, as long as they are seen: at the speed of the motion, but each for a thirtieth
// to a sixth of a second, and the last one for half a second. Frames that the reference has no solution of are left
// out.
export function play(state, run_of, is_seen) {
    const shown_s = (at, next, times) => next > at ? Math.min(1 / 6, Math.max(1 / 30, times[next] - times[at])) : 0.5;
    const run = (since) => requestAnimationFrame((time) => {
        if (!state.now.playing) return;
        const { at } = state.now, next = run_of().played_after(at);
        const due = is_seen() && time - since >= 1000 * shown_s(at, next, run_of().times_s);
        if (due) state.set({ at: next });
        run(due ? time : since);
    });
    state.on_change((now, changed) => { if (changed.has("playing") && now.playing) run(performance.now()); });
}

// A pose as text in the address:
// #run=human_jump&frame=12&colour=error&panels=lbs,dqs,pbs,nh_p1&surface=rendered&cut=x,0.1,below&bones=1
//     &view=24,83,1.2,0,0,0&claim=C02
// view: the camera's direction [degrees], its distance and its shift, see Views.seen
export const colourings = ["skin", "error", "contact", "ratio", "inverted"];

// The pose that the address states; null if it is not an address of the viewer.
export function pose_of(hash) {
    const words = new URLSearchParams(hash.replace(/^#/, ""));
    if (!words.has("run") && !words.has("claim")) return null;
    const pose = {};
    if (words.has("run")) pose.run = words.get("run");
    if (/^\d+$/.test(words.get("frame") ?? "")) pose.frame = Number(words.get("frame"));
    if (colourings.includes(words.get("colour"))) pose.colour = words.get("colour");
    if (words.get("panels")) pose.panels = words.get("panels").split(",");
    if (words.has("surface")) pose.rendered = words.get("surface") === "rendered";
    if (words.has("cut")) pose.cut = cut_of(words.get("cut"));
    if (words.has("bones")) pose.bones = words.get("bones") === "1";
    if (words.get("claim")) pose.claim = words.get("claim");
    const view = (words.get("view") ?? "").split(",").map(Number);
    if (view.length === 6 && view.every(Number.isFinite) && view[2] > 0) pose.view = view;
    return pose;
}

export function hash_of(pose) {
    const words = [`run=${pose.run}`, `frame=${pose.frame}`, `colour=${pose.colour}`,
                   `panels=${pose.panels.join(",")}`];
    if (pose.cut)
        words.push(
            `cut=${pose.cut.axis},${Number(pose.cut.at_m.toPrecision(4))},${pose.cut.above ? "above" : "below"}`);
    if (pose.rendered) words.push("surface=rendered");
    if (pose.bones) words.push("bones=1");
    if (pose.view) words.push(`view=${pose.view.map((number) => Number(number.toPrecision(4))).join(",")}`);
    if (pose.claim) words.push(`claim=${encodeURIComponent(pose.claim)}`);
    return `#${words.join("&")}`;
}

function cut_of(text) {
    const [axis, at_m, side] = text.split(",");
    return /^[xyz]$/.test(axis) && Number.isFinite(Number(at_m)) ? { axis, at_m: Number(at_m), above: side === "above" }
        : null;
}
