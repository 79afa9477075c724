// The places at which limbs are cut. Reference: the built-in limb's geometry, a capsule of radius 0.15 m around (-1,0,0) -> 0 -> (1,0,0).
// Tolerances: the rounding of a motion, and of the mean of two directions, which counts as another.
#include "experiments/run/frame_measurement.hpp"

#include "analysis/metrics/cross_section.hpp"
#include "pbs/character/bodies.hpp"
#include "tests/support/motion_rounding.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace {

pbs::Character small_limb()
{
    pbs::CharacterSource source;
    source.body = "limb";
    source.vertices = 600;
    return pbs::make_character(source);
}

TEST(LimbStations, StandAlongBothBonesAndAcrossTheJoint)
{
    const auto stations = experiments::limb_stations(small_limb());
    ASSERT_EQ(stations.size(), 11u);
    int joints = 0;
    for (const auto& station : stations) {
        EXPECT_EQ(station.point.tail<2>().norm(), 0.0);
        EXPECT_EQ(station.normal, pbs::Vec3::UnitX());
        joints += station.carriers.size() == 2;
    }
    EXPECT_EQ(joints, 1);
}

// The polygon inscribed in the circle of radius r has at least half the area of the circle, and at most all of it.
TEST(LimbStations, CutTheWholeLimb)
{
    const pbs::Character limb = small_limb();
    const double circle = std::numbers::pi * 0.15 * 0.15;
    for (const auto& station : experiments::limb_stations(limb)) {
        const double area = analysis::cross_section_area(limb.mesh.rest, limb.mesh.tets, station.tets, {station.point, station.normal});
        EXPECT_GT(area, 0.8 * circle) << station.name;
        EXPECT_LT(area, 1.01 * circle) << station.name;
    }
}

TEST(LimbStations, MoveWithTheirBones)
{
    const pbs::Character limb = small_limb();
    const auto motion = pbs::joint_sweep(limb.skeleton, 1, pbs::Vec3::UnitZ(), 90.0, 2, 0.01);
    for (const auto& station : experiments::limb_stations(limb)) {
        const pbs::Vec3 normal = experiments::posed_normal(station, motion.steps[1]);
        pbs::Vec3 expected = station.carriers.front() == 1 ? pbs::Vec3::UnitY() : pbs::Vec3::UnitX();
        if (station.carriers.size() == 2) expected = pbs::Vec3(1, 1, 0).normalized();
        EXPECT_LE((normal - expected).norm(), test_support::motion_error(2, 1.0)) << station.name;
    }
}

// Opposite directions have no mean, so the direction of the first bone is used.
TEST(LimbStations, AJointFoldedBackStillHasANormal)
{
    const pbs::Character limb = small_limb();
    const auto motion = pbs::joint_sweep(limb.skeleton, 1, pbs::Vec3::UnitZ(), 180.0, 2, 0.01);
    for (const auto& station : experiments::limb_stations(limb))
        EXPECT_NEAR(experiments::posed_normal(station, motion.steps[1]).norm(), 1.0, test_support::motion_error(2, 1.0));
}

}  // namespace
