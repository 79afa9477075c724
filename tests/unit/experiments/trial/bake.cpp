// The poses that correctives are learned from, and the skin of the exported surface. Reference: the definitions in bake.hpp, by hand.
#include "experiments/trial/bake.hpp"

#include "tests/support/bar_character.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

namespace {

using namespace experiments;

TEST(BakedPoses, TurnOneJointAloneByEachAngleAboutThreeAxes)
{
    const pbs::Character bar = test_support::bar_character({4, 1, 1});
    const std::vector<pbs::Pose> poses = poses_of_single_joints(bar);
    ASSERT_EQ(poses.size(), 12u);  // the forearm alone has a parent
    const double rounding = test_support::rounding_error(30, 180.0);
    for (std::size_t p = 0; p < poses.size(); ++p) {
        EXPECT_TRUE(poses[p][0].isApprox(Eigen::Isometry3d::Identity(), 0.0));
        const Eigen::AngleAxisd turn(poses[p][1].linear());
        EXPECT_NEAR(turn.angle() * 180.0 / M_PI, p % 4 == 0 || p % 4 == 3 ? 60.0 : 30.0, rounding);
        EXPECT_LT((poses[p][1] * bar.skeleton.bones[1].head - bar.skeleton.bones[1].head).norm(), rounding);
        EXPECT_NEAR(std::abs(turn.axis().x()), p < 4 ? 1.0 : 0.0, rounding) << "about the bone, then across it";
    }
}

TEST(BakedPoses, LeaveOutJointsWithoutFlesh)
{
    pbs::Character bar = test_support::bar_character({4, 1, 1});
    bar.skeleton.bones.push_back({"fingers", 1, {1, 0, 0}, {1.1, 0, 0}});
    EXPECT_EQ(poses_of_single_joints(bar).size(), 12u);
}

// A point in the middle of a tet has a quarter of the weights of each corner, of which the four heaviest bones remain.
TEST(BakedSurface, HasTheFourHeaviestBonesOfTheTetThatCarriesAPoint)
{
    pbs::Character character;
    character.mesh.rest = pbs::Positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    character.mesh.tets = pbs::Tets{{0, 1, 2, 3}};
    character.weights.first = {0};
    for (int corner = 0; corner < 4; ++corner) {
        character.weights.add(corner, 0.6);
        character.weights.add(4 + corner / 2, 0.4);
        character.weights.end_vertex();
    }
    character.surface.emplace();
    character.surface->tet = Eigen::VectorXi::Zero(2);
    character.surface->barycentric.resize(2, 4);
    character.surface->barycentric << 0.25, 0.25, 0.25, 0.25, 1.0, 0.0, 0.0, 0.0;
    const pbs::Weights weights = surface_weights(character);
    ASSERT_EQ(weights.first, (std::vector<int>{0, 4, 6}));
    const double rounding = test_support::rounding_error(20, 1.0);
    const double sum = 0.2 + 0.2 + 0.15 + 0.15;  // bones 4 and 5 have 0.4 / 4 twice, the first four 0.6 / 4
    for (const auto& [bone, share] : {std::pair(4, 0.2), std::pair(5, 0.2), std::pair(0, 0.15), std::pair(1, 0.15)})
        EXPECT_NEAR(weights.of(0, bone), share / sum, rounding) << bone;
    EXPECT_NEAR(weights.of(1, 0), 0.6, rounding);
    EXPECT_NEAR(weights.of(1, 4), 0.4, rounding);
}

}  // namespace
