// The metrics of one frame, combined. Reference: maps with known results on the built-in limb. The planes that cut it
// have axes as normals, so that nothing of them is rounded.

#include "analysis/metrics/cross_section.hpp"
#include "experiments/characters/bodies.hpp"
#include "experiments/characters/bone_capsules.hpp"
#include "experiments/run/frame_measurement.hpp"
#include "tests/support/bar_character.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

namespace frame_measurement_tests {
namespace {

using namespace experiments;

pbs::Character small_limb(int vertices = 400)
{
    return pbs::make_character({.body = "limb", .vertices = vertices});
}

pbs::Pose rest_pose(const pbs::Character& character)
{
    return pbs::Pose(character.skeleton.bones.size(), Eigen::Isometry3d::Identity());
}

// The limb in its rest pose.
class LimbMeasurement : public testing::Test {
protected:
    FrameMeasurement measured(const pbs::Positions& positions, const OutputSpec& output = {}) const
    {
        return FrameMeasurer(limb, output, {}).measure(positions, context);
    }

    const pbs::Character limb = small_limb();
    pbs::Pose pose = rest_pose(limb);
    FrameContext context{.pose = &pose};
};

TEST_F(LimbMeasurement, TheRestPoseIsAllZero)
{
    context.reference = &limb.mesh.rest;
    const auto of = measured(limb.mesh.rest);
    EXPECT_EQ(of.metrics.volume_change_pct, 0.0);
    // The squares and sums of a distance may be ordered differently on both sides: three roundings and half of them of
    // the root.
    EXPECT_LE(of.bind_rms_m, test_support::rounding_error(2 * 3, limb.binding.distance.maxCoeff()));
    EXPECT_EQ(of.errors->l2_pct, 0.0);
    EXPECT_DOUBLE_EQ(*of.min_section_pct, 100.0);
    EXPECT_EQ(of.rotation_deg, 0.0);
}

// x -> (x, y/2, z/2): sections and volume fall to a quarter. Halves are exact, and so are areas and volumes up to the
// same powers of two; their sums, differences and ratios go through at most six roundings.
TEST_F(LimbMeasurement, AThinnedLimbHasAQuarterOfItsSection)
{
    pbs::Positions thinned = limb.mesh.rest;
    thinned.rightCols(2) *= 0.5;
    const auto of = measured(thinned);
    EXPECT_NEAR(*of.min_section_pct, 25.0, test_support::rounding_error(6, 25.0));
    EXPECT_NEAR(of.metrics.volume_change_pct, -75.0, test_support::rounding_error(6, 75.0));
    EXPECT_FALSE(of.errors);
}

// Two bars of width 0.3, 3 m apart at rest. The upper one comes down to the lower one, shifted by 0.03 so that no
// vertex meets a face of a tet. Its vertices in the middle of the face have the overlap as depth; to measure it, skins
// are moved by half of `touching`, edges in a slanted direction.
TEST(FrameMeasurement, StatesHowDeepSkinLiesInOtherFleshAndWhereItTouches)
{
    pbs::Character bars = test_support::bar_character({24, 4, 4});
    const pbs::TetMesh one = bars.mesh;
    const Eigen::Index vertices = one.rest.rows();
    bars.mesh.rest.resize(2 * vertices, 3);
    bars.mesh.rest << one.rest, one.rest.rowwise() + Eigen::RowVector3d(0.03, 0.03, 3.0);
    bars.mesh.tets.resize(2 * one.tets.rows(), 4);
    bars.mesh.tets << one.tets, one.tets.array() + static_cast<int>(vertices);
    const double touching_m = 1e-3 * (bars.mesh.rest.colwise().maxCoeff() - bars.mesh.rest.colwise().minCoeff()).norm();
    OutputSpec output;
    output.errors = output.sections = output.surface = false;
    FrameMeasurer measurer(bars, output, {});
    const auto depths_um = [&](double overlap_m) {
        pbs::Positions lowered = bars.mesh.rest;
        lowered.bottomRows(vertices).col(2).array() -= 3.0 - 0.3 + overlap_m;
        return measurer.contact_depths_um(lowered);
    };
    const auto least_and_most = [&](double overlap_m) {
        const std::vector<int> depths = depths_um(overlap_m);
        return std::pair(std::ranges::min(depths), std::ranges::max(depths));
    };
    EXPECT_NEAR(least_and_most(0.02).second, 20e3, 0.5e6 * touching_m);
    EXPECT_EQ(least_and_most(-0.25 * touching_m), std::pair(-1, 0));
    EXPECT_EQ(least_and_most(-2.0 * touching_m), std::pair(0, 0));
}

// The bar has vertices in 25 planes, at x = -1, -11/12 ... 1. The tip lies at x = 1 on the axis, with the radius 0.2.
// In the two planes at x = 1 and 11/12 it holds the vertex on the axis and the four in the middles of the sides; the
// corners are 0.21 from the axis. In the plane at x = 10/12 it holds the vertex on the axis alone.
TEST(FrameMeasurement, LeavesOutTheTipsOfCreasesButForTheErrorOnTheWholeBody)
{
    const pbs::Character bar = test_support::bar_character({24, 2, 2});
    const pbs::Pose pose = rest_pose(bar);
    const pbs::Positions& reference = bar.mesh.rest;
    OutputSpec output;
    output.sections = output.surface = false;
    FrameMeasurer measurer(bar, output, {});
    EXPECT_EQ(measurer.leave_out({}), 0.0);
    const CreaseTip tip{pbs::Vec3(1.0, 0.0, 0.0), 0.2};
    const double share_pct = measurer.leave_out({tip});
    EXPECT_GT(share_pct, 0.0);
    EXPECT_LT(share_pct, 100.0 * 2.5 / 24.0) << "less than two and a half sections";
    std::vector<bool> left_out;
    for (const auto& vertex : reference.rowwise())
        left_out.push_back((vertex.transpose() - tip.at_rest).norm() <= tip.radius_m);
    FrameContext context;
    context.pose = &pose;
    context.reference = &reference;
    for (std::size_t v = 0; v < left_out.size(); ++v) {
        pbs::Positions moved = reference;
        moved(static_cast<Eigen::Index>(v), 0) += 0.01;
        const auto measured = measurer.measure(moved, context);
        EXPECT_EQ(measured.masked_share_pct, share_pct);
        EXPECT_EQ(measured.errors->linf_m > 0.0, !left_out[v]) << v;
        EXPECT_GT(measured.errors_on_whole_body->linf_m, 0.0) << v;
    }
}

TEST(FrameMeasurement, SeesABodyThatPassesThroughItself)
{
    const pbs::Character bar = test_support::bar_character({24, 2, 2});
    const FrameMeasurer measurer(bar, {}, {});
    EXPECT_FALSE(measurer.overlaps(bar.mesh.rest));
    EXPECT_TRUE(measurer.overlaps(test_support::wound(bar.mesh.rest)));
}

TEST_F(LimbMeasurement, LeavesOutWhatIsNotAsked)
{
    OutputSpec output;
    output.errors = output.sections = output.surface = false;
    context.reference = &limb.mesh.rest;
    const auto of = measured(limb.mesh.rest, output);
    EXPECT_FALSE(of.errors);
    EXPECT_FALSE(of.min_section_pct);
}

// A rotation by the angle a differs from the identity by 2 sqrt 2 |sin(a / 2)| in the Frobenius norm, so that its angle
// is in error by less than its matrix, here of three motions: that of the root, of the bone and of one relative to the
// other.
TEST_F(LimbMeasurement, RotationIsRelativeToTheRoot)
{
    const Eigen::Isometry3d turned(Eigen::AngleAxisd(0.5, pbs::Vec3::UnitY()));
    const double degrees = 180.0 / std::numbers::pi, rounding_deg = degrees * test_support::motion_matrix_error(3, 0.0);
    pose = {turned, turned};
    EXPECT_NEAR(measured(limb.mesh.rest).rotation_deg, 0.0, rounding_deg);
    pose[1] = turned * Eigen::AngleAxisd(0.5, pbs::Vec3::UnitX());
    EXPECT_NEAR(measured(limb.mesh.rest).rotation_deg, 0.5 * degrees, rounding_deg);
}

TEST_F(LimbMeasurement, ABrokenFrameIsMeasuredNotRefused)
{
    pbs::Positions broken = limb.mesh.rest;
    broken(3, 1) = std::numeric_limits<double>::quiet_NaN();
    const auto of = measured(broken);
    EXPECT_TRUE(std::isnan(of.metrics.volume_change_pct));
    EXPECT_FALSE(of.min_section_pct);
}

// The error at the joints decides; if nothing is blended, the whole body decides, since there is no value for the
// joints.
TEST(FrameMeasurement, AnErrorNotAboveTheReferencesOwnIsMarked)
{
    FrameMeasurement measured;
    measured.errors = analysis::ErrorNorms{0.1, 2.0, 0.01};
    EXPECT_FALSE(measured.error_below_reference_error());  // there is no error bar
    measured.reference_error = analysis::ErrorNorms{0.5, 1.0, 0.5};
    EXPECT_FALSE(measured.error_below_reference_error());
    measured.reference_error->joint_pct = 2.0;
    EXPECT_TRUE(measured.error_below_reference_error());
    measured.errors->joint_pct = measured.reference_error->joint_pct = std::nan("");
    EXPECT_TRUE(measured.error_below_reference_error());
    measured.errors->l2_pct = 0.6;
    EXPECT_FALSE(measured.error_below_reference_error());
}

// The places at which limbs are cut. Reference: the built-in limb's geometry, a capsule of radius 0.15 m around
// (-1,0,0) -> 0 -> (1,0,0). Tolerances: the rounding of a motion, and of the mean of two directions, which counts as
// another.

// The polygon inscribed in the circle of radius r has at least half the area of the circle, and at most all of it.
TEST(LimbStations, StandAlongBothBonesAndAcrossTheJointAndCutTheWholeLimb)
{
    const pbs::Character limb = small_limb(600);
    const auto stations = limb_stations(limb);
    ASSERT_EQ(stations.size(), 11u);
    const double circle = std::numbers::pi * 0.15 * 0.15;
    int joints = 0;
    for (const auto& station : stations) {
        EXPECT_EQ(station.point.tail<2>().norm(), 0.0);
        EXPECT_EQ(station.normal, pbs::Vec3::UnitX());
        joints += station.carriers.size() == 2;
        EXPECT_EQ(std::ssize(station.tets), limb.mesh.tets.rows())
            << station.name << ": the bones in one line are one limb";
        const double area =
            analysis::cross_section_area(limb.mesh.rest, limb.mesh.tets, station.tets, {station.point, station.normal});
        EXPECT_GT(area, 0.8 * circle) << station.name;
        EXPECT_LT(area, 1.01 * circle) << station.name;
    }
    EXPECT_EQ(joints, 1);
}

// Opposite directions have no mean, so the direction of the first bone is used.
TEST(LimbStations, MoveWithTheirBonesAndHaveANormalAtAJointFoldedBack)
{
    const pbs::Character limb = small_limb(600);
    const auto posed = [&](double angle_deg) {
        return pbs::joint_sweep(limb.skeleton, 1, pbs::Vec3::UnitZ(), angle_deg, 2, 0.01).steps[1];
    };
    const pbs::Pose bent = posed(90.0), folded = posed(180.0);
    for (const auto& station : limb_stations(limb)) {
        const pbs::Vec3 normal = posed_normal(station, bent);
        pbs::Vec3 expected = station.carriers.front() == 1 ? pbs::Vec3::UnitY() : pbs::Vec3::UnitX();
        if (station.carriers.size() == 2) expected = pbs::Vec3(1, 1, 0).normalized();
        EXPECT_LE((normal - expected).norm(), test_support::motion_error(2, 1.0)) << station.name;
        EXPECT_NEAR(posed_normal(station, folded).norm(), 1.0, test_support::motion_error(2, 1.0)) << station.name;
    }
}

}  // namespace
}  // namespace frame_measurement_tests
