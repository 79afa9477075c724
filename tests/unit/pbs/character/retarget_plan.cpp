// Reference: the twist of q = swing * twist is the twist; CMU's names cover every bone of the human except the hips.
#include "pbs/character/retarget_plan.hpp"

#include "pbs/character/human.hpp"
#include "pbs/character/joint_map.hpp"
#include "tests/support/motion_rounding.hpp"

#include <gtest/gtest.h>

#include <set>

namespace {

using namespace pbs;

TEST(TwistAngle, OfATwistWithASwingBeforeIt)
{
    const Vec3 axis = Vec3(1.0, -2.0, 0.5).normalized();
    const Vec3 across = axis.cross(Vec3::UnitX()).normalized();
    for (const double angle : {-3.0, -1.0, 0.0, 0.3, 1.5, 3.1}) {
        const Eigen::Quaterniond q(Eigen::AngleAxisd(1.2, across) * Eigen::AngleAxisd(angle, axis));
        const double rounding = 2.0 * test_support::motion_error(2, 1.0);  // of two rotations, whose quaternions have half the angle
        EXPECT_NEAR(twist_angle(q, axis), angle, rounding);
        EXPECT_NEAR(twist_angle(Eigen::Quaterniond(-q.coeffs()), axis), angle, rounding) << "q and -q are one rotation";
    }
}

TEST(TwistAngle, OfASwingAloneIsZero)
{
    EXPECT_NEAR(twist_angle(Eigen::Quaterniond(Eigen::AngleAxisd(2.0, Vec3::UnitY())), Vec3::UnitX()), 0.0,
                test_support::motion_error(1, 1.0));
}

TEST(TwistAngle, OfAHalfTurnSwingIsFinite)  // where the twist is undefined
{
    EXPECT_TRUE(std::isfinite(twist_angle(Eigen::Quaterniond(0.0, 0.0, 1.0, 0.0), Vec3::UnitX())));
}

TEST(JointMap, NamesTheBonesOfTheHuman)
{
    const Skeleton human = human_skeleton();
    std::set<std::string> mapped;
    for (const JointMapping& mapping : cmu_joint_map()) {
        EXPECT_GE(find_bone(human, mapping.bone), 0) << mapping.bone;
        EXPECT_TRUE(mapped.insert(mapping.bone).second) << mapping.bone << " twice";
    }
    for (const Bone& bone : human.bones) EXPECT_EQ(mapped.count(bone.name), bone.name.starts_with("hip.") ? 0u : 1u) << bone.name;
}

}  // namespace
