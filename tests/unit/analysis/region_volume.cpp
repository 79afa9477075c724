// Reference: volumes of stretched unit cubes by hand; regions that cover all tets add up to the whole volume. Tolerances: a volume is
// rounded once, by its division by 6, and then there are the differences and sums over the tets of a region.
#include "analysis/metrics/frame_metrics.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/structured_bar.hpp"

#include <gtest/gtest.h>

namespace {

using namespace analysis;
using test_support::rounding_error;

const pbs::TetMesh bar = test_support::structured_bar({0, 0, 0}, {2, 1, 1}, {2, 1, 1});

// Region 0 is left of x = 1, region 1 right of it.
std::vector<int> halves()
{
    std::vector<int> region;
    for (Eigen::Index t = 0; t < bar.tets.rows(); ++t) {
        double x = 0.0;
        for (const int vertex : bar.tets.row(t)) x += bar.rest(vertex, 0) / 4.0;
        region.push_back(x < 1.0 ? 0 : 1);
    }
    return region;
}

TEST(RegionVolume, OnlyTheStretchedHalfGrows)
{
    pbs::Positions stretched = bar.rest;
    for (Eigen::Index i = 0; i < stretched.rows(); ++i) stretched(i, 0) += 0.5 * std::max(0.0, bar.rest(i, 0) - 1.0);
    const auto changes = RegionMetrics(bar.rest, bar.tets, halves()).measure(stretched);
    ASSERT_EQ(changes.size(), 2u);
    const double of_change = rounding_error(2 + 6, 1.5 + 1.0);
    EXPECT_EQ(changes[0].change_m3, 0.0);
    EXPECT_NEAR(changes[1].change_m3, 0.5, of_change);
    EXPECT_NEAR(changes[1].abs_change_m3, 0.5, of_change);
    EXPECT_NEAR(changes[1].rest_m3, 1.0, rounding_error(1 + 6, 1.0));
}

TEST(RegionVolume, InsideOutIsTwiceTheVolumeAndSignsDoNotCancelInTheAbsolute)
{
    pbs::Positions mirrored = bar.rest;
    mirrored.col(1) *= -1.0;
    const auto changes = RegionMetrics(bar.rest, bar.tets, halves()).measure(mirrored);
    EXPECT_NEAR(changes[0].change_m3, -2.0, rounding_error(2 + 6, 2.0));
    EXPECT_NEAR(changes[0].abs_change_m3, 2.0, rounding_error(2 + 6, 2.0));
    pbs::Positions moved = bar.rest;
    for (Eigen::Index i = 0; i < moved.rows(); ++i)
        if (bar.rest(i, 0) == 1.0) moved(i, 0) = 1.25;
    const auto both = RegionMetrics(bar.rest, bar.tets, std::vector<int>(bar.tets.rows(), 0)).measure(moved);
    EXPECT_NEAR(both[0].change_m3, 0.0, rounding_error(2 + 12, 2.0 + 2.0));
    EXPECT_NEAR(both[0].abs_change_m3, 0.5, rounding_error(2 + 12, 2.0 + 2.0));
}

TEST(RegionVolume, RegionsAddUpToTheWholeAndNoneIsLeftOut)
{
    pbs::Positions bent = bar.rest;
    for (Eigen::Index i = 0; i < bent.rows(); ++i) bent(i, 2) += 0.3 * bar.rest(i, 0) * bar.rest(i, 1);
    const auto changes = RegionMetrics(bar.rest, bar.tets, halves()).measure(bent);
    const double whole = pbs::tet_volumes(bent, bar.tets).sum() - pbs::tet_volumes(bar.rest, bar.tets).sum();
    EXPECT_NEAR(changes[0].change_m3 + changes[1].change_m3, whole, 2.0 * rounding_error(2 + 12, 2.0 + 2.0));  // the same volumes twice
    const std::vector<int> none(bar.tets.rows(), -1);
    EXPECT_TRUE(RegionMetrics(bar.rest, bar.tets, none).measure(bent).empty());
    EXPECT_NEAR(RegionMetrics(bar.rest, bar.tets, none).rest_volume_m3(), 2.0, rounding_error(1 + 12, 2.0));
}

TEST(RegionVolume, RefusesRegionsOfAnotherMesh)
{
    EXPECT_THROW(RegionMetrics(bar.rest, bar.tets, {0, 1}), pbs::InputError);
}

}  // namespace
