// Decodes the packed bytes: positions on a grid, volume ratios, float32 bone ends. viewer/data.py encodes them.

// Converts differences from the previous frame, low bytes then high bytes, to codes frame by frame.
export function codes_of(bytes, frames, numbers) {
    const count = frames * numbers;
    const codes = new Uint16Array(count);
    for (let i = 0; i < count; ++i) {
        const difference = bytes[i] | (bytes[count + i] << 8);
        codes[i] = i < numbers ? difference : codes[i - numbers] + difference;  // modulo 65536
    }
    return codes;
}

// Positions [m], x y z of each vertex, from the codes of one frame.
export function positions_of(codes, low_m, step_m) {
    const positions = new Float32Array(codes.length);
    for (let i = 0; i < codes.length; ++i) positions[i] = low_m[i % 3] + step_m * codes[i];
    return positions;
}

// 0: inverted; otherwise (code - 1) / steps.
export function ratio_of(code, steps) {
    return code === 0 ? -Infinity : (code - 1) / steps;
}

// The distance [mm] of each vertex from that of the reference.
export function distances_mm(positions, reference) {
    const distances = new Float32Array(positions.length / 3);
    for (let v = 0; v < distances.length; ++v)
        distances[v] = 1000 * Math.hypot(positions[3 * v] - reference[3 * v], positions[3 * v + 1] - reference[3 * v + 1],
                                         positions[3 * v + 2] - reference[3 * v + 2]);
    return distances;
}
