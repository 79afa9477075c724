// The recorded runs of the page: header (JSON) and block (base64, gzip), which are read once.
import { codes_of, distances_mm, positions_of } from "./codes.js";
import { carried } from "./surface.js";

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
        Object.assign(this, rest, { bone_names: bones.names, surface: surface ? surface_of(surface, block) : null });
        this.block = block;
        this.corners = new Uint32Array(block, header.tet_corners, 4 * header.tets);
        this.rest = positions_of(new Uint16Array(block, header.rest_codes, 3 * header.vertices), header.rest_low_m, header.rest_step_m);
        this.bone_ends = new Float32Array(block, header.bones.ends, 6 * header.bones.names.length * header.frames.length);
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

    errors_mm(label, at, rendered) {
        return distances_mm(this.points(label, at, rendered), this.points(this.reference, at, rendered));
    }

    // The head and tail [m] of every bone.
    posed_bones(at) {
        const numbers = 6 * this.bone_names.length;
        return this.bone_ends.subarray(numbers * at, numbers * (at + 1));
    }

    // The lowest and highest coordinate at rest [m].
    rest_range(axis) {
        let low = Infinity, high = -Infinity;
        for (let i = "xyz".indexOf(axis); i < this.rest.length; i += 3) {
            low = Math.min(low, this.rest[i]);
            high = Math.max(high, this.rest[i]);
        }
        return [low, high];
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

    // Whether the solve of this frame reached its pose, according to the record.
    reached(label, at) {
        return !this.deformer(label).not_reached.includes(at);
    }

    // Whether a distance of this deformer from the reference is meaningful: both reached the pose of the frame.
    has_errors(label, at) {
        return this.labels.includes(this.reference) && this.reached(label, at) && this.reached(this.reference, at);
    }

    // The share of the volume [%] that distances from the reference leave out, because it overlaps itself there.
    masked_share_pct(at) {
        return Math.max(0, ...this.deformers.map((deformer) => deformer.figures.masked_share_pct[at] ?? 0));
    }

    // The index of the frame nearest to this number.
    place_of(frame) {
        let best = 0;
        this.frames.forEach((number, at) => { if (Math.abs(number - frame) < Math.abs(this.frames[best] - frame)) best = at; });
        return best;
    }

    // The largest recorded distance to the reference over all frames and deformers [mm].
    largest_error_mm() {
        const recorded = this.deformers.flatMap((deformer) => deformer.figures.error_linf_m).filter((value) => value !== null);
        return 1000 * Math.max(0, ...recorded);
    }
}

function surface_of(header, block) {
    const { points, triangles } = header;
    return { points, largest_sum: header.largest_sum, corners: new Uint32Array(block, header.corners, 3 * triangles),
             tets: new Uint32Array(block, header.tets, points), shares: new Float32Array(block, header.shares, 4 * points) };
}
