// Reference: the plain implementation of the same energy.
#include "pbs/flesh/packed_flesh.hpp"

#include "pbs/flesh/flesh_system.hpp"
#include "tests/support/evaluated_flesh.hpp"
#include "tests/support/flesh_rounding.hpp"
#include "tests/support/four_threads.hpp"
#include "tests/support/held_bar.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace {

using pbs::Positions;
using test_support::Evaluated;
using test_support::evaluated;

struct Flesh {
    explicit Flesh(const std::array<int, 3>& cells, const pbs::Vec3& joint = pbs::Vec3::Zero())
        : bent(test_support::two_bone_limb(cells, pbs::Vec3::UnitZ(), 70.0, joint)),
          hold(bent.mesh, test_support::springs_at(joint), 2),
          energy(bent.mesh, pbs::flesh_material(0.45), hold),
          laplacian(pbs::flesh_laplacian(bent.mesh, pbs::flesh_material(0.45), energy, 0.6)),
          factor(pbs::cholesky_factor(laplacian))
    {
        hold.centres(bent.pose, centres);
    }
    test_support::TwoBoneLimb bent;
    pbs::BoneHold hold;
    pbs::FleshEnergy energy;
    Eigen::SparseMatrix<double> laplacian;  // its lower triangle
    pbs::CholeskyFactor factor;
    Positions centres;
};

int longest_row(const pbs::CholeskyFactor& factor)
{
    std::vector<int> entries(factor.order.size(), 0);
    for (const int row : factor.row) ++entries[row];
    return *std::max_element(entries.begin(), entries.end());
}

// The two substitutions solve a system that differs from A = L L^T by at most 2 n u |L| |L^T|, n the longest row of L and u = epsilon / 2
// (N. Higham, Accuracy and Stability of Numerical Algorithms, SIAM 2002, Theorem 8.5), and the rounding of L adds 2 u |L| |L^T|. The norm
// of |L| |L^T| is at most that of Frobenius of L squared, which is the trace of A.
template <typename Scalar>
void expect_equal_to_plain(const Flesh& flesh)
{
    const Positions x = test_support::jittered(flesh.bent.lbs, 0.02);
    pbs::PlainFlesh plain(flesh.energy, flesh.factor);
    pbs::PackedFlesh<Scalar> packed(flesh.bent.mesh, flesh.energy, flesh.factor, 1);
    const Evaluated expected = evaluated<double>(plain, flesh.centres, x), found = evaluated<Scalar>(packed, flesh.centres, x);
    const double unit = std::numeric_limits<Scalar>::epsilon(), rounding = test_support::rounding_of_gradient<Scalar>(flesh.energy);
    EXPECT_LE((found.gradient - expected.gradient).cwiseAbs().maxCoeff(), rounding);
    EXPECT_NEAR(found.energy, expected.energy, 30 * 32 * unit * expected.energy);
    EXPECT_GT(expected.gradient.norm(), 100.0 * rounding);
    const Eigen::VectorXd spectrum =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(Eigen::MatrixXd(flesh.laplacian), Eigen::EigenvaluesOnly).eigenvalues();
    const double lowest = spectrum.minCoeff(), of_solve = (longest_row(flesh.factor) + 1.0) * unit * spectrum.sum() / lowest;
    EXPECT_LE((found.preconditioned - expected.preconditioned).norm(),
              rounding * std::sqrt(static_cast<double>(x.size())) / lowest + of_solve * expected.preconditioned.norm());
    EXPECT_LT(of_solve, 0.1);
}

TEST(PackedFlesh, EqualsPlainInDouble)
{
    expect_equal_to_plain<double>(Flesh({10, 3, 3}));
}

TEST(PackedFlesh, EqualsPlainInFloat)
{
    expect_equal_to_plain<float>(Flesh({10, 3, 3}));
}

TEST(PackedFlesh, EqualsPlainInFloatFarFromTheOrigin)
{
    expect_equal_to_plain<float>(Flesh({10, 3, 3}, {1000.0, -500.0, 200.0}));
}

TEST(PackedFlesh, EqualsPlainOnOneTet)
{
    Flesh flesh({10, 3, 3});
    flesh.bent.mesh.tets = pbs::Tets(flesh.bent.mesh.tets.topRows(1));
    pbs::BoneSprings spring{Positions(1, 3), Eigen::VectorXd::Constant(1, 1.0), {0}};
    spring.points.row(0).setZero();
    for (const int v : flesh.bent.mesh.tets.row(0)) spring.points.row(0) += flesh.bent.mesh.rest.row(v) / 4.0;
    flesh.hold = pbs::BoneHold(flesh.bent.mesh, spring, 2);
    flesh.energy = pbs::FleshEnergy(flesh.bent.mesh, pbs::flesh_material(0.45), flesh.hold);
    flesh.factor = pbs::cholesky_factor(pbs::flesh_laplacian(flesh.bent.mesh, pbs::flesh_material(0.45), flesh.energy, 0.6));
    flesh.hold.centres(flesh.bent.pose, flesh.centres);
    expect_equal_to_plain<double>(flesh);
}

template <typename Scalar>
void expect_threads_to_change_no_bit(const Flesh& flesh)
{
    const Positions x = test_support::jittered(flesh.bent.lbs, 0.002);
    pbs::PackedFlesh<Scalar> alone(flesh.bent.mesh, flesh.energy, flesh.factor, 1);
    const Evaluated expected = evaluated<Scalar>(alone, flesh.centres, x);
    for (const int threads : {2, 4}) {
        pbs::PackedFlesh<Scalar> shared(flesh.bent.mesh, flesh.energy, flesh.factor, threads);
        const Evaluated found = evaluated<Scalar>(shared, flesh.centres, x);
        EXPECT_EQ(found.energy, expected.energy);
        EXPECT_EQ(found.gradient, expected.gradient);
        EXPECT_EQ(found.preconditioned, expected.preconditioned);
    }
}

// 13,005 vertices: enough slabs for several threads.
TEST(PackedFlesh, ThreadsChangeNoBit)
{
    const Flesh flesh({44, 16, 16});
    ASSERT_GE(test_support::slabs_of(flesh.bent.mesh), 4);
    expect_threads_to_change_no_bit<float>(flesh);
    expect_threads_to_change_no_bit<double>(flesh);
}

}  // namespace
