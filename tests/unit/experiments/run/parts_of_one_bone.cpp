// Reference: rigid motions, of which the angle is known.

#include "experiments/characters/bodies.hpp"
#include "experiments/characters/model_character.hpp"
#include "experiments/run/parts_of_one_bone.hpp"
#include "pbs/geometry/topology.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace {

using namespace experiments;

Eigen::Isometry3d turned(double angle_deg)
{
    Eigen::Isometry3d turn(
        Eigen::AngleAxisd(angle_deg * std::numbers::pi / 180.0, pbs::Vec3(1.0, 2.0, -2.0).normalized()));
    turn.translation() = pbs::Vec3(0.3, -2.0, 0.1);
    return turn;
}

class LagOfTheLimb : public testing::Test {
protected:
    const pbs::Character limb = pbs::make_character({.body = "limb", .vertices = 400});
    const PartsOfOneBone parts{limb};
    const pbs::Pose rest = pbs::Pose(limb.skeleton.bones.size(), Eigen::Isometry3d::Identity());
    // The lag is the difference of two rotations, in radians within some epsilons, and 1 - cos doubles the digits that
    // are lost near zero.
    static constexpr double rounding_deg = 1e-6;
};

TEST_F(LagOfTheLimb, IsNoneWhereTheFleshMovesWithItsBones)
{
    const Eigen::Isometry3d turn = turned(70.0);
    const pbs::Positions moved =
        (limb.mesh.rest * turn.linear().transpose()).rowwise() + turn.translation().transpose();
    const PartLag lag = parts.largest_lag(moved, pbs::Pose(limb.skeleton.bones.size(), turn));
    EXPECT_GE(lag.bone, 0);
    EXPECT_NEAR(lag.turn_deg, 0.0, rounding_deg);
}

TEST_F(LagOfTheLimb, IsTheTurnOfTheBoneThatTheFleshDoesNotFollow)
{
    for (const std::size_t bone : {std::size_t{0}, limb.skeleton.bones.size() - 1}) {
        pbs::Pose pose = rest;
        pose[bone] = turned(36.0);
        const PartLag lag = parts.largest_lag(limb.mesh.rest, pose);
        EXPECT_EQ(lag.bone, static_cast<int>(bone));
        EXPECT_NEAR(lag.turn_deg, 36.0, rounding_deg);
        EXPECT_GT(lag.share, 0.0);
        EXPECT_LT(lag.share, 0.5) << "one of two bones, without the joint";
    }
}

// The tets are thicker than what one bone alone moves, so that only the artist's points show that they stay behind. The
// second copy of every point, as along a texture seam, belongs to the same part.
TEST(LagOfAPart, IsMeasuredOnTheArtistsPointsWhereNoTetBelongsToOneBone)
{
    pbs::Character limb = pbs::make_character({.body = "limb", .vertices = 400});
    auto model = std::make_shared<pbs::RiggedModel>();
    const Eigen::Index points = limb.mesh.rest.rows();
    model->body.surface = limb.mesh.rest.replicate(2, 1);
    model->body.triangles = pbs::boundary_of(limb.mesh.tets);
    for (Eigen::Index f = 0; f < model->body.triangles.rows(); f += 2)
        model->body.triangles.row(f).array() += static_cast<int>(points);
    pbs::Weights& weights = limb.artist.emplace().weights;
    weights.first = model->body.skin.first = {0};
    for (Eigen::Index p = 0; p < 2 * points; ++p) {
        model->body.skin.add(0, 1.0);
        model->body.skin.end_vertex();
        if (p >= points) continue;
        for (const auto& [bone, weight] : {std::pair(0, 0.9), std::pair(1, 0.1)}) weights.add(bone, weight);
        weights.end_vertex();
    }
    limb.surface = pbs::embed(model->body.surface, model->body.triangles, limb.mesh);
    limb.artist->model = model;
    pbs::Pose pose(limb.skeleton.bones.size(), Eigen::Isometry3d::Identity());
    pose[0] = turned(36.0);
    const PartLag lag = PartsOfOneBone(limb).largest_lag(limb.mesh.rest, pose);
    EXPECT_EQ(lag.bone, 0);
    EXPECT_NEAR(lag.turn_deg, 36.0, 1e-6);
    EXPECT_NEAR(lag.share, 1.0, 1e-12) << "all of the surface";
    pose[0] = turned(4.9);
    EXPECT_EQ(PartsOfOneBone(limb).largest_lag(limb.mesh.rest, pose).share, 0.0);
}

// Every vertex is blended between both bones.
TEST(LagOfAPart, IsOfNoBoneWhereNoneMovesATetAlone)
{
    pbs::Character limb = pbs::make_character({.body = "limb", .vertices = 400});
    pbs::Weights& weights = limb.artist.emplace().weights;
    weights.first = {0};
    for (Eigen::Index v = 0; v < limb.mesh.rest.rows(); ++v) {
        for (const int bone : {0, 1}) weights.add(bone, 0.5);
        weights.end_vertex();
    }
    const pbs::Pose pose(limb.skeleton.bones.size(), turned(36.0));
    EXPECT_EQ(PartsOfOneBone(limb).largest_lag(limb.mesh.rest, pose).bone, -1);
}

}  // namespace
