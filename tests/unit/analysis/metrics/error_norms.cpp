// Reference: closed forms for translations, single vertices and linear maps. Tolerances: moved positions are rounded
// relative to their distance from the origin, and means and roots to their own size.

#include "analysis/metrics/error_norms.hpp"
#include "pbs/geometry/input_error.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/structured_bar.hpp"

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

namespace error_norms_tests {
namespace {

using analysis::ErrorDomain;
using analysis::ErrorMetrics;
using analysis::ErrorNorms;
using pbs::Positions;
using pbs::Vec3;
using test_support::rounding_error;

ErrorDomain bar_domain()
{
    const auto bar = test_support::structured_bar({-1.0, -0.15, -0.15}, {1.0, 0.15, 0.15}, {8, 2, 2});
    return {bar.rest, bar.tets, {}, {}, Eigen::VectorXd::Constant(bar.rest.rows(), 0.1)};
}

const double bar_diagonal = std::sqrt(4.0 + 2.0 * 0.09);

TEST(ErrorNorms, TranslationByKnownDistance)
{
    ErrorDomain domain = bar_domain();
    domain.blended = {0, 5, 7};
    const Eigen::RowVector3d d(0.03, -0.04, 0.12);  // length 0.13
    const ErrorNorms error = ErrorMetrics(domain).measure(domain.rest.rowwise() + d, domain.rest);
    // two of a position, a dozen of the mean of squares
    const double rounding_m = rounding_error(2, 1.2) + rounding_error(12, 0.13);
    EXPECT_NEAR(error.linf_m, 0.13, rounding_m);
    EXPECT_NEAR(error.l2_pct, 100.0 * 0.13 / bar_diagonal, 100.0 * rounding_m / bar_diagonal);
    EXPECT_NEAR(error.joint_pct, 130.0, 100.0 * rounding_m / 0.1);
}

// Two tets of volumes 1/6 and 3/6 on one face: the apex of the large one carries 3/4 of a quarter of the whole.
// Tolerances: some twenty roundings of products and of sums of positive terms.
TEST(ErrorNorms, VerticesWeighByTheirLumpedRestVolume)
{
    const pbs::TetMesh mesh = test_support::two_tets(3.0);
    const ErrorDomain domain{mesh.rest, mesh.tets, {}, {3, 4}, (Eigen::VectorXd(5) << 9, 9, 9, 1.0, 3.0).finished()};
    Positions moved = domain.rest;
    moved(4, 0) += 1.0;
    const ErrorMetrics metrics(domain);
    const ErrorNorms error = metrics.measure(moved, domain.rest);
    const double l2_pct = 100.0 * std::sqrt(0.75 / 4.0) / std::sqrt(18.0),
                 joint_pct = 100.0 * std::sqrt(0.75) / (0.25 * 1.0 + 0.75 * 3.0);
    EXPECT_NEAR(error.l2_pct, l2_pct, rounding_error(20, l2_pct));
    EXPECT_NEAR(error.joint_pct, joint_pct, rounding_error(20, joint_pct));
    EXPECT_NEAR(metrics.share_pct({false, false, false, false, true}), 75.0 / 4.0, rounding_error(20, 75.0 / 4.0));
    EXPECT_NEAR(metrics.share_pct({true, true, true, true, true}), 100.0, rounding_error(20, 100.0));
}

// Two vertices are blended, and the far one is left out: the near one, at 1 m from its bone, has moved by 0.2 m. An
// inverted mask would measure the other, at 3 m, which has not moved.
TEST(ErrorNorms, WhatIsLeftOutOfAFrameCountsInNoNorm)
{
    ErrorDomain domain = bar_domain();
    domain.blended = {3, 4};
    domain.bone_distance_m(3) = 1.0;
    domain.bone_distance_m(4) = 3.0;
    Positions moved = domain.rest;
    moved(3, 1) += 0.2;
    std::vector<bool> left_out(domain.rest.rows(), false);
    left_out[4] = true;
    const ErrorMetrics metrics(domain);
    EXPECT_NEAR(metrics.measure(moved, domain.rest, left_out).joint_pct, 20.0,
                100.0 * rounding_error(2 + 12, 1.2));  // of coordinates within 1.2 m
    left_out[3] = true;
    EXPECT_TRUE(std::isnan(metrics.measure(moved, domain.rest, left_out).joint_pct));
    EXPECT_EQ(metrics.measure(moved, domain.rest, left_out).linf_m, 0.0);
    EXPECT_GT(metrics.measure(moved, domain.rest).linf_m, 0.0);
    EXPECT_THROW(metrics.measure(moved, domain.rest, std::vector<bool>(3)), pbs::InputError);
}

TEST(ErrorNorms, PrescribedVerticesAreLeftOut)
{
    ErrorDomain domain = bar_domain();
    Positions moved = domain.rest;
    moved.row(4) += Eigen::RowVector3d(0.0, 1.0, 0.0);
    EXPECT_NEAR(ErrorMetrics(domain).measure(moved, domain.rest).linf_m, 1.0, rounding_error(2, 1.15));
    domain.blended = {4, 5};
    domain.prescribed.assign(domain.rest.rows(), false);
    domain.prescribed[4] = true;
    const ErrorNorms error = ErrorMetrics(domain).measure(moved, domain.rest);
    for (const double each : {error.linf_m, error.l2_pct, error.joint_pct}) EXPECT_EQ(each, 0.0);
}

TEST(ErrorNorms, NothingToMeasureAndABrokenFrameAreNaN)
{
    ErrorDomain domain = bar_domain(), prescribed = domain;
    EXPECT_TRUE(std::isnan(ErrorMetrics(domain).measure(domain.rest, domain.rest).joint_pct));
    prescribed.prescribed.assign(domain.rest.rows(), true);
    Positions broken = domain.rest;
    broken(3, 1) = std::nan("");
    for (const ErrorNorms& error : {ErrorMetrics(prescribed).measure(domain.rest, domain.rest),
                                    ErrorMetrics(domain).measure(broken, domain.rest)}) {
        EXPECT_TRUE(std::isnan(error.l2_pct));
        EXPECT_TRUE(std::isnan(error.linf_m));
    }
}

TEST(ErrorNorms, RefusesArraysThatDoNotFit)
{
    const ErrorDomain good = bar_domain();
    ErrorDomain of_three = good, out_of_range = good, without_distances = good;
    of_three.prescribed.assign(3, false);
    out_of_range.blended = {static_cast<int>(good.rest.rows())};
    without_distances.blended = {0};
    without_distances.bone_distance_m.resize(0);
    for (const ErrorDomain& bad : {of_three, out_of_range, without_distances})
        EXPECT_THROW(ErrorMetrics{bad}, pbs::InputError);
    EXPECT_THROW(ErrorMetrics(good).measure(good.rest.topRows(2), good.rest), pbs::InputError);
    EXPECT_THROW(ErrorMetrics(good).measure(good.rest, good.rest.topRows(2)), pbs::InputError);
}

// Reference: strains and angles of boxes in closed form.

using analysis::SmoothnessMetrics;
pbs::TetMesh bar()
{
    return test_support::structured_bar({-1.0, -0.5, -0.5}, {1.0, 0.5, 0.5}, {2, 1, 1});
}

SmoothnessMetrics metrics_of(const pbs::TetMesh& mesh)
{
    return {mesh.rest, mesh.tets, std::vector<bool>(mesh.rest.rows(), true)};
}

// The rounding of a jump of strain between Kuhn tets, and more than that of an angle [rad]: six roundings of a
// position, twice in an edge. F is the edges times the inverse of the rest edges, of norm sqrt 5 / cell, which goes
// through a dozen roundings of its own times the condition number sqrt 6 sqrt 5. E has the error |F| dF, and a jump has
// it twice. A normal turns by less.
double jump_error(double farthest_m, double stretch, double cell_m)
{
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

// The right half is stretched along x by s: E_xx = (s^2 - 1) / 2 there, and 0 on the left. Only the faces in the plane
// x = 0 have a jump, so the rms is smaller than it; and the rms is linear in E.
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

// Two tets share a triangle of area 1/2. The apex of the second one is raised: its E_zz is known, and that of the other
// is 0. All numbers are multiples of powers of two, which are not rounded.
TEST(Smoothness, JumpBetweenTwoTets)
{
    const pbs::TetMesh mesh = test_support::two_tets();
    Positions positions = mesh.rest;
    positions(3, 2) = 2.0;
    EXPECT_EQ(metrics_of(mesh).measure(positions).strain_jump_rms, 1.5);
    EXPECT_THROW(SmoothnessMetrics(mesh.rest, mesh.tets, {true}), pbs::InputError) << "a region of another size";
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
    EXPECT_EQ(SmoothnessMetrics(mesh.rest, mesh.tets, std::vector<bool>(mesh.rest.rows(), false))
                  .measure(positions)
                  .strain_jump_rms,
              0.0);
}

// One tet whose apex is rotated by 0.3 about an edge of its base: the change of both dihedral angles is known, and no
// other angle changes.
TEST(Smoothness, BendingOfASkinThatIsTurnedAboutOneEdge)
{
    const pbs::TetMesh mesh{Positions{{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0.5, 0, 1}}, pbs::Tets{{0, 1, 2, 3}}};
    std::vector<bool> edge = {true, true, false, false};
    Positions positions = mesh.rest;
    positions.row(3) << 0.5, std::sin(0.3), std::cos(0.3);
    // Two angles of at most pi, from normals of some ten roundings each.
    EXPECT_NEAR(SmoothnessMetrics(mesh.rest, mesh.tets, edge).measure(positions).bending_rms_rad, 0.3,
                rounding_error(2 * 10, std::numbers::pi));
}

}  // namespace
}  // namespace error_norms_tests
