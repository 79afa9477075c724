// Reference: the definition. An address and the view represent each other; an address of other origin is left alone.
import assert from "node:assert/strict";
import { test } from "node:test";
import { hash_of, pose_of } from "../../../../paper_figures/viewer/src/state.js";

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
