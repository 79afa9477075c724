// The remarks on what a reference with a budget of time has reached. Reference: the words of the header.
#include "experiments/run/reference_outcome.hpp"

#include <gtest/gtest.h>

namespace {

using namespace experiments;

TEST(ReferenceOutcome, SaysWhatIsMissing)
{
    EXPECT_TRUE(remarks_on({.frames = 5, .solved = 5}, "a.toml").empty());
    const auto few = remarks_on({.frames = 60, .solved = 2, .seconds = 7.0}, "a.toml");
    ASSERT_EQ(few.size(), 1u);
    EXPECT_EQ(few.front().gravity, pbs::Gravity::comparison_wrong);
    EXPECT_EQ(remarks_on({.frames = 60, .solved = 30}, "a.toml").front().gravity, pbs::Gravity::information);
    const auto missing = remarks_on(
        {.frames = 3, .solved = 2, .not_reached = {{1, 4.0, ""}}, .with_contact = {{0, 5.0, "head"}}}, "a.toml");
    ASSERT_EQ(missing.size(), 2u);
    EXPECT_NE(missing[0].text.find("the flesh of head holds it up"), std::string::npos);
    EXPECT_EQ(missing[1].text.find("holds it up"), std::string::npos);
}

}  // namespace
