// The scene of one panel: the body (tets or rendered surface), its inverted tets, the skeleton and the ground, updated
// when the state changes.
import { BufferAttribute, BufferGeometry, DoubleSide, DynamicDrawUsage, Group, Mesh, Points, PointsMaterial,
         ShaderMaterial } from "three";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";
import fragment_shader from "./body.frag.glsl";
import vertex_shader from "./body.vert.glsl";
import { area_normal, triangles_of, vertex_normals } from "./faces.js";
import { Ground } from "./ground.js";
import { shade_of } from "./legend.js";
import { draws_surface } from "./state.js";

const ghost = [0.62, 0.66, 0.7];

export class Panel {
    constructor() {
        this.body = new Body();
        this.inverted = new Body();
        this.skeleton = new Skeleton();
        this.ground = new Ground();
        this.contents = [this.ground.mesh, this.inverted.mesh, this.body.mesh, this.skeleton.group];
    }

    // mesh: { run, neighbours, outer, kept, faces }, see faces.js
    update(mesh, label, shown, palette, ratio_shades) {
        const { run } = mesh, at = shown.at;
        const rendered = draws_surface(run, shown), codes = run.ratio_codes(label, at);
        this.choose_faces(mesh, rendered);
        this.points = run.points(label, at, rendered);
        this.body.move(this.points, vertex_normals(this.points, rendered ? run.surface.corners : mesh.outer));
        this.body.paint(this.colouring(run, label, shown, palette, ratio_shades, codes));
        this.body.look(["skin", "contact"].includes(shown.colour) ? 0.3 : 0.55, shown.colour === "inverted" ? 0.3 : 1);
        this.inverted.mesh.visible = shown.colour === "inverted";
        if (this.inverted.mesh.visible) this.show_inverted(mesh, run.positions(label, at), codes, palette);
        this.skeleton.group.visible = shown.bones;
        if (shown.bones) this.skeleton.pose(run.posed_bones(at));
    }

    // stage: the colours of the ground and of the background
    stand_on_ground(run, at, middle, stage) {
        this.ground.update(this.points, middle, run.ground_m(), run.sphere().radius, stage);
    }

    choose_faces(mesh, rendered) {
        const chosen = rendered ? mesh.run.surface : mesh.faces;
        if (this.chosen === chosen) return;
        this.chosen = chosen;
        if (rendered) this.body.show_surface(chosen);
        else this.body.show_faces(mesh.run.corners, chosen, (face) => mesh.neighbours[face] < 0);
    }

    drawn_positions() {
        return this.body.drawn_positions(this.points.length / 3);
    }

    colouring(run, label, shown, palette, ratio_shades, codes) {
        if (shown.colour === "ratio") return (tet) => ratio_shades[codes[tet]];
        if (shown.colour === "inverted") return () => ghost;
        if (shown.colour === "skin") return () => palette.skin;
        if (shown.colour === "contact") {
            const codes = run.contact_codes(label, shown.at, draws_surface(run, shown)), { touching, shades } =
                palette.contact;
            const shade = (code) => code === 0 ? palette.skin : code === 1 ? touching :
                shade_of(shades, 0, run.deepest_mm, (code - 2) * run.contact_step_mm);
            return (_, vertex) => codes ? shade(codes[vertex]) : ghost;
        }
        if (!run.has_errors(label, shown.at)) return () => ghost;
        const errors = run.errors_mm(label, shown.at, draws_surface(run, shown));
        return (_, vertex) => shade_of(palette.error.shades, 0, run.difference_mm, errors[vertex]);
    }

    // All four faces of each inverted tet that the cut keeps.
    show_inverted(mesh, positions, codes, palette) {
        const faces = [...codes.keys()].filter((tet) => codes[tet] === 0 && mesh.kept[tet])
            .flatMap((tet) => [4 * tet, 4 * tet + 1, 4 * tet + 2, 4 * tet + 3]);
        this.inverted.show_faces(mesh.run.corners, faces, () => false);
        this.inverted.move(positions, positions);
        this.inverted.paint(() => palette.inverted);
        this.inverted.look(0.6, 1);
    }
}

// One deformer's body in three dimensions: the visible faces, shaded and coloured. Each face has its own corners.
function copy(to, at, from, place) {
    for (let axis = 0; axis < 3; ++axis) to[3 * at + axis] = from[3 * place + axis];
}

class Body {
    constructor() {
        this.geometry = new BufferGeometry();
        this.material = new ShaderMaterial({
            vertexShader: vertex_shader, fragmentShader: fragment_shader, side: DoubleSide,
            uniforms: { brightness: { value: 0.5 }, opacity: { value: 1 } },
        });
        this.mesh = new Mesh(this.geometry, this.material);
        this.mesh.frustumCulled = false;
    }

    // Sets the faces of tets that are drawn; `outer` distinguishes those of the body's surface, which are shaded
    // smoothly, from those of the cut.
    show_faces(corners, faces, outer) {
        this.show_triangles(triangles_of(corners, faces), Uint32Array.from(faces, (face) => face >> 2),
                            Uint8Array.from(faces, (face) => outer(face) ? 1 : 0));
    }

    // Sets the rendered surface; see carried in data.js.
    show_surface({ corners, tets }) {
        const behind = Uint32Array.from({ length: corners.length / 3 }, (_, face) => tets[corners[3 * face]]);
        this.show_triangles(corners, behind, new Uint8Array(behind.length).fill(1));
    }

    // vertices: three per triangle; for each triangle the tet behind it, and whether it is shaded smoothly.
    show_triangles(vertices, tets, smooth) {
        Object.assign(this, { vertices, tets, smooth });
        this.geometry.dispose();
        for (const [name, size] of [["position", 3], ["normal", 3], ["colour", 3], ["is_cut", 1]]) {
            const attribute = new BufferAttribute(new Float32Array(size * vertices.length), size);
            this.geometry.setAttribute(name, attribute.setUsage(DynamicDrawUsage));
        }
        this.geometry.attributes.is_cut.array.forEach((_, at, all) => { all[at] = this.smooth[Math.floor(at / 3)] ? 0
            : 1; });
        this.geometry.setDrawRange(0, this.vertices.length);
    }

    move(positions, normals) {
        const to = this.geometry.attributes.position.array, up = this.geometry.attributes.normal.array;
        this.vertices.forEach((v, at) => {
            copy(to, at, positions, v);
            if (this.smooth[Math.floor(at / 3)]) copy(up, at, normals, v);
        });
        this.smooth.forEach((smooth, face) => {
            if (smooth) return;
            const normal = area_normal(positions, ...this.vertices.subarray(3 * face, 3 * face + 3));
            for (let corner = 0; corner < 3; ++corner) up.set(normal, 9 * face + 3 * corner);
        });
        this.geometry.attributes.position.needsUpdate = this.geometry.attributes.normal.needsUpdate = true;
    }

    // colour_of(tet, vertex) -> [red, green, blue]
    paint(colour_of) {
        const to = this.geometry.attributes.colour.array;
        this.vertices.forEach((v, at) => to.set(colour_of(this.tets[Math.floor(at / 3)], v), 3 * at));
        this.geometry.attributes.colour.needsUpdate = true;
    }

    look(brightness, opacity) {
        this.material.uniforms.brightness.value = brightness;
        this.material.uniforms.opacity.value = opacity;
        this.material.transparent = opacity < 1;
        this.material.depthWrite = opacity === 1;
    }

    // Positions [m] as drawn, by vertex; nan for vertices of no visible face.
    drawn_positions(count) {
        const drawn = new Float32Array(3 * count).fill(NaN);
        const from = this.geometry.attributes.position.array;
        this.vertices.forEach((v, at) => copy(drawn, v, from, at));
        return drawn;
    }
}

// The posed bones, drawn over the body: a line for each, with a dot at its head.
const dark = 0x111111;

class Skeleton {
    constructor() {
        // Dark on a white seam, visible on any body.
        this.lines = [[5, 0xffffff], [2.5, dark]].map(([linewidth, color]) =>
            new LineSegments2(new LineSegmentsGeometry(), new LineMaterial({ color, linewidth, depthTest: false })));
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
