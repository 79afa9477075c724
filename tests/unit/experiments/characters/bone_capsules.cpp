// Reference: the capsule of a bone of a bar of known width, by hand, and integrals over its parts.
#include "experiments/characters/bodies.hpp"
#include "experiments/characters/bone_capsules.hpp"
#include "experiments/characters/skinning_weights.hpp"

#include "tests/support/bar_character.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/unit/experiments/characters/expect_input_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <numbers>
#include <set>

namespace bone_capsules_tests {
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

// With two cells across, the skin around the axis has 4 vertices at the half width a and 4 at sqrt(2) a: the mean is a
// (1 + sqrt(2)) / 2.
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

// Equal shares of the volume: means over the samples are those over the capsule, centre (1, 0, 0) and <radius^2> = r^2
// / 2. A ring at the radius that halves its area has exactly the mean square of that area. Only the centre point, 1 / n
// of the disc, is counted with 0 instead of r^2 / (2 n), n = 193 points per disc: 1.3e-5 of r^2.
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
    const auto at = [&](AttachmentKernel kernel, const Vec3& point) {
        return smooth_density(capsule, kernel, 1.0, point);
    };
    EXPECT_DOUBLE_EQ(at(AttachmentKernel::biweight, {1, 0, 0}), 1.0);
    EXPECT_DOUBLE_EQ(at(AttachmentKernel::wendland, {1, 0, 0}), 1.0);
    EXPECT_DOUBLE_EQ(at(AttachmentKernel::biweight, {1, 0, 0.25}), 9.0 / 16.0);
    EXPECT_DOUBLE_EQ(at(AttachmentKernel::wendland, {1, 0.25, 0}), 3.0 / 16.0);
    EXPECT_DOUBLE_EQ(at(AttachmentKernel::biweight, {0.25, 0, 0}), 0.5);
    EXPECT_DOUBLE_EQ(at(AttachmentKernel::wendland, {1.75, 0, 0}), 0.5);
    for (const auto kernel : {AttachmentKernel::biweight, AttachmentKernel::wendland})
        for (const Vec3& outside : {Vec3(-0.1, 0, 0), Vec3(2.1, 0, 0), Vec3(1, 0.5, 0), Vec3(1, 0, 7)})
            EXPECT_EQ(at(kernel, outside), 0.0);
}

// Steps longer than half of the capsule would not meet: each is half of it then, and the density is 1 in the middle
// alone.
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

// The springs.

constexpr double length_m = 2.0 / 3.0;                                      // of the middle of each bone of the bar
constexpr double limb_radius_m = 0.15 * (1.0 + std::numbers::sqrt2) / 2.0;  // of the bar
// of the bar's section: its area and the mean of y^2
constexpr double part_area_m2 = 0.3 * 0.3, part_square_m2 = 0.3 * 0.3 / 12.0;

// Sums over the springs of one bone from the first of them on: of k, k x, k x^2 and k y^2.
Eigen::Vector4d moments(const BoneSprings& springs, int bone, Eigen::Index first = 0)
{
    Eigen::Vector4d sums = Eigen::Vector4d::Zero();
    for (Eigen::Index s = first; s < springs.points.rows(); ++s) {
        const double x = springs.points(s, 0), y = springs.points(s, 1);
        if (springs.bone[s] == bone) sums += springs.stiffness(s) * Eigen::Vector4d(1.0, x, x * x, y * y);
    }
    return sums;
}

// The density q / r^2 over the volume pi r^2 L is q pi L, whatever the radius is.
TEST(BoneSprings, OfEmbeddedBonesHaveOneDensityInTheWholeCapsule)
{
    const CapsuleSprings held =
        bone_springs(bar(), SpringPlacement::embedded, {.core_radius = 0.35, .spring_factor = 1e4});
    ASSERT_EQ(held.springs.points.rows(), 2 * 40 * 193);
    EXPECT_TRUE(std::ranges::all_of(held.density, [](double density) { return density == 1.0; }));
    const double total = 1e4 * std::numbers::pi * length_m, share = total / (40 * 193);
    for (const int bone : {0, 1})
        EXPECT_NEAR(moments(held.springs, bone)(0), total, test_support::mean_error(40 * 193 + 20, total));
    for (Eigen::Index s = 0; s < held.springs.points.rows(); ++s) {
        ASSERT_NEAR(held.springs.stiffness(s), share, test_support::rounding_error(20, share)) << s;
        ASSERT_TRUE(held.capsules[held.springs.bone[s]].contains(held.springs.points.row(s).transpose())) << s;
    }
}

// The biweight (1 - s^2)^2 has a third of the section's area, and a step over one radius at each end takes half of it:
// q pi (L - R) / 3. The midpoint rule over eight rings of equal area underestimates the first integral by 1 / (12 8^2)
// of the area, 0.4 % of it.
TEST(BoneSprings, OfSmoothAttachmentsHaveTheIntegralOfTheirDensity)
{
    const CapsuleSprings held =
        bone_springs(bar(), SpringPlacement::smooth, {.core_radius = 0.7, .spring_factor = 10.0});
    const double total = 10.0 * std::numbers::pi * (length_m - 0.7 * limb_radius_m) / 3.0;
    for (const int bone : {0, 1}) EXPECT_NEAR(moments(held.springs, bone)(0), total, 0.005 * total);
    for (Eigen::Index s = 0; s < held.springs.points.rows(); ++s)
        ASSERT_EQ(held.density[s], smooth_density(held.capsules[held.springs.bone[s]], AttachmentKernel::biweight, 1.0,
                                                  held.springs.points.row(s).transpose()));
}

// By hand: each half of the bar follows one bone alone, the plane of the joint follows both, and of the plane x = 1/2
// the forearm has no more than the threshold. The cells next to these planes, 1/12 long, are moved by two bones.
pbs::Character bar_of_known_parts()
{
    pbs::Character character = bar();
    Weights weights{.first = {0}, .bone = {}, .weight = {}};
    for (const auto& point : character.mesh.rest.rowwise()) {
        const auto is_at = [&](double x) { return std::abs(point.x() - x) < 1e-9; };
        const double forearm = is_at(0.0) ? 0.5 : is_at(0.5) ? weight_alone : point.x() < 0.0 ? 0.0 : 1.0;
        if (forearm < 1.0) weights.add(0, 1.0 - forearm);
        if (forearm > 0.0) weights.add(1, forearm);
        weights.end_vertex();
    }
    character.artist = ArtistSkin{.weights = weights};
    return character;
}

struct Part {
    double from, to;  // along x [m]
};
const std::vector<std::vector<Part>> parts_of_bones = {{{-1.0, -1.0 / 12.0}},
                                                       {{1.0 / 12.0, 5.0 / 12.0}, {7.0 / 12.0, 1.0}}};

TEST(BonesThatMoveAlone, AreThoseOfWeightsAboveTheThresholdAtAllCorners)
{
    const pbs::Character character = bar_of_known_parts();
    const std::vector<int> alone = bones_that_move_alone(character);
    ASSERT_EQ(alone.size(), static_cast<std::size_t>(character.mesh.tets.rows()));
    for (std::size_t tet = 0; tet < alone.size(); ++tet) {
        double x = 0.0;
        for (const int v : character.mesh.tets.row(tet)) x += character.mesh.rest(v, 0) / 4.0;
        int expected = -1;
        for (const int bone : {0, 1})
            for (const Part& part : parts_of_bones[bone])
                if (x > part.from && x < part.to) expected = bone;
        EXPECT_EQ(alone[tet], expected) << "tet " << tet << ", x = " << x;
    }
}

TEST(BonesThatMoveAlone, CountAsOneWhereTheyMoveAsOne)
{
    pbs::Character character = bar_of_known_parts();
    character.moves_with = {0, 0};
    EXPECT_EQ(bones_that_move_alone(character),
              std::vector<int>(static_cast<std::size_t>(character.mesh.tets.rows()), 0));
}

// A second bar of the same tets, away from the bones, is moved by a quarter of the one and three quarters of the other.
TEST(BoneSprings, OfAPartThatNoBoneHoldsPullItToItsPlaceByLinearBlendSkinning)
{
    pbs::Character character = bar_of_known_parts();
    const TetMesh own = character.mesh;
    const auto vertices = own.rest.rows(), tets = own.tets.rows();
    character.mesh.rest = own.rest.replicate(2, 1);
    character.mesh.rest.bottomRows(vertices).rowwise() += Eigen::RowVector3d(0, 5, 0);
    character.mesh.tets = own.tets.replicate(2, 1);
    character.mesh.tets.bottomRows(tets).array() += static_cast<int>(vertices);
    for (Eigen::Index v = 0; v < vertices; ++v) {
        character.artist->weights.add(0, 0.25);
        character.artist->weights.add(1, 0.75);
        character.artist->weights.end_vertex();
    }
    bind_by_paper(character);
    const CapsuleSprings held = bone_springs(character, SpringPlacement::held, {});
    EXPECT_EQ(held.loose_parts, 1);
    EXPECT_NEAR(held.loose_share, 0.5, test_support::rounding_error(2.0 * static_cast<double>(tets), 0.5));
    const PointLocation location(character.mesh);
    std::map<int, std::array<double, 2>> of_tet;  // the stiffness of the springs of each bone
    for (Eigen::Index s = 0; s < held.springs.points.rows(); ++s)
        if (held.springs.points(s, 1) > 2.5)
            of_tet[static_cast<int>(location.locate(held.springs.points.row(s)).tet)][held.springs.bone[s]] +=
                held.springs.stiffness(s);
    ASSERT_EQ(of_tet.size(), static_cast<std::size_t>(tets));
    for (const auto& [tet, stiffness] : of_tet)
        EXPECT_NEAR(stiffness[1], 3.0 * stiffness[0], test_support::rounding_error(60, stiffness[1])) << tet;
}

// The rule of four points integrates polynomials of degree 2 exactly.
TEST(BoneSprings, OfHeldPartsFillThemAndCrossNoBones)
{
    const pbs::Character character = bar_of_known_parts();
    const BoneSprings smooth = bone_springs(character, SpringPlacement::smooth, {}).springs,
                      held = bone_springs(character, SpringPlacement::held, {}).springs;
    const Eigen::Index first = smooth.points.rows();
    ASSERT_GT(held.points.rows(), first);
    EXPECT_EQ(held.points.topRows(first), smooth.points);
    EXPECT_EQ(held.stiffness.head(first), smooth.stiffness);
    const double density = 1e4 / std::pow(0.35 * limb_radius_m, 2);
    for (const int bone : {0, 1}) {
        Eigen::Vector4d expected = Eigen::Vector4d::Zero();
        for (const auto& [a, b] : parts_of_bones[bone])
            expected +=
                density * part_area_m2 *
                Eigen::Vector4d(b - a, (b * b - a * a) / 2.0, (b * b * b - a * a * a) / 3.0, (b - a) * part_square_m2);
        const Eigen::Vector4d sums = moments(held, bone, first);
        // A term goes through fewer than 60 roundings, those of the tet's volume and of the limb's radius among them.
        for (int i = 0; i < 4; ++i)
            EXPECT_NEAR(sums(i), expected(i),
                        test_support::mean_error(static_cast<std::size_t>(held.points.rows()) + 60, expected(0)));
    }
    const PointLocation location(character.mesh);
    const std::vector<int> alone = bones_that_move_alone(character);
    for (Eigen::Index s = first; s < held.points.rows(); ++s)
        ASSERT_EQ(alone[location.locate(held.points.row(s)).tet], held.bone[s]) << s;
}

// Without an artist, the weights are those of Eq. 2, smoothed over the edges. Finer tets have the same springs.
TEST(BoneSprings, OfHeldPartsOfTheLimbAreThoseOfItsUnrefinedTets)
{
    const pbs::Character limb = pbs::make_character({.body = "limb", .vertices = 300});
    const std::vector<int> alone = bones_that_move_alone(limb);
    const Weights weights = weights_by(WeightKind::diffused, limb);
    std::set<int> bones(alone.begin(), alone.end());
    EXPECT_EQ(bones, (std::set<int>{-1, 0, 1}));
    for (std::size_t tet = 0; tet < alone.size(); ++tet)
        for (const int bone : {0, 1}) {
            const auto corners = limb.mesh.tets.row(tet);
            const bool is_alone = std::ranges::all_of(corners, [&](int v) { return weights.of(v, bone) > 0.99; });
            EXPECT_EQ(alone[tet] == bone, is_alone) << tet;
        }
    const BoneSprings coarse = bone_springs(limb, SpringPlacement::held, {}).springs,
                      fine = bone_springs(refined(limb), SpringPlacement::held, {}).springs;
    EXPECT_EQ(fine.points, coarse.points);
    EXPECT_EQ(fine.stiffness, coarse.stiffness);
    EXPECT_EQ(fine.bone, coarse.bone);
}

// Reference: the built-in limb, whose skin is farther from the bones than the mean vertex, and a zone that consists of
// two known pieces.

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
    for (Eigen::Index v = 0; v < bar.mesh.rest.rows(); ++v)
        bar.binding.distance(v) = std::abs(bar.mesh.rest(v, 0)) > 0.7 ? 1.0 : 0.0;
    const auto zone = pbs::zone_contents(bar);
    ASSERT_EQ(zone.pieces.size(), 2u);
    std::set<int> seen;
    for (const auto& piece : zone.pieces) seen.insert(piece.begin(), piece.end());
    EXPECT_EQ(seen.size(), zone.pieces[0].size() + zone.pieces[1].size());
    EXPECT_DOUBLE_EQ(zone.share, double(seen.size()) / double(bar.mesh.rest.rows()));
}

}  // namespace
}  // namespace bone_capsules_tests
