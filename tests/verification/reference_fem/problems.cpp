// The verification problems that need neither a character nor another program run in their quick form. thick_sphere and
// half_turn take long: only ./check --long runs them, half_turn with every law. half_turn is a regression test, since
// it compares with an earlier implementation of ours; laws.cpp verifies each law by itself. Reference: what each row
// cites (closed forms, published benchmarks); the row states its bounds and where they come from. The record can fail:
// with an error of 5 % in the solver's lambda, which the compared values do not have, named rows do not hold.
#include "reference_fem/verification/problems.hpp"
#include "tests/support/long_form.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace {

using namespace reference_fem;

const std::map<std::string, std::function<VerificationRows(const Effort&)>> problems = {
    {"laws", laws_rows},
    {"patch_test", patch_test_rows},
    {"manufactured_solution", manufactured_solution_rows},
    {"own_weight", own_weight_rows},
    {"cantilever", cantilever_rows},
    {"gravity_cantilever", gravity_cantilever_rows},
    {"torsion", torsion_rows},
    {"thick_sphere", thick_sphere_rows},
    {"cooks_membrane", cooks_membrane_rows},
    {"cooks_membrane_finite_strain", cooks_membrane_finite_strain_rows},
    {"twisted_beam", twisted_beam_rows},
    {"half_turn", [](const Effort&) { return half_turn_rows({.full = true}); }},
    {"thick_plate", thick_plate_rows},
    {"dynamics", dynamics_rows},
    {"moving_skeleton", moving_skeleton_rows},
    {"contact", contact_rows}};

const std::set<std::string> long_problems = {"thick_sphere", "half_turn"};

class VerificationProblem : public testing::TestWithParam<std::string> {};

TEST_P(VerificationProblem, EveryRowWithBoundsHoldsAndStatesWhy)
{
    int judged = 0;
    for (const VerificationRow& row : problems.at(GetParam())({})) {
        const std::string place =
            row.quantity.description + ", " + row.elements.text() + ", " + row.material.law + ", " + row.mesh;
        EXPECT_EQ(row.problem, GetParam()) << place;
        EXPECT_FALSE(row.quantity.key.empty() || row.quantity.description.empty() || row.mesh.empty() ||
                     row.unit.empty())
            << place;
        EXPECT_FALSE(row.source.empty()) << place;
        if (!holds(row)) continue;
        ++judged;
        EXPECT_FALSE(row.bound_from.empty()) << place;
        EXPECT_TRUE(*holds(row)) << place << ": " << row.value << " in " << row.low.value_or(0.0) << " to "
                                 << row.high.value_or(0.0);
        if (row.bound_from == rounding_bound_text) {
            EXPECT_LT(*row.high, 1e-9) << place << ": a bound that would let an error of a percent pass proves nothing";
        }
    }
    EXPECT_GT(judged, 0);
}

std::vector<std::string> names_to_run()
{
    std::vector<std::string> names;
    for (const auto& [name, rows] : problems)
        if (test_support::is_long_form() || !long_problems.contains(name)) names.push_back(name);
    return names;
}
INSTANTIATE_TEST_SUITE_P(Quick, VerificationProblem, testing::ValuesIn(names_to_run()),
                         [](const auto& info) { return info.param; });

// A wrong Lame parameter moves these quantities out of their bounds.
TEST(WrongLameParameter, DoesNotPass)
{
    for (const auto& [problem, quantity] : {std::pair("patch_test", "nodal_error_from_tractions"),
                                            {"own_weight", "nodal_error"},
                                            {"manufactured_solution", "error_l2"},
                                            {"manufactured_solution", "error_h1_seminorm"},
                                            {"cooks_membrane", "corner_rise_plane_strain"}}) {
        bool failed = false;
        for (const VerificationRow& row : problems.at(problem)({.lambda_error = 0.05}))
            failed |= row.quantity.key == quantity && !holds(row).value_or(true);
        EXPECT_TRUE(failed) << problem << ", " << quantity;
    }
}

}  // namespace
