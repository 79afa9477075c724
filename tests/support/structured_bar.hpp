// Meshes with known volume, counts and topology, without a mesher, and the mean edge of a mesh with tets.
//   const pbs::TetMesh bar = test_support::structured_bar({-1, -0.15, -0.15}, {1, 0.15, 0.15}, {20, 3, 3});
#pragma once

#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

namespace test_support {

// The smallest mesh: vertices at the origin and at 1 m on each axis, one positively oriented tet of 1/6 m^3 with three
// edges of 1 m and three of sqrt 2 m.
inline pbs::TetMesh unit_tet()
{
    return {pbs::Positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, pbs::Tets{{0, 1, 2, 3}}};
}

// The unit tet and a second one below it on the triangle 0 1 2, of `depth_m` / 6 m^3.
inline pbs::TetMesh two_tets(double depth_m = 1.0)
{
    return {pbs::Positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -depth_m}},
            pbs::Tets{{0, 1, 2, 3}, {0, 2, 1, 4}}};
}

// A box of nx x ny x nz cubes, each Kuhn-split into six tets. Corners [m]; cells along x, y, z. (nx+1)(ny+1)(nz+1)
// vertices, x fastest; 6 nx ny nz tets, all positively oriented.
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

    // Each of the six tets follows a path from corner (0,0,0) to (1,1,1) along the axes in one order; odd orders are
    // mirrored.
    const std::array<std::array<int, 3>, 6> axis_orders = {
        {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
    mesh.tets.resize(6 * nx * ny * nz, 4);
    for (int t = 0; t < mesh.tets.rows(); ++t) {
        const int cube = t / 6;
        std::array<int, 3> corner = {cube % nx, cube / nx % ny, cube / nx / ny};
        for (int c = 0; c < 4; ++c) {
            mesh.tets(t, c) = vertex(corner[0], corner[1], corner[2]);
            if (c < 3) ++corner[axis_orders[t % 6][c]];
        }
        if (t % 6 >= 3) std::swap(mesh.tets(t, 2), mesh.tets(t, 3));
    }
    return mesh;
}

// Moves every vertex that is not on the box's surface by up to `share` / 2 of a cell along each axis; the seed is
// fixed.
inline pbs::TetMesh jittered(pbs::TetMesh mesh, const pbs::Vec3& cell_size_m, double share)
{
    const Eigen::RowVector3d low = mesh.rest.colwise().minCoeff(), high = mesh.rest.colwise().maxCoeff();
    std::mt19937 random(12345);
    for (auto vertex : mesh.rest.rowwise()) {
        Eigen::RowVector3d shift;
        for (int c = 0; c < 3; ++c) shift(c) = cell_size_m(c) * share * (random() / 4294967295.0 - 0.5);
        if (((vertex - low).array() > 1e-9).all() && ((high - vertex).array() > 1e-9).all()) vertex += shift;
    }
    return mesh;
}

// The unit cube of n^3 cells whose inner vertices are displaced at random, so that no symmetry of the mesh hides an
// error.
inline pbs::TetMesh jittered_cube(int n, double share = 0.25)
{
    return jittered(structured_bar({0, 0, 0}, {1, 1, 1}, {n, n, n}), pbs::Vec3::Constant(1.0 / n), share);
}

// The mesh with vertices and tets in a random order; its vertex vertex[v] is vertex v of the mesh.
struct Renumbered {
    pbs::TetMesh mesh;
    std::vector<int> vertex;
};

inline Renumbered renumbered(const pbs::TetMesh& mesh, unsigned seed)
{
    std::mt19937 random(seed);
    std::vector<int> vertex(mesh.rest.rows()), tet(mesh.tets.rows());
    std::iota(vertex.begin(), vertex.end(), 0);
    std::iota(tet.begin(), tet.end(), 0);
    std::shuffle(vertex.begin(), vertex.end(), random);
    std::shuffle(tet.begin(), tet.end(), random);
    Renumbered other{mesh, vertex};
    other.mesh.rest(vertex, Eigen::all) = mesh.rest;
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t) {
        const auto corner = mesh.tets.row(t);
        other.mesh.tets.row(tet[t]) << vertex[corner(1)], vertex[corner(2)], vertex[corner(0)],
            vertex[corner(3)];  // of the same orientation
    }
    return other;
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
        if (keep(cell % cells[0], cell / cells[0] % cells[1], cell / (cells[0] * cells[1])))
            kept.row(count++) = box.tets.row(t);
    }
    box.tets = kept.topRows(count);
    return box;
}

inline double mean_edge_m(const pbs::TetMesh& mesh)
{
    const pbs::Edges edges = pbs::edges_of(mesh.tets);
    return (mesh.rest(edges.col(0), Eigen::all) - mesh.rest(edges.col(1), Eigen::all)).rowwise().norm().mean();
}

}  // namespace test_support
