// Reference: volumes of cubes whose corners are whole numbers, so that nothing is rounded but by the division by 6.

#include "analysis/metrics/closed_shells.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using analysis::ClosedShells;
using analysis::ShellRole;
using test_support::rounding_error;

struct Surface {
    pbs::Positions points = pbs::Positions(0, 3);
    pbs::Triangles triangles = pbs::Triangles(0, 3);

    Surface& add(const Surface& other)
    {
        const Eigen::Index first_point = points.rows(), first_triangle = triangles.rows();
        points.conservativeResize(first_point + other.points.rows(), 3);
        points.bottomRows(other.points.rows()) = other.points;
        triangles.conservativeResize(first_triangle + other.triangles.rows(), 3);
        triangles.bottomRows(other.triangles.rows()) = other.triangles.array() + static_cast<int>(first_point);
        return *this;
    }
};

// A cube of an edge, with its lowest corner at `low`; corner 4 x + 2 y + z. Twelve triangles that face outward, or
// inward.
Surface cube(const pbs::Vec3& low, double edge, bool inward = false)
{
    Surface surface;
    surface.points.resize(8, 3);
    for (int corner = 0; corner < 8; ++corner)
        surface.points.row(corner) =
            low.transpose() + edge * Eigen::RowVector3d(corner / 4, corner / 2 % 2, corner % 2);
    surface.triangles.resize(12, 3);
    surface.triangles << 0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1, 2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 5,
        7, 1, 7, 3;
    if (inward) surface.triangles.col(1).swap(surface.triangles.col(2));
    return surface;
}

// Each triangle with three points of its own, as along seams of hard edges.
Surface with_seams(const Surface& surface)
{
    Surface split;
    split.points = surface.points(surface.triangles.reshaped<Eigen::RowMajor>(), Eigen::all);
    split.triangles.resize(surface.triangles.rows(), 3);
    for (int f = 0; f < split.triangles.rows(); ++f) split.triangles.row(f) << 3 * f, 3 * f + 1, 3 * f + 2;
    return split;
}

ClosedShells shells_of(const Surface& surface)
{
    return {surface.points, surface.triangles};
}

void expect_volumes(const Surface& surface, const std::vector<double>& expected_m3)
{
    const ClosedShells shells = shells_of(surface);
    const Eigen::VectorXd volumes_m3 = shells.volumes(surface.points);
    ASSERT_EQ(volumes_m3.size(), std::ssize(expected_m3));
    for (std::size_t s = 0; s < expected_m3.size(); ++s) {
        const double tolerance_m3 = rounding_error(12, std::abs(expected_m3[s]));
        EXPECT_NEAR(volumes_m3(s), expected_m3[s], tolerance_m3);
        EXPECT_NEAR(shells.all()[static_cast<std::size_t>(shells.counted()[s])].volume_m3, expected_m3[s],
                    tolerance_m3);
    }
}

TEST(ClosedShells, ACubeWithAndWithoutSeamsAndFarFromTheOrigin)
{
    expect_volumes(cube({0, 0, 0}, 2), {8});
    expect_volumes(with_seams(cube({0, 0, 0}, 2)), {8});
    expect_volumes(with_seams(cube({1048576, 4194304, -1048576}, 2)), {8});
}

// The joined cube lacks up to the shift on each of its faces: 6 faces of 4 m^2.
TEST(ClosedShells, ASeamWithARoundingInItIsJoinedAndAWiderOneIsOpen)
{
    Surface surface = with_seams(cube({0, 0, 0}, 2));
    const pbs::Positions exact = surface.points;
    for (const double shift_m : {1e-7, 1e-3}) {
        for (Eigen::Index p = 0; p < exact.rows(); ++p)
            surface.points.row(p) = exact.row(p).array() + shift_m * std::sin(7.0 * static_cast<double>(p));
        const ClosedShells shells = shells_of(surface);
        ASSERT_EQ(shells.counted().size(), shift_m == 1e-7 ? 1u : 0u);
        if (shells.counted().empty()) continue;
        EXPECT_NEAR(shells.volumes(surface.points)(0), 8.0, 24.0 * shift_m);
        EXPECT_GT(shells.largest_gap_m(surface.points), 0.0);
    }
}

// A cube of 2 m without the face at x = 2 m, whose triangles have the corners 4 to 7. Its cap is that face of 4 m^2.
TEST(ClosedShells, AHoleIsCapped)
{
    Surface surface = cube({0, 0, 0}, 2);
    std::vector<int> kept;
    for (int f = 0; f < surface.triangles.rows(); ++f)
        if (surface.triangles.row(f).minCoeff() < 4) kept.push_back(f);
    surface.triangles = pbs::Triangles(surface.triangles(kept, Eigen::all));
    EXPECT_TRUE(shells_of(surface).counted().empty()) << "without caps";
    const ClosedShells shells(surface.points, surface.triangles, analysis::Holes::cap);
    ASSERT_EQ(shells.counted().size(), 1u);
    EXPECT_NEAR(shells.volumes(surface.points)(0), 8.0, rounding_error(16, 8.0));
    EXPECT_DOUBLE_EQ(shells.counted_share(), 1.0);

    pbs::Positions moved = surface.points;
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.0, pbs::Vec3(1, 2, 3).normalized()).toRotationMatrix();
    moved = (moved * turn.transpose()).rowwise() + Eigen::RowVector3d(3, 4, 5);
    EXPECT_NEAR(shells.volumes(moved)(0), 8.0, 1e-13);
    EXPECT_NEAR(shells.cap_bound_m3(moved), 0.0, 1e-13) << "a rigid rim";
    pbs::Positions wider = surface.points;
    // the rim about its middle
    wider.bottomRows(4).rightCols(2) = (1.5 * (wider.bottomRows(4).rightCols(2).array() - 1.0) + 1.0).matrix();
    EXPECT_NEAR(shells.cap_bound_m3(wider), 9.0 * 0.5 * std::sqrt(2.0), 1e-12)
        << "a cap of 9 m^2 whose corners have moved by 0.5 (1, 1) m";
    surface.triangles = surface.triangles.topRows(2).eval();
    EXPECT_TRUE(ClosedShells(surface.points, surface.triangles, analysis::Holes::cap).counted().empty()) << "a sheet";
}

TEST(ClosedShells, ACavityIsSubtractedAndANestedBodyAdded)
{
    for (const auto& [inward, is_inside_out] : {std::pair(true, false), {false, false}, {true, true}, {false, true}}) {
        Surface surface = cube({0, 0, 0}, 4);
        surface.add(cube({1, 1, 1}, 2, inward)).add(cube({10, 0, 0}, 1));
        if (is_inside_out) surface.triangles.col(1).swap(surface.triangles.col(2));
        expect_volumes(surface, {64, inward ? -8.0 : 8.0, 1});
        const ClosedShells shells = shells_of(surface);
        EXPECT_EQ(shells.all()[0].role, ShellRole::body);
        EXPECT_EQ(shells.all()[1].role, inward ? ShellRole::cavity : ShellRole::nested);
        EXPECT_EQ(shells.all()[1].inside, 0);
        EXPECT_EQ(shells.all()[2].role, ShellRole::body);
        EXPECT_EQ(shells.counted_share(), 1.0);
    }
}

TEST(ClosedShells, ABodyWithinACavityIsABodyWhicheverWayItFaces)
{
    for (const bool inward : {true, false}) {
        Surface surface = cube({3, 3, 3}, 1, inward);
        surface.add(cube({0, 0, 0}, 8)).add(cube({2, 2, 2}, 4, true));
        expect_volumes(surface, {1, 512, -64});
        EXPECT_EQ(shells_of(surface).all()[0].role, ShellRole::body);
    }
}

TEST(ClosedShells, WhatIsInsideOutOrFacesBothWaysIsTurned)
{
    expect_volumes(cube({0, 0, 0}, 2, true), {8});
    EXPECT_EQ(shells_of(cube({0, 0, 0}, 2, true)).all()[0].turned, 12);
    Surface mixed = with_seams(cube({0, 0, 0}, 2));
    for (const int f : {1, 4, 9}) std::swap(mixed.triangles(f, 0), mixed.triangles(f, 1));
    expect_volumes(mixed, {8});
    EXPECT_EQ(shells_of(mixed).all()[0].turned, 3);
}

TEST(ClosedShells, AnOpenShellIsExcludedAndItsOpenEdgesAreCounted)
{
    Surface surface = cube({0, 0, 0}, 2);
    surface.triangles.conservativeResize(11, 3);  // without 1, 7, 3
    surface.add(cube({5, 0, 0}, 1));
    expect_volumes(surface, {1});
    const ClosedShells shells = shells_of(surface);
    EXPECT_EQ(shells.all()[0].role, ShellRole::open);
    EXPECT_EQ(shells.all()[0].open_edges, 3);
    EXPECT_EQ(shells.all()[0].first_open_edge, pbs::DirectedEdge(1, 3));
    EXPECT_NEAR(shells.counted_share(), 6.0 / (22.0 + 6.0), rounding_error(30, 1.0));
}

TEST(ClosedShells, ASheetWithTwoSidesEnclosesNothing)
{
    Surface sheet;
    sheet.points.resize(4, 3);
    sheet.points << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0;
    sheet.triangles.resize(4, 3);
    sheet.triangles << 0, 1, 2, 0, 2, 3, 2, 1, 0, 3, 2, 0;
    EXPECT_TRUE(shells_of(sheet).counted().empty());
    EXPECT_EQ(shells_of(sheet).all()[0].role, ShellRole::flat);
}

TEST(ClosedShells, BackFacesAreCountedOnceWithPointsOfTheirOwnAndWithout)
{
    Surface shared = cube({0, 0, 0}, 2);
    shared.triangles.conservativeResize(24, 3);
    shared.triangles.bottomRows(12) = cube({0, 0, 0}, 2, true).triangles;
    expect_volumes(shared, {8});
    EXPECT_EQ(shells_of(shared).all()[0].copies, 12);
    Surface own = cube({0, 0, 0}, 2);
    own.add(cube({0, 0, 0}, 2, true));
    expect_volumes(own, {8});
    EXPECT_EQ(shells_of(own).all()[1].role, ShellRole::copy);
}

TEST(ClosedShells, BodiesThatTouchInAFaceStayApart)
{
    Surface surface = cube({0, 0, 0}, 2);
    surface.add(cube({2, 0, 0}, 2));
    const ClosedShells shells = shells_of(surface);
    surface.points.bottomRows(8).rowwise() += Eigen::RowVector3d(1, 0, 0);  // they move apart: nothing was joined
    EXPECT_EQ(shells.largest_gap_m(surface.points), 0.0);
    for (const double volume_m3 : shells.volumes(surface.points)) EXPECT_NEAR(volume_m3, 8.0, rounding_error(12, 8.0));
}

TEST(ClosedShells, ASeamThatOpensIsMeasuredAndItsGapIsStated)
{
    const Surface surface = with_seams(cube({0, 0, 0}, 2));
    const ClosedShells shells = shells_of(surface);
    pbs::Positions posed = surface.points;
    posed.row(35) += Eigen::RowVector3d(3, 0, 4);  // the last triangle's last corner, for which another point stands
    EXPECT_EQ(shells.largest_gap_m(posed), 5.0);
    EXPECT_EQ(shells.volumes(posed)(0), shells.volumes(surface.points)(0));
}

}  // namespace
