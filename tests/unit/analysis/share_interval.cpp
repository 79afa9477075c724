// Reference: theory where none or all are counted; else the definition, by sums of the binomial distribution.
#include "analysis/share_interval.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using analysis::share_interval;

// The probability of `counted` or fewer out of `all` with probability p each.
double at_most(int counted, int all, double p)
{
    double sum = 0.0;
    for (int k = 0; k <= counted; ++k)
        sum += std::exp(std::lgamma(all + 1.0) - std::lgamma(k + 1.0) - std::lgamma(all - k + 1.0) + k * std::log(p) +
                        (all - k) * std::log1p(-p));
    return sum;
}

TEST(ShareInterval, EndsWhereTheTailsAreAFortieth)
{
    for (const int all : {4, 18, 161})
        for (int counted = 1; counted < all; ++counted) {
            const auto share = share_interval(counted, all);
            EXPECT_EQ(share.estimate, double(counted) / all);
            EXPECT_NEAR(at_most(counted, all, share.high), 0.025, 1e-9);
            EXPECT_NEAR(1.0 - at_most(counted - 1, all, share.low), 0.025, 1e-9);
        }
}

TEST(ShareInterval, OfNoneAndOfAll)
{
    for (const int all : {1, 8, 100}) {
        const double end = 1.0 - std::pow(0.025, 1.0 / all);
        const auto none = share_interval(0, all), every = share_interval(all, all);
        EXPECT_EQ(none.low, 0.0);
        EXPECT_NEAR(none.high, end, 1e-12);
        EXPECT_NEAR(every.low, 1.0 - end, 1e-12);
        EXPECT_EQ(every.high, 1.0);
    }
}

TEST(ShareInterval, IsWiderOfFewerAndOfAHigherLevel)
{
    EXPECT_GT(share_interval(2, 8).high - share_interval(2, 8).low, share_interval(20, 80).high - share_interval(20, 80).low);
    EXPECT_GT(share_interval(2, 8, 0.99).high, share_interval(2, 8, 0.95).high);
}

}  // namespace
