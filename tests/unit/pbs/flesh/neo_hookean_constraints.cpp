// Reference: differences of the values, and the energy of the same material (FleshEnergy).
#include "pbs/flesh/flesh_energy.hpp"

#include "pbs/geometry/input_error.hpp"
#include "tests/support/eps_sweep.hpp"
#include "tests/support/held_bar.hpp"
#include "tests/support/rounding_error.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace {

using Eigen::Matrix3d;
using pbs::Positions;

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
    return pbs::deformation_gradient(tet, corners.segment<3>(0), corners.segment<3>(3), corners.segment<3>(6), corners.segment<3>(9));
}

// value and derivative: functions of F.
template <typename Value, typename Derivative>
void expect_vertex_gradients(const Value& value, const Derivative& derivative, const Eigen::VectorXd& corners)
{
    const Eigen::Matrix<double, 3, 4> gradients = pbs::vertex_gradients(tet, derivative(gradient_of_map(corners)));
    test_support::RandomPoints random(5);
    Eigen::VectorXd along(12);
    for (double& entry : along) entry = random.number(-1.0, 1.0);
    test_support::expect_slope_by_eps_sweep([&](const Eigen::VectorXd& x) { return value(gradient_of_map(x)); }, corners, along,
                                            Eigen::VectorXd::Map(gradients.data(), 12).dot(along), 1.0);
    EXPECT_LE(gradients.rowwise().sum().norm(), test_support::rounding_error(30, gradients.norm()));
}

TEST(NeoHookeanConstraints, GradientOfTheHydrostaticOneByAnEpsSweep)
{
    for (const double size : {0.1, 0.8})
        expect_vertex_gradients([](const Matrix3d& F) { return pbs::hydrostatic_value(F, 1.1); }, pbs::hydrostatic_gradient,
                                jittered_corners(size));
}

TEST(NeoHookeanConstraints, GradientOfTheDeviatoricOneByAnEpsSweep)
{
    for (const double size : {0.1, 0.8}) expect_vertex_gradients(pbs::deviatoric_value, pbs::deviatoric_gradient, jittered_corners(size));
}

TEST(NeoHookeanConstraints, GradientsInAMirroredTet)
{
    Eigen::VectorXd corners = jittered_corners(0.1);
    for (int i = 0; i < 4; ++i) corners(3 * i) *= -1.0;
    EXPECT_LT(gradient_of_map(corners).determinant(), 0.0);
    expect_vertex_gradients([](const Matrix3d& F) { return pbs::hydrostatic_value(F, 1.1); }, pbs::hydrostatic_gradient, corners);
    expect_vertex_gradients(pbs::deviatoric_value, pbs::deviatoric_gradient, corners);
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

TEST(NeoHookeanConstraints, ATetCollapsedToAPointHasNoGradients)
{
    const Matrix3d F = gradient_of_map(Eigen::VectorXd::Constant(12, 0.25));
    EXPECT_EQ(F, Matrix3d::Zero());
    EXPECT_EQ(pbs::deviatoric_value(F), 0.0);
    EXPECT_EQ(pbs::deviatoric_gradient(F), Matrix3d::Zero());
    EXPECT_EQ(pbs::hydrostatic_gradient(F), Matrix3d::Zero());
}

TEST(NeoHookeanConstraints, RefuseATetWithoutVolume)
{
    pbs::TetMesh flat = bar;
    flat.rest.row(flat.tets(2, 0)) = flat.rest.row(flat.tets(2, 1));
    EXPECT_THROW(pbs::neo_hookean_tets(flat), pbs::InputError);
}

}  // namespace
