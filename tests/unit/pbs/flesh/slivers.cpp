// Reference: the same bar without the sliver, whose volume is 1e-9 of that of a tet, so that the minimum does not depend on it.
#include "pbs/flesh/projective_dynamics.hpp"
#include "pbs/flesh/quasi_newton.hpp"
#include "pbs/flesh/vbd.hpp"
#include "pbs/geometry/topology.hpp"
#include "tests/support/held_bar.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

const test_support::HeldBar bar_of_slivers({12, 3, 3});
constexpr double regular_flatness = 0.1178511301977579;  // 1 / (6 sqrt 2)

// The bar with a further vertex above a face of its boundary next to the joint: a tet of this volume over its longest edge cubed.
test_support::HeldBar with_sliver(double flatness)
{
    const pbs::TetMesh& whole = bar_of_slivers.bent.mesh;
    const pbs::Positions& rest = whole.rest;
    const pbs::Triangles boundary = pbs::boundary_of(whole.tets);
    Eigen::Index nearest = 0;
    double least = 1e9;
    for (Eigen::Index f = 0; f < boundary.rows(); ++f) {
        const double distance = std::abs(rest(boundary.row(f), 0).sum() / 3.0 - 0.05);
        if (distance < least) least = distance, nearest = f;
    }
    const pbs::Vec3 a = rest.row(boundary(nearest, 0)), b = rest.row(boundary(nearest, 1)), c = rest.row(boundary(nearest, 2));
    const pbs::Vec3 outward = (b - a).cross(c - a);  // twice the area long
    const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    const double height = 6.0 * flatness * std::pow(longest, 3) / outward.norm();
    pbs::TetMesh mesh{pbs::Positions(rest.rows() + 1, 3), pbs::Tets(whole.tets.rows() + 1, 4)};
    mesh.rest << rest, ((a + b + c) / 3.0 + height * outward.normalized()).transpose();
    mesh.tets << whole.tets, boundary.row(nearest), static_cast<int>(rest.rows());
    test_support::TwoBoneLimb limb = test_support::two_bones_in(mesh);
    test_support::pose_limb(limb, bar_of_slivers.bent.pose);
    return test_support::HeldBar(limb, bar_of_slivers.springs);
}

// The norm of the difference at the vertices that the two bars share, divided by that of the displacement from rest.
double difference(const pbs::Positions& with, const pbs::Positions& without)
{
    return (with.topRows(without.rows()) - without).norm() / (without - bar_of_slivers.bent.mesh.rest).norm();
}

template <typename Scalar>
pbs::Positions by_quasi_newton(const test_support::HeldBar& bar, int iterations)
{
    const pbs::HeldFlesh flesh(bar.bent.mesh, bar.springs, 2, {});
    pbs::Positions x = bar.bent.lbs;
    pbs::QuasiNewton<Scalar>(bar.bent.mesh, bar.energy, flesh.factor(), {.iterations = iterations}).minimise(bar.centres, x);
    return x;
}

template <typename Scalar>
pbs::Positions by_vertices(const test_support::HeldBar& bar, int iterations)
{
    pbs::Positions x = bar.bent.lbs;
    pbs::VertexBlockDescent<Scalar>(bar.bent.mesh, bar.energy, {.iterations = iterations}).minimise(bar.centres, x);
    return x;
}

pbs::Positions by_projections(const test_support::HeldBar& bar, int iterations)
{
    const pbs::HeldFlesh flesh(bar.bent.mesh, bar.springs, 2,
                               {.poisson = 0.45, .volume_share = pbs::volume_share_of_projective(0.45, true)});
    const pbs::ProjectiveEnergy energy(bar.bent.mesh, pbs::projective_weights(0.45, true), bar.hold);
    pbs::Positions x = bar.bent.lbs;
    pbs::ProjectiveDynamics<double>(bar.bent.mesh, energy, flesh.factor(), {.iterations = iterations}).minimise(bar.centres, x);
    return x;
}

TEST(Slivers, AreAsStiffAsRegularTetsAndOthersKeepTheirStiffness)
{
    EXPECT_EQ(bar_of_slivers.energy.slivers(), 0);
    for (const double flatness : {2e-5, 0.9e-5, 7e-10}) {
        const test_support::HeldBar bar = with_sliver(flatness);
        const Eigen::Index last = bar.bent.mesh.tets.rows() - 1;
        const double expected = flatness < 1e-5 ? flatness / regular_flatness : 1.0;
        EXPECT_NEAR(pbs::sliver_factor(bar.bent.mesh, last), expected, 1e-5 * expected);  // the height has five digits next to the places
        EXPECT_EQ(pbs::sliver_factor(bar.bent.mesh, 0), 1.0);
        EXPECT_EQ(bar.energy.slivers(), flatness < 1e-5);
        for (std::size_t t = 0; t + 1 < bar.energy.tets().size(); ++t) {
            EXPECT_EQ(bar.energy.tets()[t].w, bar_of_slivers.energy.tets()[t].w) << t;
            EXPECT_EQ(bar.energy.tets()[t].kappa, bar_of_slivers.energy.tets()[t].kappa) << t;
        }
    }
}

TEST(Slivers, DoNotMoveTheMinimum)
{
    for (const double flatness : {1e-6, 7e-10}) {
        const test_support::HeldBar bar = with_sliver(flatness);
        EXPECT_LT(difference(by_quasi_newton<double>(bar, 300), by_quasi_newton<double>(bar_of_slivers, 300)), 1e-4) << flatness;
        EXPECT_LT(difference(by_vertices<double>(bar, 600), by_vertices<double>(bar_of_slivers, 600)), 1e-4) << flatness;
        EXPECT_LT(difference(by_projections(bar, 1200), by_projections(bar_of_slivers, 1200)), 1e-4) << flatness;
    }
}

TEST(Slivers, AreTurnedWithinTheUsualIterations)
{
    const test_support::HeldBar bar = with_sliver(7e-10);
    EXPECT_LT(difference(by_quasi_newton<float>(bar, 24), by_quasi_newton<float>(bar_of_slivers, 24)), 1e-3);
    EXPECT_LT(difference(by_vertices<float>(bar, 64), by_vertices<float>(bar_of_slivers, 64)), 1e-3);
}

}  // namespace
