// The files between pbskin and a program. Reference: the table of files in experiments/deformers/external/README.md, read here byte by
// byte.
#include "experiments/deformers/external/external_deformers.hpp"

#include "tests/support/bar_character.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/unit/pbs/character/expect_input_error.hpp"

#include <gtest/gtest.h>

#include <cstring>

namespace {

using namespace experiments;

template <typename Number>
std::vector<Number> numbers_of(const std::string& file)
{
    std::ifstream stream(file, std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
    std::vector<Number> numbers(bytes.size() / sizeof(Number));
    EXPECT_EQ(bytes.size(), numbers.size() * sizeof(Number)) << file;
    std::memcpy(numbers.data(), bytes.data(), bytes.size());
    return numbers;
}

std::string bytes_of(const std::vector<double>& numbers)
{
    return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(double)};
}

class ExchangeFolder : public testing::Test {
protected:
    ExchangeFolder() : character(test_support::bar_character({4, 1, 1})), poses(3, pbs::Pose(2, Eigen::Isometry3d::Identity()))
    {
        poses[2][1] = Eigen::Translation3d(1.0, 2.0, 3.0) * Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitY());
        write_exchange(folder.path().string(), character, poses, 0.02);
    }

    pbs::Character character;
    std::vector<pbs::Pose> poses;
    test_support::ScratchFolder folder;
};

TEST_F(ExchangeFolder, DescribesTheCharacter)
{
    nlohmann::json facts;
    std::ifstream(folder / "character.json") >> facts;
    const nlohmann::json bones = {{{"name", "upper"}, {"parent", -1}, {"head_m", {-1.0, 0.0, 0.0}}, {"tail_m", {0.0, 0.0, 0.0}}},
                                  {{"name", "forearm"}, {"parent", 0}, {"head_m", {0.0, 0.0, 0.0}}, {"tail_m", {1.0, 0.0, 0.0}}}};
    const nlohmann::json expected = {{"schema", 1},   {"name", "bar"},       {"vertices", character.mesh.rest.rows()},
                                     {"poses", 3},    {"time_step_s", 0.02}, {"tets", character.mesh.tets.rows()},
                                     {"bones", bones}};
    EXPECT_EQ(facts, expected);
}

TEST_F(ExchangeFolder, HoldsTheTetsByRows)
{
    const auto rest = numbers_of<double>(folder / "rest.f64");
    const auto tets = numbers_of<std::int32_t>(folder / "tets.i32");
    ASSERT_EQ(rest.size(), character.mesh.rest.size());
    ASSERT_EQ(tets.size(), character.mesh.tets.size());
    for (Eigen::Index v = 0; v < character.mesh.rest.rows(); ++v)
        for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(rest[3 * v + axis], character.mesh.rest(v, axis));
    for (Eigen::Index t = 0; t < character.mesh.tets.rows(); ++t)
        for (int corner = 0; corner < 4; ++corner) EXPECT_EQ(tets[4 * t + corner], character.mesh.tets(t, corner));
}

// A row of weights sums to one up to the rounding of the two weights and of their sum.
TEST_F(ExchangeFolder, HoldsAWeightForEachVertexAndBone)
{
    const auto weights = numbers_of<double>(folder / "weights.f64");
    ASSERT_EQ(weights.size(), 2 * static_cast<std::size_t>(character.weights.vertices()));
    for (int v = 0; v < character.weights.vertices(); ++v) {
        EXPECT_NEAR(weights[2 * v] + weights[2 * v + 1], 1.0, 3 * std::numeric_limits<double>::epsilon());
        for (int e = character.weights.first[v]; e < character.weights.first[v + 1]; ++e)
            EXPECT_EQ(weights[2 * v + character.weights.bone[e]], character.weights.weight[e]);
    }
}

TEST_F(ExchangeFolder, HoldsTheUpperThreeRowsOfEachTransform)
{
    const auto numbers = numbers_of<double>(folder / "poses.f64");
    ASSERT_EQ(numbers.size(), 3u * 2 * 12);
    const std::vector<double> still = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}, first(numbers.begin(), numbers.begin() + 12);
    EXPECT_EQ(first, still);
    const double *moved = numbers.data() + (2 * 2 + 1) * 12, half = 0.5;
    for (const auto& [at, expected] :
         {std::pair{3, 1.0}, {7, 2.0}, {11, 3.0}, {0, std::cos(half)}, {2, std::sin(half)}, {8, -std::sin(half)}})
        EXPECT_NEAR(moved[at], expected, 4 * std::numeric_limits<double>::epsilon()) << at;
}

TEST_F(ExchangeFolder, ReadsWhatTheProgramWrote)
{
    folder.file("positions.f64", bytes_of({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}));
    ExchangedPositions read = read_exchange(folder.path().string(), 2, 2);
    ASSERT_EQ(read.positions.size(), 2u);
    EXPECT_EQ(read.positions[1], (pbs::Positions(2, 3) << 7, 8, 9, 10, 11, 12).finished());
    EXPECT_FALSE(read.seconds);
    folder.file("seconds.f64", bytes_of({0.5, 0.25}));
    read = read_exchange(folder.path().string(), 2, 2);
    EXPECT_EQ(*read.seconds, (std::vector{0.5, 0.25}));
}

TEST_F(ExchangeFolder, RefusesFilesOfAnotherSizeAndTimesThatAreNone)
{
    const auto read = [&] { read_exchange(folder.path().string(), 2, 2); };
    expect_input_error(read, "positions.f64: ", "missing: expected the program to write it");
    folder.file("positions.f64", bytes_of({1, 2, 3}));
    expect_input_error(read, "positions.f64: bytes = 24: ", "expected 96: 2 poses x 2 vertices x 3 numbers of 8 bytes");
    folder.file("positions.f64", bytes_of(std::vector<double>(13, 0.0)));
    expect_input_error(read, "positions.f64: bytes = 104: ", "expected 96");
    folder.file("positions.f64", bytes_of(std::vector<double>(12, 0.0)));
    folder.file("seconds.f64", bytes_of({0.5}));
    expect_input_error(read, "seconds.f64: bytes = 8: ", "expected 16: 2 poses x 1 numbers of 8 bytes");
    for (const auto& [time, shown] : {std::pair{-1.0, "-1"}, {std::nan(""), "nan"}, {INFINITY, "inf"}}) {
        folder.file("seconds.f64", bytes_of({0.5, time}));
        expect_input_error(read, std::string("seconds.f64: time = ") + shown, "expected a finite time of at least 0 s");
    }
}

}  // namespace
