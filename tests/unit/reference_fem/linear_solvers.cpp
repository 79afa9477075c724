// Reference: a dense solve of the same small system by Eigen. Tolerances: two solves, each in error by rounding,
// sqrt(n) eps cond(K).

#include "reference_fem/assembly.hpp"
#include "reference_fem/linear_flesh.hpp"
#include "reference_fem/linear_solvers.hpp"
#include "reference_fem/verification/problems.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/structured_bar.hpp"

#include <Eigen/LU>
#include <dlfcn.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <limits>

namespace {

using namespace reference_fem;

SparseMatrix compressed(const Eigen::MatrixXd& matrix)
{
    SparseMatrix sparse = matrix.sparseView();
    sparse.makeCompressed();
    return sparse;
}

SparseMatrix spring_chain(int n, double ground)
{
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
    for (int i = 0; i + 1 < n; ++i) matrix.block<2, 2>(i, i) += Eigen::Matrix2d{{1, -1}, {-1, 1}};
    matrix(0, 0) += ground;
    return compressed(matrix);
}

Spectrum spectrum_of(const SparseMatrix& matrix)
{
    return spectrum(matrix, std::vector<bool>(matrix.rows(), false));
}

constexpr auto every_solver = {LinearSolver::cholmod, LinearSolver::umfpack};

TEST(PreparedSolver, AgreesWithADenseSolveForManyRightHandSides)
{
    const SparseMatrix matrix = spring_chain(30, 2.0);
    for (const auto kind : every_solver) {
        const auto solver = prepare(matrix, kind);
        SCOPED_TRACE(solver->name());
        ASSERT_TRUE(solver->usable());
        EXPECT_GT(solver->reciprocal_condition(), 0.0);
        for (int i = 0; i < 30; i += 5) {
            const Eigen::VectorXd right_hand_side = Eigen::VectorXd::Unit(30, i);
            const Eigen::VectorXd dense = Eigen::MatrixXd(matrix).lu().solve(right_hand_side);
            EXPECT_LT((solver->solve(right_hand_side) - dense).norm() / dense.norm(),
                      2.0 * rounding_bound(spectrum_of(matrix)));
        }
    }
}

TEST(PreparedSolver, AnotherMatrixOfTheSamePatternIsSolvedAfterRefactor)
{
    for (const auto kind : every_solver) {
        SparseMatrix matrix = spring_chain(30, 2.0);
        const auto solver = prepare(matrix, kind);
        const Eigen::VectorXd once = solver->solve(Eigen::VectorXd::Ones(30));
        matrix.coeffs() *= 4.0;
        solver->refactor();
        EXPECT_LT((4.0 * solver->solve(Eigen::VectorXd::Ones(30)) - once).norm() / once.norm(),
                  2.0 * rounding_bound(spectrum_of(matrix)))
            << solver->name();
    }
}

TEST(PreparedSolver, ReportsWhatItCannotSolve)
{
    const SparseMatrix floating = spring_chain(4, 0.0), indefinite = spring_chain(4, -3.0);
    EXPECT_FALSE(prepare(floating, LinearSolver::cholmod)->usable());
    EXPECT_FALSE(prepare(floating, LinearSolver::umfpack)->usable());
    EXPECT_FALSE(prepare(indefinite, LinearSolver::cholmod)->usable());
    EXPECT_TRUE(prepare(indefinite, LinearSolver::umfpack)->usable());
    EXPECT_TRUE(prepare(SparseMatrix(0, 0), LinearSolver::cholmod)->usable()) << "nothing to solve for";
    test_support::expect_refused("block_size", [&] { prepare_cholmod(floating, 3); });
}

// Stiffness of a bar on springs of a thousandth of its own stiffness. Its cross-section has 363 unknowns: OpenBLAS
// shares dense blocks of that size among its threads.
SparseMatrix bar_on_springs()
{
    const SimplexSpace space(test_support::structured_bar({0, 0, 0}, {0.5, 0.3, 0.3}, {6, 5, 5}), 2);
    SparseMatrix stiffness = stiffness_matrix(space, lame_parameters(1e5, 0.3));
    const double springs = 1e-3 * stiffness.diagonal().mean();
    for (Eigen::Index i = 0; i < stiffness.rows(); ++i) stiffness.coeffRef(i, i) += springs;
    return stiffness;
}

// METIS has its own handler of SIGTERM while it orders a matrix. What it puts back afterwards would handle only one
// signal.
TEST(PreparedSolver, LeavesTheHandlerOfSigtermAsItWas)
{
    struct sigaction own = {}, before = {}, after = {};
    own.sa_handler = [](int) {};
    own.sa_flags = SA_RESTART;
    sigaction(SIGTERM, nullptr, &before);
    const SparseMatrix matrix = bar_on_springs();
    for (const bool is_cholmod : {true, false}) {
        sigaction(SIGTERM, &own, nullptr);
        const auto solver = is_cholmod ? prepare_cholmod(matrix, 3) : prepare_umfpack(matrix);
        sigaction(SIGTERM, &before, &after);
        EXPECT_EQ(after.sa_handler, own.sa_handler) << solver->name();
        EXPECT_EQ(after.sa_flags & (SA_RESTART | SA_RESETHAND), SA_RESTART) << solver->name();
    }
}

// Reference: one thread. The contract says 1e-10 of the displacements; rounding, by the condition of some 1e4, explains
// no more than that. Prepared on one thread, a solver repeats to the bit for any number of threads that a user sets for
// OpenBLAS in the environment.
TEST(PreparedSolver, ThreadsOfTheBlasChangeTheSolutionByLessThanTheContractSays)
{
    for (const char* part : {"blas", ".so"})
        EXPECT_NE(resolved_blas().find(part), std::string::npos) << resolved_blas();
    EXPECT_EQ(resolved_blas().find('/'), std::string::npos) << resolved_blas();
    auto* set_threads = reinterpret_cast<void (*)(int)>(dlsym(RTLD_DEFAULT, "openblas_set_num_threads"));
    auto* threads = reinterpret_cast<int (*)()>(dlsym(RTLD_DEFAULT, "openblas_get_num_threads"));
    const SparseMatrix matrix = bar_on_springs();
    const Eigen::VectorXd load = Eigen::VectorXd::LinSpaced(matrix.rows(), -1.0, 1.0);
    const Eigen::VectorXd of_environment = prepare(matrix, LinearSolver::cholmod)->solve(load);
    if (set_threads) set_threads(2);
    EXPECT_EQ(prepare(matrix, LinearSolver::cholmod)->solve(load), of_environment);
    if (!set_threads || !threads) GTEST_SKIP() << "not on " << resolved_blas();
    const double rounding = rounding_bound(spectrum_of(matrix));
    for (const bool is_cholmod : {true, false}) {
        const auto solved = [&] {
            return (is_cholmod ? prepare_cholmod(matrix, 3) : prepare_umfpack(matrix))->solve(load);
        };
        set_threads(1);
        const Eigen::VectorXd alone = solved(), again = solved();
        EXPECT_EQ(alone, again);
        set_threads(2);
        ASSERT_EQ(threads(), 2);
        EXPECT_LT((solved() - alone).norm() / alone.norm(), std::min(1e-10, 2.0 * rounding));
    }
    set_threads(1);
}

// A deformer of the user may have parallel regions of its own on the same thread.
TEST(PreparedSolver, LeavesOpenMpAsItWas)
{
    const auto levels = reinterpret_cast<int (*)()>(dlsym(RTLD_DEFAULT, "omp_get_max_active_levels"));
    if (!levels) GTEST_SKIP() << "without OpenMP";
    const int before = levels();
    prepare(spring_chain(4, 1.0), LinearSolver::cholmod);
    EXPECT_EQ(levels(), before);
    EXPECT_GT(before, 0);
}

TEST(PreparedSolver, HasTheSameSolutionWhetherNodesOrRowsAreOrdered)
{
    const SparseMatrix matrix = bar_on_springs();
    const Eigen::VectorXd load = Eigen::VectorXd::LinSpaced(matrix.rows(), -1.0, 1.0);
    const auto by_nodes = prepare_cholmod(matrix, 3), by_rows = prepare_cholmod(matrix, 1);
    ASSERT_TRUE(by_nodes->usable() && by_rows->usable());
    const Eigen::VectorXd expected = by_rows->solve(load);
    EXPECT_LT((by_nodes->solve(load) - expected).norm() / expected.norm(), 2.0 * rounding_bound(spectrum_of(matrix)));
}

// Reference: the rows of the eliminated system. Tolerance: the residual of a backward stable solve, |r| <= sqrt(n) eps
// |K| |u|, see reference_fem/verification/problems.hpp, with n = 4 free unknowns and |K| <= 2.5 + 2 by Gershgorin.

SparseMatrix tridiagonal(double diagonal)
{
    Eigen::MatrixXd matrix = diagonal * Eigen::MatrixXd::Identity(6, 6);
    for (int i = 0; i < 5; ++i) matrix(i, i + 1) = matrix(i + 1, i) = -1.0;
    return compressed(matrix);
}

const std::vector<bool> first_and_fifth = {true, false, false, false, true, false};

TEST(EliminatedSystem, PrescribedValuesStayAndFreeRowsHold)
{
    const SparseMatrix stiffness = tridiagonal(2.5);
    const EliminatedSystem system(stiffness, first_and_fifth, LinearSolver::cholmod);
    const Eigen::VectorXd load = Eigen::VectorXd::LinSpaced(6, 1.0, 2.0);
    // read only at prescribed degrees of freedom
    Eigen::VectorXd prescribed = Eigen::VectorXd::Constant(6, std::nan(""));
    for (const double first : {0.5, -3.0}) {
        prescribed(0) = first;
        prescribed(4) = 7.0;
        const EliminatedSolution solution = system.solve(load, prescribed);
        EXPECT_EQ(solution.displacement(0), first);
        EXPECT_EQ(solution.displacement(4), 7.0);
        const Eigen::VectorXd defect = stiffness * solution.displacement - load;
        const double rounding = 2.0 * std::numeric_limits<double>::epsilon() * 4.5 * solution.displacement.norm();
        for (const int row : {1, 2, 3, 5}) EXPECT_NEAR(defect(row), 0.0, rounding);
        // of the free rows
        const double load_norm = Eigen::Vector4d(load(1) + first, load(2), load(3) + 7.0, load(5) + 7.0).norm();
        EXPECT_LT(solution.residual, rounding / load_norm);
    }
}

TEST(EliminatedSystem, NothingToDoEverythingPrescribedAndABrokenFactorisation)
{
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(6), values = Eigen::VectorXd::LinSpaced(6, 1.0, 2.0);
    const EliminatedSolution nothing =
        EliminatedSystem(tridiagonal(2.5), first_and_fifth, LinearSolver::cholmod).solve(zero, zero);
    EXPECT_EQ(nothing.displacement, zero);
    EXPECT_EQ(nothing.residual, 0.0);
    const EliminatedSystem prescribed(tridiagonal(2.5), std::vector<bool>(6, true), LinearSolver::cholmod);
    EXPECT_EQ(prescribed.solve(zero, values).displacement, values);
    const EliminatedSystem singular(tridiagonal(0.0), std::vector<bool>(6, false), LinearSolver::cholmod);
    const EliminatedSolution broken = singular.solve(Eigen::VectorXd::Ones(6), zero);
    EXPECT_FALSE(broken.displacement.allFinite());
    EXPECT_FALSE(std::isfinite(broken.residual));
}

}  // namespace
