// The size of a body, by which distances are stated.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

namespace pbs {

// The diagonal of the bounding box of points [m], #V x 3. At least one point.
inline double diagonal_m(const Positions& points)
{
    return (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
}

}  // namespace pbs
