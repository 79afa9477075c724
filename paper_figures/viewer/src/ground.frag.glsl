// The ground: lines every half step, the soft shadow of the body, and its fading into the background of the panel.
uniform sampler2D shadow;
uniform vec2 centre;
uniform float half_m, step_m;
uniform vec3 paper, shade;
varying vec2 place;
void main() {
    vec2 away = (place - centre) / half_m, line = abs(fract(place / step_m - 0.5) - 0.5) / fwidth(place / step_m);
    float seen = 1.0 - smoothstep(0.45, 1.0, length(away));
    float drawn = 0.35 * (1.0 - min(min(line.x, line.y), 1.0));
    vec3 ground = mix(mix(paper, shade, 0.35 + drawn), 0.25 * shade, 0.6 * texture2D(shadow, 0.5 * away + 0.5).r);
    gl_FragColor = vec4(mix(paper, ground, seen), 1.0);
}
