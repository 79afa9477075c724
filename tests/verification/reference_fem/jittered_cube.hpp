// The unit cube of n^3 Kuhn-split cells whose inner vertices are displaced at random, so that no symmetry of the mesh hides an error.
#pragma once

#include "tests/support/structured_bar.hpp"

#include <random>

namespace test_support {

// Moves every vertex that is not on the box's surface by up to `share` / 2 of a cell along each axis; the seed is fixed.
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

inline pbs::TetMesh jittered_cube(int n, double share = 0.25)
{
    return jittered(structured_bar({0, 0, 0}, {1, 1, 1}, {n, n, n}), pbs::Vec3::Constant(1.0 / n), share);
}

}  // namespace test_support
