// Reference: the energy density of the material at one deformation gradient, and differences of the value.
#include "pbs/flesh/flesh_energy.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "tests/support/eps_sweep.hpp"
#include "tests/support/held_bar.hpp"
#include "tests/support/rounding_error.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace {

using pbs::Positions;

const test_support::TwoBoneLimb bent = test_support::two_bone_limb({8, 2, 2}, pbs::Vec3::UnitZ(), 70.0);
const pbs::BoneHold hold(bent.mesh, test_support::random_springs(60, 0.3), 2);

Positions centres_of(const pbs::Pose& pose)
{
    Positions centres;
    hold.centres(pose, centres);
    return centres;
}
const Positions centres = centres_of(bent.pose);

Eigen::VectorXd flat(const Positions& positions)
{
    return Eigen::VectorXd::Map(positions.data(), positions.size());
}

class FleshEnergyOf : public testing::TestWithParam<double> {
protected:
    const pbs::FleshMaterial material = pbs::flesh_material(GetParam());
    const pbs::FleshEnergy energy{bent.mesh, material, hold};
};

// mu / 2 |F|^2 + lambda / 2 (J - alpha)^2 times the volume, and the springs. The bar has some 200 tets.
TEST_P(FleshEnergyOf, OfAnAffineMapIsItsDensityTimesTheVolume)
{
    const pbs::BoneSprings none{Positions(0, 3), Eigen::VectorXd(0), {}};
    const pbs::FleshEnergy free(bent.mesh, material, pbs::BoneHold(bent.mesh, none, 2));
    Eigen::Matrix3d F;
    F << 1.2, 0.3, -0.1, 0.2, 0.7, 0.4, -0.3, 0.1, -0.9;  // mirrored
    const Positions x = bent.mesh.rest * F.transpose();
    const double beyond = F.determinant() - material.alpha;
    const double density = material.mu / 2.0 * F.squaredNorm() + material.lambda / 2.0 * beyond * beyond;
    const double volume = pbs::tet_volumes(bent.mesh.rest, bent.mesh.tets).sum();
    EXPECT_NEAR(free.value(x, Positions::Zero(x.rows(), 3)), density * volume, test_support::rounding_error(2000, 10.0 * density * volume));
}

TEST_P(FleshEnergyOf, GradientByAnEpsSweep)
{
    const Positions at = test_support::jittered(bent.lbs, 0.05), along = test_support::jittered(Positions::Zero(at.rows(), 3), 1.0, 9);
    Positions gradient;
    energy.value_and_gradient(at, centres, gradient);
    const auto value = [&](const Eigen::VectorXd& x) { return energy.value(Positions::Map(x.data(), at.rows(), 3), centres); };
    test_support::expect_slope_by_eps_sweep(value, flat(at), flat(along), flat(gradient).dot(flat(along)), 0.1);
}

// Third differences of a quadratic vanish. Values are of order E; each has some 20 roundings per tet.
TEST_P(FleshEnergyOf, IsQuadraticAlongOneVertex)
{
    Positions x = test_support::jittered(bent.lbs, 0.1);
    const Eigen::RowVector3d step(0.02, -0.03, 0.05);
    double values[4];
    for (double& value : values) {
        value = energy.value(x, centres);
        x.row(20) += step;
    }
    EXPECT_GT(std::abs(values[2] - 2.0 * values[1] + values[0]), 1e-6 * values[0]);
    EXPECT_NEAR(values[3] - 3.0 * values[2] + 3.0 * values[1] - values[0], 0.0, test_support::rounding_error(8.0 * 20 * 200, values[3]));
}

// With a volume share of zero, H is the Hessian of all terms but those of the volume, which are affine in kappa: H x = g - g(kappa terms).
TEST_P(FleshEnergyOf, LaplacianIsTheGradientOfTheOtherTerms)
{
    const Eigen::SparseMatrix<double> lower = pbs::flesh_laplacian(bent.mesh, material, energy, 0.0);
    const Eigen::SparseMatrix<double> H = lower.selfadjointView<Eigen::Lower>();
    const Positions x = test_support::jittered(bent.lbs, 0.1);
    Positions expected;
    energy.value_and_gradient(x, centres, expected);
    for (const pbs::FleshTet& tet : energy.tets()) {
        pbs::Vec3 p[4];
        for (int i = 0; i < 4; ++i) p[i] = x.row(tet.vertex[i]);
        const double pressure = tet.kappa * (6.0 * pbs::tet_volume(p[0], p[1], p[2], p[3]) - tet.d);
        for (int i = 0; i < 4; ++i) {  // 6 times the gradient of the volume: the normal of the opposite face
            const pbs::Vec3 &a = p[(i + 1) % 4], &b = p[(i + 2) % 4], &c = p[(i + 3) % 4];
            const pbs::Vec3 normal = (b - a).cross(c - a) * (i % 2 == 0 ? -1.0 : 1.0);
            expected.row(tet.vertex[i]) -= pressure * normal.transpose();
        }
    }
    Positions found = H * x;
    for (Eigen::Index i = 0; i < x.rows(); ++i) found.row(i) -= energy.hold()(i) * centres.row(i);
    const double largest = H.diagonal().maxCoeff() * x.cwiseAbs().maxCoeff() + material.lambda;
    EXPECT_LE((found - expected).cwiseAbs().maxCoeff(), test_support::rounding_error(2000, largest) + 1e-9 * largest);  // 1e-9: its hold
}

INSTANTIATE_TEST_SUITE_P(PoissonsRatios, FleshEnergyOf, testing::Values(0.0, 0.3, 0.45));

TEST(FleshEnergy, RefusesATetWithoutVolume)
{
    pbs::TetMesh flat_mesh = bent.mesh;
    flat_mesh.rest.row(flat_mesh.tets(5, 0)) = flat_mesh.rest.row(flat_mesh.tets(5, 1));
    EXPECT_THROW(pbs::FleshEnergy(flat_mesh, pbs::flesh_material(0.45), hold), pbs::InputError);
}

TEST(FleshEnergy, AVertexWithoutTetsHasARowOfItsOwn)
{
    pbs::TetMesh mesh = bent.mesh;
    mesh.rest.conservativeResize(mesh.rest.rows() + 1, 3);
    mesh.rest.bottomRows(1) << 5.0, 5.0, 5.0;
    const pbs::FleshMaterial material = pbs::flesh_material(0.45);
    const pbs::FleshEnergy energy(mesh, material, pbs::BoneHold(mesh, test_support::random_springs(60, 0.3), 2));
    const Eigen::SparseMatrix<double> H = pbs::flesh_laplacian(mesh, material, energy, 0.5);
    EXPECT_EQ(H.coeff(H.rows() - 1, H.cols() - 1), 1.0);
}

}  // namespace
