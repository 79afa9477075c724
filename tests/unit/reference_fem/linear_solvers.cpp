// Reference: a dense solve of the same small system by Eigen. Tolerances: two solves, each in error by rounding, sqrt(n) eps cond(K).

#include "reference_fem/assembly.hpp"
#include "reference_fem/linear_solvers.hpp"
#include "reference_fem/verification/problems.hpp"
#include "tests/support/structured_bar.hpp"

#include <Eigen/LU>
#include <dlfcn.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <limits>

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

Spectrum spectrum_of(const SparseMatrix& matrix)
{
    return spectrum(matrix, std::vector<bool>(matrix.rows(), false));
}

TEST(PreparedSolver, DirectSolversAgreeWithADenseSolveForManyRightHandSides)
{
    const SparseMatrix matrix = spring_chain(30, 2.0);
    for (const auto solver : {LinearSolver::cholmod, LinearSolver::umfpack}) {
        const auto factor = prepare(matrix, solver);
        ASSERT_TRUE(factor->usable());
        EXPECT_GT(factor->reciprocal_condition(), 0.0);
        for (int i = 0; i < 30; i += 5) {
            const Eigen::VectorXd right_hand_side = Eigen::VectorXd::Unit(30, i);
            const Eigen::VectorXd dense = Eigen::MatrixXd(matrix).lu().solve(right_hand_side);
            EXPECT_LT((factor->solve(right_hand_side) - dense).norm() / dense.norm(), 2.0 * rounding_bound(spectrum_of(matrix)))
                << factor->name();
        }
    }
}

// |e| <= |A^-1| |r|, and |x| >= |b| / |A|: the condition number times the required residual, 1e-10.
TEST(PreparedSolver, ConjugateGradientsAgreeWithADenseSolveToTheirTolerance)
{
    const SparseMatrix matrix = spring_chain(30, 2.0);
    const auto solver = prepare(matrix, LinearSolver::cg_ml);
    ASSERT_TRUE(solver->usable());
    const double condition = spectrum_of(matrix).condition();
    for (int i = 0; i < 30; i += 5) {
        const Eigen::VectorXd right_hand_side = Eigen::VectorXd::Unit(30, i);
        const Eigen::VectorXd dense = Eigen::MatrixXd(matrix).lu().solve(right_hand_side);
        EXPECT_LT((solver->solve(right_hand_side) - dense).norm() / dense.norm(), 1e-10 * condition);
        EXPECT_GT(solver->iterations(), 0);
    }
}

// Direct solvers: rounding, twice. Conjugate gradients: the condition times their tolerance of 1e-10, twice.
TEST(PreparedSolver, AnotherMatrixOfTheSamePatternIsSolvedAfterRefactor)
{
    for (const auto kind : {LinearSolver::cholmod, LinearSolver::umfpack, LinearSolver::cg_ml}) {
        SparseMatrix matrix = spring_chain(30, 2.0);
        const auto solver = prepare(matrix, kind);
        const Eigen::VectorXd once = solver->solve(Eigen::VectorXd::Ones(30));
        matrix.coeffs() *= 4.0;
        solver->refactor();
        const Spectrum of_matrix = spectrum_of(matrix);
        const double bound = kind == LinearSolver::cg_ml ? 1e-10 * of_matrix.condition() : rounding_bound(of_matrix);
        EXPECT_LT((4.0 * solver->solve(Eigen::VectorXd::Ones(30)) - once).norm() / once.norm(), 2.0 * bound) << solver->name();
    }
}

TEST(PreparedSolver, ConjugateGradientsThatDoNotConvergeReportIt)
{
    const SparseMatrix floating = spring_chain(4, 0.0);  // and a load that no displacement balances
    EXPECT_FALSE(prepare(floating, LinearSolver::cg_ml)->solve(Eigen::VectorXd::Ones(4)).allFinite());
}

// Open MPI's own variables would make an mpirun in a child process fail.
TEST(PreparedSolver, StartingMpiLeavesTheEnvironmentAsItWas)
{
    const auto count = [] {
        int variables = 0;
        for (char** variable = environ; *variable; ++variable) ++variables;
        return variables;
    };
    const int before = count();  // if this test runs alone, as in ctest, MPI starts below
    prepare(spring_chain(4, 1.0), LinearSolver::cg_ml);
    EXPECT_EQ(count(), before);
    EXPECT_EQ(std::getenv("PMIX_RANK"), nullptr);
}

TEST(PreparedSolver, NothingToSolveForIsNoError)
{
    const SparseMatrix nothing(0, 0);
    EXPECT_TRUE(prepare(nothing, LinearSolver::cg_ml)->usable());
}

TEST(PreparedSolver, ASingularMatrixIsReportedNotThrown)
{
    const SparseMatrix floating = spring_chain(4, 0.0);
    EXPECT_FALSE(prepare(floating, LinearSolver::cholmod)->usable());
    EXPECT_FALSE(prepare(floating, LinearSolver::umfpack)->usable());
}

TEST(PreparedSolver, CholmodRefusesAnIndefiniteMatrixThatUmfpackSolves)
{
    const SparseMatrix indefinite = spring_chain(4, -3.0);
    EXPECT_FALSE(prepare(indefinite, LinearSolver::cholmod)->usable());
    EXPECT_TRUE(prepare(indefinite, LinearSolver::umfpack)->usable());
}

// Stiffness of a bar on springs of a thousandth of its own stiffness. Its cross-section has 363 unknowns: OpenBLAS shares dense blocks of
// that size among its threads.
SparseMatrix bar_on_springs()
{
    const SimplexSpace space(test_support::structured_bar({0, 0, 0}, {0.5, 0.3, 0.3}, {6, 5, 5}), 2);
    SparseMatrix stiffness = stiffness_matrix(space, lame_parameters(1e5, 0.3));
    const double springs = 1e-3 * stiffness.diagonal().mean();
    for (Eigen::Index i = 0; i < stiffness.rows(); ++i) stiffness.coeffRef(i, i) += springs;
    return stiffness;
}

// Reference: one thread. The contract says 1e-10 of the displacements; rounding, by the condition of some 1e4, explains no more than that.
TEST(PreparedSolver, ThreadsOfTheBlasChangeTheSolutionByLessThanTheContractSays)
{
    auto* set_threads = reinterpret_cast<void (*)(int)>(dlsym(RTLD_DEFAULT, "openblas_set_num_threads"));
    auto* threads = reinterpret_cast<int (*)()>(dlsym(RTLD_DEFAULT, "openblas_get_num_threads"));
    if (!set_threads || !threads) GTEST_SKIP() << "not on " << resolved_blas();
    const SparseMatrix matrix = bar_on_springs();
    const Eigen::VectorXd load = Eigen::VectorXd::LinSpaced(matrix.rows(), -1.0, 1.0);
    const double rounding = rounding_bound(spectrum_of(matrix));
    for (auto* prepare_direct : {prepare_cholmod, prepare_umfpack}) {
        set_threads(1);
        const Eigen::VectorXd alone = prepare_direct(matrix)->solve(load), again = prepare_direct(matrix)->solve(load);
        EXPECT_EQ(alone, again);
        set_threads(2);
        ASSERT_EQ(threads(), 2);
        EXPECT_LT((prepare_direct(matrix)->solve(load) - alone).norm() / alone.norm(), std::min(1e-10, 2.0 * rounding));
    }
}

// Holds for any number of threads that a user sets for OpenBLAS in the environment.
TEST(PreparedSolver, PreparedOnOneThreadItRepeatsToTheBit)
{
    const SparseMatrix matrix = bar_on_springs();
    const Eigen::VectorXd load = Eigen::VectorXd::LinSpaced(matrix.rows(), -1.0, 1.0);
    auto* set_threads = reinterpret_cast<void (*)(int)>(dlsym(RTLD_DEFAULT, "openblas_set_num_threads"));
    const Eigen::VectorXd alone = prepare(matrix, LinearSolver::cholmod)->solve(load);
    if (set_threads) set_threads(2);
    EXPECT_EQ(prepare(matrix, LinearSolver::cholmod)->solve(load), alone);
}

TEST(PreparedSolver, TheBlasInUseIsNamedWithItsFile)
{
    EXPECT_NE(resolved_blas().find("blas"), std::string::npos) << resolved_blas();
    EXPECT_NE(resolved_blas().find(".so"), std::string::npos) << resolved_blas();
    EXPECT_EQ(resolved_blas().find('/'), std::string::npos) << resolved_blas();
}

// Reference: the rows of the eliminated system. Tolerance: the residual of a backward stable solve, |r| <= sqrt(n) eps |K| |u|, see
// reference_fem/verification/problems.hpp, with n = 4 free unknowns and |K| <= 2.5 + 2 by Gershgorin.

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
