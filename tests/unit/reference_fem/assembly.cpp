// Reference: the P1 stiffness of one tet in closed form, derived by hand; rigid motions store no energy; the load adds up to the weight;
// the energy is half of u K u.
#include "reference_fem/assembly.hpp"

#include "pbs/geometry/tet_volume.hpp"
#include "tests/support/structured_bar.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include <random>

namespace {

using namespace reference_fem;
using pbs::Vec3;

const Lame material{2.0, 3.0};
const pbs::TetMesh bar = test_support::structured_bar({0, 0, 0}, {2, 1, 1}, {3, 2, 2});

Eigen::VectorXd at_nodes(const SimplexSpace& space, const VectorField& field)
{
    Eigen::VectorXd values(space.dofs());
    for (int n = 0; n < space.nodes(); ++n) values.segment<3>(3 * n) = field(space.node_positions().row(n));
    return values;
}

TEST(Assembly, StiffnessOfOneLinearTetIsTheClosedForm)
{
    pbs::TetMesh tet;
    tet.rest.resize(4, 3);
    tet.rest << 0.1, 0, 0, 1.2, 0.1, 0, 0.2, 0.9, 0.1, 0, 0.3, 1.1;
    tet.tets.resize(1, 4);
    tet.tets << 0, 1, 2, 3;
    Eigen::Matrix3d edges = (tet.rest.bottomRows(3).rowwise() - tet.rest.row(0)).transpose();
    Eigen::Matrix<double, 3, 4> gradient;  // gradients of the four shape functions
    gradient.rightCols(3) = edges.inverse().transpose();
    gradient.col(0) = -gradient.rightCols(3).rowwise().sum();
    Eigen::MatrixXd expected(12, 12);
    for (int a = 0; a < 4; ++a)
        for (int b = 0; b < 4; ++b)
            expected.block<3, 3>(3 * a, 3 * b) = edges.determinant() / 6.0 *
                                                 (material.lambda_pa * gradient.col(a) * gradient.col(b).transpose() +
                                                  material.mu_pa * gradient.col(b) * gradient.col(a).transpose() +
                                                  material.mu_pa * gradient.col(a).dot(gradient.col(b)) * Eigen::Matrix3d::Identity());
    const Eigen::MatrixXd stiffness = stiffness_matrix(SimplexSpace(tet, 1), material);
    EXPECT_LT((stiffness - expected).norm() / expected.norm(), 1e-14);
}

TEST(Assembly, StiffnessIsSymmetricAndKnowsNoRigidMotion)
{
    for (const int order : {1, 2}) {
        const SimplexSpace space(bar, order);
        const SparseMatrix stiffness = stiffness_matrix(space, material);
        EXPECT_LT((stiffness - SparseMatrix(stiffness.transpose())).norm(), 1e-13 * stiffness.norm());
        for (int axis = 0; axis < 3; ++axis) {
            const Eigen::VectorXd translation = at_nodes(space, [&](const Vec3&) -> Vec3 { return Vec3::Unit(axis); });
            const Eigen::VectorXd rotation = at_nodes(space, [&](const Vec3& x) -> Vec3 { return Vec3::Unit(axis).cross(x); });
            for (const Eigen::VectorXd& rigid : {translation, rotation})
                EXPECT_LT((stiffness * rigid).norm(), 1e-13 * stiffness.norm() * rigid.norm());
        }
    }
}

TEST(Assembly, StiffnessHasEachEntryOnceAndSorted)
{
    const SparseMatrix stiffness = stiffness_matrix(SimplexSpace(bar, 2), material);
    ASSERT_TRUE(stiffness.isCompressed());
    for (Eigen::Index c = 0; c < stiffness.cols(); ++c)
        for (auto k = stiffness.outerIndexPtr()[c] + 1; k < stiffness.outerIndexPtr()[c + 1]; ++k)
            EXPECT_LT(stiffness.innerIndexPtr()[k - 1], stiffness.innerIndexPtr()[k]);
}

TEST(Assembly, LoadAddsUpToTheTotalForceAndItsMoment)
{
    const Vec3 force(1.0, -2.0, 0.5);
    for (const int order : {1, 2}) {
        const SimplexSpace space(bar, order);
        const Eigen::VectorXd load = load_vector(space, [&](const Vec3&) { return force; });
        Vec3 total = Vec3::Zero(), moment = Vec3::Zero();
        for (int n = 0; n < space.nodes(); ++n) {
            total += load.segment<3>(3 * n);
            moment += Vec3(space.node_positions().row(n)).cross(load.segment<3>(3 * n));
        }
        const double volume = pbs::tet_volumes(bar.rest, bar.tets).sum();
        EXPECT_LT((total - volume * force).norm(), 1e-12);
        EXPECT_LT((moment - volume * Vec3(1.0, 0.5, 0.5).cross(force)).norm(), 1e-12);  // about the bar's centre of mass
    }
}

TEST(Assembly, LoadOfACubicForceIsExactOnQuadraticTets)
{
    // The virtual work of f = x^3 e_x with v = x^2 e_x over [0, 2] x [0, 1]^2 is 2^6 / 6. Its degree is 5, the highest that three points
    // per direction integrate.
    const SimplexSpace space(bar, 2);
    const Eigen::VectorXd load = load_vector(space, [](const Vec3& x) -> Vec3 { return {x(0) * x(0) * x(0), 0, 0}; });
    const Eigen::VectorXd square = at_nodes(space, [](const Vec3& x) -> Vec3 { return {x(0) * x(0), 0, 0}; });
    EXPECT_NEAR(load.dot(square), 64.0 / 6.0, 1e-12 * 64.0 / 6.0);
}

TEST(Assembly, EnergyIsHalfTheWorkOfTheStiffness)
{
    std::mt19937 random(3);
    for (const int order : {1, 2}) {
        const SimplexSpace space(bar, order);
        Eigen::VectorXd displacement(space.dofs());
        for (double& u : displacement) u = random() / 4294967296.0 - 0.5;
        const double work = displacement.dot(stiffness_matrix(space, material) * displacement) / 2.0;
        EXPECT_NEAR(strain_energy(space, material, displacement), work, 1e-12 * work);
    }
}

TEST(Assembly, ErrorNormsOfZeroAreTheNormsOfTheField)
{
    // |x|^2 and |grad|^2 = 1 for u = (x, 0, 0) over [0, 2] x [0, 1]^2: 8/3 and 2.
    const SimplexSpace space(bar, 1);
    const auto field = [](const Vec3& x) -> Vec3 { return {x(0), 0, 0}; };
    const auto gradient = [](const Vec3&) -> Eigen::Matrix3d { return Vec3(1, 0, 0).asDiagonal(); };
    const ErrorNorms norms = error_norms(space, Eigen::VectorXd::Zero(space.dofs()), field, gradient);
    EXPECT_NEAR(norms.l2, std::sqrt(8.0 / 3.0), 1e-12);
    EXPECT_NEAR(norms.h1_seminorm, std::sqrt(2.0), 1e-12);
    EXPECT_LT(error_norms(space, at_nodes(space, field), field, gradient).l2, 1e-14);
}

}  // namespace
