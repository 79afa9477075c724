// The posed bones, drawn over the body: a line for each, with a dot at its head.
import { Group, Points, PointsMaterial, BufferGeometry, BufferAttribute } from "three";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";

const dark = 0x111111;

function line(linewidth, color) {
    return new LineSegments2(new LineSegmentsGeometry(), new LineMaterial({ color, linewidth, depthTest: false }));
}

export class Skeleton {
    constructor() {
        this.lines = [line(5, 0xffffff), line(2.5, dark)];  // dark on a white seam, visible on any body
        const dot = new PointsMaterial({ color: dark, size: 6, sizeAttenuation: false, depthTest: false });
        this.dots = new Points(new BufferGeometry(), dot);
        this.group = new Group();
        [...this.lines, this.dots].forEach((part, order) => {
            part.renderOrder = 10 + order;
            part.frustumCulled = false;
            this.group.add(part);
        });
    }

    // The head and tail [m] of every bone.
    pose(ends) {
        for (const line of this.lines) {
            line.geometry.dispose();
            line.geometry = new LineSegmentsGeometry().setPositions(Float32Array.from(ends));
        }
        const heads = Float32Array.from({ length: ends.length / 2 }, (_, i) => ends[6 * Math.floor(i / 3) + (i % 3)]);
        this.dots.geometry.dispose();
        this.dots.geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(heads, 3));
    }
}
