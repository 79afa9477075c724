// References: the matrix itself, assembled from the second derivative of the energy, and the theory of Newton's method
// near rest.
#include "pbs/flesh/warped_newton.hpp"

#include "pbs/flesh/flesh_system.hpp"
#include "pbs/geometry/input_error.hpp"
#include "tests/support/held_bar.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

namespace warped_newton_tests {
namespace {

using pbs::Positions;
using test_support::HeldBar;

const HeldBar bar({12, 3, 3});
const pbs::TetMesh& mesh = bar.bent.mesh;
const pbs::HeldFlesh& flesh()
{
    static const pbs::HeldFlesh held(mesh, bar.springs, 2, {});
    return held;
}

std::vector<Eigen::Matrix3d> random_rotations(int count)
{
    test_support::RandomPoints random(11);
    std::vector<Eigen::Matrix3d> rotations;
    for (int i = 0; i < count; ++i) rotations.push_back(random.rigid_motion(1.0).linear());
    return rotations;
}

// Vertex i has row place[i].
template <typename Scalar>
Positions applied(pbs::WarpedSolve<Scalar>& solve, const std::vector<int>& place, const Positions& b)
{
    pbs::Rows<Scalar> rows(static_cast<int>(place.size()));
    pbs::load_rows(b, place, pbs::Vec3::Zero(), rows);
    solve.apply(rows);
    Positions x;
    pbs::store_rows(rows, place, pbs::Vec3::Zero(), x);
    return x;
}

// (R K R^T)^-1 b with the vertices in reversed rows.
template <typename Scalar>
Positions solved(const HeldBar& held, const pbs::CholeskyFactor& factor, bool packed, const Positions& b)
{
    std::vector<int> place(held.vertices());
    std::iota(place.rbegin(), place.rend(), 0);
    pbs::WarpedSolve<Scalar> solve(held.bent.mesh, held.energy, factor.order, place, packed);
    solve.set_rotations(random_rotations(held.vertices()));
    return applied(solve, place, b);
}

// R K R^T x. A vertex without tets has the row of a unit matrix.
Positions multiplied(const HeldBar& held, const Positions& x)
{
    const Eigen::SparseMatrix<double> lower = pbs::flesh_hessian(held.energy, held.bent.mesh.rest),
                                      K = lower.selfadjointView<Eigen::Lower>();
    const std::vector<Eigen::Matrix3d> rotations = random_rotations(held.vertices());
    Eigen::VectorXd turned(3 * x.rows());
    for (int i = 0; i < x.rows(); ++i) turned.segment<3>(3 * i) = rotations[i].transpose() * x.row(i).transpose();
    Eigen::VectorXd product = K * turned;
    for (int row = 0; row < product.size(); ++row)
        if (K.coeff(row, row) == 0.0) product(row) = turned(row);
    Positions result(x.rows(), 3);
    for (int i = 0; i < x.rows(); ++i) result.row(i) = (rotations[i] * product.segment<3>(3 * i)).transpose();
    return result;
}

// The residual of a Cholesky solve is at most some 4 n eps |A| |x|, |A| its largest row sum (N. Higham, Accuracy and
// Stability of Numerical Algorithms, theorem 10.4), and the regular part is 1e-9 of the diagonal. Panels have the
// inverses of their triangles, which multiplies the first bound by the condition of a triangle (J. Du Croz, N. Higham,
// IMA Journal of Numerical Analysis 12, 1992); the second one, which is 10,000 times larger, covers that.
TEST(WarpedSolve, SolvesTheSystemPlainlyAndByPanels)
{
    const Positions b = test_support::jittered(Positions::Zero(mesh.rest.rows(), 3), 0.1);
    const Eigen::SparseMatrix<double> lower = pbs::flesh_hessian(bar.energy, mesh.rest),
                                      K = lower.selfadjointView<Eigen::Lower>();
    const double norm = (K.cwiseAbs() * Eigen::VectorXd::Ones(K.cols())).maxCoeff();
    for (const bool packed : {false, true}) {
        const Positions x = solved<double>(bar, flesh().factor(), packed, b);
        EXPECT_LE((multiplied(bar, x) - b).norm(),
                  (2e-9 + 12.0 * double(b.rows()) * std::numeric_limits<double>::epsilon()) * norm * x.norm());
        EXPECT_GT(x.norm(), 1e-3 * b.norm());
    }
}

// A frame that is not finite, and then the same one as before.
TEST(WarpedSolve, NumbersThatAreNotFiniteLeaveNothingBehind)
{
    std::vector<int> place(bar.vertices());
    std::iota(place.begin(), place.end(), 0);
    pbs::WarpedSolve<float> solve(mesh, bar.energy, flesh().factor().order, place, true);
    solve.set_rotations(random_rotations(bar.vertices()));
    const Positions b = test_support::jittered(Positions::Zero(bar.vertices(), 3), 0.1),
                    before = applied(solve, place, b);
    EXPECT_FALSE(applied(solve, place, Positions::Constant(bar.vertices(), 3, std::numeric_limits<double>::quiet_NaN()))
                     .allFinite());
    EXPECT_EQ(applied(solve, place, b), before);
}

// Float has rounded values, but both substitutions read the same ones, so that the matrix is symmetric and positive
// definite as L-BFGS requires.
TEST(WarpedSolve, IsSymmetricAndPositiveDefiniteInFloat)
{
    for (unsigned seed = 1; seed < 20; seed += 2) {
        const Positions a = test_support::jittered(Positions::Zero(mesh.rest.rows(), 3), 1.0, seed),
                        b = test_support::jittered(Positions::Zero(mesh.rest.rows(), 3), 1.0, seed + 1);
        const Positions of_a = solved<float>(bar, flesh().factor(), true, a),
                        of_b = solved<float>(bar, flesh().factor(), true, b);
        EXPECT_NEAR(a.cwiseProduct(of_b).sum(), b.cwiseProduct(of_a).sum(),
                    3.0 * double(a.size()) * std::numeric_limits<float>::epsilon() * a.norm() * of_b.norm());
        EXPECT_GT(a.cwiseProduct(of_a).sum(), 0.0);
    }
}

TEST(WarpedSolve, AVertexWithoutTetsHasARowOfItsOwn)
{
    const HeldBar one = HeldBar::one_tet({3, 2, 2});
    const pbs::HeldFlesh held(one.bent.mesh, one.springs, 2, {});
    const Positions expected = test_support::jittered(Positions::Zero(one.vertices(), 3), 1.0),
                    b = multiplied(one, expected);
    const auto tet = one.bent.mesh.tets.row(0);
    for (const bool packed : {false, true}) {
        const Positions x = solved<double>(one, held.factor(), packed, b);
        EXPECT_LT((multiplied(one, x) - b).cwiseAbs().maxCoeff(), 1e-6) << "the one spring lets the tet rotate";
        for (int i = 0; i < one.vertices(); ++i)
            if ((tet.array() != i).all()) {
                EXPECT_LT((x.row(i) - expected.row(i)).norm(), test_support::rounding_error(20, 2.0)) << i;
            }
    }
}

// The bar whose second bone turns by this angle, and its minimum.
struct Bent {
    explicit Bent(double degrees) : limb(test_support::two_bone_limb({12, 3, 3}, pbs::Vec3::UnitZ(), degrees))
    {
        bar.hold.centres(limb.pose, centres);
        minimum = moved({.iterations = 200}).first;
    }
    // Without rotations the flesh keeps the axes of rest.
    std::pair<Positions, pbs::WarpedNewtonSummary> moved(const pbs::WarpedNewtonOptions& options) const
    {
        const std::vector<Eigen::Matrix3d> none(mesh.rest.rows(), Eigen::Matrix3d::Identity());
        Positions x = mesh.rest;
        const auto summary =
            pbs::WarpedNewton<double>(mesh, bar.energy, flesh().factor(), options).minimise(centres, none, x);
        return {x, summary};
    }
    double distance(const pbs::WarpedNewtonOptions& options) const { return (moved(options).first - minimum).norm(); }

    test_support::TwoBoneLimb limb;
    Positions centres, minimum;
};

// At rest K is the second derivative of the energy, so that the first step without sweeps is Newton's: it leaves an
// error of second order in the angle. A Laplacian leaves one of first order. Between 0.1 and 0.2 degrees the third
// order is below a hundredth.
TEST(WarpedNewton, TheFirstStepFromRestIsOfSecondOrder)
{
    const pbs::WarpedNewtonOptions one_step{.iterations = 1, .sweeps = 0};
    EXPECT_NEAR(std::log2(Bent(0.2).distance(one_step) / Bent(0.1).distance(one_step)), 2.0, 0.05);
}

// The pairs correct the stiffness at rest where the flesh has turned away from the axes that the matrix knows.
TEST(WarpedNewton, HistorySavesSteps)
{
    const Bent bent(10.0);
    const auto distance = [&](int history) { return bent.distance({.iterations = 8, .history = history}); };
    EXPECT_LT(distance(5), 0.5 * distance(0));
}

TEST(WarpedNewton, ReportsEnergiesThatDoNotIncreaseAndCountsItsWork)
{
    const Bent bent(70.0);
    for (const int sweeps : {0, 2}) {
        const auto [x, summary] = bent.moved({.iterations = 12, .sweeps = sweeps, .packed = false});
        EXPECT_EQ(summary.iterations, 12);
        EXPECT_EQ(summary.evaluations, 13);
        EXPECT_EQ(summary.sweeps, 13 * sweeps);
        EXPECT_EQ(summary.energies.size() + summary.taken_back, 13u);
        for (std::size_t k = 1; k < summary.energies.size(); ++k)
            EXPECT_LE(summary.energies[k],
                      (1.0 + 16.0 * std::numeric_limits<double>::epsilon()) * summary.energies[k - 1])
                << k;
        EXPECT_NEAR(bar.energy.value(x, bent.centres), summary.energies.back(), 1e-12 * summary.energies.back());
    }
}

TEST(WarpedNewton, RefusesFactorsThatCannotConverge)
{
    for (const double omega : {-1.0, 0.0, 2.0, std::numeric_limits<double>::quiet_NaN()})
        EXPECT_THROW(pbs::WarpedNewton<double>(mesh, bar.energy, flesh().factor(), {.omega = omega}), pbs::InputError);
}

// Its energy and its sweeps, the parts with threads, are tested on so many vertices that they use several in
// packed_systems.cpp.
TEST(WarpedNewton, NeitherThreadsNorRepetitionChangeABit)
{
    const Bent bent(70.0);
    const Positions once = bent.moved({}).first;
    for (const int threads : {1, 2, 4}) EXPECT_EQ(bent.moved({.threads = threads}).first, once);
}

}  // namespace
}  // namespace warped_newton_tests
