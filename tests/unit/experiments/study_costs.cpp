// Truth: sums and maxima by hand.
#include "experiments/study_costs.hpp"

#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

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
