#include "analysis/share_interval.hpp"

#include <gsl/gsl_cdf.h>

namespace analysis {

Interval share_interval(int counted, int all, double level)
{
    const double tail = (1.0 - level) / 2.0;
    Interval share{.estimate = double(counted) / all, .low = 0.0, .high = 1.0, .level = level, .n = all};
    if (counted > 0) share.low = gsl_cdf_beta_Pinv(tail, counted, all - counted + 1.0);
    if (counted < all) share.high = gsl_cdf_beta_Pinv(1.0 - tail, counted + 1.0, all - counted);
    return share;
}

}  // namespace analysis
