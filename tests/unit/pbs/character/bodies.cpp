// Reference: the specified shape of the built-in limb (capsule of radius 0.15 m around (-1,0,0) -> 0 -> (1,0,0)), and refusals by field.
#include "pbs/character/bodies.hpp"

#include "tests/support/mesher_error.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/unit/pbs/character/expect_input_error.hpp"

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

TEST(Bodies, RefusesWhatIsNotThere)
{
    expect_input_error([] { make_character({.body = "limp"}); },
                       "character.body = limp: ", "expected limb, bar, ring, human, man, lady or frankie");
    expect_input_error([] { make_character({}); }, "character.mesh: ", "expected a body");
    expect_input_error([] { make_character({.mesh_file = "arm.msh"}); }, "character.skeleton: ", "needs a skeleton");
    expect_input_error([] { make_character({.body = "limb", .vertices = -5}); }, "character.vertices = -5: ", "0 or more");
}

}  // namespace
