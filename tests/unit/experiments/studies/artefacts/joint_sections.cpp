// Reference: theory of the blends on the built-in limb, whose vertices near the joint are blended with equal weights by Eq. 2. For a twist
// by t, LBS reduces their distance from the axis by cos(t/2), so the area of the section falls by cos^2(t/2). This is exact where the plane
// cuts only triangles of such vertices.
#include "experiments/studies/artefacts/joint_sections.hpp"

#include "pbs/character/bodies.hpp"
#include "pbs/skinning/blend.hpp"

#include <gtest/gtest.h>

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

    pbs::Character limb = pbs::make_character({.body = "limb"});
    JointSections sections{limb, experiments::limb_joints(limb)[0]};
    pbs::Pose pose;
};

TEST_F(JointSectionsOfLimb, AreWholeAtRest)
{
    const auto profile = sections.measure(limb.mesh.rest, pbs::Pose(2, Eigen::Isometry3d::Identity()));
    ASSERT_EQ(profile.size(), 21u);
    for (const auto& section : profile) {
        EXPECT_NEAR(section.area, 1.0, 1e-12);
        EXPECT_NEAR(section.smallest_radius, 1.0, 1e-12);
        EXPECT_EQ(section.outlines, 1);
        EXPECT_EQ(section.limb_share, 1.0);  // both bones are children of the parent
    }
}

TEST_F(JointSectionsOfLimb, AreaOfTheCandyWrapperIsTheSquaredCosineOfHalfTheTwist)
{
    for (const double angle_deg : {30.0, 90.0, 150.0}) {
        const double half = 0.5 * angle_deg * std::numbers::pi / 180.0;
        const auto extremes = extremes_of(sections.measure(lbs(pbs::Vec3::UnitX(), angle_deg), pose));
        EXPECT_NEAR(extremes.smallest_area, std::cos(half) * std::cos(half), 1e-9) << angle_deg;
        EXPECT_LE(extremes.smallest_radius, std::cos(half) + 1e-9) << angle_deg;
    }
}

TEST_F(JointSectionsOfLimb, HalfATurnLeavesNothing)
{
    const auto extremes = extremes_of(sections.measure(lbs(pbs::Vec3::UnitX(), 180.0), pose));
    EXPECT_NEAR(extremes.smallest_area, 0.0, 1e-12);
    EXPECT_NEAR(extremes.smallest_radius, 0.0, 1e-6);
}

TEST_F(JointSectionsOfLimb, MoveWithTheWholeBody)
{
    pbs::Positions twisted = lbs(pbs::Vec3::UnitX(), 60.0);
    const auto before = sections.measure(twisted, pose);
    Eigen::Isometry3d moved = Eigen::Isometry3d::Identity();
    moved.rotate(Eigen::AngleAxisd(0.8, pbs::Vec3(1, 2, -1).normalized()));
    moved.pretranslate(pbs::Vec3(3, -2, 1));
    for (auto& bone : pose) bone = moved * bone;
    for (Eigen::Index v = 0; v < twisted.rows(); ++v) twisted.row(v) = moved * pbs::Vec3(twisted.row(v));
    const auto after = sections.measure(twisted, pose);
    for (std::size_t i = 0; i < before.size(); ++i) EXPECT_NEAR(after[i].area, before[i].area, 1e-9) << i;
}

TEST_F(JointSectionsOfLimb, BendIsTheAngleBetweenTheBonesAndTwistIsNone)
{
    lbs(pbs::Vec3::UnitZ(), 70.0);
    EXPECT_NEAR(sections.bend_deg(pose), 70.0, 1e-9);
    lbs(pbs::Vec3::UnitX(), 70.0);
    EXPECT_NEAR(sections.bend_deg(pose), 0.0, 1e-9);
}

TEST_F(JointSectionsOfLimb, SkinThatIsGoneHasNoSize)
{
    const pbs::Positions away = limb.mesh.rest.rowwise() + Eigen::RowVector3d(10.0, 0.0, 0.0);
    const auto profile = sections.measure(away, pbs::Pose(2, Eigen::Isometry3d::Identity()));
    for (const auto& section : profile) EXPECT_EQ(section.area, 0.0);
}

}  // namespace
