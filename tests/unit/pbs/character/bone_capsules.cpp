// Reference: the capsule of a bone of a bar of known width, by hand.
#include "pbs/character/bone_capsules.hpp"
#include "pbs/character/bodies.hpp"

#include "tests/support/bar_character.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/unit/pbs/character/expect_input_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <set>

namespace {

using namespace pbs;
using pbs::Vec3;

pbs::Character bar()
{
    return test_support::bar_character({24, 2, 2});
}

const BoneCapsule capsule{{0, 0, 0}, {2, 0, 0}, 0.5, ""};  // of radius 1/2 and length 2 along x

TEST(BoneCapsules, SpanTheMiddleOfTheBone)
{
    const auto capsules = bone_capsules(bar(), 0.35);
    ASSERT_EQ(capsules.size(), 2u);
    EXPECT_EQ(capsules[1].start, Vec3(1.0 / 6.0, 0, 0));
    EXPECT_EQ(capsules[1].end, Vec3(5.0 / 6.0, 0, 0));
}

// With two cells across, the skin around the axis has 4 vertices at the half width a and 4 at sqrt(2) a: the mean is a (1 + sqrt(2)) / 2.
TEST(BoneCapsules, RadiusIsAShareOfTheMeanDistanceOfTheSkin)
{
    for (const BoneCapsule& of_bone : bone_capsules(bar(), 0.35)) {
        // The mean of eight distances in each of at most 25 sections, each after some eight roundings.
        EXPECT_NEAR(of_bone.radius_m, 0.35 * 0.15 * (1.0 + std::numbers::sqrt2) / 2.0,
                    test_support::mean_error(8 * 25 + 8, of_bone.radius_m));
        EXPECT_EQ(of_bone.radius_from, "skin on its middle");
    }
}

TEST(BoneCapsules, ABoneWithoutSkinOnItsMiddleTakesWhatIsNearestAndThenTheWholeSkin)
{
    pbs::Character character = bar();
    for (std::size_t v = 0; v < character.binding.bone.size(); ++v)
        if (character.binding.bone[v] == 1) character.binding.parameter(v) = 2.0;
    EXPECT_EQ(bone_capsules(character, 0.35)[1].radius_from, "skin nearest to it");
    for (int& bone : character.binding.bone) bone = 0;
    const auto capsules = bone_capsules(character, 0.35);
    EXPECT_EQ(capsules[1].radius_from, "the whole skin");
    EXPECT_GT(capsules[1].radius_m, 0.0);
}

TEST(BoneCapsules, ABoneWithoutLengthIsRefusedByName)
{
    pbs::Character character = bar();
    character.skeleton.bones[1].tail = character.skeleton.bones[1].head;
    expect_input_error([&] { bone_capsules(character, 0.35); }, "bar: bone = forearm: ", "");
}

TEST(BoneCapsules, ContainsItsAxisAndNothingBeyondItsEndsOrRadius)
{
    EXPECT_TRUE(capsule.contains({0, 0, 0}));
    EXPECT_TRUE(capsule.contains({1, 0.3, -0.39}));
    EXPECT_FALSE(capsule.contains({1, 0.3, -0.41}));
    EXPECT_FALSE(capsule.contains({-0.01, 0, 0}));
    EXPECT_FALSE(capsule.contains({2.01, 0, 0}));
    EXPECT_EQ(capsule.volume_m3(), std::numbers::pi * 0.25 * 2.0);
}

// Equal shares of the volume: means over the samples are those over the capsule, centre (1, 0, 0) and <radius^2> = r^2 / 2. A ring at the
// radius that halves its area has exactly the mean square of that area. Only the centre point, 1 / n of the disc, is counted with 0 instead
// of r^2 / (2 n), n = 193 points per disc: 1.3e-5 of r^2.
TEST(BoneCapsules, SamplesStandForEqualSharesOfTheVolume)
{
    const pbs::Positions samples = sample_points(capsule);
    EXPECT_EQ(samples.rows(), 40 * 193);
    // A sample goes through ten roundings. Those of the sums do not cancel, since all discs are alike.
    const auto terms = static_cast<std::size_t>(samples.rows() + 10);
    EXPECT_LT((samples.colwise().mean() - Eigen::RowVector3d(1, 0, 0)).norm(), test_support::mean_error(terms, 1.0));
    const double mean_square = samples.rightCols(2).rowwise().squaredNorm().mean();
    EXPECT_NEAR(mean_square, 0.25 / 2.0 - 0.25 / (2.0 * 193.0) / 193.0, test_support::mean_error(terms, mean_square));
    for (const auto& sample : samples.rowwise()) EXPECT_TRUE(capsule.contains(sample.transpose()));
}

// With steps of one radius. By hand: s = 1/2 a quarter off the axis, t = 1/2 a quarter from
// an end, where both steps are 1/2.
TEST(SmoothDensity, IsThatOfTheKernelsFormulas)
{
    const auto at = [&](AttachmentKernel kernel, const Vec3& point) { return smooth_density(capsule, kernel, 1.0, point); };
    EXPECT_DOUBLE_EQ(at(AttachmentKernel::biweight, {1, 0, 0}), 1.0);
    EXPECT_DOUBLE_EQ(at(AttachmentKernel::wendland, {1, 0, 0}), 1.0);
    EXPECT_DOUBLE_EQ(at(AttachmentKernel::biweight, {1, 0, 0.25}), 9.0 / 16.0);
    EXPECT_DOUBLE_EQ(at(AttachmentKernel::wendland, {1, 0.25, 0}), 3.0 / 16.0);
    EXPECT_DOUBLE_EQ(at(AttachmentKernel::biweight, {0.25, 0, 0}), 0.5);
    EXPECT_DOUBLE_EQ(at(AttachmentKernel::wendland, {1.75, 0, 0}), 0.5);
    for (const auto kernel : {AttachmentKernel::biweight, AttachmentKernel::wendland})
        for (const Vec3& outside : {Vec3(-0.1, 0, 0), Vec3(2.1, 0, 0), Vec3(1, 0.5, 0), Vec3(1, 0, 7)}) EXPECT_EQ(at(kernel, outside), 0.0);
}

// Steps longer than half of the capsule would not meet: each is half of it then, and the density is 1 in the middle alone.
TEST(SmoothDensity, StepsAreAtMostHalfOfTheCapsule)
{
    EXPECT_DOUBLE_EQ(smooth_density(capsule, AttachmentKernel::biweight, 10.0, {1, 0, 0}), 1.0);
    EXPECT_DOUBLE_EQ(smooth_density(capsule, AttachmentKernel::biweight, 10.0, {0.5, 0, 0}), 0.5);
}

TEST(BoneCapsules, ADensityOfSamplesMultipliesTheirNumbersInEachDirection)
{
    EXPECT_EQ(sample_points(capsule, 2).rows(), 80 * (1 + 16 * 48));
    EXPECT_THROW(sample_points(capsule, 0), std::invalid_argument);
}

// Reference: the built-in limb, whose skin is farther from the bones than the mean vertex, and a zone that consists of two known pieces.

TEST(JiggleZoneContents, OfTheLimbIsMostlySkinInOnePieceOnBothBones)
{
    const pbs::Character limb = pbs::make_character({.body = "limb", .vertices = 600});
    const auto zone = pbs::zone_contents(limb);
    const auto flags = pbs::jiggle_zone(limb.binding);
    EXPECT_DOUBLE_EQ(zone.share, double(std::count(flags.begin(), flags.end(), true)) / double(flags.size()));
    EXPECT_GT(zone.skin_share, 0.9);
    EXPECT_EQ(zone.pieces.size(), 1u);
    ASSERT_EQ(zone.bones.size(), 2u);
    EXPECT_DOUBLE_EQ(zone.bones[0].share_of_zone + zone.bones[1].share_of_zone, 1.0);
}

// Only the two ends of a bar are farther away than a prescribed distance.
TEST(JiggleZoneContents, TwoEndsAreTwoPiecesAndTogetherTheWholeZone)
{
    pbs::Character bar = test_support::character_of(test_support::two_bone_limb({10, 2, 2}, {0, 0, 1}, 0.0));
    for (Eigen::Index v = 0; v < bar.mesh.rest.rows(); ++v) bar.binding.distance(v) = std::abs(bar.mesh.rest(v, 0)) > 0.7 ? 1.0 : 0.0;
    const auto zone = pbs::zone_contents(bar);
    ASSERT_EQ(zone.pieces.size(), 2u);
    std::set<int> seen;
    for (const auto& piece : zone.pieces) seen.insert(piece.begin(), piece.end());
    EXPECT_EQ(seen.size(), zone.pieces[0].size() + zone.pieces[1].size());
    EXPECT_DOUBLE_EQ(zone.share, double(seen.size()) / double(bar.mesh.rest.rows()));
}

}  // namespace
