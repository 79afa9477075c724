// The visible part of a run's tet mesh, computed once per run, and again when the cut moves.
import { kept_by, neighbours_of, seen_faces, triangles_of } from "./faces.js";

export class Meshes {
    constructor() {
        this.topologies = new Map();
    }

    // Returns the same object as long as run and cut stay the same.
    of(run, cut) {
        const key = JSON.stringify([run.name, cut]);
        if (this.key === key) return this.mesh;
        const { neighbours, outer } = this.topology(run);
        const kept = kept_by(cut, run.corners, run.rest);
        this.key = key;
        this.mesh = { run, neighbours, outer, kept, faces: seen_faces(neighbours, kept) };
        return this.mesh;
    }

    topology(run) {
        if (!this.topologies.has(run.name)) {
            const neighbours = neighbours_of(run.corners);
            const outer = seen_faces(neighbours, new Uint8Array(run.tets).fill(1));
            this.topologies.set(run.name, { neighbours, outer: triangles_of(run.corners, outer) });
        }
        return this.topologies.get(run.name);
    }
}
