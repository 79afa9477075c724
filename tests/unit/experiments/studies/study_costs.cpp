// Reference: sums and maxima by hand.
#include "experiments/studies/study_costs.hpp"

#include "analysis/records/record_files.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

namespace {

using namespace experiments;
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
    EXPECT_EQ(expected_cost(study, {run_of(10), run_of(20), run_of(30)}, 2).wall_s, 30.0);
    EXPECT_EQ(expected_cost(study, {run_of(10), run_of(50)}, 2).wall_s, 50.0);
    EXPECT_EQ(expected_cost(study, {}, 2).wall_s, 0.0);
    const Study alone{.name = "timing", .alone = true};
    EXPECT_EQ(expected_cost(alone, {run_of(10), run_of(20), run_of(30)}, 2).wall_s, 60.0);
}

TEST(StudyCosts, StayOverResumedRuns)
{
    const ScratchFolder folder;
    StudyCosts first(folder.path().string());
    first.add("limb", 10.0, 12.0);
    first.add("human", 30.0, 25.0);
    first.write();
    StudyCosts resumed(folder.path().string());
    resumed.add("human", 30.0, 28.0);  // done again
    EXPECT_EQ(resumed.expected_s(), 40.0);
    EXPECT_EQ(resumed.cpu_s(), 40.0);
}

TEST(StudyCosts, RecordsWithoutWallTimeAreRead)
{
    const ScratchFolder folder;
    analysis::write_text_atomically(folder / "costs.csv", "run,expected_cpu_s,cpu_s\nlimb,10,12\n");
    const StudyCosts costs(folder.path().string());
    EXPECT_EQ(costs.cpu_s(), 12.0);
    costs.write();
    EXPECT_EQ(analysis::read_text(folder / "costs.csv"), "run,expected_cpu_s,cpu_s,wall_s\nlimb,10,12,\n");
}

// The process was killed before it wrote the table, so the record of each run supplies its cost.
TEST(StudyCosts, AreCompletedFromTheRunsThatEndedInTheOrderOfThePlan)
{
    const ScratchFolder folder;
    for (const char* run : {"scene", "work", "lost"}) std::filesystem::create_directories(folder.path() / run);
    folder.file("scene/run.json", R"({"cost": {"cpu_seconds": {"total": 3.5}}, "outcome": {}})");
    folder.file("work/run.json", R"({"outcome": {"wall_s": 9.0, "cpu_seconds": 8.0}})");
    StudyPlan plan;
    for (const char* run : {"scene", "lost", "work"}) plan.runs.push_back({.name = run, .cost_s = 2.0});
    StudyCosts costs(folder.path().string());
    costs.add("lost", 2.0, 100.0);  // from an earlier run; it did not end again
    costs.add("work", 2.0, 8.5);    // as measured by the parent
    costs.complete(folder.path().string(), plan);
    costs.write();
    std::ifstream file(folder / "costs.csv");
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), "run,expected_cpu_s,cpu_s,wall_s\nscene,2,3.5,\nwork,2,8.5,9\n");
}

// Records of another version, or a file that is not a record: their cost is unknown, which is not an error.
TEST(StudyCosts, RunsThatDoNotTellTheirCostAreLeftOutButForWhatTheParentSaw)
{
    const ScratchFolder folder;
    StudyPlan plan;
    for (const char* run : {"seen", "bare", "words", "list", "torn", "told"}) {
        std::filesystem::create_directories(folder.path() / run);
        plan.runs.push_back({.name = run, .cost_s = 2.0});
    }
    folder.file("seen/run.json", R"({"outcome": {"wall_s": 9.0}})");
    folder.file("bare/run.json", R"({"cost": {}, "outcome": {"cpu_seconds": 8.0}})");
    folder.file("words/run.json", R"({"outcome": {"cpu_seconds": "8"}})");
    folder.file("list/run.json", "[1, 2]");
    folder.file("torn/run.json", R"({"outcome": {"cpu_)");
    folder.file("told/run.json", R"({"outcome": {"cpu_seconds": 3.0, "wall_s": "4"}})");
    StudyCosts costs(folder.path().string());
    costs.add("seen", 2.0, 8.5);
    costs.complete(folder.path().string(), plan);
    costs.write();
    EXPECT_EQ(analysis::read_text(folder / "costs.csv"), "run,expected_cpu_s,cpu_s,wall_s\nseen,2,8.5,9\ntold,2,3,\n");
}

TEST(StudyCosts, PointAtWhatIsNotWithinAFactorOfTwo)
{
    const ScratchFolder folder;
    StudyCosts met(folder / "met"), missed(folder / "missed"), tiny(folder / "tiny");
    met.add("run", 100.0, 190.0);
    missed.add("run", 100.0, 210.0);
    tiny.add("run", 1.0, 0.1);
    EXPECT_EQ(cost_table({{"met", met}}).find("not within"), std::string::npos);
    EXPECT_NE(cost_table({{"missed", missed}}).find("2.10  not within a factor of 2"), std::string::npos);
    EXPECT_EQ(cost_table({{"tiny", tiny}}).find("not within"), std::string::npos);
}

}  // namespace
