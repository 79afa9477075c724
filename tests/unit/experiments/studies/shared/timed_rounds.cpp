// Variants take turns, and each one's values come back round by round. Medians and quartiles are computed by hand.
#include "experiments/studies/shared/timed_rounds.hpp"

#include <gtest/gtest.h>

#include <string>

namespace {

using namespace experiments;

TEST(TimedRounds, VariantsTakeTurnsNoMoreThanTheMostAndTheFirstRoundIsNotKept)
{
    std::string order;
    double a = 0.0, b = 100.0;
    const auto samples = take_turns({[&] { return order += 'A', std::vector<double>{a += 1.0}; },
                                     [&] {
                                         return order += 'B', std::vector<double>{b += 1.0, -b};
                                     }},
                                    {.seconds = 0.0, .fewest = 3, .most = 9});
    EXPECT_EQ(order, "ABABABAB");
    ASSERT_EQ(samples.size(), 2u);
    EXPECT_EQ(samples[0][0], (std::vector<double>{2.0, 3.0, 4.0}));
    EXPECT_EQ(samples[1][0], (std::vector<double>{102.0, 103.0, 104.0}));
    EXPECT_EQ(samples[1][1], (std::vector<double>{-102.0, -103.0, -104.0}));
    const auto most = take_turns({[] { return std::vector<double>{1.0}; }}, {.seconds = 60.0, .fewest = 1, .most = 4});
    EXPECT_EQ(most[0][0].size(), 4u);
}

TEST(TimedRounds, MedianAndQuartiles)
{
    const auto odd = spread_of({5.0, 1.0, 4.0, 2.0, 3.0});
    EXPECT_DOUBLE_EQ(odd.median, 3.0);
    EXPECT_DOUBLE_EQ(odd.lower, 2.0);
    EXPECT_DOUBLE_EQ(odd.upper, 4.0);
    EXPECT_EQ(odd.rounds, 5);
    EXPECT_DOUBLE_EQ(spread_of({1.0, 2.0, 3.0, 10.0}).median, 2.5);  // one disturbed round changes it little
    EXPECT_DOUBLE_EQ(scaled(odd, 10.0).upper, 40.0);
}

TEST(TimedRounds, ColumnsOfASpread)
{
    const analysis::Columns<Spread> columns = spread_columns("step_ms");
    EXPECT_EQ(table_of(columns, std::vector<Spread>{{2.0, 1.5, 4.0, 7}}).text(),
              "step_ms,step_ms_low,step_ms_high\n2,1.5,4\n");
}

}  // namespace
