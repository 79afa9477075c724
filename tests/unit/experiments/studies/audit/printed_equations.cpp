// Reference: difference quotients of Eq. 11, which is linear in each coordinate.
#include "experiments/studies/audit/printed_equations.hpp"

#include <gtest/gtest.h>

namespace {

TEST(PrintedEquationsAudit, SumsHoldLabelsAndSignsDoNot)
{
    const auto values = experiments::equation_values(50, 7);
    ASSERT_EQ(values.size(), 10u);
    const auto consistent = [&](int i) { return values[i].printed <= values[i].most; };
    EXPECT_TRUE(consistent(0)) << "Eq. 15-16 are right as printed";
    for (int i = 1; i <= 8; ++i) EXPECT_FALSE(consistent(i)) << analysis::text_of(values[i].of);
    EXPECT_TRUE(consistent(9)) << "the derived form";
}

TEST(PrintedEquationsAudit, DoesNotDependOnTheSeed)
{
    const auto one = experiments::equation_values(50, 1), other = experiments::equation_values(50, 2);
    for (std::size_t i = 0; i < one.size(); ++i)
        EXPECT_EQ(one[i].printed <= one[i].most, other[i].printed <= other[i].most) << analysis::text_of(one[i].of);
}

}  // namespace
