// Reference: the size of a body whose animation scales its root joint is that of the first frame.
#include "pbs/rig/rig_binding.hpp"

#include "tests/support/rounding_error.hpp"
#include "tests/support/two_joint_rig.hpp"
#include "tests/unit/pbs/character/expect_input_error.hpp"

#include <gtest/gtest.h>

namespace {

using namespace pbs;

Rig with_scaled_root(const Vec3& first)
{
    Rig rig = test_support::two_joint_rig();
    KeyTrack track;
    track.times_s = {0.0, 1.0};
    track.values = {{first.x(), first.y(), first.z(), 0}, {9, 9, 9, 0}};
    NodeTracks tracks;
    tracks.node = 0;
    tracks.scale = track;
    rig.animations = {{"Grow", 0.0, 1.0, {tracks}}};
    return rig;
}

TEST(ScaledAnimation, TheFirstFrameDeterminesTheSize)
{
    const Rig rig = with_scaled_root({3, 3, 3});
    const RigBinding binding = bind_rig(rig, &rig.animations[0], 1.0);
    const Positions expected = 3.0 * rig.meshes[0].points;
    // The scale is a cubic root of a determinant: some 20 roundings of numbers of at most 12.
    EXPECT_LE((rest_points(binding.meshes[0], binding) - expected).cwiseAbs().maxCoeff(), test_support::rounding_error(64, 12.0));
    EXPECT_EQ(binding.metres_per_unit, 1.0);
}

TEST(ScaledAnimation, AThousandthIsTakenForRounding)
{
    const Rig rig = with_scaled_root({1.0005, 1.0005, 1.0005});
    const RigBinding binding = bind_rig(rig, &rig.animations[0], 1.0);
    EXPECT_EQ(rest_points(binding.meshes[0], binding), bind_rig(rig, nullptr, 1.0).meshes[0].points);
}

TEST(ScaledAnimation, AScaleOfZeroIsRefusedByTheNameOfTheJoint)
{
    const Rig rig = with_scaled_root({0, 1, 1});
    expect_input_error([&] { bind_rig(rig, &rig.animations[0], 1.0); }, "arm.gltf: scale of root = 0: ", "not zero");
}

TEST(ScaledAnimation, AMirroredRootHasTheSizeOfItsMagnitude)
{
    const Rig rig = with_scaled_root({-2, 2, 2});
    const RigBinding binding = bind_rig(rig, &rig.animations[0], 1.0);
    EXPECT_LE((rest_points(binding.meshes[0], binding) - 2.0 * rig.meshes[0].points).cwiseAbs().maxCoeff(),
              test_support::rounding_error(64, 8.0));
}

}  // namespace
