// Reference: volumes in closed form, and the topology of a ball. Tolerances: the roundings of tets' volumes and of their sum. Where
// coordinates are multiples of 1/2 a volume is rounded once, by its division by 6.

#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"
#include "reference_fem/verification/problems.hpp"
#include "tests/support/volume_rounding.hpp"

#include <gtest/gtest.h>

namespace {

using namespace reference_fem;
using pbs::Vec3;
using test_support::rounding_error;

double lowest_volume(const pbs::TetMesh& mesh)
{
    return pbs::tet_volumes(mesh.rest, mesh.tets).minCoeff();
}

double volume(const pbs::TetMesh& mesh)
{
    return pbs::tet_volumes(mesh.rest, mesh.tets).sum();
}

void expect_ball(const pbs::TetMesh& mesh)
{
    const pbs::Topology topology = pbs::topology_of(mesh.tets, mesh.rest.rows());
    EXPECT_TRUE(topology.boundary_manifold);
    EXPECT_EQ(topology.boundary_components, 1);
    EXPECT_EQ(topology.boundary_euler, 2);
    EXPECT_EQ(topology.unused_vertices, 0);
}

TEST(StructuredMesh, ABoxIsFilledByEqualTets)
{
    const pbs::TetMesh box = box_mesh({0, -1, 2}, {3, 1, 3}, {3, 2, 2});
    EXPECT_EQ(box.tets.rows(), 6 * 12);
    EXPECT_NEAR(volume(box), 6.0, rounding_error(1 + 6 * 12, 6.0));
    EXPECT_EQ(lowest_volume(box), 0.5 / 6.0);
    expect_ball(box);
    EXPECT_EQ(text_of({3, 2, 2}), "3 x 2 x 2");
}

TEST(StructuredMesh, JitterMovesInnerVerticesOnly)
{
    const pbs::TetMesh even = jittered_cube(4, 0.0), moved = jittered_cube(4, 0.45);
    EXPECT_GT(lowest_volume(moved), 0.0);
    EXPECT_NEAR(volume(moved), 1.0, test_support::volume_error(moved.rest, moved.tets));
    const std::vector<bool> on_boundary = pbs::boundary_vertices(even.tets, even.rest.rows());
    for (Eigen::Index v = 0; v < even.rest.rows(); ++v) EXPECT_EQ(even.rest.row(v) == moved.rest.row(v), on_boundary[v]);
}

TEST(StructuredMesh, AMirroredMeshIsTurnedRightSideOut)
{
    const pbs::TetMesh mirrored = mapped(box_mesh({0, 0, 0}, {1, 1, 1}, {2, 2, 2}), [](const Vec3& p) -> Vec3 {
        return {-p.x(), p.y(), p.z()};
    });
    EXPECT_GT(lowest_volume(mirrored), 0.0);
}

TEST(StructuredMesh, JoinedBoxesShareTheirVertices)
{
    const pbs::TetMesh whole = joined({box_mesh({0, 0, 0}, {1, 1, 1}, {2, 2, 2}), box_mesh({1, 0, 0}, {2, 1, 1}, {2, 2, 2})});
    EXPECT_EQ(whole.rest.rows(), 5 * 3 * 3);
    EXPECT_NEAR(volume(whole), 2.0, rounding_error(1 + 2 * 6 * 8, 2.0));
    expect_ball(whole);
}

// Reference: beam theory. A slender beam follows Bernoulli and Euler, and the reduction by shear and rotary inertia is proportional to (h /
// L)^2.

double share_of_shear(double length_m)
{
    const Beam beam{length_m, 0.1, 1e5, 0.3, 1000.0};
    return 1.0 - timoshenko_rad_s(beam) / bernoulli_euler_rad_s(beam);
}

// Rayleigh's quotient over the Bernoulli-Euler mode lowers omega^2 by a factor of 1 + 2 s with s = 4.647 (r / L)^2 (1 + E / (k G)) / 2.
double first_order_share(double length_m)
{
    const double nu = 0.3, r_over_l = std::sqrt(1.0 / 12.0) * 0.1 / length_m;
    return 4.647 * r_over_l * r_over_l * (1.0 + (12.0 + 11.0 * nu) / 5.0) / 2.0;
}

// At 20 to 100 times the height. The mode itself changes by s, which changes the quotient by s^2; 4.647 has half a unit of its last digit.
TEST(BeamFrequency, IsLoweredByRotaryInertiaAndShear)
{
    for (const double length_m : {2.0, 4.0, 10.0}) {
        const double s = first_order_share(length_m);
        EXPECT_NEAR(share_of_shear(length_m), 1.0 - 1.0 / std::sqrt(1.0 + 2.0 * s), s * s + 0.0005 / 4.647 * s);
    }
}

// Factors of powers of two change no digit.
TEST(BeamFrequency, ScalesAsTheRootOfYoungsModulusOverDensity)
{
    const Beam beam{1.0, 0.1, 1e5, 0.3, 1000.0}, stiff{1.0, 0.1, 4e5, 0.3, 1000.0}, heavy{1.0, 0.1, 1e5, 0.3, 4000.0};
    EXPECT_EQ(timoshenko_rad_s(stiff), 2.0 * timoshenko_rad_s(beam));
    EXPECT_EQ(timoshenko_rad_s(heavy), 0.5 * timoshenko_rad_s(beam));
}

TEST(BeamFrequency, OfBernoulliAndEulerIsAsPrinted)
{
    // Blevins, Formulas for natural frequency and mode shape, 1979, table 8-1: f = 1.87510407^2 / (2 pi L^2) sqrt(E I / m). The
    // printed root is rounded by half a unit of its last digit, which changes its square by twice the root times as much.
    const double root = 1.87510407, half_a_unit = 0.5e-8, scale = std::sqrt(1e5 * 1e-4 / 12.0 / (1000.0 * 1e-2));
    EXPECT_NEAR(bernoulli_euler_rad_s({1.0, 0.1, 1e5, 0.0, 1000.0}), root * root * scale, 2.0 * root * half_a_unit * scale);
}

}  // namespace
