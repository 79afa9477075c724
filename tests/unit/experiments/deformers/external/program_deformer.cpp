// A deformer that is a program: when it is called, with what, and what is made of its files. Reference: the specification in
// experiments/deformers/external/README.md. The programs are shell scripts that copy files made here.
#include "experiments/deformers/external/external_deformers.hpp"

#include "tests/support/bar_character.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/unit/pbs/character/expect_input_error.hpp"

#include <gtest/gtest.h>

namespace {

using namespace experiments;

class ProgramDeformer : public testing::Test {
protected:
    ProgramDeformer() : character(test_support::bar_character({4, 1, 1}))
    {
        for (int i = 0; i < 3; ++i) poses.push_back(pbs::Pose(2, Eigen::Isometry3d(Eigen::Translation3d(0.25 * i, 0.0, 0.0))));
    }

    // A deformer called `mine` in scene.toml, whose program is `/bin/sh -c SCRIPT` with the scratch folder as $0 and the exchange folder as
    // $1. It is at rest and knows its poses.
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
            const pbs::Positions moved = character.mesh.rest.rowwise() + Eigen::RowVector3d(first + double(pose), 0.0, 0.0);
            bytes.append(reinterpret_cast<const char*>(moved.data()), static_cast<std::size_t>(moved.size()) * sizeof(double));
        }
        folder.file("answer", bytes);
    }

    pbs::Character character;
    std::vector<pbs::Pose> poses;
    test_support::ScratchFolder folder;
};

const std::string answers = "echo run >> $0/calls; cp $0/answer $1/positions.f64";

int calls(const test_support::ScratchFolder& folder)
{
    std::ifstream stream(folder / "calls");
    return static_cast<int>(std::count(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>(), '\n'));
}

TEST_F(ProgramDeformer, IsCalledOnceForAllForeseenPoses)
{
    write_answer(3);
    const auto mine = deformer(answers);
    for (int pose = 0; pose < 3; ++pose) {
        EXPECT_EQ(mine->advance(poses[pose], 0.01).outcome, pbs::Outcome::finished);
        const pbs::Positions expected = character.mesh.rest.rowwise() + Eigen::RowVector3d(pose, 0.0, 0.0);
        EXPECT_EQ(mine->positions(), expected) << pose;
    }
    EXPECT_EQ(calls(folder), 1);
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

TEST_F(ProgramDeformer, IsAtRestAfterAReset)
{
    write_answer(3);
    const auto mine = deformer(answers);
    mine->advance(poses[0], 0.01);
    mine->advance(poses[1], 0.01);
    mine->reset(character);
    EXPECT_EQ(mine->positions(), character.mesh.rest);
    EXPECT_FALSE(mine->has_memory());
    EXPECT_TRUE(deformer(answers, true)->has_memory());
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

TEST_F(ProgramDeformer, PositionsThatAreNotFiniteAreABreakdown)
{
    const double nan = std::nan("");
    write_answer(3);
    const auto mine = deformer(answers +
                               "; dd if=$0/nan of=$1/positions.f64 bs=8 count=1 "
                               "conv=notrunc 2> /dev/null");
    folder.file("nan", std::string(reinterpret_cast<const char*>(&nan), 8));
    EXPECT_EQ(mine->advance(poses[0], 0.01).outcome, pbs::Outcome::not_finite);
    EXPECT_EQ(mine->advance(poses[1], 0.01).outcome, pbs::Outcome::finished);
}

TEST_F(ProgramDeformer, NamesTheSceneTheDeformerTheCommandAndTheRule)
{
    write_answer(2);
    const std::string begins = "scene.toml: mine.command = /bin/sh -c ";
    for (const auto& [script, rule] : {std::pair{"exit 3", "ended with status 3: expected status 0"},
                                       {"echo one; echo two >&2; exit 1", "ended with status 1: expected status 0; its last line: two"},
                                       {"kill -9 $$", "ended by a signal: expected status 0"},
                                       {"true", "positions.f64: missing: expected the program to write it"},
                                       {"cp $0/answer $1/positions.f64", "expected 1440: 3 poses x 20 vertices x 3 numbers of 8 bytes"}})
        expect_input_error([&] { deformer(script)->advance(poses[0], 0.01); }, begins, rule);
}

TEST_F(ProgramDeformer, AProgramThatCannotBeStartedIsNamedWithTheReason)
{
    const auto start = [&](const std::string& program) {
        const auto made = make_program_deformer({.command = {program}, .scene = "scene.toml", .name = "mine"});
        made->reset(character);
        made->advance(poses[0], 0.01);
    };
    expect_input_error([&] { start("/nowhere/mine"); },
                       "scene.toml: mine.command = /nowhere/mine: ", "cannot be started: No such file or directory");
    const std::string text = folder.file("text", "#!/bin/sh\n");
    expect_input_error([&] { start(text); }, "scene.toml: mine.command = " + text, "cannot be started: Permission denied");
}

}  // namespace
