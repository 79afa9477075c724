// Reference: the value and the gradient of the plain energy, which knows nothing of vertices' blocks.
#include "pbs/flesh/vbd.hpp"

#include "tests/support/held_bar.hpp"
#include "tests/support/rounding_error.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

namespace {

using pbs::Positions;
using pbs::Vec3;

const test_support::TwoBoneLimb bent = test_support::two_bone_limb({8, 2, 2}, Vec3::UnitZ(), 70.0);
const pbs::BoneHold hold(bent.mesh, test_support::random_springs(60, 0.3), 2);
constexpr int tets = 6 * 8 * 2 * 2;

Positions centres_of(const pbs::Pose& pose)
{
    Positions centres;
    hold.centres(pose, centres);
    return centres;
}
const Positions centres = centres_of(bent.pose);

Positions mirrored(Positions x)
{
    x.col(1) *= -1.0;
    return x;
}

class VertexBlockOf : public testing::TestWithParam<double> {
protected:
    const pbs::FleshEnergy energy{bent.mesh, pbs::flesh_material(GetParam()), hold};
    const std::vector<pbs::VertexStar> stars = pbs::vertex_stars(energy);
    const std::vector<Positions> shapes = {bent.lbs, test_support::jittered(bent.lbs, 0.1), mirrored(bent.lbs)};

    // The largest term of a gradient: a pressure of kappa (|6 V| + d) on the largest face, or a spring or edge of 2 m.
    double largest_term() const
    {
        double largest = 2.0 * energy.hold().maxCoeff();
        for (const pbs::FleshTet& tet : energy.tets()) {
            largest = std::max(largest, tet.kappa * 8.0 * tet.d * 0.25);
            for (const double w : tet.w) largest = std::max(largest, 2.0 * std::abs(w));
        }
        return largest;
    }
};

// A vertex has at most 24 tets, each of which goes through some 30 roundings on either side.
TEST_P(VertexBlockOf, HasTheGradientOfTheEnergy)
{
    for (const Positions& x : shapes) {
        Positions gradient;
        energy.value_and_gradient(x, centres, gradient);
        for (int i = 0; i < static_cast<int>(stars.size()); ++i) {
            const Vec3 found = pbs::vertex_block(stars[i], i, x, centres).gradient;
            EXPECT_LE((found - gradient.row(i).transpose()).cwiseAbs().maxCoeff(),
                      test_support::rounding_error(2 * 24 * 30, largest_term()))
                << "vertex " << i;
        }
    }
}

// The energy is quadratic along a vertex: its differences are those of the block at every step length, without a remainder. An energy has
// some 40 roundings per tet of terms that are positive.
TEST_P(VertexBlockOf, HasTheDifferencesOfTheEnergyAtEveryEps)
{
    const Vec3 direction(0.3, -0.7, 0.5);
    for (const Positions& x : shapes)
        for (const int i : {0, 13, 40, 80})
            for (const double eps : {1.0, 0.1, 0.01}) {
                const pbs::VertexBlock block = pbs::vertex_block(stars[i], i, x, centres);
                Positions moved = x;
                const double at = energy.value(moved, centres);
                moved.row(i) = x.row(i) + eps * direction.transpose();
                const double ahead = energy.value(moved, centres);
                moved.row(i) = x.row(i) - eps * direction.transpose();
                const double behind = energy.value(moved, centres);
                const double rounding = test_support::rounding_error(4.0 * 40 * tets, std::max({at, ahead, behind}));
                EXPECT_NEAR(ahead - behind, 2.0 * eps * block.gradient.dot(direction), rounding) << i << ", " << eps;
                EXPECT_NEAR(ahead - 2.0 * at + behind, eps * eps * direction.dot(block.hessian * direction), rounding) << i << ", " << eps;
                EXPECT_GT(eps * eps * direction.dot(block.hessian * direction), 20.0 * rounding) << "the comparison would see an error";
            }
}

// Theory: the Hessian is diagonal * I plus positive semidefinite terms, and diagonal is the sum of mu V0 |grad N|^2 and k beta^2.
TEST_P(VertexBlockOf, HasNoEigenvalueBelowItsDiagonal)
{
    for (const Positions& x : shapes)
        for (int i = 0; i < static_cast<int>(stars.size()); ++i) {
            const pbs::VertexBlock block = pbs::vertex_block(stars[i], i, x, centres);
            EXPECT_GT(block.diagonal, 0.0);
            const Eigen::Vector3d eigenvalues = block.hessian.selfadjointView<Eigen::Lower>().eigenvalues();
            EXPECT_GE(eigenvalues(0), block.diagonal - test_support::rounding_error(100.0, eigenvalues(2)));
        }
}

// Roundings of the solve are magnified by at most the condition number of the block.
TEST_P(VertexBlockOf, StepSolvesTheBlock)
{
    for (const Positions& x : shapes)
        for (int i = 0; i < static_cast<int>(stars.size()); ++i) {
            const pbs::VertexBlock block = pbs::vertex_block(stars[i], i, x, centres);
            const Vec3 expected = block.hessian.ldlt().solve(block.gradient);
            const double condition = block.hessian.norm() / block.diagonal;
            EXPECT_LE((pbs::block_step(block) - expected).norm(), test_support::rounding_error(50.0 * condition, expected.norm()));
        }
}

INSTANTIATE_TEST_SUITE_P(PoissonsRatios, VertexBlockOf, testing::Values(0.0, 0.3, 0.45, 0.499));

TEST(VertexBlock, AVertexWithoutTetsHasNoStep)
{
    const pbs::VertexStar star;
    const pbs::VertexBlock block = pbs::vertex_block(star, 0, Positions::Constant(1, 3, 2.0), Positions::Zero(1, 3));
    EXPECT_EQ(block.gradient, Vec3(Vec3::Zero()));
    EXPECT_EQ(pbs::block_step(block), Vec3(Vec3::Zero()));
}

// Coincident vertices have no normal: the block is the diagonal, and the step goes to the mean that the edges and the spring weigh.
TEST(VertexBlock, CoincidentVerticesLeaveTheDiagonal)
{
    const pbs::FleshEnergy energy(bent.mesh, pbs::flesh_material(0.45), hold);
    const std::vector<pbs::VertexStar> stars = pbs::vertex_stars(energy);
    const Positions point = Positions::Constant(bent.mesh.rest.rows(), 3, 0.25);
    for (const int i : {0, 13, 40}) {
        const pbs::VertexBlock block = pbs::vertex_block(stars[i], i, point, centres);
        EXPECT_EQ(block.hessian, Eigen::Matrix3d(stars[i].diagonal * Eigen::Matrix3d::Identity()));
        const Vec3 expected = stars[i].hold / stars[i].diagonal * (Vec3::Constant(0.25) - centres.row(i).transpose());
        EXPECT_LE((pbs::block_step(block) - expected).norm(), test_support::rounding_error(4.0, expected.norm()));
    }
}

}  // namespace
