// Pieces of work in their folders. Reference: the contract of the header: run.json is written last, and only for a run that ended.
#include "experiments/studies/study_run.hpp"

#include "experiments/run/run.hpp"
#include "pbs/geometry/input_error.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace {

using namespace experiments;
namespace fs = std::filesystem;

StudyRun counting_run(int count, const StudyWork& work)
{
    return {.name = "count", .work = work, .settings = {{"count", count}}};
}

std::string write_a_record(const std::string& folder)
{
    std::ofstream(fs::path(folder) / "rows.csv") << "row\n";
    return "";
}

class StudyRunTest : public testing::Test {
protected:
    test_support::ScratchFolder scratch;
    const std::string folder = scratch / "study/count";
};

TEST_F(StudyRunTest, WorkThatEndedIsFinishedUnderItsOwnSettings)
{
    const StudyRun run = counting_run(3, write_a_record);
    EXPECT_FALSE(is_finished(run, folder));
    EXPECT_EQ(carry_out(run, folder), "");
    EXPECT_TRUE(fs::exists(fs::path(folder) / "rows.csv"));
    EXPECT_TRUE(is_finished(run, folder));
    EXPECT_FALSE(is_finished(counting_run(4, write_a_record), folder));
}

TEST_F(StudyRunTest, AnAlteredRecordIsNotFinished)
{
    const StudyRun run = counting_run(3, write_a_record);
    carry_out(run, folder);
    const fs::path record = fs::path(folder) / "run.json";
    const nlohmann::json whole = nlohmann::json::parse(std::ifstream(record));
    const auto finished_with = [&](const std::string& text) {
        std::ofstream(record) << text;
        return is_finished(run, folder);
    };
    for (const nlohmann::json& provenance : {nlohmann::json(3), nlohmann::json::array(), nlohmann::json{{"git_revision", 3}}}) {
        nlohmann::json altered = whole;
        altered["provenance"] = provenance;
        EXPECT_FALSE(finished_with(altered.dump())) << provenance;
    }
    for (const nlohmann::json& schema : {nlohmann::json(1), nlohmann::json("2"), nlohmann::json()}) {
        nlohmann::json altered = whole;
        altered["schema"] = schema;
        EXPECT_FALSE(finished_with(altered.dump())) << schema;
    }
    for (const char* text : {"", "[]", "{}", "{\"settings\": "}) EXPECT_FALSE(finished_with(text)) << text;
    EXPECT_TRUE(finished_with(whole.dump()));
}

TEST_F(StudyRunTest, ABreakdownIsOnRecordAndTheRunEnded)
{
    const StudyRun run = counting_run(3, [](const std::string&) { return std::string("step 7 diverged"); });
    EXPECT_EQ(carry_out(run, folder), "step 7 diverged");
    EXPECT_TRUE(is_finished(run, folder));
    std::ifstream record(fs::path(folder) / "run.json");
    EXPECT_EQ(nlohmann::json::parse(record).at("outcome").at("breakdown"), "step 7 diverged");
    EXPECT_EQ(breakdown_on_record(run, folder), "step 7 diverged");
}

// Two iterations do not reach a tolerance of 1e-12.
TEST_F(StudyRunTest, AFrameThatWasNotReachedIsABreakdownWhereTheSceneWasExpectedToFinish)
{
    StudyRun run = {.name = "limb",
                    .scene = read_scene("limb_bend", {"pbs.iterations=2", "pbs.stop_residual=1e-12", "motion.frames=2",
                                                      "deformers.use=[\"pbs\"]", "reference.name=\"\""})};
    const RunResult result = run_scene(run.scene, scratch / "alone");
    EXPECT_EQ(result.breakdown, "");
    EXPECT_EQ(result.bad_frame.rfind("pose not reached: pbs is not converged in frame 0: worst tet ", 0), 0u) << result.bad_frame;
    EXPECT_EQ(carry_out(run, folder), result.bad_frame);
    EXPECT_TRUE(is_finished(run, folder));  // recorded nevertheless
    EXPECT_EQ(breakdown_on_record(run, folder), result.bad_frame);
    run.bad_frames_are_results = true;
    EXPECT_EQ(carry_out(run, folder), "");
    EXPECT_EQ(breakdown_on_record(run, folder), "");
}

TEST_F(StudyRunTest, ARecordThatCannotBeRemovedIsNamed)
{
    fs::create_directories(fs::path(folder) / "run.json" / "kept");
    try {
        carry_out(counting_run(3, write_a_record), folder);
        FAIL() << "accepted";
    } catch (const pbs::InputError& error) {
        EXPECT_EQ(error.what(), folder + "/run.json: an earlier run's record cannot be removed: Directory not empty");
    }
}

TEST_F(StudyRunTest, WorkThatFailsLeavesNoRecordOfAnEarlierRun)
{
    carry_out(counting_run(3, write_a_record), folder);
    const StudyRun failing = counting_run(3, [](const std::string&) -> std::string { throw std::runtime_error("no solver"); });
    EXPECT_THROW(carry_out(failing, folder), std::runtime_error);
    EXPECT_FALSE(is_finished(failing, folder));
}

}  // namespace
