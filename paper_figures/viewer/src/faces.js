// The faces of a tet mesh, which are visible if only some tets are kept, the normals of a surface, and its shadow.

// Face i is opposite corner i; outwards for positive volumes.
const face_corners = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

// The tet behind each face, 4 x tets; -1 if there is none.
export function neighbours_of(corners) {
    const neighbours = new Int32Array(corners.length).fill(-1);
    const open = new Map();
    for (let face = 0; face < corners.length; ++face) {
        const key = face_of(corners, face).sort((a, b) => a - b).join();
        const other = open.get(key);
        if (other === undefined) {
            open.set(key, face);
        } else {
            neighbours[face] = other >> 2;
            neighbours[other] = face >> 2;
        }
    }
    return neighbours;
}

// The three vertices of face 4 tet + i.
export function face_of(corners, face) {
    const tet = face & ~3;
    return face_corners[face & 3].map((corner) => corners[tet + corner]);
}

// Faces between a kept tet and no tet, or one that is left out.
export function seen_faces(neighbours, kept) {
    const faces = [];
    for (let face = 0; face < neighbours.length; ++face)
        if (kept[face >> 2] && (neighbours[face] < 0 || !kept[neighbours[face]])) faces.push(face);
    return faces;
}

// Marks the tets whose centre at rest lies below the plane (or above it) by 1. Without a plane: all.
export function kept_by(cut, corners, rest) {
    const kept = new Uint8Array(corners.length / 4).fill(1);
    if (!cut) return kept;
    const axis = "xyz".indexOf(cut.axis);
    for (let tet = 0; tet < kept.length; ++tet) {
        let sum = 0;
        for (let corner = 0; corner < 4; ++corner) sum += rest[3 * corners[4 * tet + corner] + axis];
        kept[tet] = (sum / 4 <= cut.at_m) !== cut.above ? 1 : 0;
    }
    return kept;
}

// The three vertices of each face, one face after the other.
export function triangles_of(corners, faces) {
    return Uint32Array.from(faces.flatMap((face) => face_of(corners, face)));
}

// Normals (not normalised) at the vertices of a surface, weighted by the areas of the triangles; x y z of each vertex
// of the mesh.
export function vertex_normals(positions, triangles) {
    const normals = new Float32Array(positions.length);
    for (let at = 0; at < triangles.length; at += 3) {
        const corners = triangles.subarray(at, at + 3), normal = area_normal(positions, ...corners);
        for (const v of corners) for (let axis = 0; axis < 3; ++axis) normals[3 * v + axis] += normal[axis];
    }
    return normals;
}

// (b - a) x (c - a)
export function area_normal(p, a, b, c) {
    const ux = p[3 * b] - p[3 * a], uy = p[3 * b + 1] - p[3 * a + 1], uz = p[3 * b + 2] - p[3 * a + 2];
    const vx = p[3 * c] - p[3 * a], vy = p[3 * c + 1] - p[3 * a + 1], vz = p[3 * c + 2] - p[3 * a + 2];
    return [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
}

// The soft shadow of points on the ground below them: one byte per cell of the square around (x, z), row by row. A
// point counts less the higher it is.
export const cells = 64;
const passes = 2;

export function shadow_of(points, x, z, height_m, half_m) {
    let above = new Float32Array(cells * cells);
    const cell_of = (away) => Math.floor((away / half_m + 1) / 2 * cells), is_in = (cell) => cell >= 0 && cell < cells;
    for (let i = 0; i < points.length; i += 3) {
        const across = cell_of(points[i] - x), along = cell_of(points[i + 2] - z);
        if (is_in(across) && is_in(along))
            above[along * cells + across] += 1 / (1 + 4 * Math.max(0, points[i + 1] - height_m) / half_m);
    }
    const covered = above.filter((value) => value > 0),
        usual = covered.reduce((a, b) => a + b, 0) / (covered.length || 1);
    for (let pass = 0; pass < passes; ++pass) above = blurred(blurred(above, 1), cells);
    return Uint8Array.from(above, (value) => 255 * (1 - Math.exp(-value / (usual || 1))));
}

// The mean of three neighbours in one direction.
function blurred(values, stride) {
    return values.map((value, at) => (value + (values[at - stride] ?? 0) + (values[at + stride] ?? 0)) / 3);
}

// The visible part of a run's tet mesh, computed once per run, and again when the cut moves.
export class Meshes {
    constructor() {
        this.topologies = new Map();
    }

    // Returns the same object as long as run and cut stay the same.
    of(run, cut) {
        const key = JSON.stringify([run.name, cut]);
        if (this.key === key) return this.mesh;
        if (!this.topologies.has(run.name)) {
            const neighbours = neighbours_of(run.corners), outer = seen_faces(neighbours, kept_by(null, run.corners));
            this.topologies.set(run.name, { neighbours, outer: triangles_of(run.corners, outer) });
        }
        const topology = this.topologies.get(run.name), kept = kept_by(cut, run.corners, run.rest);
        this.key = key;
        this.mesh = { run, ...topology, kept, faces: seen_faces(topology.neighbours, kept) };
        return this.mesh;
    }
}
