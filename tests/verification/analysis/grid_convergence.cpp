// Grid convergence compared with printed values, and with series and fields of a known order. Reference: the sample table of I. B. Celik et
// al., Journal of Fluids Engineering 130, 078001, 2008 (three columns; tolerance: half the last printed digit); the worked example of
// NASA's NPARC tutorial "Examining Spatial (Grid) Convergence" (J. W. Slater; pressure recovery of an inlet), which follows P. J. Roache.
#include "analysis/grid_convergence.hpp"

#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using analysis::GridBehaviour;
using analysis::GridConvergence;
using test_support::rounding_error;

constexpr double no_limit = 100.0;  // formal order: the observed one is used, as in the print

struct PrintedColumn {
    std::array<double, 3> values;
    std::array<double, 2> ratios;
    double order, extrapolated, approximate_error_pct, extrapolated_error_pct, gci_pct;
    double half_a_unit;  // of the last printed digit of the values

    double our_extrapolated_error_pct(const std::array<double, 3>& of) const
    {
        const double limit = analysis::three_grids(of, ratios, no_limit).extrapolated;
        return 100.0 * std::abs((limit - of[0]) / limit);
    }
    // The largest change where each of the values is changed by half a unit.
    double rounding_of_extrapolated_error_pct() const
    {
        double largest = 0.0;
        for (int signs = 0; signs < 8; ++signs) {
            std::array<double, 3> changed = values;
            for (int grid = 0; grid < 3; ++grid) changed[grid] += (signs >> grid & 1 ? 1.0 : -1.0) * half_a_unit;
            largest = std::max(largest, std::abs(our_extrapolated_error_pct(changed) - our_extrapolated_error_pct(values)));
        }
        return largest;
    }
};

class CelikTable : public testing::TestWithParam<PrintedColumn> {};

TEST_P(CelikTable, Monotone)
{
    const PrintedColumn& column = GetParam();
    const GridConvergence grids = analysis::three_grids(column.values, column.ratios, no_limit);
    const double fine = column.values[0];
    EXPECT_EQ(grids.behaviour, GridBehaviour::monotone);
    EXPECT_NEAR(grids.observed_order, column.order, 0.005);
    EXPECT_NEAR(grids.extrapolated, column.extrapolated, 0.00005);
    EXPECT_NEAR(100.0 * std::abs((fine - column.values[1]) / fine), column.approximate_error_pct, 0.05);
    // The printed 0.9 is 0.847 by the table's own values, which are rounded themselves.
    EXPECT_NEAR(column.our_extrapolated_error_pct(column.values), column.extrapolated_error_pct,
                0.05 + column.rounding_of_extrapolated_error_pct());
    EXPECT_NEAR(100.0 * grids.bounds[0] / fine, column.gci_pct, 0.05);
}

// Reattachment length and axial velocity over a backward facing step.
INSTANTIATE_TEST_SUITE_P(Columns, CelikTable,
                         testing::Values(PrintedColumn{{6.063, 5.972, 5.863}, {1.5, 4.0 / 3.0}, 1.53, 6.1685, 1.5, 1.7, 2.2, 0.0005},
                                         PrintedColumn{{10.7880, 10.7250, 10.6050}, {2.0, 2.143}, 0.75, 10.8801, 0.6, 0.9, 1.1, 0.00005}));

TEST(CelikTable, Oscillating)
{
    const GridConvergence grids = analysis::three_grids({6.0042, 5.9624, 6.0909}, {2.0, 2.143}, no_limit);
    EXPECT_EQ(grids.behaviour, GridBehaviour::oscillating);
    EXPECT_NEAR(grids.observed_order, 1.51, 0.005);
    // No limit is extrapolated, although the table does so: the bound is wider than its 0.5 %.
    EXPECT_TRUE(std::isnan(grids.extrapolated));
    EXPECT_DOUBLE_EQ(grids.bounds[0], 3.0 * (6.0909 - 5.9624));
}

TEST(NparcTutorial, PressureRecovery)
{
    const GridConvergence grids = analysis::three_grids({0.97050, 0.96854, 0.96178}, {2.0, 2.0}, 2.0);
    EXPECT_NEAR(grids.observed_order, 1.786170, 5e-7);
    EXPECT_NEAR(grids.extrapolated, 0.97130, 5e-6);
    const double gci_12_pct = 100.0 * grids.bounds[0] / 0.97050, gci_23_pct = 100.0 * grids.bounds[1] / 0.96854;
    EXPECT_NEAR(gci_12_pct, 0.103083, 5e-7);
    EXPECT_NEAR(gci_23_pct, 0.356249, 5e-7);
    EXPECT_NEAR(std::pow(2.0, grids.observed_order) * gci_12_pct / gci_23_pct, 0.997980, 5e-7);
}

// How far rounding moves the order where each value is in error by `of_value`. The quotient R of the differences is in error by those of
// the two differences, and d ln R / dp lies between the smaller of ln r21 and ln r32 and their sum. The search for the root ends at an
// interval of 1e-13, relative and absolute.
double order_error(const std::array<double, 3>& values, const std::array<double, 2>& ratios, double order, double of_value)
{
    const double of_quotient = 2.0 * of_value / std::abs(values[1] - values[0]) + 2.0 * of_value / std::abs(values[2] - values[1]);
    return of_quotient / std::log(std::min(ratios[0], ratios[1])) + 1e-13 * (1.0 + std::abs(order));
}

// f + C h^p with unequal ratios is recovered exactly, for any f, C and p. A value goes through four roundings. The limit is f1 + D / (r^p -
// 1) with D = f1 - f2, so that it is in error by that of f1, of D and of p.
TEST(MadeUpSeries, HasItsOrderAndItsLimit)
{
    for (const double order : {0.3, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0})
        for (const double r21 : {1.3, 2.0})
            for (const double r32 : {1.4, 2.0, 3.0})
                for (const double size : {-0.7, 40.0}) {
                    const auto value = [&](double h) { return 5.0 + size * std::pow(h, order); };
                    const std::array<double, 3> values = {value(1.0), value(r21), value(r21 * r32)};
                    const GridConvergence grids = analysis::three_grids(values, {r21, r32}, no_limit);
                    const double of_value = rounding_error(4, 5.0 + std::abs(size) * std::pow(r21 * r32, order));
                    const double of_order = order_error(values, {r21, r32}, order, of_value), growth = std::pow(r21, order);
                    const double of_limit =
                        of_value + 2.0 * of_value / (growth - 1.0) + std::abs(size) * growth * std::log(r21) / (growth - 1.0) * of_order;
                    EXPECT_EQ(grids.behaviour, GridBehaviour::monotone);
                    EXPECT_NEAR(grids.observed_order, order, of_order);
                    EXPECT_NEAR(grids.extrapolated, 5.0, of_limit);
                    for (int grid = 0; grid < 3; ++grid)
                        EXPECT_NEAR(grids.bounds[grid], 1.25 * std::abs(values[grid] - 5.0), 1.25 * (of_value + of_limit));
                }
}

// A divergent series f + C h^-p has a negative order, which distinguishes it from a convergent one.
TEST(MadeUpSeries, ThatDivergesHasItsNegativeOrder)
{
    const auto value = [](double h) { return 2.0 + std::pow(h, -0.5); };
    const std::array<double, 3> values = {value(1.0), value(1.5), value(3.3)};
    const GridConvergence grids = analysis::three_grids(values, {1.5, 2.2}, 2.0);
    EXPECT_EQ(grids.behaviour, GridBehaviour::diverging);
    EXPECT_NEAR(grids.observed_order, -0.5, order_error(values, {1.5, 2.2}, -0.5, rounding_error(4, 3.0)));
    EXPECT_TRUE(std::isnan(grids.extrapolated));
}

// Two orders at once, as in real errors: the bound holds, and the observed order becomes more accurate closer to the limit.
TEST(MadeUpSeries, WithATailOfHigherOrderIsCovered)
{
    double last_gap = 1.0;
    for (const double h : {0.2, 0.1, 0.05, 0.025}) {
        const auto error = [](double size) { return 0.8 * size * size - 1.1 * size * size * size; };
        const GridConvergence grids = analysis::three_grids({error(h), error(2 * h), error(4 * h)}, {2.0, 2.0}, 2.0);
        if (grids.behaviour != GridBehaviour::monotone) continue;
        EXPECT_LT(std::abs(error(h)), grids.bounds[0]);
        EXPECT_LT(std::abs(grids.observed_order - 2.0), last_gap);
        EXPECT_EQ(grids.asymptotic, std::abs(grids.observed_order - 2.0) <= 0.2);
        last_gap = std::abs(grids.observed_order - 2.0);
    }
    EXPECT_LT(last_gap, 0.2);  // the last is asymptotic
}

// The fields limit + h e and limit + 2 h e differ by h |e|. The coarser one is twice as far from the limit, and the safety factor is 3.
TEST(MadeUpField, IsBoundedByThreeTimesItsDistance)
{
    constexpr double difference = 0.3;
    EXPECT_EQ(analysis::two_fields(difference, 2.0, 1.0).bounds[1], 3.0 * 2.0 * difference);
}

}  // namespace
