#include "experiments/studies/stability/share_interval.hpp"

#include <gsl/gsl_cdf.h>

namespace experiments {

ShareInterval share_interval(int counted, int all, double level)
{
    const double tail = (1.0 - level) / 2.0;
    ShareInterval share{double(counted) / all, 0.0, 1.0};
    if (counted > 0) share.low = gsl_cdf_beta_Pinv(tail, counted, all - counted + 1.0);
    if (counted < all) share.high = gsl_cdf_beta_Pinv(1.0 - tail, counted + 1.0, all - counted);
    return share;
}

}  // namespace experiments
