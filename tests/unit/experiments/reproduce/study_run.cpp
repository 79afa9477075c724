// Pieces of work in their folders. Reference: the contract of the header: run.json is written last, and only for a run
// that ended.

#include "analysis/records/record_files.hpp"
#include "experiments/characters/bodies.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/reproduce/studies.hpp"
#include "experiments/run/run.hpp"
#include "experiments/scene/movements.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/solver/options.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
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

TEST_F(StudyRunTest, WorkThatEndedIsFinishedUnderItsOwnSettingsAndWorkThatFailsLeavesNoRecordOfIt)
{
    const StudyRun run = counting_run(3, write_a_record);
    EXPECT_FALSE(is_finished(run, folder));
    EXPECT_EQ(carry_out(run, folder), "");
    EXPECT_TRUE(fs::exists(fs::path(folder) / "rows.csv"));
    EXPECT_TRUE(is_finished(run, folder));
    EXPECT_FALSE(is_finished(counting_run(4, write_a_record), folder));
    const StudyRun failing =
        counting_run(3, [](const std::string&) -> std::string { throw std::runtime_error("no solver"); });
    EXPECT_THROW(carry_out(failing, folder), std::runtime_error);
    EXPECT_FALSE(is_finished(failing, folder));
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
    for (const nlohmann::json& provenance :
         {nlohmann::json(3), nlohmann::json::array(), nlohmann::json{{"git_revision", 3}}}) {
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
    EXPECT_EQ(result.bad_frame.rfind("pose not reached: pbs is not converged in frame 0: worst tet ", 0), 0u)
        << result.bad_frame;
    EXPECT_EQ(carry_out(run, folder), result.bad_frame);
    EXPECT_TRUE(is_finished(run, folder));  // recorded nevertheless
    EXPECT_EQ(breakdown_on_record(run, folder), result.bad_frame);
    run.bad_frames_are_results = true;
    EXPECT_EQ(carry_out(run, folder), "");
    EXPECT_EQ(breakdown_on_record(run, folder), "");
}

// Reference: sums and maxima by hand.

using test_support::ScratchFolder;

StudyRun run_of(double cost_s)
{
    StudyRun run;
    run.cost_s = cost_s;
    return run;
}

TEST(StudyCosts, SideBySideButNeverShorterThanTheLongestRun)
{
    const Study study{.name = "volume"};
    EXPECT_EQ(expected_wall_s(study, {run_of(10), run_of(20), run_of(30)}, 2), 30.0);
    EXPECT_EQ(expected_wall_s(study, {run_of(10), run_of(50)}, 2), 50.0);
    EXPECT_EQ(expected_wall_s(study, {}, 2), 0.0);
    const Study alone{.name = "timing", .alone = true};
    EXPECT_EQ(expected_wall_s(alone, {run_of(10), run_of(20), run_of(30)}, 2), 60.0);
}

// "lost" did not end. A record that is none has no cost, which is not an error.
TEST(StudyCosts, AreThoseOfTheRunsThatEndedInTheOrderOfThePlan)
{
    const ScratchFolder folder;
    StudyPlan plan;
    for (const auto& [run, record] : std::vector<std::pair<std::string, std::string>>{
             {"scene", R"({"cost": {"cpu_seconds": {"total": 3.5}}, "outcome": {}})"},
             {"lost", ""},
             {"work", R"({"outcome": {"wall_s": 9.0, "cpu_seconds": 8.0}})"},
             {"words", R"({"outcome": {"cpu_seconds": "8", "wall_s": 4.0}})"},
             {"torn", R"({"outcome": {"cpu_)"}}) {
        plan.runs.push_back({.name = run, .cost_s = 2.0});
        fs::create_directories(folder.path() / run);
        if (!record.empty()) folder.file(run + "/run.json", record);
    }
    write_costs(folder.path().string(), plan);
    EXPECT_EQ(analysis::read_text(folder / "costs.csv"),
              "run,expected_cpu_s,cpu_s,wall_s\nscene,2,3.5,\nwork,2,8,9\nwords,2,,4\ntorn,2,,\n");
}

// Reference: cases.toml of the study setup, whose ring is built in, and of volume, which has fewer deformers of the
// limb by default.
TEST(StudyCases, HaveTheKeysAndTheCostOfTheirForm)
{
    for (const bool full : {false, true}) {
        std::vector<std::string> rings;
        plan_of_cases("setup", full, [&](const StudyCase& of, StudyPlan&) {
            EXPECT_EQ(of.value<double>("rate_hz"), 100.0);
            EXPECT_EQ(of.value<std::string>("deformer", "pbs_author"), "pbs_author");
            if (of.name == "ring") {
                EXPECT_EQ(of.cost_s, 9.0);
            }
            if (!of.has("vertices")) rings.push_back(of.name + " " + of.value<std::string>("body"));
        });
        EXPECT_EQ(std::ranges::count(rings, "ring ring"), 1);
        EXPECT_EQ(std::ranges::count(rings, "ring_by_the_author ring"), full ? 1 : 0) << "it has no quick_s";
        plan_of_cases("volume", full, [&](const StudyCase& of, StudyPlan&) {
            if (of.name == "limb_twist") {
                EXPECT_EQ(of.cost_s, full ? 72.0 : 9.0);
                EXPECT_EQ(of.scene().deformers.size(), full ? 9u : 4u);
            }
            for (const char* key :
                 {"scene", "overrides", "motion", "add", "goes_on", "beside", "k_in_zone", "through_movements"})
                of.has(key);
        });
    }
}

// The overrides of a form follow those that both forms have in common.
TEST(StudyCases, AddTheOverridesOfAFormToThoseOfTheCase)
{
    for (const bool full : {false, true}) {
        int bends = 0;
        plan_of_cases("frames", full, [&](const StudyCase& study_case, StudyPlan&) {
            const nlohmann::json values = study_case.values();  // which counts all keys as read
            if (study_case.name != "limb_bend") return;
            ++bends;
            EXPECT_EQ(values.at("overrides"),
                      (nlohmann::json{R"(deformers.use=["lbs","dqs","pbs","nh_p1"])", R"(reference.name="nh_p1")",
                                      full ? "motion.angle_deg=150" : "motion.angle_deg=110",
                                      full ? "motion.frames=16" : "motion.frames=12"}));
            const Scene scene = study_case.scene();
            EXPECT_EQ(scene.motion.angle_deg, full ? 150.0 : 110.0);
            EXPECT_EQ(scene.reference, "nh_p1");
            EXPECT_EQ(scene.deformers.size(), 4u);
        });
        EXPECT_EQ(bends, 1);
    }
}

// A deformer that a study adds is that of the case's scene, except for what its table states.
TEST(StudyCases, AddPbsWithOtherSettings)
{
    const StudyCase bend(
        "made_up", {{"name", "bend"}, {"quick_s", 1.0}, {"scene", "limb_bend"}, {"overrides", {"pbs.k_volume=0.5"}}},
        false);
    const Scene scene = bend.scene();
    const DeformerSpec own = *find_deformer_with<pbs::PbsOptions>(scene);
    DeformerSpec spec =
        bend.further_pbs({{"label", "pbs_other"}, {"overrides", {"pbs.iterations=7"}}}, {"pbs.jiggle.k_stretch=0.3"});
    EXPECT_EQ(spec.name, "pbs");
    EXPECT_EQ(spec.label, "pbs_other");
    EXPECT_EQ(spec.variant, "jiggle");
    auto& options = options_of<pbs::PbsOptions>(spec);
    EXPECT_EQ(options.iterations, 7);
    EXPECT_EQ(options.jiggle->k_stretch, 0.3);
    options.iterations = options_of<pbs::PbsOptions>(own).iterations;
    options.jiggle.reset();
    EXPECT_EQ(to_json(spec).at("options"), to_json(own).at("options"));
    EXPECT_EQ(bend.further_pbs({{"label", "b"}, {"name", "pbs_orders"}, {"variant", "a"}}).name, "pbs_orders");
}

TEST(StudyCases, LeaveOutABodyWithAllOfItsCases)
{
    int asked = 0;
    const StudyPlan plan = plan_of_cases("setup", true, [&](const StudyCase&, StudyPlan&) {
        ++asked;
        throw pbs::InputError("scene.toml", 1, "motion.clip", "", "missing");
    });
    EXPECT_EQ(asked, 3 + pbs::body_is_installed("human") + pbs::body_is_installed("man") +
                         pbs::body_is_installed("lady") + pbs::body_is_installed("frankie"));
    EXPECT_EQ(std::ranges::count(plan.left_out, "human", &analysis::LeftOut::scene), 1);
    EXPECT_EQ(std::ranges::count(plan.left_out, "ring", &analysis::LeftOut::scene), 1);
}

TEST(StudyCases, RefuseKeysThatAreMissingOrThatNothingReads)
{
    const StudyCase of("made_up", {{"name", "bend"}, {"quick_s", 1.0}, {"angel_deg", 90.0}}, false);
    EXPECT_THROW(of.value<double>("angle_deg"), std::logic_error);
    EXPECT_THROW(of.require_nothing_unread(), std::logic_error);
    EXPECT_EQ(of.value("angel_deg", 0.0), 90.0);
    EXPECT_NO_THROW(of.require_nothing_unread());
}

}  // namespace
