// The ground under a body, with its soft shadow: how much of the body is above each place, less for what is high above
// it.
import { DataTexture, LinearFilter, Mesh, PlaneGeometry, RedFormat, ShaderMaterial, Vector2 } from "three";
import { cells, shadow_of } from "./faces.js";
import fragment_shader from "./ground.frag.glsl";

const vertex_shader = `
varying vec2 place;
void main() {
    vec4 world = modelMatrix * vec4(position, 1.0);
    place = world.xz;
    gl_Position = projectionMatrix * viewMatrix * world;
}`;

export class Ground {
    constructor() {
        this.texels = new Uint8Array(cells * cells);
        this.texture = new DataTexture(this.texels, cells, cells, RedFormat);
        Object.assign(this.texture, { magFilter: LinearFilter, minFilter: LinearFilter, unpackAlignment: 1 });
        const uniforms = { shadow: { value: this.texture }, centre: { value: new Vector2() }, half_m: { value: 1 },
                           step_m: { value: 1 }, paper: { value: null }, shade: { value: null } };
        this.material = new ShaderMaterial({ vertexShader: vertex_shader, fragmentShader: fragment_shader,
                                             depthWrite: false, uniforms });
        this.mesh = new Mesh(new PlaneGeometry(2, 2).rotateX(-Math.PI / 2), this.material);
        this.mesh.renderOrder = -1;
        this.mesh.frustumCulled = false;
    }

    // points: x y z of each [m]; middle: of the body; half_m: half of the side of the square that is drawn.
    update(points, [x, , z], height_m, half_m, { paper, shade }) {
        this.mesh.position.set(x, height_m, z);
        this.mesh.scale.setScalar(half_m);
        const { uniforms } = this.material;
        uniforms.centre.value.set(x, z);
        Object.assign(uniforms.half_m, { value: half_m });
        Object.assign(uniforms.step_m, { value: half_m / 5 });
        Object.assign(uniforms.paper, { value: paper });
        Object.assign(uniforms.shade, { value: shade });
        this.texels.set(shadow_of(points, x, z, height_m, half_m));
        this.texture.needsUpdate = true;
    }
}
