// Reference: the definitions. Paper and rigid weights are those of weights.hpp, smooth ones are linear between
// cross-sections.

#include "experiments/characters/skinning_weights.hpp"
#include "pbs/geometry/topology.hpp"
#include "tests/support/bar_character.hpp"
#include "tests/support/structured_bar.hpp"
#include "tests/support/weight_sums.hpp"
#include "tests/unit/experiments/characters/expect_input_error.hpp"

#include <gtest/gtest.h>

namespace {

using namespace pbs;
using test_support::weight_in;

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
    expect_same_weights(weights_by(WeightKind::either_end, bar), either_end_weights(bar.binding, bar.skeleton));
}

TEST(SkinningWeights, SmoothOnesAreThoseOfEquation2WhereOneBoneHoldsAVertexAlone)
{
    const Character& bar = bar_of_two_bones;
    const Weights smooth = weights_by(WeightKind::smooth, bar);
    ASSERT_EQ(smooth.vertices(), bar.mesh.rest.rows());
    int alone = 0;
    for (int v = 0; v < smooth.vertices(); ++v) {
        EXPECT_NEAR(test_support::sum_of_weights(smooth, v), 1.0, 1e-12);
        if (bar.blended[std::size_t(v)]) continue;
        ++alone;
        EXPECT_FALSE(smooth.blended(v)) << v;
        EXPECT_EQ(smooth.bone[std::size_t(smooth.first[std::size_t(v)])], bar.binding.bone[std::size_t(v)]) << v;
    }
    EXPECT_GT(alone, 0);
}

// Whole cross-sections of the bar are held on either side of its joint at x = 0: the weights between are linear, and
// one half at the joint.
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
        EXPECT_NEAR(weight_in(smooth, v, 1), (x - first) / (last - first), 3e-6) << x;
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
    expect_input_error([] { weights_by(WeightKind::artist, bar_of_two_bones); },
                       "bar: skinning.weights = artist: ", "brings such weights");
    expect_input_error([] { weights_by(WeightKind::file, bar_of_two_bones); },
                       "bar: skinning.weights = file: ", "brings such weights");
}

TEST(SkinningWeights, HaveNames)
{
    using enum WeightKind;
    for (const auto& [kind, name] : {std::pair(paper, "paper"),
                                     {rigid, "rigid"},
                                     {smooth, "smooth"},
                                     {diffused, "diffused"},
                                     {either_end, "either_end"},
                                     {artist, "artist"},
                                     {file, "file"}}) {
        EXPECT_STREQ(name_of(kind), name);
        EXPECT_EQ(weights_named(name), kind == file ? std::nullopt : std::optional(kind));
    }
}

// Reference: weights that are a linear function of the place. They are reproduced on the surface, because they are
// linear in its triangles, and inside, because linear functions are harmonic.

const TetMesh flesh = test_support::structured_bar({0, 0, 0}, {1, 0.5, 0.5}, {8, 4, 4});

// The weights of two bones: x on the second one, for points whose x is from 0 to 1.
Weights linear_weights(const Positions& points)
{
    Weights skin;
    skin.first = {0};
    for (Eigen::Index p = 0; p < points.rows(); ++p) {
        skin.bone.insert(skin.bone.end(), {0, 1});
        skin.weight.insert(skin.weight.end(), {1.0 - points(p, 0), points(p, 0)});
        skin.first.push_back(static_cast<int>(skin.bone.size()));
    }
    return skin;
}

// The term 1e-9 that keeps the system regular changes weights by less than 1e-6 in 8 cells, and 1e-6 is also where
// small ones are removed.
constexpr double transfer_tolerance = 3e-6;

TEST(TransferredWeights, LinearOnesOnTheTetsOwnSurfaceAreReproducedInTheFlesh)
{
    const Triangles boundary = boundary_of(flesh.tets);
    const TransferredWeights made = transfer_weights(flesh, flesh.rest, boundary, linear_weights(flesh.rest), 2);
    EXPECT_EQ(made.largest_distance_m, 0.0);
    ASSERT_EQ(made.weights.vertices(), flesh.rest.rows());
    for (int v = 0; v < flesh.rest.rows(); ++v) {
        EXPECT_NEAR(weight_in(made.weights, v, 1), flesh.rest(v, 0), transfer_tolerance) << v;
        EXPECT_NEAR(weight_in(made.weights, v, 0) + weight_in(made.weights, v, 1), 1.0, 1e-12) << v;
    }
}

// Two halves of one body, whose vertices between them exist twice.
TEST(TransferredWeights, AtACutThroughTheFleshAreNotFarFromTheSurface)
{
    const TetMesh whole = test_support::structured_bar({0, 0, 0}, {2, 1, 1}, {4, 2, 2}),
                  half = test_support::structured_bar({0, 0, 0}, {1, 1, 1}, {2, 2, 2});
    TetMesh halves = half;
    halves.rest.conservativeResize(2 * half.rest.rows(), 3);
    halves.rest.bottomRows(half.rest.rows()) = half.rest.rowwise() + Eigen::RowVector3d(1, 0, 0);
    halves.tets.conservativeResize(2 * half.tets.rows(), 4);
    halves.tets.bottomRows(half.tets.rows()) = half.tets.array() + static_cast<int>(half.rest.rows());
    const Triangles skin = boundary_of(whole.tets);
    EXPECT_DOUBLE_EQ(transfer_weights(half, whole.rest, skin, linear_weights(whole.rest), 2).largest_distance_m, 0.5);
    EXPECT_DOUBLE_EQ(transfer_weights(halves, whole.rest, skin, linear_weights(whole.rest), 2).largest_distance_m, 0.0);
}

TEST(TransferredWeights, ComeFromTheNearestPointOfACoarserSurface)
{
    // Two triangles at z = 2, 1.5 above the flesh, that cover it; the nearest point of (x, y, z) is (x, y, 2).
    const Positions sheet = (Positions(4, 3) << 0, 0, 2, 1, 0, 2, 1, 0.5, 2, 0, 0.5, 2).finished();
    const Triangles triangles = (Triangles(2, 3) << 0, 1, 2, 0, 2, 3).finished();
    const TransferredWeights made = transfer_weights(flesh, sheet, triangles, linear_weights(sheet), 2);
    EXPECT_DOUBLE_EQ(made.largest_distance_m, 2.0) << "from the lower side";
    for (int v = 0; v < flesh.rest.rows(); ++v)
        EXPECT_NEAR(weight_in(made.weights, v, 1), flesh.rest(v, 0), transfer_tolerance) << v;
}

TEST(TransferredWeights, OfASurfaceThatFollowsOneBoneAreAllOnThatBone)
{
    const Triangles boundary = boundary_of(flesh.tets);
    Weights skin;
    for (int p = 0; p <= flesh.rest.rows(); ++p) skin.first.push_back(p);
    skin.bone.assign(std::size_t(flesh.rest.rows()), 2);
    skin.weight.assign(std::size_t(flesh.rest.rows()), 1.0);
    const Weights weights = transfer_weights(flesh, flesh.rest, boundary, skin, 4).weights;
    for (int v = 0; v < flesh.rest.rows(); ++v) {
        EXPECT_FALSE(weights.blended(v));
        EXPECT_EQ(weights.bone[std::size_t(weights.first[std::size_t(v)])], 2);
    }
}

// The unit tet carries one point in its middle.
EmbeddedSurface point_in_the_middle()
{
    return {{}, Eigen::VectorXi::Zero(1), Eigen::RowVector4d::Constant(0.25), 0.0};
}

Weights two_weights(double second)
{
    return {.first = {0, 2}, .bone = {0, 1}, .weight = {1.0 - second, second}};
}

TEST(CarriedWeight, IsTheOverlapOfTheArtistsWeightsAndThoseOfTheTets)
{
    const TetMesh tet = test_support::unit_tet();
    // Three corners follow bone 0, one follows bone 1: a quarter in the middle.
    Weights in_tets{.first = {0, 1, 2, 3, 4}, .bone = {0, 0, 0, 1}, .weight = {1, 1, 1, 1}};
    const auto share_pct = [&](double of_second) {
        return carried_weight(two_weights(of_second), in_tets, point_in_the_middle(), tet.tets, 3).share_pct();
    };
    EXPECT_DOUBLE_EQ(share_pct(0.25), 100.0);
    EXPECT_DOUBLE_EQ(share_pct(0.75), 50.0);
    in_tets.bone = {2, 2, 2, 2};
    EXPECT_EQ(share_pct(0.25), 0.0);
}

// Reference: the format as documented (CSV vertex,joint,weight); each refusal by file, line and field.

const Skeleton two_bones{{{"upper", -1, Vec3(-1, 0, 0), Vec3(0, 0, 0)}, {"forearm", 0, Vec3(0, 0, 0), Vec3(1, 0, 0)}}};
const std::string header = "vertex,joint,weight\n";
TEST(WeightsFile, ReadsRowsInAnyOrder)
{
    const Weights weights = parse_weights(header + "1,forearm,0.25\n0,upper,1\n1,upper,0.75\n", "w.csv", two_bones, 2);
    EXPECT_EQ(weights.first, (std::vector<int>{0, 1, 3}));
    EXPECT_EQ(weights.bone, (std::vector<int>{0, 1, 0}));
    EXPECT_EQ(weights.weight, (std::vector<double>{1.0, 0.25, 0.75}));
}

TEST(WeightsFile, LeavesOutZerosAndTakesWindowsLineEnds)
{
    const Weights weights =
        parse_weights("vertex,joint,weight\r\n0,upper,1.0\r\n0,forearm,0\r\n", "w.csv", two_bones, 1);
    EXPECT_FALSE(weights.blended(0));
    EXPECT_EQ(weights.bone, (std::vector<int>{0}));
}

TEST(WeightsFile, SumsMayDifferFromOneByAMillionth)
{
    EXPECT_NO_THROW(parse_weights(header + "0,upper,0.5\n0,forearm,0.5000009\n", "w.csv", two_bones, 1));
}

// Vertex 1 of the file was left out, and vertex 2 was split.
TEST(WeightsFile, OfRepairedTetsHasTheNumbersOfTheFile)
{
    const std::string rows = header + "0,upper,1\n2,upper,0.25\n2,forearm,0.75\n";
    const Weights weights = parse_weights(rows, "w.csv", two_bones, 3, {0, 2, 2});
    EXPECT_EQ(weights.first, (std::vector<int>{0, 1, 3, 5}));
    EXPECT_EQ(weights.bone, (std::vector<int>{0, 0, 1, 0, 1}));
    EXPECT_EQ(weights.weight, (std::vector<double>{1.0, 0.25, 0.75, 0.25, 0.75}));
    expect_input_error(
        [&] {
            parse_weights(rows, "w.csv", two_bones, 3, {0, 1});
        },
        "w.csv: vertex = 1: ", "has no weights");
    expect_input_error([&] { parse_weights(header + "3,upper,1\n", "w.csv", two_bones, 3, {0}); },
                       "w.csv:2: vertex = 3: ", "0 to 2");
}

}  // namespace
