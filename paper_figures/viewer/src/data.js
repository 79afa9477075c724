// The recorded runs of the page: header (JSON) and block (base64, gzip), which are read once, and the decoding of their
// bytes, which viewer/data.py encodes: positions on a grid, volume ratios, float32 bone ends.

export async function read_page() {
    const header = JSON.parse(document.getElementById("viewer-header").textContent);
    const block = await unpacked(document.getElementById("viewer-block").textContent);
    return { ...header, runs: header.runs.map((run) => new Run(run, block)) };
}

async function unpacked(base64) {
    const packed = Uint8Array.from(atob(base64.trim()), (letter) => letter.charCodeAt(0));
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
    return new Response(stream).arrayBuffer();
}

// One run: the fields of its header, its arrays as views, and its frames by their index in `frames`.
export class Run {
    constructor(header, block) {
        const { bones, surface, ...rest } = header;
        Object.assign(this, rest, { block, bone_names: bones.names, surface: surface && {
            points: surface.points, largest_sum: surface.largest_sum, of_joints: surface.of_joints,
            corners: new Uint32Array(block, surface.corners, 3 * surface.triangles),
            tets: new Uint32Array(block, surface.tets, surface.points),
            shares: new Float32Array(block, surface.shares, 4 * surface.points),
        } });
        this.corners = new Uint32Array(block, header.tet_corners, 4 * header.tets);
        this.rest = positions_of(new Uint16Array(block, header.rest_codes, 3 * header.vertices), header.rest_low_m,
                                 header.rest_step_m);
        this.bone_ends = new Float32Array(block, bones.ends, 6 * bones.names.length * header.frames.length);
        this.labels = header.deformers.map((deformer) => deformer.label);
        this.codes = new Map();
    }

    deformer(label) {
        return this.deformers.find((deformer) => deformer.label === label);
    }

    positions(label, at) {
        const numbers = 3 * this.vertices;
        if (!this.codes.has(label)) {
            const bytes = new Uint8Array(this.block, this.deformer(label).positions, 2 * numbers * this.frames.length);
            this.codes.set(label, codes_of(bytes, this.frames.length, numbers));
        }
        return positions_of(this.codes.get(label).subarray(numbers * at, numbers * (at + 1)), this.low_m, this.step_m);
    }

    ratio_codes(label, at) {
        return new Uint8Array(this.block, this.deformer(label).ratios + at * this.tets, this.tets);
    }

    // Positions [m] of the points that are drawn: the tets' vertices, or the points of the rendered surface.
    points(label, at, rendered) {
        const positions = this.positions(label, at);
        return rendered ? carried(this.surface, this.corners, positions) : positions;
    }

    // The codes of contact of the points that are drawn: 0 none, 1 touching, more: overlap in steps. A point of the
    // rendered surface has the highest code of its tet's corners. Null if the frames were written without.
    contact_codes(label, at, rendered) {
        const { contact } = this.deformer(label);
        if (contact === undefined) return null;
        const codes = new Uint8Array(this.block, contact + at * this.vertices, this.vertices);
        if (!rendered) return codes;
        return Uint8Array.from(this.surface.tets,
                               (tet) => Math.max(...this.corners.subarray(4 * tet, 4 * tet + 4).map((v) => codes[v])));
    }

    has_contact() {
        return this.deformers.some(({ contact }) => contact !== undefined);
    }

    errors_mm(label, at, rendered) {
        return distances_mm(this.points(label, at, rendered), this.points(this.reference, at, rendered), this.mm_per_m);
    }

    // The head and tail [m] of every bone.
    posed_bones(at) {
        const numbers = 6 * this.bone_names.length;
        return this.bone_ends.subarray(numbers * at, numbers * (at + 1));
    }

    // A sphere around all points and bones of all frames [m]: the grid's cube, enlarged by the bones.
    sphere() {
        const half = 65535 / 2 * this.step_m, middle = this.low_m.map((low) => low + half);
        let radius = Math.sqrt(3) * half;
        for (let i = 0; i < this.bone_ends.length; i += 3)
            radius = Math.max(radius, Math.hypot(...middle.map((at, axis) => this.bone_ends[i + axis] - at)));
        return { middle, radius };
    }

    // The lowest and highest coordinate at rest [m].
    rest_range(axis) {
        const at = "xyz".indexOf(axis), coordinates = this.rest.filter((_, i) => i % 3 === at);
        return [coordinates.reduce((a, b) => Math.min(a, b)), coordinates.reduce((a, b) => Math.max(a, b))];
    }

    // The position of the cut, moved by hundredths of the body [m].
    stepped(cut, by) {
        const [low, high] = this.rest_range(cut.axis);
        return Math.min(high, Math.max(low, cut.at_m + by * (high - low) / 100));
    }

    // A recorded number of one frame; null if the record has none.
    figure(label, column, at) {
        return this.deformer(label).figures[column][at];
    }

    // Whether some frame of some deformer has this number.
    has_figure(column) {
        return this.deformers.some((deformer) => deformer.figures[column].some((value) => value !== null));
    }

    // Whether the solve of this frame reached its pose, according to the record.
    reached(label, at) {
        return !this.deformer(label).not_reached.includes(at);
    }

    // What a panel says of a frame without a solution: the frame whose shape it shows, if that is another one.
    unreached_words(label, at) {
        const shown = this.deformer(label).states?.[at] ?? this.frames[at];
        return shown === this.frames[at] ? "pose not reached" : `not solved: the pose of frame ${shown}`;
    }

    // The frame that is played after this one: one with a solution of the reference, if that has two or more.
    played_after(at) {
        const places = this.frames.map((_, place) => place);
        const solved = this.labels.includes(this.reference)
            ? places.filter((place) => this.reached(this.reference, place)) : places;
        const played = solved.length > 1 ? solved : places;
        return played.find((place) => place > at) ?? played[0];
    }

    // Whether a distance of this deformer from the reference is meaningful: both reached the pose of the frame.
    has_errors(label, at) {
        return this.labels.includes(this.reference) && this.reached(label, at) && this.reached(this.reference, at);
    }

    // The share of the volume [%] that distances from the reference leave out: tips of its creases.
    masked_share_pct(at) {
        return Math.max(0, ...this.deformers.map((deformer) => deformer.figures.masked_share_pct[at] ?? 0));
    }

    // The index of the frame nearest to this number.
    place_of(frame) {
        const away = this.frames.map((number) => Math.abs(number - frame));
        return away.indexOf(Math.min(...away));
    }

    // The height of the ground [m]: the lowest point of the reference, or else of the first deformer, in any frame.
    ground_m() {
        this.ground ??= this.frames.reduce((lowest, _, at) => {
            const positions = this.positions(this.labels.includes(this.reference) ? this.reference : this.labels[0],
                                             at);
            for (let i = 1; i < positions.length; i += 3) lowest = Math.min(lowest, positions[i]);
            return lowest;
        }, Infinity);
        return this.ground;
    }
}

// Converts differences from the previous frame, low bytes then high bytes, to codes frame by frame.
export function codes_of(bytes, frames, numbers) {
    const count = frames * numbers;
    const codes = new Uint16Array(count);
    for (let i = 0; i < count; ++i) {
        const difference = bytes[i] | (bytes[count + i] << 8);
        codes[i] = i < numbers ? difference : codes[i - numbers] + difference;  // modulo 65536
    }
    return codes;
}

// Positions [m], x y z of each vertex, from the codes of one frame.
export function positions_of(codes, low_m, step_m) {
    const positions = new Float32Array(codes.length);
    for (let i = 0; i < codes.length; ++i) positions[i] = low_m[i % 3] + step_m * codes[i];
    return positions;
}

// 0: inverted; otherwise (code - 1) / steps.
export function ratio_of(code, steps) {
    return code === 0 ? -Infinity : (code - 1) / steps;
}

// The distance of each vertex from that of the reference, in millimetres of a body of 1.7 m.
export function distances_mm(positions, reference, mm_per_m) {
    const distances = new Float32Array(positions.length / 3);
    for (let v = 0; v < distances.length; ++v)
        distances[v] = mm_per_m * Math.hypot(positions[3 * v] - reference[3 * v],
                                             positions[3 * v + 1] - reference[3 * v + 1],
                                             positions[3 * v + 2] - reference[3 * v + 2]);
    return distances;
}

// x y z of each point of the rendered surface, which the tets carry: the weighted sum of its tet's corners.
// surface: { points, tets, shares } (the tet of each point, and four weights each); corners: of the tets.
export function carried(surface, corners, positions) {
    const { points, tets, shares } = surface, to = new Float32Array(3 * points);
    for (let point = 0; point < points; ++point)
        for (let corner = 0; corner < 4; ++corner) {
            const share = shares[4 * point + corner], v = corners[4 * tets[point] + corner];
            for (let axis = 0; axis < 3; ++axis) to[3 * point + axis] += share * positions[3 * v + axis];
        }
    return to;
}
