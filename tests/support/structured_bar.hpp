// A box of nx x ny x nz cubes, each Kuhn-split into six tets: a mesh with known volume, counts and topology, without a mesher.
//   const pbs::TetMesh bar = test_support::structured_bar({-1, -0.15, -0.15}, {1, 0.15, 0.15}, {20, 3, 3});
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <array>
#include <utility>

namespace test_support {

// Corners [m]; cells along x, y, z. (nx+1)(ny+1)(nz+1) vertices, x fastest; 6 nx ny nz tets, all positively oriented.
inline pbs::TetMesh structured_bar(const pbs::Vec3& lower, const pbs::Vec3& upper, const std::array<int, 3>& cells)
{
    const auto [nx, ny, nz] = cells;
    const auto vertex = [nx = nx, ny = ny](int i, int j, int k) { return i + (nx + 1) * (j + (ny + 1) * k); };
    pbs::TetMesh mesh;
    mesh.rest.resize((nx + 1) * (ny + 1) * (nz + 1), 3);
    for (int k = 0; k <= nz; ++k)
        for (int j = 0; j <= ny; ++j)
            for (int i = 0; i <= nx; ++i)
                mesh.rest.row(vertex(i, j, k)) =
                    lower + (upper - lower).cwiseProduct(pbs::Vec3(double(i) / nx, double(j) / ny, double(k) / nz));

    // Each of the six tets follows a path from corner (0,0,0) to (1,1,1) along the axes in one order; odd orders are mirrored.
    const std::array<std::array<int, 3>, 6> axis_orders = {{{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
    mesh.tets.resize(6 * nx * ny * nz, 4);
    int t = 0;
    for (int k = 0; k < nz; ++k)
        for (int j = 0; j < ny; ++j)
            for (int i = 0; i < nx; ++i)
                for (std::size_t order = 0; order < axis_orders.size(); ++order, ++t) {
                    std::array<int, 3> corner = {i, j, k};
                    mesh.tets(t, 0) = vertex(corner[0], corner[1], corner[2]);
                    for (int step = 0; step < 3; ++step) {
                        ++corner[axis_orders[order][step]];
                        mesh.tets(t, step + 1) = vertex(corner[0], corner[1], corner[2]);
                    }
                    if (order >= 3) std::swap(mesh.tets(t, 2), mesh.tets(t, 3));
                }
    return mesh;
}

// Keeps only those tets of a Kuhn-split box of unit cubes for which keep(cell along x, y, z) is true.
template <typename Keep>
pbs::TetMesh carved_box(const std::array<int, 3>& cells, Keep keep)
{
    pbs::TetMesh box = structured_bar({0, 0, 0}, {double(cells[0]), double(cells[1]), double(cells[2])}, cells);
    pbs::Tets kept(box.tets.rows(), 4);
    Eigen::Index count = 0;
    for (Eigen::Index t = 0; t < box.tets.rows(); ++t) {
        const int cell = static_cast<int>(t) / 6;
        if (keep(cell % cells[0], cell / cells[0] % cells[1], cell / (cells[0] * cells[1]))) kept.row(count++) = box.tets.row(t);
    }
    box.tets = kept.topRows(count);
    return box;
}

}  // namespace test_support
