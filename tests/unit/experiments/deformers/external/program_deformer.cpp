// A deformer that is a program: when it is called, with what, and what is made of its files. Reference: the
// specification in experiments/deformers/external/README.md. The programs are shell scripts that copy files made here.
// robustness/experiments/own_deformer.py compares the contents of the files with pbskin's own LBS, and has each way in
// which a program can fail.

#include "experiments/deformers/external/external_deformers.hpp"
#include "tests/support/bar_character.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/unit/experiments/characters/expect_input_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace experiments;

std::string bytes_of(const std::vector<double>& numbers)
{
    return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(double)};
}

class ExchangeFolder : public testing::Test {
protected:
    const pbs::Character character = test_support::bar_character({4, 1, 1});
    test_support::ScratchFolder folder;
};

TEST_F(ExchangeFolder, DescribesTheCharacter)
{
    write_exchange(folder.path().string(), character, {3, pbs::Pose(2, Eigen::Isometry3d::Identity())}, 0.02);
    nlohmann::json facts;
    std::ifstream(folder / "character.json") >> facts;
    const nlohmann::json bones = {
        {{"name", "upper"}, {"parent", -1}, {"head_m", {-1.0, 0.0, 0.0}}, {"tail_m", {0.0, 0.0, 0.0}}},
        {{"name", "forearm"}, {"parent", 0}, {"head_m", {0.0, 0.0, 0.0}}, {"tail_m", {1.0, 0.0, 0.0}}}};
    const nlohmann::json expected = {{"schema", 1},   {"name", "bar"},       {"vertices", character.mesh.rest.rows()},
                                     {"poses", 3},    {"time_step_s", 0.02}, {"tets", character.mesh.tets.rows()},
                                     {"bones", bones}};
    EXPECT_EQ(facts, expected);
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

class ProgramDeformer : public ExchangeFolder {
protected:
    ProgramDeformer()
    {
        for (int i = 0; i < 3; ++i)
            poses.push_back(pbs::Pose(2, Eigen::Isometry3d(Eigen::Translation3d(0.25 * i, 0.0, 0.0))));
    }

    // A deformer called `mine` in scene.toml, whose program is `/bin/sh -c SCRIPT` with the scratch folder as $0 and
    // the exchange folder as $1. It is at rest and knows its poses.
    std::unique_ptr<Deformer> deformer(const std::string& script, bool has_memory = false) const
    {
        auto made = make_program_deformer({.command = {"/bin/sh", "-c", script, folder.path().string()},
                                           .has_memory = has_memory,
                                           .scene = "scene.toml",
                                           .name = "mine"});
        made->reset(character);
        made->foresee(poses);
        return made;
    }

    // The rest positions, moved by (pose, 0, 0), for so many poses.
    void write_answer(std::size_t count, double first = 0.0) const
    {
        std::string bytes;
        for (std::size_t pose = 0; pose < count; ++pose) {
            const pbs::Positions moved =
                character.mesh.rest.rowwise() + Eigen::RowVector3d(first + double(pose), 0.0, 0.0);
            bytes.append(reinterpret_cast<const char*>(moved.data()),
                         static_cast<std::size_t>(moved.size()) * sizeof(double));
        }
        folder.file("answer", bytes);
    }

    std::vector<pbs::Pose> poses;
};

const std::string answers = "echo run >> $0/calls; cp $0/answer $1/positions.f64";

int calls(const test_support::ScratchFolder& folder)
{
    std::ifstream stream(folder / "calls");
    return static_cast<int>(std::count(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>(), '\n'));
}

TEST_F(ProgramDeformer, IsCalledOnceForAllForeseenPosesAndIsAtRestAfterAReset)
{
    write_answer(3);
    const auto mine = deformer(answers);
    for (int pose = 0; pose < 3; ++pose) {
        EXPECT_EQ(mine->advance(poses[pose], 0.01).outcome, pbs::Outcome::finished);
        const pbs::Positions expected = character.mesh.rest.rowwise() + Eigen::RowVector3d(pose, 0.0, 0.0);
        EXPECT_EQ(mine->positions(), expected) << pose;
    }
    EXPECT_EQ(calls(folder), 1);
    mine->reset(character);
    EXPECT_EQ(mine->positions(), character.mesh.rest);
    EXPECT_FALSE(mine->has_memory());
    EXPECT_TRUE(deformer(answers, true)->has_memory());
}

TEST_F(ProgramDeformer, IsCalledAgainForAPoseThatWasNotForeseen)
{
    write_answer(1, 5.0);
    const auto mine = deformer(answers + "; wc -c < $1/poses.f64 > $0/bytes");
    mine->advance(poses[2], 0.01);  // the first one was foreseen
    EXPECT_DOUBLE_EQ(mine->positions()(0, 0), character.mesh.rest(0, 0) + 5.0);
    int bytes = 0;
    std::ifstream(folder / "bytes") >> bytes;
    EXPECT_EQ(bytes, 2 * 12 * 8);
}

TEST_F(ProgramDeformer, TakesItsOwnTimesOrSharesTheProgramsTime)
{
    write_answer(3);
    const std::vector<double> seconds = {0.5, 0.25, 0.125};
    folder.file("seconds", std::string(reinterpret_cast<const char*>(seconds.data()), 24));
    const auto timed = deformer(answers + "; cp $0/seconds $1/seconds.f64");
    EXPECT_EQ(timed->advance(poses[0], 0.01).seconds, 0.5);
    EXPECT_EQ(timed->advance(poses[1], 0.01).seconds, 0.25);
    EXPECT_EQ(timed->record().at("own_times"), true);
    const auto shared = deformer(answers + "; sleep 0.06");
    const double share = shared->advance(poses[0], 0.01).seconds;
    EXPECT_GE(share, 0.02);
    EXPECT_EQ(shared->advance(poses[1], 0.01).seconds, share);
    EXPECT_EQ(shared->record().at("own_times"), false);
}

}  // namespace
