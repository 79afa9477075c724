// How often a closed surface goes round a point: 1 inside of one that faces outwards, -1 of one that faces inwards, 0
// outside. The sum of the solid angles of its triangles over 4 pi: A. Van Oosterom, J. Strackee, The solid angle of a
// plane triangle, IEEE Transactions on Biomedical Engineering 30 (1983), Eq. 8.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

namespace pbs {

// points: #P x 3.
inline double winding_number(const Positions& points, const Triangles& triangles, const Vec3& around)
{
    double half_angles = 0.0;
    for (const auto& triangle : triangles.rowwise()) {
        const Vec3 a = points.row(triangle(0)).transpose() - around, b = points.row(triangle(1)).transpose() - around,
                   c = points.row(triangle(2)).transpose() - around;
        const double la = a.norm(), lb = b.norm(), lc = c.norm();
        half_angles += std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
    }
    return half_angles / (2.0 * std::numbers::pi);
}

}  // namespace pbs
