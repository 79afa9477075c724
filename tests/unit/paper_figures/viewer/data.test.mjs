// Reference: the definition of the packed bytes in viewer/data.py, by hand; an affine map preserves barycentric coordinates, inside a tet
// and outside.
import assert from "node:assert/strict";
import { test } from "node:test";
import { Run, carried, codes_of, distances_mm, positions_of, ratio_of } from "../../../../paper_figures/viewer/src/data.js";

test("frames are sums of differences modulo 65536", () => {
    // codes 65535 0 300, then 2 65534 300: differences 3 (past the top), -2, 0
    const low = [0xff, 0x00, 0x2c, 0x03, 0xfe, 0x00], high = [0xff, 0x00, 0x01, 0x00, 0xff, 0x00];
    assert.deepEqual([...codes_of(Uint8Array.from([...low, ...high]), 2, 3)], [65535, 0, 300, 2, 65534, 300]);
});

test("a position is its axis's low corner and so many steps", () => {
    assert.deepEqual([...positions_of(Uint16Array.from([0, 2, 4, 65535, 0, 0]), [-1, 1, 0], 0.5)], [-1, 2, 2, 32766.5, 1, 0]);
});

test("code 0 is an inverted tet, 128 a tet as at rest", () => {
    assert.equal(ratio_of(0, 127), -Infinity);
    assert.equal(ratio_of(1, 127), 0);
    assert.equal(ratio_of(128, 127), 1);
});

test("distances are in millimetres", () => {
    assert.deepEqual([...distances_mm(Float32Array.from([0, 0, 0, 3, 0, 4]), Float32Array.from([0, 0, 0, 0, 0, 0]))], [0, 5000]);
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
