// The verification problems that need neither a character nor another program, in their quick form; half_turn with every law. Reference:
// what each row cites (closed forms, published benchmarks); the row states its bounds and where they come from. The record can fail: with
// an error of 5 % in the solver's lambda, which the compared values do not have, named rows do not hold.
#include "reference_fem/verification/problems.hpp"

#include <gtest/gtest.h>

namespace {

using namespace reference_fem;

struct Problem {
    std::string name;
    VerificationRows (*rows)(const Effort& effort);
    Effort effort = {};
};

void PrintTo(const Problem& problem, std::ostream* out)
{
    *out << problem.name;
}

class VerificationProblem : public testing::TestWithParam<Problem> {};

TEST_P(VerificationProblem, EveryRowWithBoundsHoldsAndStatesWhy)
{
    int judged = 0;
    for (const VerificationRow& row : GetParam().rows(GetParam().effort)) {
        const std::string place = row.quantity.description + ", " + row.elements.text() + ", " + row.material.text() + ", " + row.mesh;
        EXPECT_EQ(row.problem, GetParam().name) << place;
        EXPECT_FALSE(row.quantity.key.empty() || row.quantity.description.empty() || row.mesh.empty() || row.unit.empty()) << place;
        EXPECT_FALSE(row.source.empty()) << place;
        if (!holds(row)) continue;
        ++judged;
        EXPECT_FALSE(row.bound_from.empty()) << place;
        EXPECT_TRUE(*holds(row)) << place << ": " << row.value << " in " << row.low.value_or(0.0) << " to " << row.high.value_or(0.0);
        if (row.bound_from == rounding_bound_text) {
            EXPECT_LT(*row.high, 1e-9) << place << ": a bound that would let an error of a percent pass proves nothing";
        }
    }
    EXPECT_GT(judged, 0);
}

const std::string name_of(const testing::TestParamInfo<Problem>& info)
{
    return info.param.name;
}

INSTANTIATE_TEST_SUITE_P(Quick, VerificationProblem,
                         testing::Values(Problem{"laws", laws_rows}, Problem{"patch_test", patch_test_rows},
                                         Problem{"manufactured_solution", manufactured_solution_rows},
                                         Problem{"own_weight", own_weight_rows}, Problem{"cantilever", cantilever_rows},
                                         Problem{"gravity_cantilever", gravity_cantilever_rows}, Problem{"torsion", torsion_rows},
                                         Problem{"thick_sphere", thick_sphere_rows}, Problem{"cooks_membrane", cooks_membrane_rows},
                                         Problem{"cooks_membrane_finite_strain", cooks_membrane_finite_strain_rows},
                                         Problem{"twisted_beam", twisted_beam_rows}, Problem{"half_turn", half_turn_rows, {.full = true}},
                                         Problem{"thick_plate", thick_plate_rows}, Problem{"dynamics", dynamics_rows},
                                         Problem{"moving_skeleton", moving_skeleton_rows}),
                         name_of);

// The quantity of a row that a wrong Lame parameter moves out of its bounds.
struct Sensitive {
    Problem problem;
    std::string quantity;
};

class WrongLameParameter : public testing::TestWithParam<Sensitive> {};

TEST_P(WrongLameParameter, DoesNotPass)
{
    bool failed = false;
    for (const VerificationRow& row : GetParam().problem.rows({.lambda_error = 0.05}))
        failed |= row.quantity.key == GetParam().quantity && !holds(row).value_or(true);
    EXPECT_TRUE(failed);
}

INSTANTIATE_TEST_SUITE_P(Row, WrongLameParameter,
                         testing::Values(Sensitive{{"patch_test", patch_test_rows}, "nodal_error_from_tractions"},
                                         Sensitive{{"own_weight", own_weight_rows}, "nodal_error"},
                                         Sensitive{{"manufactured_solution", manufactured_solution_rows}, "error_l2"},
                                         Sensitive{{"manufactured_solution", manufactured_solution_rows}, "error_h1_seminorm"},
                                         Sensitive{{"cooks_membrane", cooks_membrane_rows}, "corner_rise_plane_strain"}));

}  // namespace
