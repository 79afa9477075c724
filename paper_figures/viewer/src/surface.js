// The rendered surface, carried by the tets: each of its points is the sum of its tet's corners by their shares.

// x y z of each point. surface: { points, tets, shares } (the carrying tet of each point, four shares each); corners: of the tets.
export function carried(surface, corners, positions) {
    const { points, tets, shares } = surface, to = new Float32Array(3 * points);
    for (let point = 0; point < points; ++point)
        for (let corner = 0; corner < 4; ++corner) {
            const share = shares[4 * point + corner], v = corners[4 * tets[point] + corner];
            for (let axis = 0; axis < 3; ++axis) to[3 * point + axis] += share * positions[3 * v + axis];
        }
    return to;
}
