// Reference: statics. A particle hangs from three fixed ones by the three edges of a tet; each edge is a spring of
// stiffness 1 / alpha, so at rest
//   sum over edges of n n^T / alpha u = m g,
// for any number of iterations and substeps per step. A multiplier that is forgotten between iterations would stiffen
// it with each. Poisson's ratio 1/4 leaves the volume constraints out. Displacements are 1e-4 of an edge; the neglected
// terms are of second order: the force of a spring of stiffness k neglects k |u|^2 / length times (sin^2 / 2, sin cos)
// of the angle between u and the spring, of its length and of its direction, at most 1 / sqrt 3.
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/solver/xpbd_solver.hpp"
#include "tests/support/hanging_tet.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <cmath>

namespace {

using pbs::Vec3;
using pbs::XpbdOptions;

const test_support::HangingTet tet = test_support::hanging_tet();
constexpr double dt_s = 0.01;

XpbdOptions hanging(int iterations, int substeps, pbs::Order order = pbs::Order::plain, double poisson = 0.25)
{
    return {.young_pa = 1e7,
            .poisson = poisson,
            .density_kg_m3 = 1000.0,
            .iterations = iterations,
            .substeps = substeps,
            .gravity_m_s2 = Vec3(1.0, 2.0, -9.0),
            .jiggle = true,
            .order = order};
}

double volume_m3()
{
    return pbs::tet_volumes(tet.mesh.rest, tet.mesh.tets)(0);
}

Eigen::Matrix3d spring_stiffness_n_m(const XpbdOptions& options)
{
    const double mu = options.young_pa / (2.0 * (1.0 + options.poisson));
    Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();
    for (int other = 0; other < 3; ++other) {
        const Vec3 edge = tet.mesh.rest.row(3) - tet.mesh.rest.row(other);
        stiffness +=
            15.0 * mu * (volume_m3() / 6.0) / edge.squaredNorm() * edge.normalized() * edge.normalized().transpose();
    }
    return stiffness;
}

// The springs, and the bulk modulus that the edges lack, K - 5/3 mu, times the outer product of the volume's gradient,
// over the volume. The volume is linear in the position of the free vertex. With Poisson's ratio 1/4 the edges lack
// nothing.
Eigen::Matrix3d stiffness_n_m(const XpbdOptions& options)
{
    const double bulk = options.young_pa / (3.0 * (1.0 - 2.0 * options.poisson)),
                 mu = options.young_pa / (2.0 * (1.0 + options.poisson));
    const Vec3 a = tet.mesh.rest.row(0), b = tet.mesh.rest.row(1), c = tet.mesh.rest.row(2);
    const Vec3 gradient = (b - a).cross(c - a) / 6.0;
    return spring_stiffness_n_m(options) + (bulk - 5.0 / 3.0 * mu) / volume_m3() * gradient * gradient.transpose();
}

Vec3 static_displacement(const XpbdOptions& options)
{
    return stiffness_n_m(options).inverse() * (options.density_kg_m3 * volume_m3() / 4.0 * options.gravity_m_s2);
}

// The displacement of the free vertex [m] after four thousand steps.
Vec3 hung(const XpbdOptions& options)
{
    pbs::XpbdSolver solver(tet.mesh, {}, tet.free, options, tet.held);
    for (int step = 0; step < 4000; ++step) solver.advance(tet.mesh.rest, tet.mesh.rest, dt_s);
    return solver.positions().row(3) - tet.mesh.rest.row(3);
}

class XpbdAtRest : public testing::TestWithParam<std::tuple<std::pair<int, int>, pbs::Order, double>> {};

TEST_P(XpbdAtRest, HangsAsSpringsDo)
{
    const auto& [counts, order, poisson] = GetParam();
    const XpbdOptions options = hanging(counts.first, counts.second, order, poisson);
    const Vec3 expected = static_displacement(options);
    ASSERT_GT(expected.norm(), 1e-6);
    ASSERT_LT(expected.norm(), 1e-3);
    const Eigen::Matrix3d stiffness = stiffness_n_m(options);
    const double springs_n_m = spring_stiffness_n_m(options).trace();  // their sum
    const double shortest_m = (tet.mesh.rest.topRows(3).rowwise() - tet.mesh.rest.row(3)).rowwise().norm().minCoeff();
    const double error_m =
        stiffness.inverse().norm() * springs_n_m * expected.squaredNorm() / (std::sqrt(3.0) * shortest_m);
    EXPECT_LT((hung(options) - expected).norm(), error_m);
}

// A particle falls by g h^2 before the constraints pull it back, and their gradients turn meanwhile. The parts that a
// multiplier has added along earlier gradients remain. They depend on the sequence of the edges and are proportional to
// h^2, so ten substeps leave a hundredth. With Poisson's ratio 0.4 there are volume constraints.
INSTANTIATE_TEST_SUITE_P(OfOrdersAndVolume, XpbdAtRest,
                         testing::Values(std::tuple{std::pair{10, 1}, pbs::Order::plain, 0.25},
                                         std::tuple{std::pair{100, 1}, pbs::Order::plain, 0.25},
                                         std::tuple{std::pair{10, 10}, pbs::Order::plain, 0.25},
                                         std::tuple{std::pair{10, 10}, pbs::Order::ordered, 0.25},
                                         std::tuple{std::pair{10, 10}, pbs::Order::plain, 0.4},
                                         std::tuple{std::pair{10, 10}, pbs::Order::ordered, 0.4},
                                         std::tuple{std::pair{10, 10}, pbs::Order::spread, 0.4}));

// One iteration per substep does not solve the substep; the error falls with its length.
TEST(XpbdAtRestWithSmallSteps, ConvergesWithTheSubsteps)
{
    const auto error = [](int substeps) {
        const Vec3 expected = static_displacement(hanging(1, substeps));
        return (hung(hanging(1, substeps)) - expected).norm() / expected.norm();
    };
    const double ten = error(10), hundred = error(100);
    EXPECT_LT(ten, 0.1);
    EXPECT_LT(hundred, ten / 10.0);
}

}  // namespace
