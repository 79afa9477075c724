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

template <typename Scalar>
pbs::Rows<Scalar> rows_of(const Positions& positions, const std::vector<int>& place)
{
    pbs::Rows<Scalar> rows(static_cast<int>(place.size()));
    for (std::size_t i = 0; i < place.size(); ++i)
        for (int axis = 0; axis < 3; ++axis) rows[place[i]][axis] = Scalar(positions(static_cast<Eigen::Index>(i), axis));
    return rows;
}

template <typename Scalar>
Positions positions_of(const pbs::Rows<Scalar>& rows, const std::vector<int>& place)
{
    Positions positions(static_cast<Eigen::Index>(place.size()), 3);
    for (std::size_t i = 0; i < place.size(); ++i)
        for (int axis = 0; axis < 3; ++axis) positions(static_cast<Eigen::Index>(i), axis) = double(rows[place[i]][axis]);
    return positions;
}

// The residual of a Cholesky solve is at most some 4 n eps |A| |x|, |A| its largest row sum (N. Higham, Accuracy and stability,
// theorem 10.4).
template <typename Scalar, typename Solve>
void expect_solved(Solve solve)
{
    const Eigen::SparseMatrix<double> lower = laplacian(), H = lower.selfadjointView<Eigen::Lower>();
    const std::vector<int> place = reversed_places();
    const Positions b = test_support::jittered(bar.mesh.rest, 0.1);
    pbs::Rows<Scalar> rows = rows_of<Scalar>(b, place);
    solve(pbs::cholesky_factor(lower), place, rows);
    const Positions x = positions_of(rows, place);
    const double norm = (H.cwiseAbs() * Eigen::VectorXd::Ones(H.cols())).maxCoeff();
    EXPECT_LE((H * x - b).norm(), 4.0 * double(b.rows()) * std::numeric_limits<Scalar>::epsilon() * norm * x.norm());
    EXPECT_GT(x.norm(), 1e-3 * b.norm());
}

TEST(TriangularSolve, PlainSolvesTheSystem)
{
    std::vector<double> work;
    expect_solved<double>([&](const auto& factor, const auto& place, auto& rows) { pbs::solve_plainly(factor, place, rows.data(), work); });
}

TEST(TriangularSolve, SupernodesSolveTheSystemInDouble)
{
    expect_solved<double>(
        [](const auto& factor, const auto& place, auto& rows) { pbs::TriangularSolve<double>(factor, place).apply(rows.data()); });
}

TEST(TriangularSolve, SupernodesSolveTheSystemInFloat)
{
    expect_solved<float>(
        [](const auto& factor, const auto& place, auto& rows) { pbs::TriangularSolve<float>(factor, place).apply(rows.data()); });
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
