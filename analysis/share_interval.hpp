// The interval of Clopper and Pearson for a share of independent cases: it contains each share p under which `counted` or fewer, and
// `counted` or more, of `all` cases have at least the probability (1 - level) / 2. Its coverage is never below `level`.
//   const Interval share = share_interval(3, 18);   // 3 / 18, between 0.036 and 0.41
#pragma once

#include "analysis/bootstrap.hpp"

namespace analysis {

// 0 <= counted <= all, all > 0.
Interval share_interval(int counted, int all, double level = 0.95);

}  // namespace analysis
