// A deformer of the user's own in a pose of a case. Reference: the shapes and times that its program writes.
#include "experiments/studies/work_precision/posed_deformer.hpp"

#include "experiments/deformers/external/external_deformers.hpp"
#include "experiments/scene/motion_case.hpp"
#include "experiments/studies/work_precision/measured_points.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/unit/pbs/character/expect_input_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

namespace {

using namespace experiments;

// A program that writes the shapes of LBS, which the test computes, and the times of 125 ms.
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
        of.reference_is_refined = of.seeks_theta = false;
        of.converged_iterations = 0;
        of.longest_frame_ms = 1e-6;  // one rung of each ladder
    }

    // #poses x #V x 3 and #poses numbers for reach(), a turn that warms up and three that are timed. NaN where `bad`.
    void write_answers(bool bad, bool with_seconds) const
    {
        const PosePair poses = poses_of_case();
        std::string positions, seconds;
        for (int pose = 0; pose < 5; ++pose) {
            pbs::Positions shape = blended(*character, pose % 2 == 0 ? poses.pose : poses.neighbour);
            if (bad) shape(3, 1) = std::nan("");
            const double time_s = 0.125;
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
    EXPECT_EQ(shape.seconds, 0.125);
    for (int turn = 0; turn < 4; ++turn) EXPECT_EQ(deformer.turn().at(0), 125.0);
    EXPECT_EQ(deformer.clock(), FrameClock::own);
    EXPECT_EQ(std::filesystem::file_size(folder / "calls"), 4u) << "one line";
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

TEST_F(OwnDeformer, ThatFailsEndsTheRun)
{
    expect_input_error([&] { points_of("exit 3"); }, "mine.toml: mine.command = /bin/sh", "ended with status 3: expected status 0");
}

}  // namespace
