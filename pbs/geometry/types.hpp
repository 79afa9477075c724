// The array types every module shares. Row-major, so that one row is one point, edge or tet in memory.
#pragma once

#include <Eigen/Core>

namespace pbs {

using Vec3 = Eigen::Vector3d;                                                 // a point or vector [m], 3 x 1
using Positions = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;  // points [m], #V x 3
using Tets = Eigen::Matrix<int, Eigen::Dynamic, 4, Eigen::RowMajor>;          // vertex indices, #T x 4
using Edges = Eigen::Matrix<int, Eigen::Dynamic, 2, Eigen::RowMajor>;         // vertex indices, #E x 2, first < second
using Triangles = Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>;     // vertex indices, #F x 3, outward

}  // namespace pbs
