// The quick verification record of the finite elements. Reference: what each row cites (closed forms, published
// benchmarks, other codes); the row states its tolerance and where that comes from. The record can fail: with an error
// of 5 % in the solver's lambda, which the compared values do not have, named rows do not hold. Problems without a
// character, PBS or another program: tests/verification/reference_fem/problems.cpp.
#include "experiments/studies/verification/problem.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

namespace {

using namespace experiments;

const VerificationProblem& problem(const std::string& name)
{
    const auto& all = verification_problems();
    const auto found = std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.name == name; });
    if (found == all.end()) throw std::out_of_range(name);
    return *found;
}

class VerificationRecord : public testing::TestWithParam<std::string> {};

TEST_P(VerificationRecord, EveryJudgedRowHoldsAndSaysWhy)
{
    int judged = 0;
    const VerificationRows rows = problem(GetParam()).rows({});
    for (const VerificationRow& row : rows) {
        const std::string place =
            row.quantity.description + ", " + row.elements.text() + ", " + row.material.law + ", " + row.mesh;
        EXPECT_NO_THROW(problem(row.problem)) << place;
        EXPECT_FALSE(row.quantity.key.empty() || row.quantity.description.empty() || row.mesh.empty() ||
                     row.unit.empty())
            << place;
        EXPECT_FALSE(row.source.empty()) << place;
        if (!holds(row)) continue;
        ++judged;
        EXPECT_FALSE(row.bound_from.empty()) << place;
        EXPECT_TRUE(*holds(row)) << place << ": " << row.value << " in " << row.low.value_or(0.0) << " to "
                                 << row.high.value_or(0.0);
    }
    EXPECT_TRUE(judged > 0 || rows.empty());  // no rows: the body or the program that the problem needs is missing
}

INSTANTIATE_TEST_SUITE_P(Problem, VerificationRecord,
                         testing::Values("pbs_locking", "nested_convergence", "calculix"),
                         [](const auto& info) { return info.param; });

TEST(VerificationRecordWithAWrongLameParameter, DoesNotPass)
{
    bool failed = false;
    for (const VerificationRow& row : problem("nested_convergence").rows({{.lambda_error = 0.05}}))
        failed |= row.quantity.key == "bound" && !holds(row).value_or(true);
    EXPECT_TRUE(failed);
}

}  // namespace
