// Signed volumes of tets, in double. Indices of tets are in range (unchecked).
#pragma once

#include "pbs/geometry/types.hpp"

namespace pbs {

// Signed volume [m^3] of one tet: (p2 - p1) x (p3 - p1) . (p4 - p1) / 6; negative when inverted.
inline double tet_volume(const Vec3& p1, const Vec3& p2, const Vec3& p3, const Vec3& p4)
{
    const Vec3 p21 = p2 - p1, p31 = p3 - p1, p41 = p4 - p1;
    return (p21(1) * p31(2) - p21(2) * p31(1)) * p41(0) / 6.0 + (p21(2) * p31(0) - p21(0) * p31(2)) * p41(1) / 6.0 +
           (p21(0) * p31(1) - p21(1) * p31(0)) * p41(2) / 6.0;
}

// Signed volumes [m^3] of all tets, #T.
Eigen::VectorXd tet_volumes(const Positions& positions, const Tets& tets);

// A quarter of the rest volume of each tet around a vertex [m^3], #V: the lumped rest volume.
Eigen::VectorXd lumped_volumes(const Positions& rest, const Tets& tets);

}  // namespace pbs
