// Reference: an affine map preserves barycentric coordinates, inside a tet and outside.
import assert from "node:assert/strict";
import { test } from "node:test";
import { carried } from "../../../../paper_figures/viewer/src/data.js";

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
