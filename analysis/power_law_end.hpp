// Where a cost that grows with size as a power reaches a limit.
//   const PowerLawEnd end = power_law_end(vertices, ms_per_frame, 1e3 / 30.0);   // the size at which a frame takes 1 / 30 s
#pragma once

#include <vector>

namespace analysis {

struct PowerLawEnd {
    double size = 0.0;      // at which the cost is at the limit
    bool beyond = false;    // all measured costs are below the limit, or all are above it
    double exponent = 0.0;  // of the power law over all sizes
};

// On the straight line through log cost over log size between the two sizes around the limit, or beyond the last two. The sizes may have
// any order. InputError for fewer than two sizes, another number of costs, a size or cost that is not above 0, equal sizes, and equal costs
// at the two sizes that the line passes through.
PowerLawEnd power_law_end(const std::vector<double>& sizes, const std::vector<double>& costs, double limit);

}  // namespace analysis
