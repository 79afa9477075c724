// Draws all panels with one WebGL context: each canvas shows a scissored part, one camera serves all, and every panel
// has controls. The camera points at the body of the first frame, and later follows its motion.
import { Color, ColorManagement, LinearSRGBColorSpace, PerspectiveCamera, Scene, Spherical, TOUCH, Vector3,
         WebGLRenderer } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { keep_level, leave_scrolling } from "./input.js";
import { range_of_sight } from "./state.js";

ColorManagement.enabled = false;  // colours appear on the screen as in the legend
const most_pixels_per_point = 2;
const first_direction = new Vector3(0.45, 0.12, 1).normalize();

export class Views {
    constructor(canvas, on_move) {
        this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
        this.renderer.outputColorSpace = LinearSRGBColorSpace;
        this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, most_pixels_per_point));
        this.renderer.autoClear = false;
        this.camera = new PerspectiveCamera(18);
        this.target = new Vector3();
        this.on_move = on_move;
        this.views = [];
        this.stage = { paper: new Color(), shade: new Color() };
    }

    // Takes the colours of background and ground from the page's style, which may be light or dark.
    take_colours(root) {
        const style = getComputedStyle(root);
        for (const name of ["paper", "shade"]) this.stage[name].set(style.getPropertyValue(`--vw-${name}`).trim());
    }

    // Makes a view for each of these elements, with the contents of its scene.
    show(elements, contents) {
        for (const view of this.views) view.controls.dispose();
        this.views = elements.map((element, at) => {
            const scene = new Scene();
            scene.background = this.stage.paper;
            scene.add(...contents[at]);
            const controls = new OrbitControls(this.camera, element);
            controls.target = this.target;
            leave_scrolling(element);
            keep_level(element, controls);
            controls.update();
            controls.addEventListener("change", this.on_move);
            return { element, scene, controls };
        });
    }

    // One finger turns the view; two fingers zoom, and shift or turn it.
    two_fingers(shift) {
        const touches = { ONE: TOUCH.ROTATE, TWO: shift ? TOUCH.DOLLY_PAN : TOUCH.DOLLY_ROTATE };
        for (const { controls } of this.views) controls.touches = touches;
    }

    // Points the camera at the middle of what it sees of a cloud of points around this middle [m], at a distance from
    // which all are in the panel.
    look_at(middle, cloud) {
        const right = new Vector3(first_direction.z, 0, -first_direction.x).normalize();
        const up = new Vector3().crossVectors(first_direction, right);
        const slope = Math.tan(this.camera.fov / 2 * Math.PI / 180), aspect = this.aspect();
        const shift = new Vector3();
        for (const axis of [right, up]) {
            const along = cloud.map((point) => point.dot(axis));
            shift.addScaledVector(axis,
                                  along.reduce((a, b) => Math.min(a, b)) / 2 + along.reduce((a, b) => Math.max(a, b))
                                  / 2);
        }
        const distances = cloud.map((point) => point.clone().sub(shift)).map((point) => point.dot(first_direction)
            + Math.max(Math.abs(point.dot(up)), Math.abs(point.dot(right)) / aspect) / slope);
        this.target.copy(middle).add(shift);
        this.first_distance = 1.03 * Math.max(...distances);
        this.camera.position.copy(this.target).addScaledVector(first_direction, this.first_distance);
        this.camera.lookAt(this.target);
    }

    aspect() {
        const box = this.views[0].element.getBoundingClientRect();
        return box.height > 0 ? box.width / box.height : 1;
    }

    // Points the camera at the body of a new run, and moves it with the body.
    update(run, now, changed) {
        if (run.name !== this.run_name) return this.first(run, now);
        if (changed.has("panels")) this.fit_again(run, now);
        const middle = middle_of(run, now.at);
        if (changed.has("at") && now.follow) this.move(middle.clone().sub(this.middle));
        if (changed.has("at") || !now.follow) this.middle = middle;
    }

    first(run, now) {
        this.run_name = run.name;
        const { middle, radius } = run.sphere();
        this.sphere = { middle: new Vector3(...middle), radius };
        this.middle = middle_of(run, now.at);
        this.look_at(this.middle, cloud_of(run, now.panels[0]));
    }

    // After a change of the panels' width, the camera is as far from its target in parts of the first distance as
    // before.
    fit_again(run, now) {
        const seen = this.seen();
        this.look_at(this.middle, cloud_of(run, now.panels[0]));
        this.see(seen);
    }

    move(step) {
        this.target.add(step);
        this.camera.position.add(step);
    }

    // The camera relative to the target: direction around and from above [degrees] and distance, in parts of the first
    // one; then the shift of the target from the body's middle [m].
    seen() {
        const { theta, phi, radius } = new Spherical().setFromVector3(this.camera.position.clone().sub(this.target));
        return [theta * 180 / Math.PI, phi * 180 / Math.PI, radius / this.first_distance,
                ...this.target.clone().sub(this.middle)];
    }

    see([around_deg, down_deg, distance, ...shift]) {
        this.target.copy(this.middle).add(new Vector3(...shift));
        const from = new Spherical(distance * this.first_distance, down_deg * Math.PI / 180,
                                   around_deg * Math.PI / 180);
        this.camera.position.setFromSpherical(from).add(this.target);
        this.camera.lookAt(this.target);
    }

    turn(around_deg, up_deg) {
        const seen = new Spherical().setFromVector3(this.camera.position.clone().sub(this.target));
        seen.phi = Math.min(3.1, Math.max(0.04, seen.phi - up_deg * Math.PI / 180));
        seen.theta += around_deg * Math.PI / 180;
        this.camera.position.setFromSpherical(seen).add(this.target);
        this.camera.lookAt(this.target);
    }

    // Shifts by fractions of the height that a panel shows.
    shift(right, up) {
        const height = 2 * this.camera.position.distanceTo(this.target) * Math.tan(this.camera.fov / 2 * Math.PI / 180);
        this.camera.updateMatrix();
        const [across, upwards] = [0, 1].map((column) => new Vector3().setFromMatrixColumn(this.camera.matrix, column));
        this.move(across.multiplyScalar(right * height).addScaledVector(upwards, up * height));
    }

    zoom(factor) {
        this.camera.position.sub(this.target).multiplyScalar(factor).add(this.target);
    }

    // Left, bottom, width and height of a panel in the canvas.
    part_of(element) {
        const whole = this.renderer.domElement.parentElement.getBoundingClientRect(),
            box = element.getBoundingClientRect();
        return [box.left - whole.left, whole.bottom - box.bottom, box.width, box.height];
    }

    draw() {
        const canvas = this.renderer.domElement;
        if (canvas.clientWidth !== this.width || canvas.clientHeight !== this.height) {
            [this.width, this.height] = [canvas.clientWidth, canvas.clientHeight];
            this.renderer.setSize(this.width, this.height, false);
        }
        this.renderer.setScissorTest(false);
        this.renderer.setClearColor(0xffffff, 0);
        this.renderer.clear();
        this.renderer.setScissorTest(true);
        const { middle, radius } = this.sphere;
        Object.assign(this.camera, range_of_sight(this.camera.position.distanceTo(middle), radius));
        for (const { element, scene } of this.views) {
            const part = this.part_of(element);
            this.renderer.setViewport(...part);
            this.renderer.setScissor(...part);
            this.camera.aspect = part[2] / part[3];
            this.camera.updateProjectionMatrix();
            this.renderer.render(scene, this.camera);
        }
    }

    // Red, green, blue and alpha of the pixels of one panel.
    pixels(at) {
        this.draw();
        const context = this.renderer.getContext(), ratio = this.renderer.getPixelRatio();
        const part = this.part_of(this.views[at].element).map((number) => Math.round(number * ratio));
        const bytes = new Uint8Array(4 * part[2] * part[3]);
        context.readPixels(...part, context.RGBA, context.UNSIGNED_BYTE, bytes);
        return bytes;
    }
}

// The mean of the posed bones' ends [m], the same for all deformers.
function middle_of(run, at) {
    const ends = run.posed_bones(at), sum = new Vector3();
    for (let i = 0; i < ends.length; i += 3) sum.add(new Vector3().fromArray(ends, i));
    return sum.divideScalar(ends.length / 3);
}

// Some points of the body relative to its middle [m] in all frames of the run, enough to determine the space that it
// takes.
function cloud_of(run, label) {
    const points = [];
    for (let at = 0; at < run.frames.length; ++at) {
        const positions = run.positions(label, at), middle = middle_of(run, at);
        for (let v = at % 7; v < run.vertices; v += 7)
            points.push(new Vector3().fromArray(positions, 3 * v).sub(middle));
    }
    return points;
}

// Whether it takes more space horizontally than vertically.
export function is_wide(run) {
    const [left, right] = run.rest_range("x"), [low, high] = run.rest_range("y");
    return right - left > 1.5 * (high - low);
}
