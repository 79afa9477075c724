// The training of correctives. Reference: the turns that poses are made of, the mirror image of a turn, the rules of
// the header for poses that are drawn, and the deformer of the same energy.
#include "experiments/run/corrective_training.hpp"

#include "experiments/deformers/registry.hpp"
#include "experiments/scene/scene.hpp"
#include "tests/support/bar_character.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace {

using namespace experiments;
using Eigen::Quaterniond;

const double rounding = test_support::rounding_error(60, M_PI);

Quaterniond turn(double deg, const pbs::Vec3& axis)
{
    return Quaterniond(Eigen::AngleAxisd(deg * M_PI / 180.0, axis.normalized()));
}

// A trunk with an arm on each side, whose hands have the names of a movement's joints.
pbs::Skeleton two_arms()
{
    pbs::Skeleton skeleton;
    skeleton.bones = {{"spine", -1, {0, 0, 0}, {0, 1, 0}},
                      {"forearm.L", 0, {0.2, 1, 0}, {0.6, 1, 0}},
                      {"hand.L", 1, {0.6, 1, 0}, {0.8, 1, 0}},
                      {"forearm.R", 0, {-0.2, 1, 0}, {-0.6, 1, 0}},
                      {"hand.R", 3, {-0.6, 1, 0}, {-0.8, 1, 0}}};
    return skeleton;
}

TEST(KnownRotations, AreThoseOfTheJointsThatTurn)
{
    const pbs::Skeleton skeleton = two_arms();
    const std::vector<Quaterniond> turns = {turn(40, {1, 2, 3}), turn(70, {0, 1, 1}), Quaterniond::Identity(),
                                            turn(20, {1, 0, 0}), turn(-90, {0, 0, 1})};
    const pbs::Pose rest(5, Eigen::Isometry3d::Identity());
    const JointRotations known =
        rotations_in(skeleton, {rest, pbs::pose_from_joints(skeleton, turns, pbs::Vec3(1, 2, 3))});
    ASSERT_EQ(known.size(), 5u);
    EXPECT_TRUE(known[0].empty()) << "the root";
    EXPECT_TRUE(known[2].empty()) << "it does not turn";
    for (const int bone : {1, 3, 4}) {
        ASSERT_EQ(known[bone].size(), 1u);
        EXPECT_LT(known[bone][0].angularDistance(turns[bone]), rounding);
    }
}

TEST(KnownRotations, OfMovementsAreMirroredToTheRight)
{
    const JointRotations known = rotations_of_movements(two_arms());
    EXPECT_GT(known[2].size(), 50u) << "several movements of the wrist";
    ASSERT_EQ(known[4].size(), known[2].size());
    Eigen::Matrix3d mirror = Eigen::Matrix3d::Identity();
    mirror(0, 0) = -1.0;
    for (std::size_t k = 0; k < known[2].size(); ++k)
        EXPECT_LT((known[4][k].toRotationMatrix() - mirror * known[2][k].toRotationMatrix() * mirror).norm(), rounding);
    EXPECT_TRUE(known[1].empty()) << "no movement turns this joint alone";
}

TEST(DrawnPosesOfTraining, TurnFewManyAndAllJointsNearTheirKnownRotations)
{
    const pbs::Skeleton skeleton = two_arms();
    JointRotations known(5);
    known[1] = {turn(90, {0, 0, 1}), turn(-60, {1, 0, 0})};
    constexpr double further_deg = 25.0;
    const std::vector<pbs::Pose> poses = drawn_poses(skeleton, known, {.count = 300, .further_deg = further_deg});
    ASSERT_EQ(poses.size(), 300u);
    std::array<int, 3> turned = {};
    int exact = 0;
    for (std::size_t p = 0; p < poses.size(); ++p) {
        EXPECT_TRUE(poses[p][0].isApprox(Eigen::Isometry3d::Identity(), 0.0));
        const JointRotations drawn = rotations_in(skeleton, {poses[p]});
        for (std::size_t bone = 1; bone < 5; ++bone) {
            turned[p % 3] += static_cast<int>(drawn[bone].size());
            for (const Quaterniond& rotation : drawn[bone]) {
                double nearest = known[bone].empty() ? rotation.angularDistance(Quaterniond::Identity()) : M_PI;
                for (const Quaterniond& one : known[bone]) nearest = std::min(nearest, rotation.angularDistance(one));
                EXPECT_LE(nearest, further_deg * M_PI / 180.0 + rounding);
                exact += nearest < 1e-7;
            }
        }
    }
    // Each third of the poses has 400 joints. The bounds are four standard deviations of a binomial distribution.
    EXPECT_NEAR(turned[0], 48, 4 * std::sqrt(400 * 0.12 * 0.88));
    EXPECT_NEAR(turned[1], 160, 4 * std::sqrt(400 * 0.4 * 0.6));
    EXPECT_EQ(turned[2], 400);
    EXPECT_EQ(exact, 0) << "no pose has exactly a known rotation";
}

TEST(DrawnPosesOfTraining, AreTheSameEachTime)
{
    const JointRotations known(5);
    const std::vector<pbs::Pose> once = drawn_poses(two_arms(), known, {.count = 9}),
                                 again = drawn_poses(two_arms(), known, {.count = 9});
    for (std::size_t p = 0; p < once.size(); ++p)
        for (std::size_t bone = 0; bone < 5; ++bone) EXPECT_EQ(once[p][bone].matrix(), again[p][bone].matrix());
    EXPECT_TRUE(drawn_poses(two_arms(), known, {.count = 0}).empty());
}

// Reference: the deformer quasi_newton, with as many iterations as it takes.
TEST(LinearElementsOfTraining, AreTheMinimumOfTheEnergy)
{
    const pbs::Character bar = test_support::bar_character({8, 2, 2});
    const std::vector<pbs::Pose> poses = drawn_poses(bar.skeleton, {{}, {turn(60, {0, 0, 1})}}, {.count = 6});
    FemOptions reference;
    reference.poisson = 0.3;
    const std::vector<pbs::CorrectiveSample> samples = solved_on_linear_elements(bar, reference, poses);
    ASSERT_EQ(samples.size(), poses.size());
    const auto minimiser = make_deformer(
        read_scene("limb_bend", {"deformers.use=[\"quasi_newton\"]", "reference.name=", "quasi_newton.poisson=0.3",
                                 "quasi_newton.iterations=500", "quasi_newton.precision=f64"})
            .deformers.front());
    minimiser->reset(bar);
    for (std::size_t p = 0; p < poses.size(); ++p) {
        minimiser->advance(poses[p], 0.01);
        pbs::Positions lbs;
        pbs::linear_blend_skinning(bar.mesh.rest, bar.weights, poses[p], lbs);
        const double moved_m = (minimiser->positions() - lbs).norm();
        EXPECT_LE((samples[p].shape - minimiser->positions()).norm(), 1e-4 * moved_m + 1e-9)
            << "solved to 1e-5 of the first step";
    }
}

TEST(LinearElementsOfTraining, EndWithTheirTimeAndNeedSprings)
{
    const pbs::Character bar = test_support::bar_character({4, 1, 1});
    const std::vector<pbs::Pose> poses = drawn_poses(bar.skeleton, JointRotations(2), {.count = 3});
    EXPECT_TRUE(solved_on_linear_elements(bar, {}, poses, -1.0).empty());
    FemOptions bound;
    bound.attachment = FemAttachment::bind;
    EXPECT_THROW(solved_on_linear_elements(bar, bound, poses), std::invalid_argument);
}

}  // namespace
