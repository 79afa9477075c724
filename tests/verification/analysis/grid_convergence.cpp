// Grid convergence compared with printed values, and with a field of a known order. Reference: the sample table of I. B. Celik et al.,
// Journal of Fluids Engineering 130, 078001, 2008; the worked example of NASA's NPARC tutorial "Examining Spatial (Grid) Convergence"
// (J. W. Slater; pressure recovery of an inlet), which follows P. J. Roache. Both observe their order on a third grid; here it is presumed.
// Their index has the safety factor 1.25 of three grids.
#include "analysis/grid_convergence.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

constexpr double of_three_grids = 1.25 / analysis::grid_safety_factor;

struct PrintedColumn {
    std::array<double, 2> values;
    double ratio, order, extrapolated, gci_pct;
};

class CelikTable : public testing::TestWithParam<PrintedColumn> {};

// The printed order has two decimals: half a digit of it changes the limit by at most `of_order`, to which half of the last printed digit
// is added.
TEST_P(CelikTable, LimitAndIndex)
{
    const PrintedColumn& column = GetParam();
    const auto at = [&](double order) { return analysis::two_grids(column.values, column.ratio, order); };
    const analysis::GridConvergence grids = at(column.order);
    const double of_order = std::abs(at(column.order - 0.005).extrapolated - grids.extrapolated);
    EXPECT_NEAR(grids.extrapolated, column.extrapolated, of_order + 0.00005);
    EXPECT_NEAR(100.0 * of_three_grids * grids.bounds[0] / column.values[0], column.gci_pct, 125.0 * of_order / column.values[0] + 0.05);
}

// Reattachment length and axial velocity over a backward facing step.
INSTANTIATE_TEST_SUITE_P(Columns, CelikTable,
                         testing::Values(PrintedColumn{{6.063, 5.972}, 1.5, 1.53, 6.1685, 2.2},
                                         PrintedColumn{{10.7880, 10.7250}, 2.0, 0.75, 10.8801, 1.1}));

TEST(NparcTutorial, PressureRecovery)
{
    const analysis::GridConvergence grids = analysis::two_grids({0.97050, 0.96854}, 2.0, 1.786170);
    EXPECT_NEAR(grids.extrapolated, 0.97130, 5e-6);
    // The order has six decimals, so that it changes the index by less than half of its last printed digit.
    EXPECT_NEAR(100.0 * of_three_grids * grids.bounds[0] / 0.97050, 0.103083, 5e-7 + 1e-7);
    EXPECT_NEAR(100.0 * of_three_grids * grids.bounds[1] / 0.96854, 0.356249, 5e-7 + 1e-7);
}

// The fields limit + h e and limit + 2 h e differ by h |e|. The coarser one is twice as far from the limit, and the safety factor is 3.
TEST(MadeUpField, IsBoundedByThreeTimesItsDistance)
{
    constexpr double difference = 0.3;
    EXPECT_EQ(analysis::two_fields(difference, 2.0, 1.0).bounds[1], 3.0 * 2.0 * difference);
}

}  // namespace
