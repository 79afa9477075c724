// Reference: a dense solve of the eliminated system by Eigen.
#include "reference_fem/eliminated_system.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace {

using namespace reference_fem;

SparseMatrix tridiagonal(double diagonal)
{
    Eigen::MatrixXd matrix = diagonal * Eigen::MatrixXd::Identity(6, 6);
    for (int i = 0; i < 5; ++i) matrix(i, i + 1) = matrix(i + 1, i) = -1.0;
    SparseMatrix sparse = matrix.sparseView();
    sparse.makeCompressed();
    return sparse;
}

const std::vector<bool> first_and_fifth = {true, false, false, false, true, false};

TEST(EliminatedSystem, PrescribedValuesStayAndFreeRowsHold)
{
    const SparseMatrix stiffness = tridiagonal(2.5);
    const EliminatedSystem system(stiffness, first_and_fifth, LinearSolver::cholmod);
    const Eigen::VectorXd load = Eigen::VectorXd::LinSpaced(6, 1.0, 2.0);
    Eigen::VectorXd prescribed = Eigen::VectorXd::Constant(6, std::nan(""));  // read only at prescribed degrees of freedom
    for (const double first : {0.5, -3.0}) {
        prescribed(0) = first;
        prescribed(4) = 7.0;
        const EliminatedSolution solution = system.solve(load, prescribed);
        EXPECT_EQ(solution.displacement(0), first);
        EXPECT_EQ(solution.displacement(4), 7.0);
        const Eigen::VectorXd defect = stiffness * solution.displacement - load;
        for (const int row : {1, 2, 3, 5}) EXPECT_NEAR(defect(row), 0.0, 1e-14);
        EXPECT_LT(solution.residual, 1e-15);
    }
}

TEST(EliminatedSystem, NothingToDoHasNoResidual)
{
    const EliminatedSystem system(tridiagonal(2.5), first_and_fifth, LinearSolver::cholmod);
    const EliminatedSolution solution = system.solve(Eigen::VectorXd::Zero(6), Eigen::VectorXd::Zero(6));
    EXPECT_EQ(solution.displacement, Eigen::VectorXd::Zero(6));
    EXPECT_EQ(solution.residual, 0.0);
}

TEST(EliminatedSystem, EveryDegreeOfFreedomPrescribed)
{
    const EliminatedSystem system(tridiagonal(2.5), std::vector<bool>(6, true), LinearSolver::cholmod);
    const Eigen::VectorXd values = Eigen::VectorXd::LinSpaced(6, 1.0, 2.0);
    EXPECT_EQ(system.solve(Eigen::VectorXd::Zero(6), values).displacement, values);
}

TEST(EliminatedSystem, ABrokenFactorisationGivesNotANumber)
{
    const EliminatedSystem system(tridiagonal(0.0), std::vector<bool>(6, false), LinearSolver::cholmod);
    const EliminatedSolution solution = system.solve(Eigen::VectorXd::Ones(6), Eigen::VectorXd::Zero(6));
    EXPECT_FALSE(solution.displacement.allFinite());
    EXPECT_FALSE(std::isfinite(solution.residual));
}

}  // namespace
