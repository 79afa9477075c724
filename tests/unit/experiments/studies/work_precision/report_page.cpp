// A deformer of the user's own in the tables and on the page. Reference: points made by hand.
#include "experiments/studies/work_precision/report_page.hpp"

#include "experiments/studies/work_precision/diagram_tables.hpp"
#include "experiments/studies/work_precision/findings.hpp"
#include "tests/support/comparison_records.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace {

using namespace experiments;

// `mine` is nearer than PBS and slower.
ComparisonRecords records_with(std::optional<FrameClock> clock)
{
    CaseRows rows = test_support::hand_case({.body = "limb", .pose = "a"},
                                            {{{.deformer = "mine"}, 2.0, 4.0},
                                             {{.deformer = "lbs", .precision = "f64"}, 0.1, 60.0},
                                             {{.deformer = "pbs", .iterations = 4, .precision = "f32", .packed = true}, 1.0, 30.0},
                                             test_support::hand_reference()});
    if (clock) rows.front().is_external = true, rows.front().clock = clock;
    ComparisonRecords records;
    records.cases = {{rows}};
    records.chosen = choose_settings({rows});
    records.diagrams = diagrams_of(records.cases, records.chosen);
    return records;
}

const Diagram& packed_one(const ComparisonRecords& records)
{
    return *std::ranges::find(records.diagrams, Comparison::packed_f32, &Diagram::comparison);
}

TEST(OwnDeformersOnThePage, AreAGroupOfTheirOwnInBothComparisons)
{
    const ComparisonRecords records = records_with(FrameClock::own);
    for (const Diagram& diagram : records.diagrams) {
        EXPECT_EQ(diagram.groups.size(), deformer_groups().size() + 1);
        EXPECT_TRUE(diagram.groups.back().is_external);
        EXPECT_EQ(best_within(diagram, 3.0).front().group, "mine");
    }
    EXPECT_NE(fronts_table(records.diagrams).text().find(",mine,mine,"), std::string::npos);
    EXPECT_NE(crossings_table(records.diagrams).text().find(",mine,pbs,from,2"), std::string::npos);
    const std::vector<ProfileStep> steps = data_profiles(records.diagrams);
    EXPECT_TRUE(std::ranges::any_of(steps, [](const ProfileStep& step) { return step.group == "mine" && step.tolerance_pct == 5.0; }));
    const std::vector<std::string> lines = findings(packed_one(records));
    EXPECT_TRUE(
        std::ranges::any_of(lines, [](const std::string& line) { return line.starts_with("mine is nearer than PBS from 2 ms on"); }));
}

TEST(OwnDeformersOnThePage, HaveTheirClockInWords)
{
    for (const auto& [clock, words] : {std::pair{FrameClock::own, "- `mine`: the times that the program states in seconds.f64\n"},
                                       {FrameClock::wall, "- `mine`: the wall time of the program with its start"},
                                       {FrameClock::processor, "- `mine`: processor time, as of all other deformers\n"}}) {
        const std::string page = page_of(records_with(clock));
        EXPECT_NE(page.find(words), std::string::npos) << page;
    }
}

TEST(OwnDeformersOnThePage, AreNotMentionedWhereThereAreNone)
{
    EXPECT_EQ(page_of(records_with({})).find("user's own"), std::string::npos);
    for (const Diagram& diagram : records_with({}).diagrams) EXPECT_EQ(diagram.groups.size(), deformer_groups().size());
    EXPECT_EQ(groups_of({}).size(), deformer_groups().size());
}

}  // namespace
