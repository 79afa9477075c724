// Deformers that follow a motion whose first pose is far from rest. Theory: a bar whose half turns about its own axis
// has room for all of its tets, and on the way from rest none needs to be inverted; LBS at 165 degrees draws the joint
// into a thread and inverts tets. A rig on which PBS stays caught if it begins there is in
// tests/robustness/experiments/moving_characters.py.
#include "experiments/deformers/registry.hpp"
#include "tests/support/bar_character.hpp"

#include <gtest/gtest.h>

namespace {

using namespace experiments;

// A bar as an artist's rig would have it, with smooth weights.
pbs::Character rigged_bar()
{
    pbs::Character bar = test_support::bar_character({24, 4, 4});
    bar.weights = pbs::diffused_weights(bar.mesh, bar.weights);
    bar.artist.emplace();
    return bar;
}

pbs::Pose twisted(const pbs::Character& bar, double degrees)
{
    return pbs::joint_sweep(bar.skeleton, 1, pbs::Vec3::UnitX(), degrees, 2, 0.01).steps.back();
}

// The positions of the last of these frames.
pbs::Positions played(const std::string& kind, const pbs::Character& bar, const std::vector<double>& frames_deg,
                      bool foreseen)
{
    std::vector<pbs::Pose> poses;
    for (const double degrees : frames_deg) poses.push_back(twisted(bar, degrees));
    const auto deformer = make_deformer(default_spec(kind));
    deformer->reset(bar);
    if (foreseen) deformer->foresee(poses);
    for (const pbs::Pose& pose : poses) deformer->advance(pose, 0.01);
    return deformer->positions();
}

Eigen::Index inverted(const pbs::Character& bar, const pbs::Positions& positions)
{
    return (pbs::tet_volumes(positions, bar.mesh.tets).array() <= 0.0).count();
}

class FollowedStart : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Method, FollowedStart,
                         testing::Values("pbs", "xpbd", "xpbd_small_steps", "quasi_newton", "vbd", "warped_newton",
                                         "xpbd_neo_hookean", "projective_dynamics"));

TEST_P(FollowedStart, FarFramesAreReachedWithoutInvertedTets)
{
    const pbs::Character bar = rigged_bar();
    ASSERT_GT(inverted(bar, played("lbs", bar, {165.0}, false)), 10) << "a blend that inverts nothing catches nothing";
    for (const std::vector<double>& frames : {std::vector<double>{165.0}, {165.0, 172.0, 160.0}})
        EXPECT_EQ(inverted(bar, played(GetParam(), bar, frames, true)), 0) << frames.size() << " frames";
}

// Rigid weights draw the joint's tets through each other at a bend of 88 degrees, which is less than what is far.
TEST(FollowedStartOfPbs, GoesInStepsWhereTheFirstFrameKeepsTetsInsideOut)
{
    pbs::Character bar = rigged_bar();
    bar.weights = pbs::rigid_weights(bar.binding);
    const std::vector<pbs::Pose> bent = {
        pbs::joint_sweep(bar.skeleton, 1, pbs::Vec3::UnitZ(), 88.0, 2, 0.01).steps.back()};
    for (const bool is_foreseen : {false, true}) {
        const auto deformer = make_deformer(default_spec("pbs"));
        deformer->reset(bar);
        if (is_foreseen) deformer->foresee(bent);
        deformer->advance(bent.front(), 0.01);
        EXPECT_EQ(inverted(bar, deformer->positions()) == 0, is_foreseen);
        EXPECT_EQ(deformer->record().is_object() && deformer->record().contains("follows_from_rest"), is_foreseen);
    }
}

TEST_P(FollowedStart, NearFramesAndNamedBodiesKeepTheirBits)
{
    pbs::Character bar = rigged_bar();
    EXPECT_EQ(played(GetParam(), bar, {80.0, 165.0}, true), played(GetParam(), bar, {80.0, 165.0}, false));
    EXPECT_NE(played(GetParam(), bar, {165.0}, true), played(GetParam(), bar, {165.0}, false)) << "this motion is far";
    bar.artist.reset();
    EXPECT_EQ(played(GetParam(), bar, {165.0}, true), played(GetParam(), bar, {165.0}, false));
}

}  // namespace
