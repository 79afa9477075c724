// Draws all panels with one WebGL context: each canvas shows a scissored part, one camera serves all, and every panel has controls.
import { Color, ColorManagement, LinearSRGBColorSpace, PerspectiveCamera, Scene, TOUCH, Vector3, WebGLRenderer } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { keep_level, leave_scrolling } from "./touch.js";

ColorManagement.enabled = false;  // colours appear on the screen as in the legend
const background = new Color(0xf1f3f5), most_pixels_per_point = 2;
const first_direction = new Vector3(0.45, 0.12, 1).normalize();

export class Views {
    constructor(canvas, on_move) {
        this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
        this.renderer.outputColorSpace = LinearSRGBColorSpace;
        this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, most_pixels_per_point));
        this.renderer.autoClear = false;
        this.camera = new PerspectiveCamera(18, 1, 0.01, 200);
        this.target = new Vector3();
        this.on_move = on_move;
        this.views = [];
    }

    // Makes a view for each of these elements, with the contents of its scene.
    show(elements, contents) {
        for (const view of this.views) view.controls.dispose();
        this.views = elements.map((element, at) => {
            const scene = new Scene();
            scene.background = background;
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

    // Points the camera at this middle, at a distance from which all points of a cloud around it [m] are in the panel.
    look_at(middle, cloud) {
        const right = new Vector3(first_direction.z, 0, -first_direction.x).normalize();
        const up = new Vector3().crossVectors(first_direction, right);
        const slope = Math.tan(this.camera.fov / 2 * Math.PI / 180), aspect = this.aspect();
        const distances = cloud.map((point) => point.dot(first_direction)
            + Math.max(Math.abs(point.dot(up)), Math.abs(point.dot(right)) / aspect) / slope);
        this.target.copy(middle);
        this.camera.position.copy(middle).addScaledVector(first_direction, 1.06 * Math.max(...distances));
        this.camera.lookAt(this.target);
    }

    aspect() {
        const box = this.views[0].element.getBoundingClientRect();
        return box.height > 0 ? box.width / box.height : 1;
    }

    // Moves the camera with the body.
    follow(step) {
        this.target.add(step);
        this.camera.position.add(step);
    }

    turn(around_deg, up_deg) {
        const offset = this.camera.position.clone().sub(this.target);
        const polar = Math.acos(offset.y / offset.length()) - up_deg * Math.PI / 180;
        const azimuth = Math.atan2(offset.x, offset.z) + around_deg * Math.PI / 180;
        offset.setFromSphericalCoords(offset.length(), Math.min(3.1, Math.max(0.04, polar)), azimuth);
        this.camera.position.copy(this.target).add(offset);
        this.camera.lookAt(this.target);
    }

    // Shifts by fractions of the height that a panel shows.
    shift(right, up) {
        const height = 2 * this.camera.position.distanceTo(this.target) * Math.tan(this.camera.fov / 2 * Math.PI / 180);
        this.camera.updateMatrix();
        const [across, upwards] = [0, 1].map((column) => new Vector3().setFromMatrixColumn(this.camera.matrix, column));
        const step = across.multiplyScalar(right * height).addScaledVector(upwards, up * height);
        this.target.add(step);
        this.camera.position.add(step);
    }

    zoom(factor) {
        this.camera.position.sub(this.target).multiplyScalar(factor).add(this.target);
    }

    draw() {
        const canvas = this.renderer.domElement;
        const whole = canvas.parentElement.getBoundingClientRect();
        if (canvas.clientWidth !== this.width || canvas.clientHeight !== this.height) {
            [this.width, this.height] = [canvas.clientWidth, canvas.clientHeight];
            this.renderer.setSize(this.width, this.height, false);
        }
        this.renderer.setScissorTest(false);
        this.renderer.setClearColor(0xffffff, 0);
        this.renderer.clear();
        this.renderer.setScissorTest(true);
        for (const { element, scene } of this.views) {
            const box = element.getBoundingClientRect();
            const part = [box.left - whole.left, whole.bottom - box.bottom, box.width, box.height];
            this.renderer.setViewport(...part);
            this.renderer.setScissor(...part);
            this.camera.aspect = box.width / box.height;
            this.camera.updateProjectionMatrix();
            this.renderer.render(scene, this.camera);
        }
    }

    // Red, green, blue and alpha of the pixels of one panel.
    pixels(at) {
        this.draw();
        const context = this.renderer.getContext(), ratio = this.renderer.getPixelRatio();
        const whole = this.renderer.domElement.parentElement.getBoundingClientRect(), box = this.views[at].element.getBoundingClientRect();
        const part = [box.left - whole.left, whole.bottom - box.bottom, box.width, box.height].map((number) => Math.round(number * ratio));
        const bytes = new Uint8Array(4 * part[2] * part[3]);
        context.readPixels(...part, context.RGBA, context.UNSIGNED_BYTE, bytes);
        return bytes;
    }
}
