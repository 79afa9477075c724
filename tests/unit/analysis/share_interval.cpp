// Reference: theory where none or all are counted; else the definition, by sums of the binomial distribution.
#include "analysis/share_interval.hpp"

#include "tests/support/rounding_error.hpp"

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

// The rounding error of such a probability, here or in the inverse: the logarithm of a term contains three log-gamma functions and two
// products with logarithms of shares, of magnitude 9 at most, each of which goes through ten roundings. (GSL's inverse converges cubically
// and ends after a step below 1e-10: only rounding is left.)
double probability_error(int all)
{
    return test_support::rounding_error(10, 3.0 * std::lgamma(all + 1.0) + 9.0 * all);
}

TEST(ShareInterval, EndsWhereTheTailsAreAFortieth)
{
    for (const int all : {4, 18, 161})
        for (int counted = 1; counted < all; ++counted) {
            const auto share = share_interval(counted, all);
            EXPECT_EQ(share.estimate, double(counted) / all);
            EXPECT_NEAR(at_most(counted, all, share.high), 0.025, 2.0 * probability_error(all));
            EXPECT_NEAR(1.0 - at_most(counted - 1, all, share.low), 0.025, 2.0 * probability_error(all));
        }
}

// An error of the probability (1 - p)^n = 0.025 is one of p over its derivative, n 0.025 / (1 - p) > n 0.025.
TEST(ShareInterval, OfNoneAndOfAll)
{
    for (const int all : {1, 8, 100}) {
        const double end = 1.0 - std::pow(0.025, 1.0 / all);
        const auto none = share_interval(0, all), every = share_interval(all, all);
        EXPECT_EQ(none.low, 0.0);
        const double rounding = probability_error(all) / (0.025 * all) + test_support::rounding_error(4, 1.0);
        EXPECT_NEAR(none.high, end, rounding);
        EXPECT_NEAR(every.low, 1.0 - end, rounding);
        EXPECT_EQ(every.high, 1.0);
    }
}

TEST(ShareInterval, IsWiderOfFewerAndOfAHigherLevel)
{
    EXPECT_GT(share_interval(2, 8).high - share_interval(2, 8).low, share_interval(20, 80).high - share_interval(20, 80).low);
    EXPECT_GT(share_interval(2, 8, 0.99).high, share_interval(2, 8, 0.95).high);
}

}  // namespace
