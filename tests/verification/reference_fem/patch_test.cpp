// Reference: theory. A displacement that is affine in x has constant stress, needs no body force and lies in both finite element spaces, so
// the solver must reproduce it on any mesh (B. Irons, A. Razzaque, 1972). Tolerance: rounding of a direct solve, sqrt(n) eps cond(K).
#include "reference_fem/boundary_value_problem.hpp"

#include "tests/support/solve_rounding.hpp"
#include "tests/verification/reference_fem/jittered_cube.hpp"

#include <gtest/gtest.h>

namespace {

using namespace reference_fem;
using pbs::Vec3;

const ElasticMaterial material{1.0, 0.3};

Vec3 affine(const Vec3& x)
{
    Eigen::Matrix3d gradient;
    gradient << 0.02, -0.03, 0.04, 0.06, 0.01, 0.02, -0.02, 0.05, -0.04;
    return Vec3(0.1, -0.05, 0.03) + gradient * x;
}

class PatchTest : public testing::TestWithParam<std::tuple<int, LinearSolver>> {};

TEST_P(PatchTest, ReturnsAnAffineDisplacementToRounding)
{
    const auto [element_order, solver] = GetParam();
    const pbs::TetMesh mesh = test_support::jittered_cube(element_order == 1 ? 5 : 3, 0.45);
    const BoundaryValueSolution solution = solve(mesh, material, {{}, affine, {}, element_order, solver});

    const double relative = test_support::relative_error(solution, affine), bound = rounding_bound(spectrum(solution, material));
    RecordProperty("relative_error", std::to_string(relative / 1e-16) + "e-16");
    RecordProperty("bound", std::to_string(bound / 1e-16) + "e-16");
    EXPECT_LT(relative, bound);
    EXPECT_LT(bound, 1e-11) << "a bound that would let an error of a percent pass proves nothing";
}

INSTANTIATE_TEST_SUITE_P(Elements, PatchTest,
                         testing::Combine(testing::Values(1, 2), testing::Values(LinearSolver::cholmod, LinearSolver::umfpack)));

}  // namespace
