// A deformer of the user's own in a pose of a case. Reference: the shapes and times that its program writes.
#include "experiments/studies/work_precision/measured_points.hpp"

#include "experiments/deformers/external/external_deformers.hpp"
#include "experiments/scene/scene.hpp"
#include "pbs/geometry/files.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/unit/pbs/character/expect_input_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <memory>
#include <numeric>

namespace {

using namespace experiments;

// A program that writes the shapes of LBS, which the test computes, and times of 1, 2, 4, 8 and 16 ms for its successive poses.
class OwnDeformer : public testing::Test {
protected:
    OwnDeformer()
    {
        of.of = {.body = "limb", .motion = "twist", .angle_deg = 30.0};
        of.scene = read_scene("limb_twist", {"character.vertices=300", "motion.angle_deg=30", "motion.frames=7"});
        character = std::make_shared<pbs::Character>(pbs::make_character(of.scene.character));
        of.frame = 6;
        of.range.in_short = true;
        of.range.quadratic = false;
        of.rounds = of.newton_rounds = {.seconds = 0.0, .fewest = 3, .most = 3};
        of.reference_is_refined = false;
        of.longest_frame_ms = 1e-6;  // the first setting of each ladder
    }

    // #poses x #V x 3 and #poses numbers for reach(), a turn that warms up and three that are timed. NaN where `bad`.
    void write_answers(bool bad, bool with_seconds) const
    {
        const PosePair poses = poses_of_case();
        std::string positions, seconds;
        for (int pose = 0; pose < 5; ++pose) {
            pbs::Positions shape = blended(*character, pose % 2 == 0 ? poses.pose : poses.neighbour);
            if (bad) shape(3, 1) = std::nan("");
            const double time_s = 0.001 * (1 << pose);
            positions.append(reinterpret_cast<const char*>(shape.data()), static_cast<std::size_t>(shape.size()) * sizeof(double));
            seconds.append(reinterpret_cast<const char*>(&time_s), sizeof(double));
        }
        folder.file("positions", positions);
        if (with_seconds) folder.file("seconds.f64", seconds);
    }

    PosePair poses_of_case() const
    {
        const pbs::Motion motion = make_motion(of.scene.motion, character->skeleton, of.scene.file);
        const auto pose = [&](int frame) { return motion.steps.at(static_cast<std::size_t>(frame) * motion.steps_per_frame); };
        return {pose(of.frame), pose(of.frame - 1), motion.time_step_s};
    }

    // `script` has the scratch folder as $0 and the exchange folder as $1.
    DeformerSpec spec_of_script(const std::string& script) const
    {
        DeformerSpec spec = default_spec("external");
        spec.name = spec.label = "mine";
        spec.options = ExternalOptions{.command = {"/bin/sh", "-c", script, folder.path().string()}, .scene = "mine.toml", .name = "mine"};
        return spec;
    }

    MeasuredPoints points_of(const std::string& script)
    {
        of.external = {spec_of_script(script)};
        return measure_points(of);
    }

    WorkPrecisionCase of;
    std::shared_ptr<const pbs::Character> character;
    test_support::ScratchFolder folder;
};

PointRow row_of_mine(const MeasuredPoints& points)
{
    return *std::ranges::find_if(points.rows, &PointRow::is_external);
}

const std::string copies_answers = "echo run >> $0/calls; cp $0/positions $1/positions.f64; cp $0/seconds.f64 $1 2> /dev/null || true";

TEST_F(OwnDeformer, IsCalledOnceForAllItsTurnsAndHasTheTimesThatItStates)
{
    write_answers(false, true);
    const BodyMesh own(character);
    const PosePair poses = poses_of_case();
    PosedDeformer deformer({"mine", spec_of_script(copies_answers)}, own, poses, 4);
    const Shape shape = deformer.reach();
    EXPECT_TRUE(shape.finished);
    EXPECT_EQ(shape.positions, blended(own.character(), poses.pose));
    EXPECT_DOUBLE_EQ(shape.seconds, 0.001);
    for (const double ms : {2.0, 4.0, 8.0, 16.0}) EXPECT_DOUBLE_EQ(deformer.turn().at(0), ms);
    EXPECT_EQ(deformer.clock(), FrameClock::own);
    EXPECT_EQ(std::filesystem::file_size(folder / "calls"), 4u) << "one line";
}

// The first turn of 2 ms warms up. The others take 4, 8 and 16 ms; the lower quartile is half way from 4 to 8.
TEST_F(OwnDeformer, HasTheMedianOfItsTurnsAfterTheFirst)
{
    write_answers(false, true);
    const PointRow mine = row_of_mine(points_of(copies_answers));
    EXPECT_DOUBLE_EQ(mine.reach_ms, 1.0);
    EXPECT_EQ(mine.rounds, 3);
    EXPECT_DOUBLE_EQ(mine.ms_median.value(), 8.0);
    EXPECT_DOUBLE_EQ(mine.ms_q1.value(), 6.0);
    EXPECT_DOUBLE_EQ(mine.ms_q3.value(), 12.0);
    EXPECT_EQ(mine.clock, FrameClock::own);
}

TEST_F(OwnDeformer, WithoutTimesHasTheWallTimeOverItsPoses)
{
    write_answers(false, false);
    const BodyMesh own(character);
    const PosePair poses = poses_of_case();
    PosedDeformer deformer({"mine", spec_of_script("sleep 0.1; " + copies_answers)}, own, poses, 4);
    EXPECT_TRUE(deformer.reach().finished);
    EXPECT_GE(deformer.turn().at(0), 20.0);  // 0.1 s over five poses
    EXPECT_EQ(deformer.clock(), FrameClock::wall);
}

TEST_F(OwnDeformer, ThatIsNotFiniteBreaksDown)
{
    write_answers(true, true);
    const MeasuredPoints points = points_of(copies_answers);
    EXPECT_EQ(points.breakdown, "mine is not finite. ");
    const PointRow mine = row_of_mine(points);
    EXPECT_EQ(mine.outcome, "not_finite");
    EXPECT_FALSE(mine.ms_median);
    EXPECT_FALSE(mine.clock);
}

// A failure ends the run. A scene without [[fem]] has no reference, which is an error as soon as it is solved.
TEST_F(OwnDeformer, IsCalledBeforeTheReferenceIsSolved)
{
    of.scene.deformers.clear();
    expect_input_error([&] { points_of("exit 3"); }, "mine.toml: mine.command = /bin/sh", "ended with status 3: expected status 0");
    write_answers(false, true);
    expect_input_error([&] { points_of(copies_answers); }, "", "fem");
}

// Frames 2 to 25 come before frame 26. The turns begin in frame 25.
TEST_F(OwnDeformer, WithMemoryGetsTheEarlierFramesFirst)
{
    of.scene = read_scene("limb_twist", {"character.vertices=300", "motion.angle_deg=30", "motion.frames=31"});
    of.frame = 26;
    of.external = {spec_of_script("cp $1/poses.f64 $0/poses; exit 3")};
    options_of<ExternalOptions>(of.external[0]).has_memory = true;
    EXPECT_THROW(measure_points(of), pbs::InputError);
    const pbs::Motion motion = make_motion(of.scene.motion, character->skeleton, of.scene.file);
    std::vector<std::size_t> frames(24);
    std::iota(frames.begin(), frames.end(), 2);
    frames.insert(frames.end(), {26, 25, 26, 25, 26});
    std::vector<double> expected;
    for (const std::size_t frame : frames) {
        const std::vector<double> rows = transform_rows(motion.steps.at(frame * motion.steps_per_frame));
        expected.insert(expected.end(), rows.begin(), rows.end());
    }
    const std::string bytes = pbs::read_text_file(folder / "poses");
    ASSERT_EQ(bytes.size(), expected.size() * sizeof(double));
    EXPECT_EQ(std::memcmp(bytes.data(), expected.data(), bytes.size()), 0);
}

}  // namespace
