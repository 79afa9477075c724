// Reference: the product of the matrix with the solution.
#include "pbs/flesh/flesh_system.hpp"

#include "pbs/flesh/flesh_energy.hpp"
#include "pbs/packed/rows.hpp"
#include "tests/support/held_bar.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numeric>

namespace {

using pbs::Positions;

const test_support::TwoBoneLimb bar = test_support::two_bone_limb({10, 3, 3}, pbs::Vec3::UnitZ(), 0.0);

Eigen::SparseMatrix<double> laplacian()
{
    const pbs::FleshMaterial material = pbs::flesh_material(0.45);
    const pbs::BoneHold hold(bar.mesh, test_support::random_springs(60, 0.3), 2);
    return pbs::flesh_laplacian(bar.mesh, material, pbs::FleshEnergy(bar.mesh, material, hold), 0.5);
}

std::vector<int> reversed_places()
{
    std::vector<int> place(bar.mesh.rest.rows());
    std::iota(place.rbegin(), place.rend(), 0);
    return place;
}

// The residual of a Cholesky solve is at most some 4 n eps |A| |x|, |A| its largest row sum (N. Higham, Accuracy and stability,
// theorem 10.4).
template <typename Scalar, typename Solve>
void expect_solved(Solve solve)
{
    const Eigen::SparseMatrix<double> lower = laplacian(), H = lower.selfadjointView<Eigen::Lower>();
    const std::vector<int> place = reversed_places();
    const Positions b = test_support::jittered(bar.mesh.rest, 0.1);
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
    expect_solved<Scalar>(
        [](const auto& factor, const auto& place, auto& rows) { pbs::TriangularSolve<Scalar>(factor, place).apply(rows.data()); });
}

TEST(TriangularSolve, SolvesTheSystemPlainlyAndBySupernodes)
{
    std::vector<double> work;
    expect_solved<double>([&](const auto& factor, const auto& place, auto& rows) { pbs::solve_plainly(factor, place, rows.data(), work); });
    expect_solved_by_supernodes<double>();
    expect_solved_by_supernodes<float>();
}

TEST(Cholesky, AnIndefiniteMatrixHasNoFactor)
{
    Eigen::SparseMatrix<double> lower = laplacian();
    lower.coeffRef(4, 4) = -1.0;
    EXPECT_FALSE(pbs::cholesky_factor(lower).usable());
}

TEST(Cholesky, OneNumber)
{
    Eigen::SparseMatrix<double> lower(1, 1);
    lower.insert(0, 0) = 4.0;
    lower.makeCompressed();
    pbs::Rows<double> rows(1);
    rows[0][1] = 12.0;
    pbs::TriangularSolve<double>(pbs::cholesky_factor(lower), {0}).apply(rows.data());
    EXPECT_EQ(rows[0][1], 3.0);
}

}  // namespace
