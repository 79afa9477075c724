// Reference: the plan and the files on disk. A verdict is based only on runs that ended. tests/support/bad_cases.toml
// has plans and records that somebody else has changed.

#include "analysis/records/record_files.hpp"
#include "analysis/verdicts/measurement.hpp"
#include "experiments/reproduce/reproduce.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <filesystem>

namespace {

using namespace experiments;
using test_support::ScratchFolder;

StudyPlan plan_of(const std::vector<std::string>& names)
{
    StudyPlan plan;
    for (const std::string& name : names)
        plan.runs.push_back({.name = name, .work = [](const std::string&) { return std::string(); }});
    return plan;
}

void finish(const std::string& study, const std::string& run, double value)
{
    const std::filesystem::path folder = std::filesystem::path(study) / run;
    std::filesystem::create_directories(folder);
    analysis::measurement_table({{"C07", "linear_drift", {.body = run}, value, value, value, "1"}})
        .write((folder / "measurements.csv").string());
    analysis::write_text_atomically((folder / "run.json").string(), "{\"schema\": 3}\n");
}

// Half the time step makes the frequency 3 times as large. A conclusion that was never drawn is not added, and one
// without its values stays.
TEST(StudyRecords, ConclusionsComeFromTheMeasuredValues)
{
    const analysis::CaseKey
        whole = {.body = "limb", .deformer = "pbs", .order = "plain", .precision = "f64", .time_step_s = 0.01},
        half = {.body = "limb", .deformer = "pbs", .order = "plain", .precision = "f64", .time_step_s = 0.005};
    const char* const at_half = "frequency_ratio_at_half_time_step";
    const auto concluded_in = [&](const std::string& study) {
        const ScratchFolder root;
        const std::string folder = root / study;
        write_study_plan(folder, plan_of({"limb"}));
        finish(folder, "limb", 0.0);
        analysis::measurement_table(
            {{"C09", "frequency_hz", whole, 2.0, 1.0, 3.0, "Hz"},
             {"C09", "frequency_hz", half, 6.0, 6.0, 6.0, "Hz"},
             {"C09", "last_share_of_peak", whole, 0.1, 0.1, 0.1, "1"},
             {"C09", at_half, whole, 2.5, 2.5, 2.5, "1"},
             {"C09", "amplitude_ratio_over_k_stretch", {.body = "limb", .deformer = "lbs"}, 7.0, 7.0, 7.0, "1"}})
            .write(folder + "/limb/measurements.csv");
        return read_study_records(folder, root.path().string()).measurements;
    };
    const auto concluded = concluded_in("jiggle"), as_recorded = concluded_in("momentum");
    ASSERT_EQ(concluded.size(), 5u);
    EXPECT_EQ(concluded[3].value, 3.0);
    EXPECT_EQ(concluded[3].high, 3.0);
    EXPECT_EQ(concluded[3].run, "jiggle/limb");
    EXPECT_EQ(concluded[4].value, 7.0);
    EXPECT_EQ(as_recorded[3].value, 2.5);
}

Scene walk()
{
    Scene scene;
    scene.name = "walk";
    scene.character.body = "man";
    scene.motion.clip = "clips/01_03.bvh";
    return scene;
}

TEST(StudyRecords, ComeFromRunsThatEnded)
{
    const ScratchFolder root;
    const std::string study = root / "momentum";
    write_study_plan(study, plan_of({"limb", "human", "man"}));
    finish(study, "limb", 1.0);
    finish(study, "man", 3.0);
    finish(study, "an_earlier_plan", 4.0);
    std::filesystem::create_directories(std::filesystem::path(study) / "human");  // killed before its run.json
    const analysis::Records records = read_study_records(study, root.path().string());
    ASSERT_EQ(records.measurements.size(), 2u);
    EXPECT_EQ(records.measurements[0].run, "momentum/limb");
    EXPECT_EQ(records.measurements[1].value, 3.0);
    EXPECT_EQ(records.missing_runs, std::vector<std::string>{"human"});
    EXPECT_TRUE(records.planned_scenes.empty());  // pieces of work, no scenes
}

TEST(StudyRecords, KnowWhatWasPlannedAndLeftOut)
{
    const ScratchFolder root;
    StudyPlan plan = plan_of({"limb"});
    plan.runs.push_back({.name = "a walk", .scene = walk()});
    plan.left_out = {{"man_01_01", "not installed"}};
    EXPECT_FALSE(has_study_plan(root / "volume"));
    write_study_plan(root / "volume", plan);
    EXPECT_TRUE(has_study_plan(root / "volume"));
    const analysis::Records records = read_study_records(root / "volume", root.path().string());
    EXPECT_EQ(records.planned_scenes, (std::vector<std::string>{"walk", "man_01_01"}));
    ASSERT_EQ(records.left_out.size(), 1u);
    EXPECT_EQ(records.left_out[0].reason, "not installed");
}

TEST(StudyRecords, ARecordIsOfTheBodyAndMotionThatThePlanGives)
{
    const ScratchFolder root;
    const std::string study = root / "volume", run = study + "/walk";
    StudyPlan plan;
    plan.runs.push_back({.name = "walk", .scene = walk()});
    write_study_plan(study, plan);
    std::filesystem::create_directories(run);
    analysis::write_text_atomically(
        run + "/metrics.csv",
        "scene,deformer,variant,order,precision,iterations,threads,frame,time_s,volume_change_pct,"
        "volume_abs_change_pct,inverted_tets\nwalk,pbs,default,plain,f64,24,1,0,0,0,0,0\n");
    analysis::write_text_atomically(run + "/run.json", "{\"schema\": 3}\n");
    const analysis::Records records = read_study_records(study, root.path().string());
    ASSERT_EQ(records.cases.size(), 1u);
    EXPECT_EQ(records.cases[0].place.body, "man");
    EXPECT_EQ(records.cases[0].place.motion, "01_03");
}

// The plan names a motion by its clip, its movements or, for a sweep, by the name in the case. Nothing is guessed.
TEST(StudyRecords, ASweepHasTheNameOfItsCase)
{
    const ScratchFolder root;
    StudyRun sweep{.name = "bend", .scene = read_scene("limb_bend", {}), .motion = "bend"};
    const auto motion_of = [&](const StudyRun& run) {
        StudyPlan plan;
        plan.runs.push_back(run);
        write_study_plan(root / "volume", plan);
        return nlohmann::json::parse(analysis::read_text(root / "volume/plan.json"))
            .at("runs")
            .at(0)
            .at("of")
            .at("motion");
    };
    EXPECT_EQ(motion_of(sweep), "bend");
    EXPECT_EQ(motion_of({.name = "a walk", .scene = walk()}), "01_03");
    sweep.motion.clear();
    EXPECT_THROW(motion_of(sweep), std::logic_error);
}

// Reference: the contents written to run.json.

class MarkedFrames : public testing::Test {
protected:
    std::string marks_of(const std::string& run_json)
    {
        std::filesystem::create_directories(scratch / "limb_bend");
        scratch.file("limb_bend/run.json", run_json);
        return marked_frames({scratch / "limb_bend"});
    }

    test_support::ScratchFolder scratch;
};

TEST_F(MarkedFrames, AreBrokenOnesOverlapsAndErrorsBelowTheReferences)
{
    EXPECT_EQ(marks_of(R"({"outcome": {"frames": 31, "broken_frames": {
                  "pbs": [{"frame": 2, "what": "not_finite", "step": 7, "first_vertex": 17,
                           "vertices_not_finite": 120}],
                  "nh_p1": [{"frame": 18, "what": "inverted", "worst_tet": 812, "volume_ratio": -0.04,
                             "inverted_tets": 3},
                            {"frame": 19, "what": "not_converged", "worst_tet": 5, "volume_ratio": 0.5,
                             "inverted_tets": 0}]}}})"),
              "     limb_bend: nh_p1 broke down in 2 of 31 frames (1 inverted, 1 not converged), the first inverted in "
              "frame 18: worst tet "
              "812 of volume ratio -0.04, 3 inverted\n"
              "     limb_bend: pbs broke down in 1 of 31 frames (1 not finite), the first not finite in frame 2 (in "
              "step 7, before it): "
              "first at vertex 17, 120 not finite\n");
    EXPECT_EQ(marks_of(R"({"outcome": {"frames": 31, "frames_with_overlap": 4, "largest_masked_share_pct": 6.25,
                                       "frames_below_reference_error": {"pbs": 2}}})"),
              "     limb_bend: the reference overlaps itself in 4 of 31 frames\n"
              "     limb_bend: errors leave out up to 6.2 % of the volume, at the tips of creases\n"
              "     limb_bend: the error of pbs at the joints is not above the reference's own in 2 of 31 frames\n");
    // Work and sound runs have none.
    EXPECT_EQ(marks_of(R"({"outcome": {"finished": true, "breakdown": ""}})"), "");
    EXPECT_EQ(marks_of(R"({"outcome": {"frames": 31, "broken_frames": {}, "frames_with_overlap": 0}})"), "");
}

TEST_F(MarkedFrames, WhatSomebodyElseMadeOfARecordIsRefusedWithItsFile)
{
    const std::string refusal =
        scratch / "limb_bend/run.json" + ": expected a record as this program writes it: it was changed, or cut short";
    for (const char* text :
         {"", "{\"outcome\": ", "[]", R"({"outcome": 3})", R"({"outcome": {"frames_with_overlap": 4}})",
          R"({"outcome": {"frames_with_overlap": "four", "frames": 31}})",
          R"({"outcome": {"broken_frames": {"pbs": []}, "frames": 31}})",
          R"({"outcome": {"broken_frames": {"pbs": [{"frame": "two"}]}, "frames": 31}})"})
        EXPECT_EQ(test_support::refusal_of([&] { marks_of(text); }), refusal) << text;
}

}  // namespace
