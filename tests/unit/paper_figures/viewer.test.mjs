// Reference: the definition of the packed bytes in viewer/data.py, by hand; an affine map preserves barycentric
// coordinates, inside a tet and outside. The faces of a closed surface enclose the body's volume and point outwards.
// The page handles gestures with one finger, the view those with two. An address and the view represent each other; an
// address of other origin is left alone.
import assert from "node:assert/strict";
import { test } from "node:test";
import { Run, carried, codes_of, distances_mm, positions_of,
         ratio_of } from "../../../paper_figures/viewer/src/data.js";
import {
    area_normal, face_of, kept_by, neighbours_of, seen_faces, shadow_of, triangles_of, vertex_normals,
} from "../../../paper_figures/viewer/src/faces.js";
import { keep_level, leave_scrolling } from "../../../paper_figures/viewer/src/input.js";
import { first_numbers, palette_of, ratio_shades, rgb_of, shade_of, shown,
         signed } from "../../../paper_figures/viewer/src/legend.js";
import {
    State, draws_surface, hash_of, no_surface_because, panels_for, pose_of, range_of_sight,
} from "../../../paper_figures/viewer/src/state.js";

test("frames are sums of differences modulo 65536", () => {
    // codes 65535 0 300, then 2 65534 300: differences 3 (past the top), -2, 0
    const low = [0xff, 0x00, 0x2c, 0x03, 0xfe, 0x00], high = [0xff, 0x00, 0x01, 0x00, 0xff, 0x00];
    assert.deepEqual([...codes_of(Uint8Array.from([...low, ...high]), 2, 3)], [65535, 0, 300, 2, 65534, 300]);
});

test("a position is its axis's low corner and so many steps", () => {
    assert.deepEqual([...positions_of(Uint16Array.from([0, 2, 4, 65535, 0, 0]), [-1, 1, 0], 0.5)],
                     [-1, 2, 2, 32766.5, 1, 0]);
});

test("code 0 is an inverted tet, 128 a tet as at rest", () => {
    assert.equal(ratio_of(0, 127), -Infinity);
    assert.equal(ratio_of(1, 127), 0);
    assert.equal(ratio_of(128, 127), 1);
});

test("distances are in millimetres", () => {
    assert.deepEqual([...distances_mm(Float32Array.from([0, 0, 0, 3, 0, 4]), Float32Array.from([0, 0, 0, 0, 0, 0]),
                                      1000)], [0, 5000]);
});

const corners = Uint32Array.from([4, 0, 1, 2, 0, 1, 2, 3]);  // the second tet is the unit one
const rest = Float32Array.from([0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 9, 9, 9]);
const surface = { points: 3, tets: Uint32Array.from([1, 1, 0]),
                  shares: Float32Array.from([0.25, 0.25, 0.25, 0.25, -0.5, 0.5, 0.5, 0.5, 1, 0, 0, 0]) };

test("points lie where their shares put them", () => {
    assert.deepEqual([...carried(surface, corners, rest)], [0.25, 0.25, 0.25, 0.5, 0.5, 0.5, 9, 9, 9]);
});

test("they are carried along", () => {
    const moved = rest.map((value, i) => 2 * value + [1, 0, -4][i % 3]);
    assert.deepEqual([...carried(surface, corners, moved)], [1.5, 0.5, -3.5, 2, 1, -3, 19, 18, 14]);
});

test("the sphere of a run holds its grid and its bones", () => {
    const grid = { low_m: [-1, -1, 4], step_m: 2 / 65535 };
    const sphere_of = (bone_ends) => Object.assign(Object.create(Run.prototype), { ...grid, bone_ends }).sphere();
    const { middle, radius } = sphere_of([0, 0, 5, 1, 0, 5]);
    assert.deepEqual(middle, [0, 0, 5]);
    assert.equal(radius, Math.sqrt(3));
    assert.equal(sphere_of([0, 0, 5, 3, 4, 5]).radius, 5);
});

// The unit cube in five tets, each of positive volume.
const points = Float32Array.from([0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1, 1, 1, 1]);
const cube = Uint32Array.from([0, 1, 2, 4, 1, 3, 2, 7, 1, 7, 4, 5, 2, 4, 7, 6, 1, 2, 4, 7]);
const all = new Uint8Array(5).fill(1);

function volume_within(faces) {
    return faces.reduce((sum, face) => {
        const [a, b, c] = face_of(cube, face);
        const normal = area_normal(points, a, b, c);
        return sum + (normal[0] * points[3 * a] + normal[1] * points[3 * a + 1] + normal[2] * points[3 * a + 2]) / 6;
    }, 0);
}

test("the surface of the whole cube", () => {
    const faces = seen_faces(neighbours_of(cube), all);
    assert.equal(faces.length, 12);
    assert.ok(Math.abs(volume_within(faces) - 1) < 1e-6);
});

test("without a corner the surface closes round what is left", () => {
    const faces = seen_faces(neighbours_of(cube), Uint8Array.from([0, 1, 1, 1, 1]));
    assert.ok(Math.abs(volume_within(faces) - 5 / 6) < 1e-6);
});

test("a cut keeps the tets whose centre lies on its side", () => {
    assert.deepEqual([...kept_by(null, cube, points)], [1, 1, 1, 1, 1]);
    assert.deepEqual([...kept_by({ axis: "z", at_m: 0.4, above: false }, cube, points)], [1, 1, 0, 0, 0]);
    assert.deepEqual([...kept_by({ axis: "z", at_m: 0.4, above: true }, cube, points)], [0, 0, 1, 1, 1]);
});

test("normals of a cube's corners point away from its middle", () => {
    const normals = vertex_normals(points, triangles_of(cube, seen_faces(neighbours_of(cube), all)));
    for (let i = 0; i < points.length; ++i) assert.equal(Math.sign(normals[i]), points[i] === 1 ? 1 : -1);
});

function panel() {
    const element = Object.assign(new EventTarget(), { style: { touchAction: "none" } });
    leave_scrolling(element);
    return element;
}

// Whether the page is prevented from scrolling and zooming.
function is_kept(gesture, fingers, cancelable = true) {
    const event = Object.assign(new Event(gesture, { cancelable }), { touches: Array(fingers).fill({}) });
    panel().dispatchEvent(event);
    return event.defaultPrevented;
}

test("the page may scroll up and down under one finger", () => {
    assert.equal(panel().style.touchAction, "pan-y");
    for (const gesture of ["touchstart", "touchmove"]) assert.equal(is_kept(gesture, 1), false, gesture);
});

test("under two fingers it stays", () => {
    for (const gesture of ["touchstart", "touchmove"]) assert.equal(is_kept(gesture, 2), true, gesture);
});

test("a scrolling that has begun is not stopped", () => assert.equal(is_kept("touchmove", 2, false), false));

test("one finger leaves the tilt as it is, two are free, and so is a mouse", () => {
    const element = new EventTarget();
    const controls = { angle: 1, minPolarAngle: 0, maxPolarAngle: Math.PI, update() {},
                       getPolarAngle() { return this.angle; } };
    keep_level(element, controls);
    const after = (change, pointerId, pointerType = "touch") => {
        element.dispatchEvent(Object.assign(new Event(change), { pointerId, pointerType }));
        return [controls.minPolarAngle, controls.maxPolarAngle];
    };
    const free = [0, Math.PI];
    assert.deepEqual(after("pointerdown", 1), [1, 1]);
    assert.deepEqual(after("pointerdown", 2), free);
    controls.angle = 2;
    assert.deepEqual(after("pointerup", 1), [2, 2]);
    assert.deepEqual(after("pointercancel", 2), free);
    assert.deepEqual(after("pointerdown", 3, "mouse"), free);
});

test("there and back", () => {
    const pose = { run: "human_jump", frame: 12, colour: "error", panels: ["lbs", "nh_p1"], rendered: true, bones: true,
                   cut: { axis: "x", at_m: -0.25, above: true }, view: [24.5, 83, 1.25, 0, -0.5, 0.125], claim: "C02" };
    assert.deepEqual(pose_of(hash_of(pose)), pose);
});

test("a claim alone is enough", () => assert.deepEqual(pose_of("#claim=C05"), { claim: "C05" }));

test("addresses of the page's own sections are not ours", () => {
    assert.equal(pose_of(""), null);
    assert.equal(pose_of("#figures"), null);
});

test("nonsense is dropped", () => {
    assert.deepEqual(pose_of("#run=a&frame=-1&colour=pink&cut=w,0,above&view=1,2,0,0,0,0"), { run: "a", cut: null });
});

test("shades lie evenly between low and high and end there", () => {
    const shades = ["a", "b", "c"];
    assert.deepEqual([-9, 0.5, 0.9, 1, 1.5, 9].map((value) => shade_of(shades, 0.5, 1.5, value)),
                     ["a", "a", "b", "b", "c", "c"]);
});

test("an inverted tet has the colour of its own", () => {
    const shades = ["#000000", "#808080", "#ffffff"];
    const palette = palette_of({ ratio: { low: 0.5, high: 1.5, shades }, error: { shades },
                                 contact: { touching: "#00ff00", shades }, skin: "#102030", inverted: "#ff0000" });
    const of_code = ratio_shades(palette, 127);
    assert.deepEqual([of_code[0], of_code[1], of_code[128], of_code[255]],
                     [[1, 0, 0], [0, 0, 0], rgb_of("#808080"), [1, 1, 1]]);
});

test("numbers have three digits and a dash where none is on record", () => {
    assert.deepEqual([null, 0, -0.37149, 12.345, 1234.5].map(shown), ["\u2013", "0", "\u22120.371", "12.3", "1235"]);
    assert.equal(signed(5), "+5");
});

test("a run shows LBS, PBS and the reference, or the panels that are asked for, at most four", () => {
    const run = { reference: "nh_p1", labels: ["lbs", "dqs", "pbs", "nh_p1", "pbs_jiggle"] };
    assert.deepEqual(panels_for(run), ["lbs", "pbs", "nh_p1"]);
    assert.deepEqual(panels_for({ reference: "", labels: ["lbs", "dqs", "pbs"] }), ["lbs", "pbs", "dqs"]);
    assert.deepEqual(panels_for(run, ["pbs_jiggle", "unheard_of"]), ["pbs_jiggle"]);
    assert.deepEqual(panels_for(run, run.labels), ["lbs", "dqs", "pbs", "nh_p1"]);
});

test("the first numbers are those of the frame; without a distance the volume alone", () => {
    const figures = { lbs: { skin_rms_mm: 12.345, volume_change_pct: -8 },
                      pbs: { skin_rms_mm: null, volume_change_pct: 1 } };
    const run = { reference: "nh_p1", has_errors: () => true, figure: (label, column) => figures[label]?.[column]
                  ?? null };
    assert.equal(first_numbers(run, "lbs", 0), "12.3\u202fmm from the reference, volume \u22128\u202f%");
    assert.equal(first_numbers(run, "pbs", 0), "volume +1\u202f%");
    assert.equal(first_numbers(run, "nh_p1", 0), "the reference");
});

test("the shadow is dark under the body, and lighter under what is high above the ground", () => {
    const low = shadow_of([0, 0, 0, 0.5, 1, 0.5], 0, 0, 0, 1),
        at = (x, z) => low[Math.floor((z + 1) * 32) * 64 + Math.floor((x + 1) * 32)];
    assert.ok(at(0, 0) > at(0.5, 0.5) && at(0.5, 0.5) > at(-0.8, -0.8));
    assert.equal(at(-0.8, -0.8), 0);
});

test("the rendered surface is drawn where the body has one and nothing is cut", () => {
    const human = { surface: {} }, limb = { surface: null }, cut = { axis: "z", at_m: 0, above: false };
    assert.equal(draws_surface(human, { rendered: true, cut: null }), true);
    assert.equal(draws_surface(human, { rendered: false, cut: null }), false);
    for (const [run, asked, why] of [[limb, null, /surface but/], [limb, cut, /surface but/],
                                     [human, cut, /while the tets are cut/]]) {
        assert.equal(draws_surface(run, { rendered: true, cut: asked }), false);
        assert.match(no_surface_because(run, { cut: asked }), why);
    }
});

// Reference: geometry. From outside nothing of the sphere may be cut off; the ratio bounds how coarse depths are.
test("a body of any size lies within the range of sight", () => {
    for (const radius of [0.005, 1, 5000])
        for (const distance of [0, 0.5, 1.01, 6, 60].map((times) => times * radius)) {
            const { near, far } = range_of_sight(distance, radius);
            assert.ok(near > 0 && far === distance + radius && far / near <= 1000 * (1 + Number.EPSILON),
                      `${distance} m`);
            if (distance > radius) assert.ok(near === distance - radius, `${distance} m`);
        }
});

test("no distance where the deformer or the reference did not reach the frame's pose", () => {
    const deformers = [{ label: "pbs", not_reached: [1] }, { label: "nh_p1", not_reached: [2] }];
    const run = Object.assign(Object.create(Run.prototype), { reference: "nh_p1", labels: ["pbs", "nh_p1"],
                                                              deformers });
    assert.deepEqual([0, 1, 2].map((at) => run.reached("pbs", at)), [true, false, true]);
    assert.deepEqual([0, 1, 2].map((at) => run.has_errors("pbs", at)), [true, false, false]);
    assert.deepEqual([0, 1, 2].map((at) => run.has_errors("nh_p1", at)), [true, true, false]);
});

test("frames that the reference has no solution of are not played, and name the pose that they show", () => {
    const deformers = [{ label: "pbs", not_reached: [] }, { label: "nh_p1", not_reached: [1, 2, 4],
                                                            states: [0, 0, 0, 30, 30] }];
    const run = Object.assign(Object.create(Run.prototype),
                              { reference: "nh_p1", labels: ["pbs", "nh_p1"], deformers, frames: [0, 10, 20, 30, 40] });
    assert.deepEqual([0, 1, 2, 3, 4].map((at) => run.played_after(at)), [3, 3, 3, 0, 0]);
    assert.equal(run.unreached_words("nh_p1", 2), "not solved: the pose of frame 0");
    run.reference = "none";
    assert.deepEqual([0, 4].map((at) => run.played_after(at)), [1, 0]);
});

test("listeners hear what changed, and nothing when nothing did", () => {
    const state = new State({ at: 0, colour: "skin" }), heard = [];
    state.on_change((now, changed) => heard.push([now.at, ...changed]));
    state.set({ at: 0 });
    state.set({ at: 3, colour: "skin" });
    assert.deepEqual(heard, [[3, "at"]]);
});
