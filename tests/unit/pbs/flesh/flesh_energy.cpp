// Reference: the energy density of the material at one deformation gradient, and differences of the value.
#include "pbs/flesh/flesh_energy.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "tests/support/eps_sweep.hpp"
#include "tests/support/held_bar.hpp"
#include "tests/support/rounding_error.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace flesh_energy_tests {
namespace {

using pbs::Positions;

const test_support::HeldBar held({8, 2, 2});
const test_support::TwoBoneLimb& bent = held.bent;
const pbs::BoneHold& hold = held.hold;
const Positions& centres = held.centres;

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
    EXPECT_NEAR(free.value(x, Positions::Zero(x.rows(), 3)), density * volume,
                test_support::rounding_error(2000, 10.0 * density * volume));
}

TEST_P(FleshEnergyOf, GradientByAnEpsSweep)
{
    const Positions at = test_support::jittered(bent.lbs, 0.05),
                    along = test_support::jittered(Positions::Zero(at.rows(), 3), 1.0, 9);
    Positions gradient;
    energy.value_and_gradient(at, centres, gradient);
    const auto value = [&](const Eigen::VectorXd& x) {
        return energy.value(Positions::Map(x.data(), at.rows(), 3), centres);
    };
    test_support::expect_slope_by_eps_sweep(value, flat(at), flat(along), flat(gradient).dot(flat(along)), 0.1);
}

TEST_P(FleshEnergyOf, HessianByAnEpsSweep)
{
    const Positions at = test_support::jittered(bent.lbs, 0.05),
                    along = test_support::jittered(Positions::Zero(at.rows(), 3), 1.0, 9),
                    also = test_support::jittered(Positions::Zero(at.rows(), 3), 1.0, 10);
    using ByVertex = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
    const auto by_vertex = [](const Positions& x) {
        const ByVertex rows = x;
        return Eigen::VectorXd(Eigen::VectorXd::Map(rows.data(), rows.size()));
    };
    const Eigen::SparseMatrix<double> lower = pbs::flesh_hessian(energy, at), H = lower.selfadjointView<Eigen::Lower>();
    const auto slope = [&](const Eigen::VectorXd& x) {
        Positions gradient;
        energy.value_and_gradient(Positions::Map(x.data(), at.rows(), 3), centres, gradient);
        return flat(gradient).dot(flat(also));
    };
    test_support::expect_slope_by_eps_sweep(slope, flat(at), flat(along), by_vertex(also).dot(H * by_vertex(along)),
                                            0.1);
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
    EXPECT_NEAR(values[3] - 3.0 * values[2] + 3.0 * values[1] - values[0], 0.0,
                test_support::rounding_error(8.0 * 20 * 200, values[3]));
}

// With a volume share of zero, H is the Hessian of all terms but those of the volume, which are affine in kappa: H x =
// g - g(kappa terms).
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
    // 1e-9: its hold
    EXPECT_LE((found - expected).cwiseAbs().maxCoeff(), test_support::rounding_error(2000, largest) + 1e-9 * largest);
}

INSTANTIATE_TEST_SUITE_P(PoissonsRatios, FleshEnergyOf, testing::Values(0.0, 0.3, 0.45));

TEST(FleshEnergy, RefusesATetWithoutVolumeButAVertexWithoutTetsHasARowOfItsOwn)
{
    pbs::TetMesh flat_mesh = bent.mesh;
    flat_mesh.rest.row(flat_mesh.tets(5, 0)) = flat_mesh.rest.row(flat_mesh.tets(5, 1));
    EXPECT_THROW(pbs::FleshEnergy(flat_mesh, pbs::flesh_material(0.45), hold), pbs::InputError);
    pbs::TetMesh mesh = bent.mesh;
    mesh.rest.conservativeResize(mesh.rest.rows() + 1, 3);
    mesh.rest.bottomRows(1) << 5.0, 5.0, 5.0;
    const pbs::FleshMaterial material = pbs::flesh_material(0.45);
    const pbs::FleshEnergy energy(mesh, material, pbs::BoneHold(mesh, test_support::random_springs(60, 0.3), 2));
    const Eigen::SparseMatrix<double> H = pbs::flesh_laplacian(mesh, material, energy, 0.5);
    EXPECT_EQ(H.coeff(H.rows() - 1, H.cols() - 1), 1.0);
}

// Reference: the conditions that rest is an equilibrium and that the moduli at small strains are those of Hooke's law.

// The stress mu F + lambda (J - alpha) dJ/dF vanishes at F = I, where dJ/dF = I. Along F = (1 + e) I, psi'' = 3 mu +
// lambda ((3 J'') (J - alpha) + 9) at e = 0 with J = (1 + e)^3, so J' = 3, J'' = 6; it is 9 K. Along the shear F = I +
// e (1, 2), J = 1 and |F|^2 = 3 + e^2, so psi'' = mu, the shear modulus E / (2 (1 + nu)).
TEST(FleshMaterial, HasNoStressAtRestAndHookesModuli)
{
    for (const double nu : {0.0, 0.3, 0.45, 0.499}) {
        SCOPED_TRACE(nu);
        const pbs::FleshMaterial material = pbs::flesh_material(nu);
        EXPECT_NEAR(material.mu + material.lambda * (1.0 - material.alpha), 0.0,
                    test_support::rounding_error(8, material.lambda));
        const double bulk = 1.0 / (3.0 * (1.0 - 2.0 * nu));
        const double second = 3.0 * material.mu + material.lambda * (9.0 + 6.0 * (1.0 - material.alpha));
        EXPECT_NEAR(second, 9.0 * bulk, test_support::rounding_error(30, 9.0 * material.lambda) / (1.0 - 2.0 * nu));
        EXPECT_DOUBLE_EQ(material.mu, 0.5 / (1.0 + nu));
    }
    for (const double nu : {0.5, -0.1, std::numeric_limits<double>::quiet_NaN()})
        EXPECT_THROW(pbs::flesh_material(nu), pbs::InputError) << "a ratio without a finite modulus";
}

// Reference: differences of the values, and the energy of the same material (FleshEnergy).

using Eigen::Matrix3d;

const pbs::TetMesh bar = test_support::structured_bar({0, 0, 0}, {2, 1, 1}, {2, 1, 1});
const pbs::NeoHookeanTet tet = pbs::neo_hookean_tets(bar)[3];

Eigen::VectorXd jittered_corners(double size)
{
    const Positions x = test_support::jittered(bar.rest, size);
    Eigen::VectorXd corners(12);
    for (int i = 0; i < 4; ++i) corners.segment<3>(3 * i) = x.row(tet.vertex[i]).transpose();
    return corners;
}

Matrix3d gradient_of_map(const Eigen::VectorXd& corners)
{
    return pbs::deformation_gradient(tet, corners.segment<3>(0), corners.segment<3>(3), corners.segment<3>(6),
                                     corners.segment<3>(9));
}

// value and derivative: functions of F.
template <typename Value, typename Derivative>
void expect_vertex_gradients(const Value& value, const Derivative& derivative, const Eigen::VectorXd& corners)
{
    const Eigen::Matrix<double, 3, 4> gradients = pbs::vertex_gradients(tet, derivative(gradient_of_map(corners)));
    test_support::RandomPoints random(5);
    Eigen::VectorXd along(12);
    for (double& entry : along) entry = random.number(-1.0, 1.0);
    test_support::expect_slope_by_eps_sweep([&](const Eigen::VectorXd& x) { return value(gradient_of_map(x)); },
                                            corners, along, Eigen::VectorXd::Map(gradients.data(), 12).dot(along), 1.0);
    EXPECT_LE(gradients.rowwise().sum().norm(), test_support::rounding_error(30, gradients.norm()));
}

TEST(NeoHookeanConstraints, GradientsByAnEpsSweep)
{
    Eigen::VectorXd mirrored = jittered_corners(0.1);
    for (int i = 0; i < 4; ++i) mirrored(3 * i) *= -1.0;
    EXPECT_LT(gradient_of_map(mirrored).determinant(), 0.0);
    for (const Eigen::VectorXd& corners : {jittered_corners(0.1), jittered_corners(0.8), mirrored}) {
        expect_vertex_gradients([](const Matrix3d& F) { return pbs::hydrostatic_value(F, 1.1); },
                                pbs::hydrostatic_gradient, corners);
        expect_vertex_gradients(pbs::deviatoric_value, pbs::deviatoric_gradient, corners);
    }
}

// C^2 / (2 compliance), summed over the dozen tets; some 50 roundings each.
TEST(NeoHookeanConstraints, HaveTheEnergyOfTheFlesh)
{
    const pbs::BoneHold none(bar, {Positions(0, 3), Eigen::VectorXd(0), {}}, 1);
    for (const double nu : {0.0, 0.3, 0.45}) {
        const pbs::FleshMaterial material = pbs::flesh_material(nu);
        const Positions x = test_support::jittered(bar.rest, 0.4);
        double energy = 0.0;
        for (const pbs::NeoHookeanTet& each : pbs::neo_hookean_tets(bar)) {
            const auto p = [&](int i) { return pbs::Vec3(x.row(each.vertex[i])); };
            const Matrix3d F = pbs::deformation_gradient(each, p(0), p(1), p(2), p(3));
            const double C_H = pbs::hydrostatic_value(F, material.alpha), C_D = pbs::deviatoric_value(F);
            energy += each.volume / 2.0 * (material.lambda * C_H * C_H + material.mu * C_D * C_D);
        }
        const double expected = pbs::FleshEnergy(bar, material, none).value(x, Positions::Zero(x.rows(), 3));
        EXPECT_NEAR(energy, expected, test_support::rounding_error(50 * 12, 10.0 * expected));
    }
}

TEST(NeoHookeanConstraints, ATetCollapsedToAPointHasNoGradientsAndAtRestIsRefused)
{
    const Matrix3d F = gradient_of_map(Eigen::VectorXd::Constant(12, 0.25));
    EXPECT_EQ(F, Matrix3d::Zero());
    EXPECT_EQ(pbs::deviatoric_value(F), 0.0);
    EXPECT_EQ(pbs::deviatoric_gradient(F), Matrix3d::Zero());
    EXPECT_EQ(pbs::hydrostatic_gradient(F), Matrix3d::Zero());
    pbs::TetMesh flat = bar;
    flat.rest.row(flat.tets(2, 0)) = flat.rest.row(flat.tets(2, 1));
    EXPECT_THROW(pbs::neo_hookean_tets(flat), pbs::InputError);
}

}  // namespace
}  // namespace flesh_energy_tests
