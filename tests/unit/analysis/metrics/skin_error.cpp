// Reference: closed forms for translations, rotations and single vertices of a bar. Tolerances: a dozen roundings of a
// position or of a mean.
#include "analysis/metrics/skin_error.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/topology.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/structured_bar.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace {

using analysis::SkinError;
using analysis::SkinErrorMetrics;
using pbs::Positions;
using test_support::rounding_error;

const pbs::TetMesh skinned_bar = test_support::structured_bar({-1.0, -0.15, -0.15}, {1.0, 0.15, 0.15}, {8, 2, 2});
const std::vector<bool> nothing_left_out(skinned_bar.rest.rows(), false);
const double not_a_number = std::numeric_limits<double>::quiet_NaN();

// The bar has 2 m.
constexpr double to_compared_mm = 1e3 * 1.7 / 2.0;

SkinError error_of(const Positions& positions, const std::vector<bool>& left_out = nothing_left_out)
{
    return SkinErrorMetrics(skinned_bar.rest, skinned_bar.tets).measure(positions, skinned_bar.rest, left_out);
}

TEST(SkinError, OfATranslationIsItsLengthEverywhereAndTurnsNoNormal)
{
    const SkinError error = error_of(skinned_bar.rest.rowwise() + Eigen::RowVector3d(0.03, -0.04, 0.12));
    const double rounding_m = rounding_error(2, 1.2) + rounding_error(12, 0.13);
    for (const double mm : {error.rms_mm, error.p95_mm, error.largest_mm})
        EXPECT_NEAR(mm, 0.13 * to_compared_mm, rounding_m * to_compared_mm);
    EXPECT_NEAR(error.rms_pct, 13.0 / std::sqrt(4.0 + 2.0 * 0.09), 100.0 * rounding_m);
    // A normal of a triangle of 0.15 m and more turns by the rounding of its positions over its height.
    EXPECT_NEAR(error.normals_p95_deg, 0.0, 180.0 / std::numbers::pi * rounding_error(20, 1.2) / 0.1);
    EXPECT_EQ(error_of(skinned_bar.rest).largest_mm, 0.0);
    EXPECT_NEAR(error_of(skinned_bar.rest).normals_mean_deg, 0.0, rounding_error(20, 180.0));
}

// A quarter of a turn about x turns the normals of the four sides by 90 degrees, and leaves those of the two ends,
// whose area is 2 (0.3 m)^2 of 2 (0.3 m)^2 + 4 (0.3 m) (2 m): 7 %.
TEST(SkinError, OfARotationTurnsTheNormalsAcrossItsAxis)
{
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(std::numbers::pi / 2.0, pbs::Vec3::UnitX()).toRotationMatrix();
    const SkinError error = error_of(skinned_bar.rest * turn.transpose());
    const double ends = 0.18, sides = 2.4;
    EXPECT_NEAR(error.normals_mean_deg, 90.0 * sides / (sides + ends),
                rounding_error(100, 90.0) + 180.0 * rounding_error(20, 1.2));
    EXPECT_NEAR(error.normals_p95_deg, 90.0, rounding_error(20, 90.0));
}

// The skin of two tets has six triangles, three of which meet at an apex. The mean of |x - xref|^2 is that apex's share
// of the area.
TEST(SkinError, WeighsVerticesByTheAreaOfTheirTrianglesAndLeavesOutWhatIsMarked)
{
    const pbs::TetMesh two = test_support::two_tets(2.0);
    const pbs::Triangles skin = pbs::boundary_of(two.tets);
    ASSERT_EQ(skin.rows(), 6);
    double at_apex_m2 = 0.0, whole_m2 = 0.0;
    for (const auto& face : skin.rowwise()) {
        const pbs::Vec3 a = two.rest.row(face(0)), b = two.rest.row(face(1)), c = two.rest.row(face(2));
        const double area_m2 = (b - a).cross(c - a).norm() / 2.0;
        whole_m2 += area_m2;
        if ((face.array() == 4).any()) at_apex_m2 += area_m2 / 3.0;
    }
    Positions moved = two.rest;
    moved(4, 2) -= 0.5;
    const SkinErrorMetrics metrics(two.rest, two.tets);
    const double rms_m = 0.5 * std::sqrt(at_apex_m2 / whole_m2);
    EXPECT_NEAR(metrics.measure(moved, two.rest, std::vector<bool>(5, false)).rms_mm, 1e3 * 1.7 / 3.0 * rms_m,
                rounding_error(40, 1e3));
    const SkinError without_apex = metrics.measure(moved, two.rest, {false, false, false, false, true});
    EXPECT_EQ(without_apex.largest_mm, 0.0);
    EXPECT_NEAR(without_apex.normals_mean_deg, 0.0, rounding_error(20, 180.0));
    EXPECT_TRUE(std::isnan(metrics.measure(moved, two.rest, std::vector<bool>(5, true)).rms_mm));
    EXPECT_THROW(metrics.measure(skinned_bar.rest, two.rest, std::vector<bool>(5, false)), pbs::InputError);
    EXPECT_THROW(metrics.measure(moved, two.rest, std::vector<bool>(4, false)), pbs::InputError);
}

TEST(SkinError, ATriangleWithoutAreaIsTurnedAndAPositionThatIsNotFiniteIsNotMeasured)
{
    const SkinError collapsed = error_of(Positions::Zero(skinned_bar.rest.rows(), 3));
    EXPECT_EQ(collapsed.normals_mean_deg, 180.0);
    EXPECT_EQ(collapsed.normals_p95_deg, 180.0);
    for (const double broken : {not_a_number, std::numeric_limits<double>::infinity()}) {
        Positions moved = skinned_bar.rest;
        moved(0, 0) = broken;
        const SkinError error = error_of(moved);
        for (const double value : {error.rms_mm, error.p95_mm, error.largest_mm, error.rms_pct, error.normals_mean_deg,
                                   error.normals_p95_deg})
            EXPECT_TRUE(std::isnan(value)) << broken;
    }
}

TEST(WeightedQuantile, IsTheSmallestValueWithItsShareOfTheWeightBelow)
{
    EXPECT_EQ(analysis::weighted_quantile({3.0, 1.0, 2.0}, {2.0, 1.0, 1.0}, 0.5), 2.0);
    EXPECT_EQ(analysis::weighted_quantile({3.0, 1.0, 2.0}, {2.0, 1.0, 1.0}, 0.51), 3.0);
    EXPECT_EQ(analysis::weighted_quantile({3.0, 1.0, 2.0}, {0.0, 1.0, 0.0}, 0.95), 1.0);
    EXPECT_TRUE(std::isnan(analysis::weighted_quantile({}, {}, 0.5)));
    EXPECT_TRUE(std::isnan(analysis::weighted_quantile({1.0}, {0.0}, 0.5)));
    EXPECT_TRUE(std::isnan(analysis::weighted_quantile({1.0, not_a_number}, {1.0, 1.0}, 0.1)));
}

TEST(RemovedShare, IsOfTheErrorThatIsThere)
{
    EXPECT_EQ(analysis::removed_share_pct(8.0, 2.0), 75.0);
    EXPECT_EQ(analysis::removed_share_pct(2.0, 3.0), -50.0);
    EXPECT_TRUE(std::isnan(analysis::removed_share_pct(0.0, 1.0)));
}

}  // namespace
