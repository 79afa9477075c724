// Reference: strains and angles of boxes in closed form.
#include "analysis/smoothness.hpp"

#include "pbs/geometry/input_error.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/structured_bar.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

namespace {

using analysis::SmoothnessMetrics;
using pbs::Positions;
using pbs::Vec3;

pbs::TetMesh bar()
{
    return test_support::structured_bar({-1.0, -0.5, -0.5}, {1.0, 0.5, 0.5}, {2, 1, 1});
}

SmoothnessMetrics metrics_of(const pbs::TetMesh& mesh)
{
    return {mesh.rest, mesh.tets, std::vector<bool>(mesh.rest.rows(), true)};
}

// The rounding of a jump of strain between Kuhn tets, and more than that of an angle [rad]: six roundings of a position, twice in an edge.
// F is the edges times the inverse of the rest edges, of norm sqrt 5 / cell, which goes through a dozen roundings of its own times the
// condition number sqrt 6 sqrt 5. E has the error |F| dF, and a jump has it twice. A normal turns by less.
double jump_error(double farthest_m, double stretch, double cell_m)
{
    using test_support::rounding_error;
    const double of_edges = 2.0 * std::sqrt(3.0) * rounding_error(6, farthest_m);
    const double of_gradient = of_edges * std::sqrt(5.0) / cell_m + rounding_error(12 + 3, std::sqrt(30.0) * stretch);
    return 2.0 * std::sqrt(3.0) * stretch * of_gradient;
}

TEST(Smoothness, RestRigidMotionAndUniformStretchAreSmooth)
{
    const pbs::TetMesh mesh = bar();
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.2, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    const Positions turned = (mesh.rest * turn.transpose()).rowwise() + Vec3(4, 5, 6).transpose();
    const Positions stretched = mesh.rest * Vec3(1.5, 1.5, 1.5).asDiagonal();
    for (const Positions& positions : std::vector<Positions>{mesh.rest, turned, stretched}) {
        const auto smoothness = metrics_of(mesh).measure(positions);
        EXPECT_NEAR(smoothness.strain_jump_rms, 0.0, jump_error(10.0, 1.5, 1.0));
        EXPECT_NEAR(smoothness.bending_rms_rad, 0.0, jump_error(10.0, 1.5, 1.0));
    }
}

// The right half is stretched along x by s: E_xx = (s^2 - 1) / 2 there, and 0 on the left. Only the faces in the plane x = 0 have a jump,
// so the rms is smaller than it; and the rms is linear in E.
TEST(Smoothness, JumpOfStrainAcrossAPlane)
{
    const pbs::TetMesh mesh = bar();
    Positions positions = mesh.rest;
    const double s = 1.6, strain = 0.5 * (s * s - 1.0);
    for (Eigen::Index v = 0; v < positions.rows(); ++v)
        if (positions(v, 0) > 0.0) positions(v, 0) *= s;
    const double jump = metrics_of(mesh).measure(positions).strain_jump_rms;
    Positions twice = positions;
    for (Eigen::Index v = 0; v < twice.rows(); ++v)
        if (mesh.rest(v, 0) > 0.0) twice(v, 0) = mesh.rest(v, 0) * std::sqrt(1.0 + 4.0 * strain);
    EXPECT_GT(jump, 0.0);
    EXPECT_LT(jump, strain);
    EXPECT_NEAR(metrics_of(mesh).measure(twice).strain_jump_rms, 2.0 * jump, 3.0 * jump_error(2.2, 2.1, 1.0));
}

// Two tets share a triangle of area 1/2. The apex of the second one is raised: its E_zz is known, and that of the other is 0. All numbers
// are multiples of powers of two, which are not rounded.
TEST(Smoothness, JumpBetweenTwoTets)
{
    pbs::TetMesh mesh;
    mesh.rest.resize(5, 3);
    mesh.rest << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1;
    mesh.tets.resize(2, 4);
    mesh.tets << 0, 1, 2, 3, 0, 2, 1, 4;
    Positions positions = mesh.rest;
    positions(3, 2) = 2.0;
    EXPECT_EQ(metrics_of(mesh).measure(positions).strain_jump_rms, 1.5);
}

// The right end is sheared off. A region that it does not touch is smooth, and so is one without vertices.
TEST(Smoothness, OnlyTheRegionIsMeasured)
{
    const pbs::TetMesh mesh = test_support::structured_bar({-1.0, -0.5, -0.5}, {1.0, 0.5, 0.5}, {4, 1, 1});
    Positions positions = mesh.rest;
    std::vector<bool> left(mesh.rest.rows());
    for (Eigen::Index v = 0; v < positions.rows(); ++v) {
        left[v] = mesh.rest(v, 0) < -0.2;
        if (mesh.rest(v, 0) > 0.9) positions(v, 1) += 0.7;
    }
    EXPECT_GT(metrics_of(mesh).measure(positions).strain_jump_rms, 0.1);
    EXPECT_GT(metrics_of(mesh).measure(positions).bending_rms_rad, 0.1);
    const auto of_left = SmoothnessMetrics(mesh.rest, mesh.tets, left).measure(positions);
    EXPECT_NEAR(of_left.strain_jump_rms, 0.0, jump_error(1.3, 1.0, 0.5));
    EXPECT_EQ(of_left.bending_rms_rad, 0.0);  // equal angles
    EXPECT_EQ(SmoothnessMetrics(mesh.rest, mesh.tets, std::vector<bool>(mesh.rest.rows(), false)).measure(positions).strain_jump_rms, 0.0);
}

// One tet whose apex is rotated by 0.3 about an edge of its base: the change of both dihedral angles is known, and no other angle changes.
TEST(Smoothness, BendingOfASkinThatIsTurnedAboutOneEdge)
{
    pbs::TetMesh mesh;
    mesh.rest.resize(4, 3);
    mesh.rest << 0, 0, 0, 1, 0, 0, 0.5, 1, 0, 0.5, 0, 1;
    mesh.tets.resize(1, 4);
    mesh.tets << 0, 1, 2, 3;
    std::vector<bool> edge = {true, true, false, false};
    Positions positions = mesh.rest;
    positions.row(3) << 0.5, std::sin(0.3), std::cos(0.3);
    // Two angles of at most pi, from normals of some ten roundings each.
    EXPECT_NEAR(SmoothnessMetrics(mesh.rest, mesh.tets, edge).measure(positions).bending_rms_rad, 0.3,
                test_support::rounding_error(2 * 10, std::numbers::pi));
}

TEST(Smoothness, RegionOfAnotherSizeIsRefused)
{
    const pbs::TetMesh mesh = bar();
    EXPECT_THROW(SmoothnessMetrics(mesh.rest, mesh.tets, {true}), pbs::InputError);
}

}  // namespace
