// Reference: geometry. The faces of a closed surface enclose the body's volume and point outwards.
import assert from "node:assert/strict";
import { test } from "node:test";
import { area_normal, face_of, kept_by, neighbours_of, seen_faces, triangles_of, vertex_normals }
    from "../../../../paper_figures/viewer/src/faces.js";

// The unit cube in five tets, each of positive volume.
const points = Float32Array.from([0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1, 1, 1, 1]);
const corners = Uint32Array.from([0, 1, 2, 4, 1, 3, 2, 7, 1, 7, 4, 5, 2, 4, 7, 6, 1, 2, 4, 7]);
const all = new Uint8Array(5).fill(1);

function volume_within(faces) {
    return faces.reduce((sum, face) => {
        const [a, b, c] = face_of(corners, face);
        const normal = area_normal(points, a, b, c);
        return sum + (normal[0] * points[3 * a] + normal[1] * points[3 * a + 1] + normal[2] * points[3 * a + 2]) / 6;
    }, 0);
}

test("the surface of the whole cube", () => {
    const faces = seen_faces(neighbours_of(corners), all);
    assert.equal(faces.length, 12);
    assert.ok(Math.abs(volume_within(faces) - 1) < 1e-6);
});

test("without a corner the surface closes round what is left", () => {
    const faces = seen_faces(neighbours_of(corners), Uint8Array.from([0, 1, 1, 1, 1]));
    assert.ok(Math.abs(volume_within(faces) - 5 / 6) < 1e-6);
});

test("a cut keeps the tets whose centre lies on its side", () => {
    assert.deepEqual([...kept_by(null, corners, points)], [1, 1, 1, 1, 1]);
    assert.deepEqual([...kept_by({ axis: "z", at_m: 0.4, above: false }, corners, points)], [1, 1, 0, 0, 0]);
    assert.deepEqual([...kept_by({ axis: "z", at_m: 0.4, above: true }, corners, points)], [0, 0, 1, 1, 1]);
});

test("normals of a cube's corners point away from its middle", () => {
    const normals = vertex_normals(points, triangles_of(corners, seen_faces(neighbours_of(corners), all)));
    for (let i = 0; i < points.length; ++i) assert.equal(Math.sign(normals[i]), points[i] === 1 ? 1 : -1);
});
