// Reference: the specified shape of the built-in limb (capsule of radius 0.15 m around (-1,0,0) -> 0 -> (1,0,0)), and
// refusals by field.

#include "experiments/characters/bodies.hpp"
#include "experiments/characters/body_cache.hpp"
#include "experiments/characters/bone_capsules.hpp"
#include "experiments/meshes/mesh_io.hpp"
#include "tests/support/arm_in_formats.hpp"
#include "tests/support/mesher_error.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/structured_bar.hpp"
#include "tests/unit/experiments/characters/expect_input_error.hpp"

#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace {

using namespace pbs;

const Character& limb()
{
    static const Character character = make_character({.body = "limb", .vertices = 600});
    return character;
}

TEST(Bodies, TheLimbHasTwoBonesAndLiesInItsCapsule)
{
    ASSERT_EQ(limb().skeleton.bones.size(), 2u);
    EXPECT_EQ(limb().skeleton.bones[0].name, "upper");
    EXPECT_EQ(limb().skeleton.bones[1].name, "forearm");
    EXPECT_EQ(limb().skeleton.bones[1].parent, 0);
    EXPECT_LE(limb().binding.distance.maxCoeff(), 0.15 + test_support::on_skin_m);
}

TEST(Bodies, EqTwoBlendsWithinASixthOfTheJointAndNowhereElse)
{
    const Character& character = limb();
    for (Eigen::Index vertex = 0; vertex < character.mesh.rest.rows(); ++vertex) {
        const double x = character.mesh.rest(vertex, 0);
        if (std::abs(std::abs(x) - 1.0 / 6.0) > 1e-9) {
            EXPECT_EQ(character.blended[vertex], std::abs(x) < 1.0 / 6.0) << x;
        }
    }
}

TEST(Bodies, RigidWeightsBlendNothingButTheZoneStaysKnown)
{
    const Character rigid = make_character({.body = "limb", .vertices = 600, .weights = WeightKind::rigid});
    EXPECT_EQ(rigid.weights.bone, rigid.binding.bone);
    EXPECT_EQ(rigid.blended, limb().blended);
}

TEST(Bodies, TheBarIsFilledToItsCorners)
{
    const Character bar = make_character({.body = "bar", .vertices = 600});
    // A point on a face goes through some ten roundings where a segment of up to the bar's length, 2 m, meets a plane.
    EXPECT_NEAR(bar.mesh.rest.col(0).maxCoeff(), 1.0, test_support::rounding_error(10, 2.0));
    EXPECT_NEAR(bar.mesh.rest.col(1).minCoeff(), -0.15, test_support::rounding_error(10, 2.0));
}

// Reference: the limb itself, and what it has on tets cut into eight.
TEST(Bodies, OnOtherTetsKeepTheBonesSizesAndAreCutIntoEightLikeOthers)
{
    const Character limb = make_character({.body = "limb", .vertices = 600}), other = remeshed(limb, {.seed = 1});
    EXPECT_NE(other.mesh.rest.rows(), limb.mesh.rest.rows());
    EXPECT_EQ(other.weights.vertices(), other.mesh.rest.rows());
    for (const Character& on_its_tets : {other, refined(other)}) {
        const auto own = bone_capsules(limb, 0.5), kept = bone_capsules(on_its_tets, 0.5);
        for (std::size_t b = 0; b < own.size(); ++b) EXPECT_EQ(kept[b].radius_m, own[b].radius_m);
    }
    EXPECT_EQ(refined(other).mesh.tets.rows(), 8 * other.mesh.tets.rows());
    Character cut = limb;
    cut.artist = ArtistSkin{.is_cut = true};
    expect_input_error([&] { remeshed(cut, {}); }, "limb: tets", "expected flesh in one piece");
}

TEST(Bodies, RefusesWhatIsNotThere)
{
    expect_input_error([] { make_character({.body = "limp"}); },
                       "character.body = limp: ", "expected limb, bar, ring, human, ");
    expect_input_error([] { make_character({}); }, "character.mesh: ", "expected a body");
    expect_input_error([] { make_character({.mesh_file = "arm.msh"}); }, "character.skeleton: ", "needs a skeleton");
    expect_input_error([] { make_character({.body = "limb", .vertices = -5}); },
                       "character.vertices = -5: ", "0 or more");
}

// Reference: the contents written to the files.

class BodyFiles : public test_support::FolderTest {
protected:
    void SetUp() override
    {
        write_tet_mesh(mesh, test_support::structured_bar(Vec3(-1, -0.1, -0.1), Vec3(1, 0.1, 0.1), {2, 1, 1}));
    }
    const std::string mesh = folder / "bar.vtu";
};

TEST_F(BodyFiles, AreReadAndHashed)
{
    const std::string bones = "[[joint]]\nname = \"only\"\nparent = \"\"\nhead_m = [-1, 0, 0]\ntail_m = [1, 0, 0]\n";
    const std::string skeleton = folder.file("bar.skeleton.toml", bones);
    std::string rows = "vertex,joint,weight\n";
    for (int vertex = 0; vertex < 12; ++vertex) rows += std::to_string(vertex) + ",only,1\n";
    const std::string weights = folder.file("bar.csv", rows);

    const Character bar = make_character({.mesh_file = mesh, .skeleton_file = skeleton, .weights_file = weights});
    EXPECT_EQ(bar.mesh.rest.rows(), 12);
    EXPECT_EQ(bar.weights.vertices(), 12);
    ASSERT_EQ(bar.inputs.size(), 4u);  // mesh, skeleton, tets, weights
    EXPECT_EQ(bar.inputs[0], std::pair(std::string("bar.vtu"), hash_of_file(mesh)));
    EXPECT_EQ(bar.inputs[1], std::pair(std::string("bar.skeleton.toml"), content_hash(bones)));
    EXPECT_EQ(bar.inputs[2].first, "tets");
    EXPECT_EQ(bar.inputs[3], std::pair(std::string("bar.csv"), content_hash(rows)));
}

// A COLLADA file whose body has no skin.
TEST_F(BodyFiles, AColladaFileWithoutASkinIsNoSkeleton)
{
    std::string text = test_support::collada_arm();
    const std::string skinned = R"(<instance_controller url="#skin"><skeleton>#root</skeleton></instance_controller>)";
    text.replace(text.find(skinned), skinned.size(), R"(<instance_geometry url="#arm"/>)");
    for (const char* name : {"arm.dae", "arm.toml"}) {
        const std::string skeleton = folder.file(name, text);
        expect_input_error([&] { make_character({.mesh_file = mesh, .skeleton_file = skeleton}); },
                           skeleton + ": skins = 0: ", "a COLLADA file without one is no skeleton");
    }
}

}  // namespace
