// One deformer's body in three dimensions: the visible faces, shaded and coloured. Each face has its own corners.
import { BufferAttribute, BufferGeometry, DoubleSide, DynamicDrawUsage, Mesh, ShaderMaterial } from "three";
import { area_normal, triangles_of } from "./faces.js";

// The light comes from the upper left of the camera, with a minimum brightness so that colours match the legend. Faces of the cut show the
// thin outline of their tets in a shade of their own colour, so that small faces show it too.
const vertex_shader = `
attribute vec3 colour;
attribute float is_cut;
varying vec3 shade, towards;
varying vec3 corner;
varying float outlined;
void main() {
    int at = gl_VertexID % 3;
    corner = vec3(at == 0, at == 1, at == 2);
    shade = colour;
    outlined = is_cut;
    towards = normalMatrix * normal;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;
const fragment_shader = `
uniform float brightness, opacity;
varying vec3 shade, towards;
varying vec3 corner;
varying float outlined;
void main() {
    vec3 n = normalize(towards) * (gl_FrontFacing ? 1.0 : -1.0);
    float light = max(dot(n, normalize(vec3(-0.5, 0.7, 1.0))), 0.0) + 0.35 * max(dot(n, normalize(vec3(0.8, 0.1, 0.6))), 0.0);
    vec3 lit = shade * min(brightness + (1.0 - brightness) * light, 1.0);
    vec3 inside = smoothstep(vec3(0.0), fwidth(corner), corner);
    float line = outlined * (1.0 - min(inside.x, min(inside.y, inside.z)));
    gl_FragColor = vec4(mix(lit, 0.72 * lit, line), opacity);
}`;

function copy(to, at, from, place) {
    for (let axis = 0; axis < 3; ++axis) to[3 * at + axis] = from[3 * place + axis];
}

export class Body {
    constructor() {
        this.geometry = new BufferGeometry();
        this.material = new ShaderMaterial({
            vertexShader: vertex_shader, fragmentShader: fragment_shader, side: DoubleSide,
            uniforms: { brightness: { value: 0.5 }, opacity: { value: 1 } },
        });
        this.mesh = new Mesh(this.geometry, this.material);
        this.mesh.frustumCulled = false;
    }

    // Sets the faces of tets that are drawn; `outer` distinguishes those of the body's surface, which are shaded smoothly, from those of
    // the cut.
    show_faces(corners, faces, outer) {
        this.show_triangles(triangles_of(corners, faces), Uint32Array.from(faces, (face) => face >> 2),
                            Uint8Array.from(faces, (face) => outer(face) ? 1 : 0));
    }

    // Sets the rendered surface; see surface.js.
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
        this.geometry.attributes.is_cut.array.forEach((_, at, all) => { all[at] = this.smooth[Math.floor(at / 3)] ? 0 : 1; });
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
