// Passes the colour and the normal of a corner on, and its place in its triangle.
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
}
