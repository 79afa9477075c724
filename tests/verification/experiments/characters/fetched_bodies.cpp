// Man, Lady and Frankie where they are installed, and the ring. Reference: topology; the sizes in Table 1; the heights
// of MakeHuman's young figures; the volume of a ring by Pappus; the joints that clips name.
#include "experiments/characters/bodies.hpp"
#include "experiments/characters/named_bodies.hpp"
#include "experiments/clips/clip.hpp"
#include "pbs/geometry/topology.hpp"
#include "tests/support/expect_ball.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

namespace {

using namespace pbs;

struct Expected {
    const char* body;
    int table_1_vertices;
    double lowest_height_m, highest_height_m;
    std::size_t bones;
};

class FetchedBody : public testing::TestWithParam<Expected> {};

TEST_P(FetchedBody, IsABallOfGoodTetsAsLargeAsInTable1WithTheHumansBonesByName)
{
    if (!body_is_installed(GetParam().body)) GTEST_SKIP() << "pbskin fetch " << GetParam().body;
    const Character body = make_character({.body = GetParam().body});
    const Quality quality = quality_of(body.mesh);
    test_support::expect_ball(quality);
    // the specification of mesh_surface
    EXPECT_NEAR(quality.vertices, GetParam().table_1_vertices, 0.1 * GetParam().table_1_vertices);
    const double height_m = body.mesh.rest.col(1).maxCoeff() - body.mesh.rest.col(1).minCoeff();
    EXPECT_GT(height_m, GetParam().lowest_height_m);
    EXPECT_LT(height_m, GetParam().highest_height_m);

    EXPECT_EQ(body.skeleton.bones.size(), GetParam().bones);
    for (const Bone& bone : human_skeleton().bones) EXPECT_GE(find_bone(body.skeleton, bone.name), 0) << bone.name;
    for (const Bone& bone : body.skeleton.bones)
        if (bone.name.ends_with(".L")) {
            EXPECT_GT(0.5 * (bone.head + bone.tail)(0), 0.0) << bone.name;  // the figure's left is +x
        }
    EXPECT_GE(body.inputs.size(), 2u);
}

// The wrap lies up to an offset of the diagonal / 510 outside the skin: some millimetres at either end.
INSTANTIATE_TEST_SUITE_P(Bodies, FetchedBody,
                         testing::Values(Expected{"man", 1654, 1.74, 1.77, 23}, Expected{"lady", 1829, 1.60, 1.63, 23},
                                         Expected{"frankie", 2108, 0.57, 0.60, 26}),
                         [](const auto& info) { return std::string(info.param.body); });

TEST(Ring, HasOneHandleAndTheVolumeOfItsTube)
{
    const Character ring = make_character({.body = "ring"});
    const Quality quality = quality_of(ring.mesh);
    test_support::expect_ball(quality, 0);
    // Pappus: the area of the section times the path of its centre. The wrap adds an offset of the diagonal / 510 all
    // around; chords of facets reduce the volume by up to a few per cent.
    const double way_m = 4.0 * 0.36 + 2.0 * std::numbers::pi * 0.14, tube_m3 = std::numbers::pi * 0.07 * 0.07 * way_m;
    EXPECT_NEAR(quality.volume_m3 / tube_m3, 1.0, 0.1);
}

TEST(Ring, AClipBendsItAtTheKnee)
{
    if (!body_is_installed("human")) GTEST_SKIP() << "the clip comes with assimp-testmodels";
    const Character ring = make_character({.body = "ring"});
    const Motion motion =
        retarget(read_clip(find_clip("01_01.bvh", "")), ring.skeleton, {{.duration_s = 2.0, .rate_hz = 25.0}});
    double most_rad = 0.0;
    for (const Pose& pose : motion.steps)
        most_rad = std::max(most_rad,
                            Eigen::Quaterniond(pose[1].linear()).angularDistance(Eigen::Quaterniond(pose[2].linear())));
    EXPECT_GT(most_rad, 1.0);  // the crouch before a jump
}

TEST(Ring, RefusesAMeshTooCoarseForItsTube)
{
    EXPECT_THROW(make_character({.body = "ring", .vertices = 20}), std::exception);
}

}  // namespace
