// The rendered surface, which the tets carry: each of its points is the weighted sum of its tet's corners.

// x y z of each point. surface: { points, tets, shares } (the tet of each point, and four weights each); corners: of the tets.
export function carried(surface, corners, positions) {
    const { points, tets, shares } = surface, to = new Float32Array(3 * points);
    for (let point = 0; point < points; ++point)
        for (let corner = 0; corner < 4; ++corner) {
            const share = shares[4 * point + corner], v = corners[4 * tets[point] + corner];
            for (let axis = 0; axis < 3; ++axis) to[3 * point + axis] += share * positions[3 * v + axis];
        }
    return to;
}
