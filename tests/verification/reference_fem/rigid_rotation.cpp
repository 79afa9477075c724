// Reference: theory. Linear strain interprets the rotation x -> R x by theta as the strain (R + R^T) / 2 - I, which is cos(theta) - 1
// across the axis: a fictitious stress. This is why the linear reference is only a negative control beyond some 10 degrees, and how large
// its error is.
#include "reference_fem/linear_elasticity.hpp"

#include "pbs/geometry/tet_mesh.hpp"
#include "tests/verification/reference_fem/jittered_cube.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <limits>
#include <numeric>

namespace {

using namespace reference_fem;
using pbs::Positions;
using pbs::Vec3;

const LinearOptions options{.element_order = 1, .young_pa = 1e5, .poisson = 0.3};

pbs::TetMesh bar(int cells_across)
{
    return test_support::structured_bar({-2, -0.25, -0.25}, {2, 0.25, 0.25}, {8 * cells_across, cells_across, cells_across});
}

Positions rotated(const Positions& points, double angle)
{
    return points * Eigen::AngleAxisd(angle, Vec3::UnitX()).toRotationMatrix().transpose();
}

class RigidRotation : public testing::TestWithParam<double> {};

// All tets are prescribed: the map is x -> R x, its volume is correct, its stress is fictitious: V (2 lambda + 2 mu) (1 - cos theta)^2.
TEST_P(RigidRotation, StoresFictitiousEnergy)
{
    const double angle = GetParam() * std::acos(-1.0) / 180.0;
    const pbs::TetMesh mesh = bar(2);
    std::vector<int> all(mesh.tets.rows());
    std::iota(all.begin(), all.end(), 0);
    for (const int order : {1, 2}) {
        LinearOptions of_order = options;
        of_order.element_order = order;
        LinearElasticity fem(mesh, of_order, {Positions(0, 3), {}, all});
        ASSERT_TRUE(fem.solve(Positions(0, 3), rotated(mesh.rest, angle)).finite);
        // Positions are the sum of the rest and a difference from it: two roundings each.
        constexpr double eps = std::numeric_limits<double>::epsilon();
        EXPECT_LT((fem.positions() - rotated(mesh.rest, angle)).norm(), 2.0 * eps * mesh.rest.norm());
        const double lambda_plus_mu = options.young_pa / (2.0 * (1.0 + options.poisson) * (1.0 - 2.0 * options.poisson));
        const double strain = 1.0 - std::cos(angle), volume = pbs::tet_volumes(mesh.rest, mesh.tets).sum();
        const double energy = volume * 2.0 * lambda_plus_mu * strain * strain;
        EXPECT_GT(energy, 0.0);
        // Each component of the gradient sums ten nodes' displacements, in error by eps times their 2 m, over at least a quarter of a cell
        // of 0.25 m. The energy is quadratic in the strain, which that error is relative to.
        const double of_gradient = std::sqrt(10.0) * eps * 2.0 / (0.25 / 4.0);
        EXPECT_NEAR(fem.strain_energy_j(), energy, 2.0 * of_gradient / strain * energy);
    }
}

// Both ends are turned equally, and the rest is free. Far from the ends the flesh loses the fictitious strain and keeps only the skew part
// of R, so F = I + sin(theta) J and the volume ratio is 1 + sin^2(theta) instead of 1. The effect of the compressed ends on the middle:
// they are compressed by 1 - cos(theta) over about a width w and tend to lengthen by at most that strain, which the length L shares between
// two fixed ends: below (1 - cos(theta)) w / L. (The rest of their influence decays like exp(-4 s / w) with the distance s.)
TEST_P(RigidRotation, SwellsFreeFleshBySineSquared)
{
    const double angle = GetParam() * std::acos(-1.0) / 180.0;
    const pbs::TetMesh mesh = bar(4);
    Attachment ends{Positions(0, 3), {}, {}};
    std::vector<int> middle;
    for (int t = 0; t < mesh.tets.rows(); ++t) {
        double nearest = 1e9, farthest = 0.0;
        for (const int v : mesh.tets.row(t)) {
            nearest = std::min(nearest, std::abs(mesh.rest(v, 0)));
            farthest = std::max(farthest, std::abs(mesh.rest(v, 0)));
        }
        if (nearest > 1.85) ends.prescribed_tets.push_back(t);
        if (farthest < 0.15) middle.push_back(t);
    }
    LinearElasticity fem(mesh, options, ends);
    ASSERT_TRUE(fem.solve(Positions(0, 3), rotated(mesh.rest, angle)).finite);
    const Eigen::VectorXd ratio = pbs::tet_volumes(fem.positions(), mesh.tets).cwiseQuotient(pbs::tet_volumes(mesh.rest, mesh.tets));
    const double sine = std::sin(angle), strain = 1.0 - std::cos(angle);
    ASSERT_FALSE(middle.empty());
    for (const int t : middle) EXPECT_NEAR(ratio(t), 1.0 + sine * sine, strain * 0.5 / 4.0) << "tet " << t;
}

INSTANTIATE_TEST_SUITE_P(Degrees, RigidRotation, testing::Values(1.0, 10.0, 45.0));

}  // namespace
