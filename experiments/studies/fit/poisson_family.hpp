// A pose's elastic solution as a function of Poisson's ratio: solved at a few ratios, interpolated between them, so that a fit costs no
// further solves.
//   PoissonFamily family(poisson_nodes(7), solutions);
//   family.at(0.37);
// The interpolant is the polynomial in log10(1 - 2 nu) through Chebyshev's points: near 1/2 the solution is smooth in the logarithm of the
// distance to it, not in nu.
#pragma once

#include "pbs/geometry/types.hpp"

#include <vector>

namespace experiments {

inline constexpr double highest_poisson = 0.4999;

// `count` >= 2 ratios from 0 to highest_poisson, increasing, both ends included.
std::vector<double> poisson_nodes(int count);
// A ratio between the nodes i and i + 1, where the interpolant is farthest from what was solved.
double between(const std::vector<double>& nodes, int i);

class PoissonFamily {
public:
    PoissonFamily(const std::vector<double>& poisson, std::vector<pbs::Positions> positions);  // one a ratio [m], #V x 3

    pbs::Positions at(double poisson) const;  // [m], #V x 3

private:
    std::vector<double> nodes_, weights_;  // in log10(1 - 2 nu); barycentric
    std::vector<pbs::Positions> positions_;
};

}  // namespace experiments
