// The rounding error of volumes of tets, for tolerances: a volume goes through ten roundings of products of three edges, over 6, whose
// magnitudes add up to at most 2 / sqrt 3 times the product of the edges' lengths.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"
#include "tests/support/rounding_error.hpp"

#include <cmath>

namespace test_support {

// The rounding error of the sum over the tets [m^3].
inline double volume_error(const pbs::Positions& positions, const pbs::Tets& tets)
{
    double magnitudes = 0.0;
    for (const auto& tet : tets.rowwise()) {
        double product = 2.0 / std::sqrt(3.0) / 6.0;
        for (int corner = 1; corner < 4; ++corner) product *= (positions.row(tet(corner)) - positions.row(tet(0))).norm();
        magnitudes += product;
    }
    return rounding_error(10.0 + static_cast<double>(tets.rows()), magnitudes);
}

}  // namespace test_support
