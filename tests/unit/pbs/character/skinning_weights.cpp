// Reference: the definitions. Paper and rigid weights are those of weights.hpp, smooth ones are linear between cross-sections.

#include "pbs/character/skinning_weights.hpp"
#include "pbs/geometry/topology.hpp"
#include "tests/support/bar_character.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/structured_bar.hpp"
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
    expect_same_weights(weights_by(WeightKind::either_end, bar), either_end_weights(bar.binding, bar.skeleton));
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
    EXPECT_STREQ(name_of(WeightKind::either_end), "either_end");
    EXPECT_STREQ(name_of(WeightKind::artist), "artist");
    EXPECT_STREQ(name_of(WeightKind::file), "file");
}

// Reference: weights that are a linear function of the place. They are reproduced on the surface, because they are linear in its triangles,
// and inside, because linear functions are harmonic.

const TetMesh flesh = test_support::structured_bar({0, 0, 0}, {1, 0.5, 0.5}, {8, 4, 4});

// Of two bones: x on the second one, for points whose x is from 0 to 1.
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

double weight_in(const Weights& weights, int vertex, int bone)
{
    double sum = 0.0;
    for (int e = weights.first[std::size_t(vertex)]; e < weights.first[std::size_t(vertex) + 1]; ++e)
        if (weights.bone[std::size_t(e)] == bone) sum += weights.weight[std::size_t(e)];
    return sum;
}

// The term 1e-9 that keeps the system regular changes weights by less than 1e-6 in 8 cells, and 1e-6 is also where small ones are removed.
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

TEST(TransferredWeights, ComeFromTheNearestPointOfACoarserSurface)
{
    // Two triangles at z = 2, 1.5 above the flesh, that cover it; the nearest point of (x, y, z) is (x, y, 2).
    const Positions sheet = (Positions(4, 3) << 0, 0, 2, 1, 0, 2, 1, 0.5, 2, 0, 0.5, 2).finished();
    const Triangles triangles = (Triangles(2, 3) << 0, 1, 2, 0, 2, 3).finished();
    const TransferredWeights made = transfer_weights(flesh, sheet, triangles, linear_weights(sheet), 2);
    EXPECT_DOUBLE_EQ(made.largest_distance_m, 2.0) << "from the lower side";
    for (int v = 0; v < flesh.rest.rows(); ++v) EXPECT_NEAR(weight_in(made.weights, v, 1), flesh.rest(v, 0), transfer_tolerance) << v;
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
    EmbeddedSurface surface;
    surface.tet = Eigen::VectorXi::Zero(1);
    surface.barycentric.resize(1, 4);
    surface.barycentric.setConstant(0.25);
    return surface;
}

Weights two_weights(double second)
{
    Weights skin;
    skin.first = {0, 2};
    skin.bone = {0, 1};
    skin.weight = {1.0 - second, second};
    return skin;
}

TEST(CarriedWeight, IsTheOverlapOfTheArtistsWeightsAndThoseOfTheTets)
{
    const TetMesh tet = test_support::unit_tet();
    Weights in_tets;  // three corners follow bone 0, one follows bone 1: a quarter in the middle
    in_tets.first = {0, 1, 2, 3, 4};
    in_tets.bone = {0, 0, 0, 1};
    in_tets.weight = {1, 1, 1, 1};
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
    const test_support::ScratchFolder folder;
    const std::string path = folder.file("w.csv", header + "1,forearm,0.25\n0,upper,1\n1,upper,0.75\n");
    const Weights weights = read_weights(path, two_bones, 2);
    EXPECT_EQ(weights.first, (std::vector<int>{0, 1, 3}));
    EXPECT_EQ(weights.bone, (std::vector<int>{0, 1, 0}));
    EXPECT_EQ(weights.weight, (std::vector<double>{1.0, 0.25, 0.75}));
}

TEST(WeightsFile, LeavesOutZerosAndTakesWindowsLineEnds)
{
    const test_support::ScratchFolder folder;
    const Weights weights = read_weights(folder.file("w.csv", "vertex,joint,weight\r\n0,upper,1.0\r\n0,forearm,0\r\n"), two_bones, 1);
    EXPECT_FALSE(weights.blended(0));
    EXPECT_EQ(weights.bone, (std::vector<int>{0}));
}

TEST(WeightsFile, SumsMayDifferFromOneByAMillionth)
{
    const test_support::ScratchFolder folder;
    EXPECT_NO_THROW(read_weights(folder.file("w.csv", header + "0,upper,0.5\n0,forearm,0.5000009\n"), two_bones, 1));
}

// Vertex 1 of the file was left out, and vertex 2 was split.
TEST(WeightsFile, OfRepairedTetsHasTheNumbersOfTheFile)
{
    const std::string rows = header + "0,upper,1\n2,upper,0.25\n2,forearm,0.75\n";
    const Weights weights = parse_weights(rows, "w.csv", two_bones, 3, {0, 2, 2});
    EXPECT_EQ(weights.first, (std::vector<int>{0, 1, 3, 5}));
    EXPECT_EQ(weights.bone, (std::vector<int>{0, 0, 1, 0, 1}));
    EXPECT_EQ(weights.weight, (std::vector<double>{1.0, 0.25, 0.75, 0.25, 0.75}));
    expect_input_error([&] { parse_weights(rows, "w.csv", two_bones, 3, {0, 1}); }, "w.csv: vertex = 1: ", "has no weights");
    expect_input_error([&] { parse_weights(header + "3,upper,1\n", "w.csv", two_bones, 3, {0}); }, "w.csv:2: vertex = 3: ", "0 to 2");
}

struct BadWeights {
    const char* name;
    std::string text, begins, holds;
};

class RefusedWeights : public testing::TestWithParam<BadWeights> {};

TEST_P(RefusedWeights, NamesFileLineFieldAndRule)
{
    const test_support::ScratchFolder folder;
    const std::string path = folder.file("bad.csv", GetParam().text);
    expect_input_error([&] { read_weights(path, two_bones, 2); }, path + GetParam().begins, GetParam().holds);
}

const BadWeights bad_weights[] = {
    {"empty", "", ":1: ", "header"},
    {"no_header", "0,upper,1\n1,upper,1\n", ":1: ", "header"},
    {"two_fields", header + "0,upper\n", ":2: ", "three fields"},
    {"four_fields", header + "0,upper,1,1\n", ":2: ", "three fields"},
    {"vertex_out_of_range", header + "0,upper,1\n2,upper,1\n", ":3: vertex = 2: ", "0 to 1"},
    {"negative_vertex", header + "-1,upper,1\n", ":2: vertex = -1: ", "0 to 1"},
    {"vertex_is_text", header + "one,upper,1\n", ":2: vertex = one: ", "0 to 1"},
    {"unknown_joint", header + "0,uper,1\n", ":2: joint = uper: ", "nearest is 'upper'"},
    {"weight_above_one", header + "0,upper,1.5\n", ":2: weight = 1.5: ", "0 <= weight <= 1"},
    {"negative_weight", header + "0,upper,-0.5\n", ":2: weight = -0.5: ", "0 <= weight <= 1"},
    {"weight_nan", header + "0,upper,nan\n", ":2: weight = nan: ", "0 <= weight <= 1"},
    {"weight_is_text", header + "0,upper,1x\n", ":2: weight = 1x: ", "0 <= weight <= 1"},
    {"joint_twice", header + "0,upper,0.5\n0,upper,0.5\n", ":3: joint = upper: ", "already"},
    {"sum_below_one", header + "0,upper,1\n1,upper,0.999998\n", ":3: vertex 1 = 0.99999", "sum to one"},
    {"vertex_without_weights", header + "0,upper,1\n", ": vertex = 1: ", "has no weights"},
};

INSTANTIATE_TEST_SUITE_P(WeightsFile, RefusedWeights, testing::ValuesIn(bad_weights),
                         [](const auto& parameter) { return std::string(parameter.param.name); });

}  // namespace
