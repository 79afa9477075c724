// Reference: what was packed is unpacked to the bit, and damaged bytes are refused.
#include "pbs/rig/rig_bytes.hpp"

#include "tests/support/two_joint_rig.hpp"
#include "tests/unit/pbs/character/expect_input_error.hpp"

#include <gtest/gtest.h>

namespace {

using namespace pbs;
using test_support::two_joint_rig;

void expect_damaged(const std::string& bytes)
{
    expect_input_error([&] { unpacked_rig(bytes, "b.glb"); }, "b.glb: ", "");
}

TEST(RigBytes, AreUnpackedToTheBit)
{
    Rig rig = two_joint_rig();
    rig.unit_m = 0.01;
    rig.remarks = {"a remark", ""};
    rig.nodes[0].rest.matrix = Eigen::Affine3d(Eigen::Translation3d(1.0 / 3.0, 0, 0));
    rig.nodes[1].rest.scale = Vec3(1, -2, 1.0 / 3.0);
    const Rig same = unpacked_rig(packed(rig), "b.glb");
    EXPECT_EQ(same.file, "b.glb");
    EXPECT_EQ(same.unit_m, 0.01);
    EXPECT_EQ(same.remarks, rig.remarks);
    ASSERT_EQ(same.nodes.size(), 3u);
    EXPECT_EQ(same.nodes[0].rest.matrix->matrix(), rig.nodes[0].rest.matrix->matrix());
    EXPECT_EQ(same.nodes[1].rest.scale, rig.nodes[1].rest.scale);
    EXPECT_EQ(same.nodes[1].parent, 0);
    EXPECT_EQ(same.meshes[0].points, rig.meshes[0].points);
    EXPECT_EQ(same.meshes[0].triangles, rig.meshes[0].triangles);
    EXPECT_EQ(same.meshes[0].joints[1].inverse_bind.matrix(), rig.meshes[0].joints[1].inverse_bind.matrix());
    EXPECT_EQ(same.meshes[0].skin.weight, rig.meshes[0].skin.weight);
    EXPECT_EQ(same.animations[0].name, "Bend");
    EXPECT_EQ(same.animations[0].nodes[0].rotation->values, rig.animations[0].nodes[0].rotation->values);
    EXPECT_FALSE(same.animations[0].nodes[0].scale);
}

TEST(RigBytes, ThatEndEarlyOrLateAreRefused)
{
    const std::string bytes = packed(two_joint_rig());
    for (std::size_t length = 0; length < bytes.size(); ++length) expect_damaged(bytes.substr(0, length));
    expect_damaged(bytes + "x");
}

TEST(RigBytes, WithIndicesOutOfRangeAreRefused)
{
    const std::vector<std::function<void(Rig&)>> damages = {
        [](Rig& rig) { rig.nodes[0].parent = 1; },
        [](Rig& rig) { rig.nodes[1].parent = 1; },
        [](Rig& rig) { rig.meshes[0].node = 3; },
        [](Rig& rig) { rig.meshes[0].triangles(0, 0) = 4; },
        [](Rig& rig) { rig.meshes[0].triangles(0, 0) = -1; },
        [](Rig& rig) { rig.meshes[0].joints[0].node = -1; },
        [](Rig& rig) { rig.meshes[0].skin.bone[0] = 2; },
        [](Rig& rig) { rig.meshes[0].skin.first[1] = 5; },
        [](Rig& rig) { rig.meshes[0].skin.first.pop_back(); },
        [](Rig& rig) { rig.animations[0].nodes[0].node = 3; },
        [](Rig& rig) {
            rig.animations[0].nodes[0].rotation->times_s = {1.0, 0.0};
        },
        [](Rig& rig) { rig.animations[0].nodes[0].rotation->times_s.clear(); },
        [](Rig& rig) { rig.animations[0].nodes[0].rotation->values.pop_back(); },
        [](Rig& rig) { rig.animations[0].end_s = -1.0; },
        [](Rig& rig) { rig.unit_m = 0.0; },
    };
    for (std::size_t number = 0; number < damages.size(); ++number) {
        SCOPED_TRACE(number);
        Rig rig = two_joint_rig();
        damages[number](rig);
        expect_damaged(packed(rig));
    }
}

TEST(RigBytes, WithNumbersThatAreNotFiniteOrHugeAreRefused)
{
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double bad : {nan, std::numeric_limits<double>::infinity(), 2e9}) {
        const std::vector<std::function<void(Rig&)>> damages = {
            [&](Rig& rig) { rig.meshes[0].points(2, 1) = bad; },
            [&](Rig& rig) { rig.nodes[0].rest.translation.y() = bad; },
            [&](Rig& rig) { rig.meshes[0].joints[1].inverse_bind.translation().x() = bad; },
            [&](Rig& rig) { rig.meshes[0].skin.weight[0] = bad; },
            [&](Rig& rig) { rig.animations[0].nodes[0].rotation->values[0].x() = bad; },
        };
        for (std::size_t number = 0; number < damages.size(); ++number) {
            SCOPED_TRACE(number);
            Rig rig = two_joint_rig();
            damages[number](rig);
            expect_damaged(packed(rig));
        }
    }
}

}  // namespace
