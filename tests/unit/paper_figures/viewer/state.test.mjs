// Reference: the definition of the view: colours, numbers, panels. An address and the view represent each other; an address of other origin
// is left alone.
import assert from "node:assert/strict";
import { test } from "node:test";
import { Run } from "../../../../paper_figures/viewer/src/data.js";
import { distance_shade, palette_of, ratio_shades, rgb_of, shade_of, shown, signed } from "../../../../paper_figures/viewer/src/legend.js";
import {
    State, draws_surface, hash_of, no_surface_because, panels_for, pose_of, range_of_sight,
} from "../../../../paper_figures/viewer/src/state.js";

test("there and back", () => {
    const pose = { run: "human_jump", frame: 12, colour: "error", panels: ["lbs", "nh_p1"], rendered: true,
                   cut: { axis: "x", at_m: -0.25, above: true }, bones: true, claim: "C02" };
    assert.deepEqual(pose_of(hash_of(pose)), pose);
});

test("a claim alone is enough", () => assert.deepEqual(pose_of("#claim=C05"), { claim: "C05" }));

test("addresses of the page's own sections are not ours", () => {
    assert.equal(pose_of(""), null);
    assert.equal(pose_of("#figures"), null);
});

test("nonsense is dropped", () => {
    assert.deepEqual(pose_of("#run=a&frame=-1&colour=pink&cut=w,0,above"), { run: "a", cut: null });
});

test("shades lie evenly between low and high and end there", () => {
    const shades = ["a", "b", "c"];
    assert.deepEqual([-9, 0.5, 0.9, 1, 1.5, 9].map((value) => shade_of(shades, 0.5, 1.5, value)), ["a", "a", "b", "b", "c", "c"]);
    assert.deepEqual([0, 25, 100].map((distance) => distance_shade(shades, 100, distance)), ["a", "b", "c"]);
});

test("an inverted tet has the colour of its own", () => {
    const shades = ["#000000", "#808080", "#ffffff"];
    const palette = palette_of({ ratio: { low: 0.5, high: 1.5, shades }, error: { shades }, skin: "#102030", inverted: "#ff0000" });
    const of_code = ratio_shades(palette, 127);
    assert.deepEqual([of_code[0], of_code[1], of_code[128], of_code[255]], [[1, 0, 0], [0, 0, 0], rgb_of("#808080"), [1, 1, 1]]);
});

test("numbers have three digits and a dash where none is on record", () => {
    assert.deepEqual([null, 0, -0.37149, 12.345, 1234.5].map(shown), ["\u2013", "0", "\u22120.371", "12.3", "1235"]);
    assert.equal(signed(5), "+5");
});

test("a run shows four panels, those asked for first", () => {
    const run = { reference: "nh_p1", labels: ["lbs", "dqs", "pbs", "nh_p1", "pbs_jiggle"] };
    assert.deepEqual(panels_for(run), ["lbs", "dqs", "pbs", "nh_p1"]);
    assert.deepEqual(panels_for(run, ["pbs_jiggle", "unheard_of"]), ["pbs_jiggle", "lbs", "dqs", "pbs"]);
});

test("the rendered surface is drawn where the body has one and nothing is cut", () => {
    const human = { surface: {} }, limb = { surface: null }, cut = { axis: "z", at_m: 0, above: false };
    assert.equal(draws_surface(human, { rendered: true, cut: null }), true);
    assert.equal(draws_surface(human, { rendered: false, cut: null }), false);
    for (const [run, asked, why] of [[limb, null, /surface but/], [limb, cut, /surface but/], [human, cut, /while the tets are cut/]]) {
        assert.equal(draws_surface(run, { rendered: true, cut: asked }), false);
        assert.match(no_surface_because(run, { cut: asked }), why);
    }
});

// Reference: geometry. From outside nothing of the sphere may be cut off; the ratio bounds how coarse depths are.
test("a body of any size lies within the range of sight", () => {
    for (const radius of [0.005, 1, 5000])
        for (const distance of [0, 0.5, 1.01, 6, 60].map((times) => times * radius)) {
            const { near, far } = range_of_sight(distance, radius);
            assert.ok(near > 0 && far === distance + radius && far / near <= 1000 * (1 + Number.EPSILON), `${distance} m`);
            if (distance > radius) assert.ok(near === distance - radius, `${distance} m`);
        }
});

test("no distance where the deformer or the reference did not reach the frame's pose", () => {
    const deformers = [{ label: "pbs", not_reached: [1] }, { label: "nh_p1", not_reached: [2] }];
    const run = Object.assign(Object.create(Run.prototype), { reference: "nh_p1", labels: ["pbs", "nh_p1"], deformers });
    assert.deepEqual([0, 1, 2].map((at) => run.reached("pbs", at)), [true, false, true]);
    assert.deepEqual([0, 1, 2].map((at) => run.has_errors("pbs", at)), [true, false, false]);
    assert.deepEqual([0, 1, 2].map((at) => run.has_errors("nh_p1", at)), [true, true, false]);
});

test("listeners hear what changed, and nothing when nothing did", () => {
    const state = new State({ at: 0, colour: "skin" }), heard = [];
    state.on_change((now, changed) => heard.push([now.at, ...changed]));
    state.set({ at: 0 });
    state.set({ at: 3, colour: "skin" });
    assert.deepEqual(heard, [[3, "at"]]);
});
