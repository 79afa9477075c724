// Reference: the format as documented (CSV vertex,joint,weight); each refusal by file, line and field.
#include "pbs/character/weights_file.hpp"

#include "tests/support/scratch_folder.hpp"
#include "tests/unit/pbs/character/expect_input_error.hpp"

namespace {

using namespace pbs;

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
