// Colours of the data, as red green blue in [0, 1]. The page contains the tables, which are the same as in the figures.
import { ratio_of } from "./codes.js";

export function rgb_of(hex) {
    return [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16) / 255);
}

// The shade of a value between low and high; beyond, the last shade.
export function shade_of(shades, low, high, value) {
    const share = Math.min(1, Math.max(0, (value - low) / (high - low || 1)));
    return shades[Math.round(share * (shades.length - 1))];
}

// The colour of a distance. The scale uses square roots, so that small distances are distinguishable next to large ones.
export function distance_shade(shades, most, distance) {
    return shade_of(shades, 0, 1, Math.sqrt(distance / (most || 1)));
}

// The page's tables, parsed.
export function palette_of(colours) {
    return {
        ratio: { ...colours.ratio, shades: colours.ratio.shades.map(rgb_of) },
        error: { shades: colours.error.shades.map(rgb_of) },
        skin: rgb_of(colours.skin),
        inverted: rgb_of(colours.inverted),
    };
}

// The colour of a tet for each code.
export function ratio_shades(palette, steps) {
    const { low, high, shades } = palette.ratio;
    return Array.from({ length: 256 }, (_, code) => code === 0 ? palette.inverted : shade_of(shades, low, high, ratio_of(code, steps)));
}
