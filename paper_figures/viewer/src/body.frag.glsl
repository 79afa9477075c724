// The light comes from the upper left of the camera, with a minimum brightness so that colours match the legend. Faces of the cut show the
// thin outline of their tets in a shade of their own colour, so that small faces show it too.
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
}
