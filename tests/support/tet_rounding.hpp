// How strongly the worst tet of a mesh magnifies rounding, for tolerances: the condition number of its matrix of edges, in the Frobenius
// norm, for its inverse and for barycentric coordinates, which go through a dozen roundings; and the norm of that inverse [1/m], the
// largest change of a barycentric coordinate, or of a displacement's gradient, for a motion of a metre.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <Eigen/LU>

#include <algorithm>

namespace test_support {

struct TetMagnification {
    double condition = 0.0;
    double inverse_edges = 0.0;  // [1/m]
};

inline TetMagnification worst_magnification(const pbs::TetMesh& mesh)
{
    TetMagnification worst;
    for (const auto& tet : mesh.tets.rowwise()) {
        Eigen::Matrix3d edges;
        for (int c = 0; c < 3; ++c) edges.col(c) = mesh.rest.row(tet(c + 1)) - mesh.rest.row(tet(0));
        const double inverse = edges.inverse().norm();
        worst = {std::max(worst.condition, edges.norm() * inverse), std::max(worst.inverse_edges, inverse)};
    }
    return worst;
}

}  // namespace test_support
