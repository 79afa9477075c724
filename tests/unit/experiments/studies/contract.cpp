// Every study keeps these promises. Reference: the contract of experiments/studies/study.hpp. A study of the list joins
// by itself.

#include "experiments/reproduce/reproduce.hpp"
#include "experiments/reproduce/studies.hpp"
#include "experiments/studies/study.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <set>

namespace {

using namespace experiments;

std::vector<std::string> names_of_studies()
{
    std::vector<std::string> names;
    for (const Study& study : studies()) names.push_back(study.name);
    return names;
}

class EveryStudy : public testing::TestWithParam<std::string> {
protected:
    const Study& study_ = *std::ranges::find(studies(), GetParam(), &Study::name);
    const test_support::ScratchFolder folder_;
};
INSTANTIATE_TEST_SUITE_P(Study, EveryStudy, testing::ValuesIn(names_of_studies()),
                         [](const auto& one) { return one.param; });

// What the result of a run depends on.
nlohmann::json identity_of(const StudyRun& run)
{
    return run.work ? run.settings : to_json(run.scene);
}

TEST_P(EveryStudy, PlansTheSameRunsAgain)
{
    const StudyPlan plan = study_.plan(false), again = study_.plan(false);
    ASSERT_EQ(again.runs.size(), plan.runs.size());
    for (std::size_t r = 0; r < plan.runs.size(); ++r) {
        EXPECT_EQ(again.runs[r].name, plan.runs[r].name);
        EXPECT_EQ(identity_of(again.runs[r]), identity_of(plan.runs[r])) << plan.runs[r].name;
    }
}

TEST_P(EveryStudy, PlansRunsWithNamesOfTheirOwnAndWithCosts)
{
    for (const bool full : {false, true}) {
        const StudyPlan plan = study_.plan(full);
        EXPECT_FALSE(plan.runs.empty() && plan.left_out.empty());
        std::set<std::string> names;
        for (const StudyRun& run : plan.runs) {
            EXPECT_TRUE(names.insert(run.name).second) << run.name;
            EXPECT_EQ(std::filesystem::path(run.name).filename(), run.name) << "a folder in that of the study";
            EXPECT_GT(run.cost_s, 0.0) << run.name;
            EXPECT_NE(static_cast<bool>(run.work), run.settings.is_null()) << run.name;
        }
        for (const analysis::LeftOut& left_out : plan.left_out) EXPECT_FALSE(left_out.reason.empty()) << left_out.scene;
        EXPECT_NO_THROW(write_study_plan(folder_.path().string(), plan)) << "each sweep has a name";
    }
}

TEST_P(EveryStudy, DoesNotRepeatWorkThatEndedUnlessItsSettingsHaveChanged)
{
    std::vector<StudyRun> runs = study_.plan(false).runs;
    std::erase_if(runs, [](const StudyRun& run) { return !run.work; });
    if (runs.empty()) GTEST_SKIP() << "its runs are scenes";
    for (StudyRun& run : runs) run.work = [](const std::string&) { return std::string(); };
    const std::string ended = folder_ / "run";
    carry_out(runs.front(), ended);
    EXPECT_TRUE(is_finished(runs.front(), ended));
    for (std::size_t r = 1; r < runs.size(); ++r) EXPECT_FALSE(is_finished(runs[r], ended)) << runs[r].name;
    for (const auto& [key, value] : runs.front().settings.items()) {
        StudyRun changed = runs.front();
        changed.settings[key] = "another value";
        EXPECT_FALSE(is_finished(changed, ended)) << key;
    }
}

}  // namespace
