// The quick verification record of the finite elements. Reference: what each row cites (closed forms, published benchmarks, other codes);
// the row states its tolerance and where that comes from. The record can fail: with an error of 5 % in the solver's lambda, which the
// compared values do not have, named rows do not hold.
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

// The quick problems; the longer ones have separate tests.
std::vector<std::string> names()
{
    std::vector<std::string> quick;
    for (const auto& one : verification_problems())
        if (one.quick_s <= 10.0) quick.push_back(one.name);
    return quick;
}

class VerificationRecord : public testing::TestWithParam<std::string> {};

TEST_P(VerificationRecord, EveryJudgedRowHoldsAndSaysWhy)
{
    int judged = 0;
    const VerificationRows rows = problem(GetParam()).rows({});
    for (const VerificationRow& row : rows) {
        const std::string place = row.quantity.description + ", " + row.elements.text() + ", " + row.material.text() + ", " + row.mesh;
        EXPECT_NO_THROW(problem(row.problem)) << place;
        EXPECT_FALSE(row.quantity.key.empty() || row.quantity.description.empty() || row.mesh.empty() || row.unit.empty()) << place;
        EXPECT_FALSE(row.source.empty()) << place;
        if (!holds(row)) continue;
        ++judged;
        EXPECT_FALSE(row.bound_from.empty()) << place;
        EXPECT_TRUE(*holds(row)) << place << ": " << to_json(row).dump(2);
    }
    EXPECT_TRUE(judged > 0 || rows.empty());  // no rows: the body or the program that the problem needs is missing
}

INSTANTIATE_TEST_SUITE_P(Problem, VerificationRecord, testing::ValuesIn(names()), [](const auto& info) { return info.param; });

// (problem, quantity), for the row of the finest mesh.
using Named = std::pair<const char*, const char*>;
class WrongLameParameter : public testing::TestWithParam<Named> {};

TEST_P(WrongLameParameter, DoesNotPass)
{
    const auto [name, quantity] = GetParam();
    bool failed = false;
    for (const VerificationRow& row : problem(name).rows({{.lambda_error = 0.05}}))
        failed |= row.quantity.key == quantity && !holds(row).value_or(true);
    EXPECT_TRUE(failed);
}

INSTANTIATE_TEST_SUITE_P(Row, WrongLameParameter,
                         testing::Values(Named{"patch_test", "nodal_error_from_tractions"}, Named{"own_weight", "nodal_error"},
                                         Named{"manufactured_solution", "error_l2"}, Named{"manufactured_solution", "error_h1_seminorm"},
                                         Named{"cooks_membrane", "corner_rise_plane_strain"}, Named{"nested_convergence", "bound"}));

}  // namespace
