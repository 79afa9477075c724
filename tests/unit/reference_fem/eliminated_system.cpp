// Reference: the rows of the eliminated system. Tolerance: the residual of a backward stable solve, |r| <= sqrt(n) eps |K| |u|, see
// reference_fem/verification/rounding_bound.hpp, with n = 4 free unknowns and |K| <= 2.5 + 2 by Gershgorin.
#include "reference_fem/eliminated_system.hpp"

#include <gtest/gtest.h>

#include <limits>

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
        const double rounding = 2.0 * std::numeric_limits<double>::epsilon() * 4.5 * solution.displacement.norm();
        for (const int row : {1, 2, 3, 5}) EXPECT_NEAR(defect(row), 0.0, rounding);
        const double load_norm = Eigen::Vector4d(load(1) + first, load(2), load(3) + 7.0, load(5) + 7.0).norm();  // of the free rows
        EXPECT_LT(solution.residual, rounding / load_norm);
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
