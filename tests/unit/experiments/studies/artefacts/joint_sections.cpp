// Reference: theory of the blends on the built-in limb, whose vertices near the joint are blended with equal weights by Eq. 2. For a twist
// by t, LBS reduces their distance from the axis by cos(t/2), so the area of the section falls by cos^2(t/2). This is exact where the plane
// cuts only triangles of such vertices. Tolerances: the rounding of the points at which planes cut edges.
#include "experiments/studies/artefacts/joint_sections.hpp"

#include "pbs/character/bodies.hpp"
#include "pbs/geometry/topology.hpp"
#include "pbs/skinning/blend.hpp"
#include "tests/support/motion_rounding.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace {

using experiments::JointSections;

class JointSectionsOfLimb : public testing::Test {
protected:
    pbs::Positions lbs(const pbs::Vec3& axis, double angle_deg)
    {
        pose = pbs::joint_sweep(limb.skeleton, 1, axis, angle_deg, 2, 0.01).steps[1];
        pbs::Positions posed;
        pbs::linear_blend_skinning(limb.mesh.rest, limb.weights, pose, posed);
        return posed;
    }

    // The rounding error of an area or a radius over that at rest. A vertex has the rounding error of its motions, and its height above a
    // plane that of eight more roundings; a cut moves by as much over the sine of the angle between its edge and the plane, and goes
    // through six roundings. Moving all points of an outline by e changes its area by at most e times its length, and a radius by 2 e; at
    // rest, an outline has a length of 2 pi r at most, four fifths of the area pi r^2 at least, and radii of 0.8 r at least. A ratio has
    // the errors of two sections. The planes cut across x.
    double rounding(const pbs::Positions& posed, int motions, double farthest_m) const
    {
        const pbs::Edges edges = pbs::edges_of(limb.mesh.tets);
        double smallest_sine = 1.0;
        for (const auto& section : sections.measure(limb.mesh.rest, pbs::Pose(2, Eigen::Isometry3d::Identity())))
            for (const auto& edge : edges.rowwise()) {
                const Eigen::RowVector3d a = posed.row(edge(0)), b = posed.row(edge(1));
                if ((a.x() - section.offset_m) * (b.x() - section.offset_m) > 0.0) continue;
                smallest_sine = std::min(smallest_sine, std::abs(a.x() - b.x()) / (a - b).norm());
            }
        const double of_vertex = test_support::motion_error(motions, farthest_m) + test_support::rounding_error(8, farthest_m);
        const double of_cut = of_vertex / smallest_sine + test_support::rounding_error(6, farthest_m);
        return 2.0 * 2.0 * of_cut / (0.8 * 0.15);
    }

    pbs::Character limb = pbs::make_character({.body = "limb"});
    JointSections sections{limb, experiments::limb_joints(limb)[0]};
    pbs::Pose pose;
};

TEST_F(JointSectionsOfLimb, AreWholeAtRest)
{
    const auto profile = sections.measure(limb.mesh.rest, pbs::Pose(2, Eigen::Isometry3d::Identity()));
    const double whole = rounding(limb.mesh.rest, 0, 1.15);
    ASSERT_EQ(profile.size(), 21u);
    for (const auto& section : profile) {
        EXPECT_NEAR(section.area, 1.0, whole);
        EXPECT_NEAR(section.smallest_radius, 1.0, whole);
        EXPECT_EQ(section.outlines, 1);
        EXPECT_EQ(section.limb_share, 1.0);  // both bones are children of the parent
    }
}

TEST_F(JointSectionsOfLimb, AreaOfTheCandyWrapperIsTheSquaredCosineOfHalfTheTwist)
{
    for (const double angle_deg : {30.0, 90.0, 150.0}) {
        const double half = 0.5 * angle_deg * std::numbers::pi / 180.0;
        const pbs::Positions twisted = lbs(pbs::Vec3::UnitX(), angle_deg);
        const auto extremes = extremes_of(sections.measure(twisted, pose));
        EXPECT_NEAR(extremes.smallest_area, std::cos(half) * std::cos(half), rounding(twisted, 2, 1.15)) << angle_deg;
        EXPECT_LE(extremes.smallest_radius, std::cos(half) + rounding(twisted, 2, 1.15)) << angle_deg;
    }
}

TEST_F(JointSectionsOfLimb, HalfATurnLeavesNothing)
{
    const pbs::Positions twisted = lbs(pbs::Vec3::UnitX(), 180.0);
    const auto extremes = extremes_of(sections.measure(twisted, pose));
    EXPECT_LE(extremes.smallest_area, rounding(twisted, 2, 1.15));
    EXPECT_LE(extremes.smallest_radius, rounding(twisted, 2, 1.15));
}

TEST_F(JointSectionsOfLimb, MoveWithTheWholeBody)
{
    pbs::Positions twisted = lbs(pbs::Vec3::UnitX(), 60.0);
    const auto before = sections.measure(twisted, pose);
    const double tolerance = rounding(twisted, 3, 1.15 + pbs::Vec3(3, -2, 1).norm());
    Eigen::Isometry3d moved = Eigen::Isometry3d::Identity();
    moved.rotate(Eigen::AngleAxisd(0.8, pbs::Vec3(1, 2, -1).normalized()));
    moved.pretranslate(pbs::Vec3(3, -2, 1));
    for (auto& bone : pose) bone = moved * bone;
    for (Eigen::Index v = 0; v < twisted.rows(); ++v) twisted.row(v) = moved * pbs::Vec3(twisted.row(v));
    const auto after = sections.measure(twisted, pose);
    for (std::size_t i = 0; i < before.size(); ++i) EXPECT_NEAR(after[i].area, before[i].area, tolerance) << i;
}

TEST_F(JointSectionsOfLimb, BendIsTheAngleBetweenTheBonesAndTwistIsNone)
{
    // An angle in radians is in error by less than the matrix of a rotation.
    const double rounding_deg = 180.0 / std::numbers::pi * test_support::motion_matrix_error(2, 0.0);
    lbs(pbs::Vec3::UnitZ(), 70.0);
    EXPECT_NEAR(sections.bend_deg(pose), 70.0, rounding_deg);
    lbs(pbs::Vec3::UnitX(), 70.0);
    EXPECT_NEAR(sections.bend_deg(pose), 0.0, rounding_deg);
}

TEST_F(JointSectionsOfLimb, SkinThatIsGoneHasNoSize)
{
    const pbs::Positions away = limb.mesh.rest.rowwise() + Eigen::RowVector3d(10.0, 0.0, 0.0);
    const auto profile = sections.measure(away, pbs::Pose(2, Eigen::Isometry3d::Identity()));
    for (const auto& section : profile) EXPECT_EQ(section.area, 0.0);
}

}  // namespace
