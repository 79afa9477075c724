// Reference: the definitions. Paper and rigid weights are those of weights.hpp, smooth ones are linear between cross-sections.
#include "pbs/character/skinning_weights.hpp"

#include "tests/support/bar_character.hpp"
#include "tests/unit/pbs/character/expect_input_error.hpp"

#include <gtest/gtest.h>

namespace {

using namespace pbs;

const Character bar_of_two_bones = test_support::bar_character({12, 2, 2});

void expect_same_weights(const Weights& weights, const Weights& expected)
{
    EXPECT_EQ(weights.first, expected.first);
    EXPECT_EQ(weights.bone, expected.bone);
    EXPECT_EQ(weights.weight, expected.weight);
}

TEST(SkinningWeights, PaperAndRigidAreThoseOfTheBinding)
{
    const Character& bar = bar_of_two_bones;
    expect_same_weights(weights_by(WeightKind::paper, bar), paper_weights(bar.binding, bar.skeleton));
    expect_same_weights(weights_by(WeightKind::rigid, bar), rigid_weights(bar.binding));
}

TEST(SkinningWeights, SmoothOnesAreThoseOfEquation2WhereOneBoneHoldsAVertexAlone)
{
    const Character& bar = bar_of_two_bones;
    const Weights smooth = weights_by(WeightKind::smooth, bar);
    ASSERT_EQ(smooth.vertices(), bar.mesh.rest.rows());
    int alone = 0;
    for (int v = 0; v < smooth.vertices(); ++v) {
        double sum = 0.0;
        for (int e = smooth.first[std::size_t(v)]; e < smooth.first[std::size_t(v) + 1]; ++e) sum += smooth.weight[std::size_t(e)];
        EXPECT_NEAR(sum, 1.0, 1e-12);
        if (bar.blended[std::size_t(v)]) continue;
        ++alone;
        EXPECT_FALSE(smooth.blended(v)) << v;
        EXPECT_EQ(smooth.bone[std::size_t(smooth.first[std::size_t(v)])], bar.binding.bone[std::size_t(v)]) << v;
    }
    EXPECT_GT(alone, 0);
}

// Whole cross-sections of the bar are held on either side of its joint at x = 0: the weights between are linear, and one half at the joint.
TEST(SkinningWeights, SmoothOnesAreLinearAcrossTheJoint)
{
    const Character& bar = bar_of_two_bones;
    const Weights smooth = weights_by(WeightKind::smooth, bar);
    double first = -1.0, last = 1.0;  // the held cross-sections nearest to the joint
    for (int v = 0; v < smooth.vertices(); ++v) {
        const double x = bar.mesh.rest(v, 0);
        if (bar.blended[std::size_t(v)]) continue;
        if (x < 0.0)
            first = std::max(first, x);
        else
            last = std::min(last, x);
    }
    for (int v = 0; v < smooth.vertices(); ++v) {
        const double x = bar.mesh.rest(v, 0);
        if (x < first || x > last) continue;
        double forearm = 0.0;
        for (int e = smooth.first[std::size_t(v)]; e < smooth.first[std::size_t(v) + 1]; ++e)
            if (smooth.bone[std::size_t(e)] == 1) forearm += smooth.weight[std::size_t(e)];
        EXPECT_NEAR(forearm, (x - first) / (last - first), 3e-6) << x;
    }
}

TEST(SkinningWeights, ArtistAndFileAreThoseThatTheCharacterBrings)
{
    Character character = bar_of_two_bones;
    EXPECT_FALSE(has_artist_weights(character));
    character.artist.emplace();
    EXPECT_FALSE(has_artist_weights(character)) << "a file without joints brings no weights";
    character.artist->weights = rigid_weights(character.binding);
    EXPECT_TRUE(has_artist_weights(character));
    expect_same_weights(weights_by(WeightKind::artist, character), rigid_weights(character.binding));
    character.weight_kind = WeightKind::file;
    expect_same_weights(weights_by(WeightKind::file, character), character.weights);
}

TEST(SkinningWeights, OnesThatTheCharacterDoesNotBringAreRefusedByName)
{
    expect_input_error([] { weights_by(WeightKind::artist, bar_of_two_bones); }, "bar: skinning.weights = artist: ", "brings such weights");
    expect_input_error([] { weights_by(WeightKind::file, bar_of_two_bones); }, "bar: skinning.weights = file: ", "brings such weights");
}

TEST(SkinningWeights, HaveNames)
{
    EXPECT_STREQ(name_of(WeightKind::paper), "paper");
    EXPECT_STREQ(name_of(WeightKind::rigid), "rigid");
    EXPECT_STREQ(name_of(WeightKind::smooth), "smooth");
    EXPECT_STREQ(name_of(WeightKind::diffused), "diffused");
    EXPECT_STREQ(name_of(WeightKind::artist), "artist");
    EXPECT_STREQ(name_of(WeightKind::file), "file");
}

}  // namespace
