// Reference: the definition of the global step, evaluated with the deformation gradients of a displacement. The energy itself is tested in
// projective_dynamics.cpp.
#include "pbs/flesh/projective_dynamics.hpp"

#include "pbs/flesh/flesh_energy.hpp"
#include "tests/support/held_bar.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

namespace {

using pbs::Positions;

constexpr int ends_of_edge[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

// Twice the energy of a displacement d, with R and D zero: sum of V0 (2 mu + 3 lambda) |F(d)|^2 and of the springs.
double quadratic_form(const pbs::ProjectiveEnergy& energy, const Positions& d)
{
    double value = 0.0;
    for (Eigen::Index i = 0; i < d.rows(); ++i) value += energy.hold()(i) * d.row(i).squaredNorm();
    for (const pbs::ProjectiveTet& tet : energy.tets()) {
        Eigen::Matrix3d edges;
        for (int k = 0; k < 3; ++k) edges.col(k) = (d.row(tet.vertex[k + 1]) - d.row(tet.vertex[0])).transpose();
        value += tet.volume * (energy.weights().strain + energy.weights().volume) * (edges * tet.inverse_edges).squaredNorm();
        for (int e = 0; e < 6; ++e)
            value += tet.w[e] * (d.row(tet.vertex[ends_of_edge[e][0]]) - d.row(tet.vertex[ends_of_edge[e][1]])).squaredNorm();
    }
    return value;
}

// The factor that gives the initial guess its weights serves the global step, too. The Laplacian adds 1e-9 of its diagonal, whose part of
// the form is below ten times the form for displacements of independent vertices.
TEST(ProjectiveEnergy, TheLaplacianOfItsShareIsTheMatrixOfTheGlobalStep)
{
    const auto bar = test_support::two_bone_limb({8, 2, 2}, pbs::Vec3::UnitZ(), 0.0);
    const pbs::BoneHold hold(bar.mesh, test_support::random_springs(40, 0.3), 2);
    const Positions d = test_support::jittered(Positions::Zero(bar.mesh.rest.rows(), 3), 1.0);
    for (const double poisson : {0.0, 0.3, 0.45})
        for (const bool keeps_volume : {true, false}) {
            const pbs::FleshMaterial material = pbs::flesh_material(poisson);
            const pbs::ProjectiveEnergy energy(bar.mesh, pbs::projective_weights(poisson, keeps_volume), hold);
            const double share = pbs::volume_share_of_projective(poisson, keeps_volume);
            const Eigen::SparseMatrix<double> lower =
                pbs::flesh_laplacian(bar.mesh, material, pbs::FleshEnergy(bar.mesh, material, hold), share);
            const double form = (d.transpose() * (lower.selfadjointView<Eigen::Lower>() * d)).trace(), expected = quadratic_form(energy, d);
            EXPECT_NEAR(form, expected, (10.0 * 1e-9 + test_support::rounding_error(100, 10.0)) * expected) << poisson << keeps_volume;
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

}  // namespace
