// Reference: the energy's own value (descent, gradient), and linear elasticity where strains are small.
#include "pbs/flesh/flesh_energy.hpp"
#include "pbs/flesh/flesh_system.hpp"
#include "pbs/flesh/projective_dynamics.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/nearest_rotation.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "tests/support/eps_sweep.hpp"
#include "tests/support/held_bar.hpp"
#include "tests/support/rounding_error.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace projective_dynamics_tests {
namespace {

using pbs::Positions;
using pbs::ProjectiveDynamics;
using pbs::ProjectiveEnergy;
using pbs::ProjectiveOptions;
using pbs::ProjectiveSummary;
using pbs::Vec3;

const test_support::HeldBar held({8, 2, 2});

struct Material {
    double poisson = 0.45;
    bool keeps_volume = true;
};

ProjectiveEnergy energy_of(const Material& material)
{
    return {held.bent.mesh, pbs::projective_weights(material.poisson, material.keeps_volume), held.hold};
}

// In plain code.
ProjectiveDynamics<double> solver_of(const Material& material, ProjectiveOptions options)
{
    options.packed = false;
    const pbs::HeldFlesh flesh(
        held.bent.mesh, held.springs, 2,
        {.poisson = material.poisson,
         .volume_share = pbs::volume_share_of_projective(material.poisson, material.keeps_volume)});
    return {held.bent.mesh, energy_of(material), flesh.factor(), options};
}

TEST(ProjectiveDynamics, RecordsTheEnergyBeforeEachIteration)
{
    ProjectiveDynamics<double> solver = solver_of({}, {.iterations = 40});
    Positions x = held.bent.lbs, unused;
    const double before = energy_of({}).value_and_gradient(x, held.centres, unused);
    const ProjectiveSummary summary = solver.minimise(held.centres, x);
    ASSERT_EQ(summary.energies.size(), 40u);
    EXPECT_EQ(summary.energies.front(), before);
    EXPECT_LT(summary.energies.back(), summary.energies.front());
}

// At the start of a pose and at its end.
TEST(ProjectiveDynamics, ItsGradientIsThatOfItsEnergy)
{
    test_support::RandomPoints random(71);
    for (const double poisson : {0.0, 0.45}) {
        const ProjectiveEnergy energy = energy_of({.poisson = poisson});
        ProjectiveDynamics<double> solver = solver_of({.poisson = poisson}, {.iterations = 30});
        Positions x = held.bent.lbs;
        for (int time = 0; time < 2; ++time) {
            Positions gradient, unused, direction(x.rows(), 3);
            for (auto row : direction.rowwise()) row = random.point(1.0).transpose();
            energy.value_and_gradient(x, held.centres, gradient);
            const auto value = [&](const Eigen::VectorXd& at) {
                return energy.value_and_gradient(Eigen::Map<const Positions>(at.data(), x.rows(), 3), held.centres,
                                                 unused);
            };
            test_support::expect_slope_by_eps_sweep(value, Eigen::Map<const Eigen::VectorXd>(x.data(), x.size()),
                                                    Eigen::Map<const Eigen::VectorXd>(direction.data(), x.size()),
                                                    gradient.cwiseProduct(direction).sum(), 0.02);
            solver.minimise(held.centres, x);
        }
    }
}

// Forces of linear elasticity over Young's modulus [m^2], and of the springs.
Positions linear_forces(const Positions& displacement, double poisson)
{
    const pbs::TetMesh& mesh = held.bent.mesh;
    const double mu = 0.5 / (1.0 + poisson), lambda = poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
    Positions forces = Positions::Zero(mesh.rest.rows(), 3);
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t) {
        Eigen::Matrix3d rest, moved;
        for (int k = 0; k < 3; ++k) {
            rest.col(k) = (mesh.rest.row(mesh.tets(t, k + 1)) - mesh.rest.row(mesh.tets(t, 0))).transpose();
            moved.col(k) = (displacement.row(mesh.tets(t, k + 1)) - displacement.row(mesh.tets(t, 0))).transpose();
        }
        const Eigen::Matrix3d h = moved * rest.inverse(), strain = 0.5 * (h + h.transpose());
        const Eigen::Matrix3d stress = 2.0 * mu * strain + lambda * strain.trace() * Eigen::Matrix3d::Identity();
        const Eigen::Matrix3d columns = rest.determinant() / 6.0 * stress * rest.inverse().transpose();
        for (int k = 0; k < 3; ++k) forces.row(mesh.tets(t, k + 1)) += columns.col(k).transpose();
        forces.row(mesh.tets(t, 0)) -= columns.rowwise().sum().transpose();
    }
    return forces;
}

// The share of the forces of linear elasticity by which those of a displacement eps u from rest differ. Springs do not
// count: they are quadratic, and their centres are placed where they do not pull.
double difference_to_linear(const Material& material, double eps)
{
    test_support::RandomPoints random(72);
    Positions displacement(held.bent.mesh.rest.rows(), 3), gradient, at_rest;
    for (auto row : displacement.rowwise()) row = 0.1 * random.point(1.0).transpose();  // edges are 0.1 m
    pbs::BoneSprings weak = held.springs;
    weak.stiffness *= 1e-12;
    const pbs::BoneHold none(held.bent.mesh, weak, 2);
    const ProjectiveEnergy energy(held.bent.mesh, pbs::projective_weights(material.poisson, material.keeps_volume),
                                  none);
    const Positions moved = held.bent.mesh.rest + eps * displacement;
    energy.value_and_gradient(moved, moved, gradient);
    const Positions linear = linear_forces(displacement, material.poisson);
    return (gradient / eps - linear).norm() / linear.norm();
}

// Weights of 2 mu and 3 lambda. Other weights leave a difference that does not fall with eps; the last case is such a
// mutant.
TEST(ProjectiveDynamics, IsLinearElasticityForSmallStrains)
{
    for (const double poisson : {0.0, 0.3, 0.45}) {
        const double coarse = difference_to_linear({.poisson = poisson}, 1e-3),
                     fine = difference_to_linear({.poisson = poisson}, 1e-4);
        EXPECT_NEAR(std::log10(coarse / fine), 1.0, 0.1) << poisson;
        EXPECT_LT(fine, 1e-2);
    }
    const Material mutant{.poisson = 0.3, .keeps_volume = false};
    EXPECT_GT(difference_to_linear(mutant, 1e-4), 0.1);
    EXPECT_NEAR(difference_to_linear(mutant, 1e-3), difference_to_linear(mutant, 1e-4), 0.01);
}

TEST(ProjectiveDynamics, VolumesAreCloserToRestWithTheirTerm)
{
    const auto volume_change = [](bool keeps_volume) {
        ProjectiveDynamics<double> solver = solver_of({.keeps_volume = keeps_volume}, {.iterations = 100});
        Positions x = held.bent.lbs;
        solver.minimise(held.centres, x);
        return (pbs::tet_volumes(x, held.bent.mesh.tets) - pbs::tet_volumes(held.bent.mesh.rest, held.bent.mesh.tets))
            .cwiseAbs()
            .sum();
    };
    EXPECT_LT(volume_change(true), 0.5 * volume_change(false));
}

TEST(ProjectiveDynamics, BadInputIsRefused)
{
    for (const double poisson : {0.5, -0.1})
        EXPECT_THROW(pbs::projective_weights(poisson, true), pbs::InputError) << poisson;
    pbs::TetMesh inverted = held.bent.mesh;
    std::swap(inverted.tets(4, 0), inverted.tets(4, 1));
    EXPECT_THROW(ProjectiveEnergy(inverted, pbs::projective_weights(0.3, true), held.hold), pbs::InputError);
}

// Reference: the definition of the global step, evaluated with the deformation gradients of a displacement. The energy
// itself is tested in projective_dynamics.cpp.

// Twice the energy of a displacement d, with R and D zero: sum of V0 (2 mu + 3 lambda) |F(d)|^2 and of the springs.
double quadratic_form(const pbs::ProjectiveEnergy& energy, const Positions& d)
{
    double value = 0.0;
    for (Eigen::Index i = 0; i < d.rows(); ++i) value += energy.hold()(i) * d.row(i).squaredNorm();
    for (const pbs::ProjectiveTet& tet : energy.tets()) {
        Eigen::Matrix3d edges;
        for (int k = 0; k < 3; ++k) edges.col(k) = (d.row(tet.vertex[k + 1]) - d.row(tet.vertex[0])).transpose();
        value += tet.volume * (energy.weights().strain + energy.weights().volume) *
                 (edges * tet.inverse_edges).squaredNorm();
        for (int e = 0; e < 6; ++e)
            value +=
                tet.w[e] *
                (d.row(tet.vertex[pbs::edges_of_tet[e][0]]) - d.row(tet.vertex[pbs::edges_of_tet[e][1]])).squaredNorm();
    }
    return value;
}

// The factor that gives the initial guess its weights serves the global step, too. The Laplacian adds 1e-9 of its
// diagonal, whose part of the form is below ten times the form for displacements of independent vertices.
TEST(ProjectiveEnergy, TheLaplacianOfItsShareIsTheMatrixOfTheGlobalStep)
{
    const pbs::TetMesh& mesh = held.bent.mesh;
    const Positions d = test_support::jittered(Positions::Zero(mesh.rest.rows(), 3), 1.0);
    for (const double poisson : {0.0, 0.3, 0.45})
        for (const bool keeps_volume : {true, false}) {
            const pbs::FleshMaterial material = pbs::flesh_material(poisson);
            const ProjectiveEnergy energy = energy_of({poisson, keeps_volume});
            const double share = pbs::volume_share_of_projective(poisson, keeps_volume);
            const Eigen::SparseMatrix<double> lower =
                pbs::flesh_laplacian(mesh, material, pbs::FleshEnergy(mesh, material, held.hold), share);
            const double form = (d.transpose() * (lower.selfadjointView<Eigen::Lower>() * d)).trace(),
                         expected = quadratic_form(energy, d);
            EXPECT_NEAR(form, expected, (10.0 * 1e-9 + test_support::rounding_error(100, 10.0)) * expected)
                << poisson << keeps_volume;
        }
}

TEST(ProjectiveEnergy, ItsWeightsAreLamesConstants)
{
    const double mu = 0.5 / 1.3, lambda = 0.3 / (1.3 * 0.4);
    EXPECT_NEAR(pbs::projective_weights(0.3, true).strain, 2.0 * mu, 1e-15);
    EXPECT_NEAR(pbs::projective_weights(0.3, true).volume, 3.0 * lambda, 1e-15);
    EXPECT_EQ(pbs::projective_weights(0.3, false).volume, 0.0);
    EXPECT_NEAR(pbs::projective_weights(0.0, true).volume, 0.0, 1e-15);
}

// Reference: the conditions of the minimum, and a search over matrices of determinant one.

using pbs::local_shapes;
using pbs::nearest_unit_product;

Vec3 random_stretches(test_support::RandomPoints& random)
{
    Vec3 s(random.number(0.0, 3.0), random.number(0.0, 3.0), random.number(0.0, 3.0));
    std::sort(s.begin(), s.end(), std::greater<>());
    if (random.number(0.0, 1.0) < 0.5) s(2) *= -1.0;
    return s;
}

// The unknown is found to the last digit, and the product of three numbers of its size goes through some ten roundings.
// Where a double root makes it sensitive, its error appears squared in the product.
TEST(VolumeProjection, HasTheProductOneAndOneMultiplier)
{
    test_support::RandomPoints random(61);
    for (int i = 0; i < 2000; ++i) {
        const Vec3 s = random_stretches(random), nearest = nearest_unit_product(s);
        EXPECT_GT(nearest.minCoeff(), 0.0);
        EXPECT_NEAR(nearest.prod(), 1.0,
                    test_support::rounding_error(40, 1.0) * (1.0 + nearest.maxCoeff() / nearest.minCoeff()))
            << s;
        const Vec3 multiplier = nearest.cwiseProduct(nearest - s);  // -kappa, three times
        const double rounding =
            test_support::rounding_error(10, nearest.maxCoeff() * (nearest.maxCoeff() + s.cwiseAbs().maxCoeff()));
        EXPECT_NEAR(multiplier(0), multiplier(2), rounding) << s;
        EXPECT_NEAR(multiplier(1), multiplier(2), rounding) << s;
    }
}

TEST(VolumeProjection, NoOtherNumbersOfProductOneAreNearer)
{
    test_support::RandomPoints random(62);
    for (int i = 0; i < 300; ++i) {
        const Vec3 s = random_stretches(random);
        const double distance = (nearest_unit_product(s) - s).norm();
        for (int other = 0; other < 200; ++other) {
            const double a = std::exp(random.number(-3.0, 3.0)), b = std::exp(random.number(-3.0, 3.0));
            EXPECT_GE((Vec3(a, b, 1.0 / (a * b)) - s).norm(),
                      distance - test_support::rounding_error(40, 1.0 + s.norm()))
                << s;
        }
    }
}

TEST(VolumeProjection, KnownCases)
{
    const double rounding = test_support::rounding_error(20, 1.0);
    for (const double size : {1.0, 0.0, 0.5})  // symmetric; volume zero, too small
        EXPECT_LT((nearest_unit_product({size, size, size}) - Vec3(1, 1, 1)).norm(), rounding) << size;
    // symmetric, volume too large
    EXPECT_LT((nearest_unit_product({1.1, 1.1, 1.1}) - Vec3(1, 1, 1)).norm(), 10 * rounding);
    // of product one already
    EXPECT_LT((nearest_unit_product({2, 1, 0.5}) - Vec3(2, 1, 0.5)).norm(), 10 * rounding);
    EXPECT_LT(std::abs(nearest_unit_product({1, 1, -1}).prod() - 1.0), 10 * rounding);          // a reflection
    EXPECT_LT(std::abs(nearest_unit_product({1e-9, 1e-9, 1e-9}).prod() - 1.0), 10 * rounding);  // collapsed
    // blown up: large over small
    EXPECT_LT(std::abs(nearest_unit_product({1e3, 1e3, 1e3}).prod() - 1.0), 1e-9);
}

TEST(VolumeProjection, OfAMatrixTurnsWithIt)
{
    test_support::RandomPoints random(63);
    for (int i = 0; i < 200; ++i) {
        Eigen::Matrix3d f = Eigen::Matrix3d::Identity();
        for (double& entry : f.reshaped()) entry += random.number(-0.4, 0.4);
        const Eigen::Matrix3d turn = random.rigid_motion(0.0).linear();
        const pbs::LocalShapes here = local_shapes(f), there = local_shapes(turn * f);
        EXPECT_NEAR(here.unit_volume.determinant(), 1.0,
                    test_support::rounding_error(100, here.unit_volume.cwiseAbs().prod() + 6.0));
        EXPECT_LT((there.rotation - turn * here.rotation).norm(), 1e-12);
        EXPECT_LT((there.unit_volume - turn * here.unit_volume).norm(), 1e-12);
    }
}

TEST(VolumeProjection, NotFiniteIsNoShape)
{
    Eigen::Matrix3d f = Eigen::Matrix3d::Identity();
    f(0, 1) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(local_shapes(f).unit_volume.array().isNaN().all());
}

}  // namespace
}  // namespace projective_dynamics_tests
