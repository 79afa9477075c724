// Truth: theory. A displacement that is affine in x has constant stress, needs no body force and lies in both finite element spaces, so
// the solver must return it on any mesh (B. Irons, A. Razzaque, 1972). Tolerance: the relative error of a backward stable direct solve
// is below n eps cond(K) with n the number of unknowns; sqrt(n) is what rounding of random sign gives, and what is asked here, with
// cond(K) from the eigenvalues of the very matrix.
#include "reference_fem/boundary_value_problem.hpp"

#include "tests/verification/reference_fem/jittered_cube.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <limits>

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

// Largest over smallest eigenvalue of the stiffness between the cube's inner nodes.
double condition_of_inner_stiffness(const SimplexSpace& space)
{
    const Eigen::MatrixXd stiffness = stiffness_matrix(space, lame_parameters(material.young_pa, material.poisson));
    std::vector<int> inner;
    for (int node = 0; node < space.nodes(); ++node) {
        const auto point = space.node_positions().row(node).array();
        if (point.minCoeff() < 1e-9 || point.maxCoeff() > 1.0 - 1e-9) continue;
        for (int c = 0; c < 3; ++c) inner.push_back(3 * node + c);
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(stiffness(inner, inner), Eigen::EigenvaluesOnly);
    return eigen.eigenvalues().tail<1>()(0) / eigen.eigenvalues()(0);
}

class PatchTest : public testing::TestWithParam<std::tuple<int, LinearSolver>> {};

TEST_P(PatchTest, ReturnsAnAffineDisplacementToRounding)
{
    const auto [element_order, solver] = GetParam();
    const pbs::TetMesh mesh = test_support::jittered_cube(element_order == 1 ? 5 : 3, 0.45);
    const BoundaryValueSolution solution = solve(mesh, material, {{}, affine, {}, element_order, solver});

    double largest_displacement = 0.0;
    for (const auto& point : mesh.rest.rowwise()) largest_displacement = std::max(largest_displacement, affine(point.transpose()).norm());
    const double relative = solution.largest_nodal_error(affine) / largest_displacement;
    const double bound =
        std::sqrt(double(solution.space->dofs())) * std::numeric_limits<double>::epsilon() * condition_of_inner_stiffness(*solution.space);
    RecordProperty("relative_error", std::to_string(relative / 1e-16) + "e-16");
    RecordProperty("bound", std::to_string(bound / 1e-16) + "e-16");
    EXPECT_LT(relative, bound);
    EXPECT_LT(bound, 1e-11) << "a bound that would let an error of a percent pass proves nothing";
}

INSTANTIATE_TEST_SUITE_P(Elements, PatchTest,
                         testing::Combine(testing::Values(1, 2), testing::Values(LinearSolver::cholmod, LinearSolver::umfpack)));

}  // namespace
