// Reference: the necessary conditions of a minimum, computed by the plain energy.
#include "pbs/flesh/quasi_newton.hpp"

#include "pbs/flesh/flesh_system.hpp"
#include "pbs/geometry/input_error.hpp"
#include "tests/support/held_bar.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/weight_sums.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

namespace quasi_newton_tests {
namespace {

using pbs::Positions;

const test_support::HeldBar bar({12, 3, 3});
const test_support::TwoBoneLimb& bent = bar.bent;
const Positions& centres = bar.centres;
const pbs::HeldFlesh& flesh()
{
    static const pbs::HeldFlesh held(bent.mesh, bar.springs, 2, {});
    return held;
}

template <typename Scalar>
pbs::QuasiNewtonSummary minimise(const pbs::QuasiNewtonOptions& options, Positions& x)
{
    return pbs::QuasiNewton<Scalar>(bent.mesh, bar.energy, flesh().factor(), options).minimise(centres, x);
}

TEST(QuasiNewton, ReportsItsEnergyAndCountsItsWork)
{
    for (const int iterations : {1, 21}) {
        Positions x = bent.lbs;
        const auto summary = minimise<double>({.iterations = iterations, .packed = false}, x);
        EXPECT_NEAR(bar.energy.value(x, centres), summary.energy, 1e-12 * summary.energy);
        EXPECT_EQ(summary.iterations, iterations);
        EXPECT_EQ(summary.solves, iterations);
        EXPECT_GE(summary.evaluations, iterations + 1);
    }
}

// The first direction has no pairs yet. The search begins with the whole of it and halves it until the energy is low
// enough.
TEST(QuasiNewton, TheFirstStepIsThePreconditionedGradientHalvedAsOftenAsTheEnergyWasEvaluatedAgain)
{
    Positions x = bent.lbs;
    const auto summary = minimise<double>({.iterations = 1, .packed = false}, x);
    const Positions step = pbs::solve_plainly(flesh().factor(), bar.gradient(bent.lbs));
    EXPECT_LT((x - (bent.lbs - std::ldexp(1.0, 2 - summary.evaluations) * step)).cwiseAbs().maxCoeff(),
              test_support::rounding_error(4, 2.0));
    EXPECT_GT(step.norm(), 1e-3);
}

// L-BFGS with pairs converges faster than linearly preconditioned descent: a history that is not used, or used in the
// wrong order, fails.
TEST(QuasiNewton, HistorySavesIterations)
{
    const auto iterations = [](int history) {
        Positions x = bent.lbs;
        return minimise<double>({.iterations = 2000, .history = history, .stop_gradient = 1e-6}, x).iterations;
    };
    EXPECT_LT(2 * iterations(5), iterations(0));
    EXPECT_LT(iterations(3), iterations(1));  // older pairs help only in their order
}

TEST(HeldFlesh, SmoothWeightsAddUpToOneAndFollowTheSprings)
{
    const pbs::Weights weights = flesh().smooth_weights(bent.weights);
    ASSERT_EQ(weights.vertices(), bent.mesh.rest.rows());
    for (const double weight : weights.weight) EXPECT_GE(weight, 0.0);
    for (int i = 0; i < weights.vertices(); ++i) {
        const double of_first = test_support::weight_in(weights, i, 0);
        EXPECT_NEAR(test_support::sum_of_weights(weights, i), 1.0, 1e-14);
        if (bent.mesh.rest(i, 0) < -0.6) {
            EXPECT_GT(of_first, 0.9);
        }
        if (bent.mesh.rest(i, 0) > 0.6) {
            EXPECT_LT(of_first, 0.1);
        }
    }
}

TEST(HeldFlesh, RefusesSpringsThatAreAllOutside)
{
    pbs::BoneSprings springs = test_support::random_springs(5, 1.0);
    springs.points.rowwise() += Eigen::RowVector3d(0.0, 9.0, 0.0);
    EXPECT_THROW(pbs::HeldFlesh(bent.mesh, springs, 2, {}), pbs::InputError);
}

// The solve with the factor. Reference: the product of the matrix with the solution.

Eigen::SparseMatrix<double> laplacian()
{
    return pbs::flesh_laplacian(bent.mesh, bar.material, bar.energy, 0.5);
}

std::vector<int> reversed_places()
{
    std::vector<int> place(bent.mesh.rest.rows());
    std::iota(place.rbegin(), place.rend(), 0);
    return place;
}

// The residual of a Cholesky solve is at most some 4 n eps |A| |x|, |A| its largest row sum (N. Higham, Accuracy and
// stability, theorem 10.4).
template <typename Scalar, typename Solve>
void expect_solved(Solve solve)
{
    const Eigen::SparseMatrix<double> lower = laplacian(), H = lower.selfadjointView<Eigen::Lower>();
    const std::vector<int> place = reversed_places();
    const Positions b = test_support::jittered(bent.mesh.rest, 0.1);
    pbs::Rows<Scalar> rows(static_cast<int>(place.size()));
    Positions x;
    pbs::load_rows(b, place, pbs::Vec3::Zero(), rows);
    solve(pbs::cholesky_factor(lower), place, rows);
    pbs::store_rows(rows, place, pbs::Vec3::Zero(), x);
    const double norm = (H.cwiseAbs() * Eigen::VectorXd::Ones(H.cols())).maxCoeff();
    EXPECT_LE((H * x - b).norm(), 4.0 * double(b.rows()) * std::numeric_limits<Scalar>::epsilon() * norm * x.norm());
    EXPECT_GT(x.norm(), 1e-3 * b.norm());
}

template <typename Scalar>
void expect_solved_by_supernodes()
{
    expect_solved<Scalar>([](const auto& factor, const auto& place, auto& rows) {
        pbs::TriangularSolve<Scalar>(factor, place).apply(rows.data());
    });
}

TEST(TriangularSolve, SolvesTheSystemPlainlyAndBySupernodes)
{
    expect_solved<double>([](const auto& factor, const auto& place, auto& rows) {
        Positions b;
        pbs::store_rows(rows, place, pbs::Vec3::Zero(), b);
        pbs::load_rows(pbs::solve_plainly(factor, b), place, pbs::Vec3::Zero(), rows);
    });
    expect_solved_by_supernodes<double>();
    expect_solved_by_supernodes<float>();
}

TEST(Cholesky, OfOneNumberAndAnIndefiniteMatrixHasNone)
{
    Eigen::SparseMatrix<double> indefinite = laplacian();
    indefinite.coeffRef(4, 4) = -1.0;
    EXPECT_FALSE(pbs::cholesky_factor(indefinite).usable());
    Eigen::SparseMatrix<double> lower(1, 1);
    lower.insert(0, 0) = 4.0;
    lower.makeCompressed();
    pbs::Rows<double> rows(1);
    rows[0][1] = 12.0;
    pbs::TriangularSolve<double>(pbs::cholesky_factor(lower), {0}).apply(rows.data());
    EXPECT_EQ(rows[0][1], 3.0);
}

}  // namespace
}  // namespace quasi_newton_tests
