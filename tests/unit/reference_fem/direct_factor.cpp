// Truth: a dense solve of the same small system by Eigen.
#include "reference_fem/direct_factor.hpp"

#include "reference_fem/blas.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace {

using namespace reference_fem;

SparseMatrix spring_chain(int n, double ground)
{
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
    for (int i = 0; i + 1 < n; ++i) matrix.block<2, 2>(i, i) += (Eigen::Matrix2d() << 1, -1, -1, 1).finished();
    matrix(0, 0) += ground;
    SparseMatrix sparse = matrix.sparseView();
    sparse.makeCompressed();
    return sparse;
}

TEST(DirectFactor, BothSolversAgreeWithADenseSolveForManyRightHandSides)
{
    const SparseMatrix matrix = spring_chain(30, 2.0);
    for (const auto solver : {LinearSolver::cholmod, LinearSolver::umfpack}) {
        const auto factor = factorise(matrix, solver);
        ASSERT_TRUE(factor->usable());
        EXPECT_GT(factor->reciprocal_condition(), 0.0);
        for (int i = 0; i < 30; i += 5) {
            const Eigen::VectorXd right_hand_side = Eigen::VectorXd::Unit(30, i);
            const Eigen::VectorXd dense = Eigen::MatrixXd(matrix).lu().solve(right_hand_side);
            EXPECT_LT((factor->solve(right_hand_side) - dense).norm() / dense.norm(), 1e-12) << factor->name();
        }
    }
}

TEST(DirectFactor, ASingularMatrixIsReportedNotThrown)
{
    const SparseMatrix floating = spring_chain(4, 0.0);
    EXPECT_FALSE(factorise(floating, LinearSolver::cholmod)->usable());
    EXPECT_FALSE(factorise(floating, LinearSolver::umfpack)->usable());
}

TEST(DirectFactor, CholmodRefusesAnIndefiniteMatrixThatUmfpackSolves)
{
    const SparseMatrix indefinite = spring_chain(4, -3.0);
    EXPECT_FALSE(factorise(indefinite, LinearSolver::cholmod)->usable());
    EXPECT_TRUE(factorise(indefinite, LinearSolver::umfpack)->usable());
}

TEST(DirectFactor, TheBlasInUseIsNamedWithItsFile)
{
    EXPECT_NE(resolved_blas().find("blas"), std::string::npos) << resolved_blas();
    EXPECT_NE(resolved_blas().find(".so"), std::string::npos) << resolved_blas();
    EXPECT_EQ(resolved_blas().find('/'), std::string::npos) << resolved_blas();
}

}  // namespace
