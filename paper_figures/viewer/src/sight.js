// The direction and target of the camera: the body of the first frame, and later its motion.
import { Vector3 } from "three";

export class Sight {
    constructor(views) {
        this.views = views;
    }

    update(run, now, changed) {
        if (run.name !== this.run_name) {
            this.first(run, now);
        } else if (changed.has("at") && now.follow) {
            const middle = middle_of(run, now.at);
            this.views.follow(middle.clone().sub(this.middle));
            this.middle = middle;
        }
        if (!now.follow) this.middle = middle_of(run, now.at);
    }

    first(run, now) {
        this.run_name = run.name;
        this.middle = middle_of(run, now.at);
        this.views.look_at(this.middle, cloud_of(run, now.panels[0]));
    }
}

// The mean of the posed bones' ends [m], the same for all deformers.
function middle_of(run, at) {
    const ends = run.posed_bones(at), sum = new Vector3();
    for (let i = 0; i < ends.length; i += 3) sum.add(new Vector3(ends[i], ends[i + 1], ends[i + 2]));
    return sum.divideScalar(ends.length / 3);
}

// Points of the body relative to its middle [m] in some frames of the run, enough to determine the space that it takes.
function cloud_of(run, label) {
    const points = [];
    for (let at = 0; at < run.frames.length; at += 3) {
        const positions = run.positions(label, at), middle = middle_of(run, at);
        for (let v = 0; v < run.vertices; v += 5)
            points.push(new Vector3(positions[3 * v], positions[3 * v + 1], positions[3 * v + 2]).sub(middle));
    }
    return points;
}

// Whether it takes more space horizontally than vertically.
export function is_wide(run) {
    const [left, right] = run.rest_range("x"), [low, high] = run.rest_range("y");
    return right - left > 1.5 * (high - low);
}
