// Reference: bars of known width. A bar of the width w, much longer than wide, has four times its volume over its area
// near w.
#include "experiments/characters/thin_shells.hpp"
#include "pbs/geometry/topology.hpp"
#include "tests/support/structured_bar.hpp"

#include <gtest/gtest.h>

namespace {

using namespace pbs;

// A cube of 1 m, and bars of 1 m beside it.
SurfaceMesh cube_and_bars(const std::vector<double>& widths_m)
{
    SurfaceMesh all;
    const auto add = [&](const TetMesh& solid) {
        const Eigen::Index points = all.points.rows(), triangles = all.triangles.rows();
        const Triangles own = boundary_of(solid.tets);
        all.points.conservativeResize(points + solid.rest.rows(), 3);
        all.points.bottomRows(solid.rest.rows()) = solid.rest;
        all.triangles.conservativeResize(triangles + own.rows(), 3);
        all.triangles.bottomRows(own.rows()) = own.array() + static_cast<int>(points);
    };
    add(test_support::structured_bar({0, 0, 0}, {1, 1, 1}, {2, 2, 2}));
    for (std::size_t k = 0; k < widths_m.size(); ++k) {
        const double y = 2.0 + static_cast<double>(k);
        add(test_support::structured_bar({0, y, 0}, {1, y + widths_m[k], widths_m[k]}, {4, 1, 1}));
    }
    return all;
}

// The edge of 2,000 vertices in 1 m^3 is 0.089 m.
TEST(ThickShells, LeaveOutWhatIsThinnerThanAnEdge)
{
    const SurfaceMesh surface = cube_and_bars({0.07, 0.12, 0.001});
    const ThickShells thick = thick_shells(surface, 2000);
    EXPECT_EQ(thick.left_out, 2);
    EXPECT_EQ(thick.triangles.rows(), cube_and_bars({0.12}).triangles.rows());
    EXPECT_EQ(thick_shells(surface, 20).left_out, 3);
    EXPECT_EQ(thick_shells(surface, 2'000'000'000).left_out, 0);
}

TEST(ThickShells, KeepTheLargestOneAndOpenSheetsAreThin)
{
    SurfaceMesh surface = cube_and_bars({});
    EXPECT_EQ(thick_shells(surface, 1).left_out, 0);
    const int points = static_cast<int>(surface.points.rows());
    surface.points.conservativeResize(points + 3, 3);
    surface.points.bottomRows(3) << 5, 5, 5, 6, 5, 5, 5, 6, 5;
    surface.triangles.conservativeResize(surface.triangles.rows() + 1, 3);
    surface.triangles.bottomRows(1) << points, points + 1, points + 2;
    EXPECT_EQ(thick_shells(surface, 2'000'000'000).left_out, 1);
}

TEST(UsedPart, NumbersThePointsThatTrianglesUse)
{
    const SurfaceMesh surface = cube_and_bars({0.1}), bar = cube_and_bars({0.1});
    const Eigen::Index first = cube_and_bars({}).triangles.rows();
    const SurfaceMesh part =
        used_part({surface.points, surface.triangles.bottomRows(surface.triangles.rows() - first)});
    EXPECT_EQ(part.points, Positions(bar.points.bottomRows(part.points.rows())));
    EXPECT_EQ(part.triangles.minCoeff(), 0);
    EXPECT_EQ(part.triangles.maxCoeff(), part.points.rows() - 1);
    for (Eigen::Index t = 0; t < part.triangles.rows(); ++t)
        for (int k = 0; k < 3; ++k)
            EXPECT_EQ(part.points.row(part.triangles(t, k)), surface.points.row(surface.triangles(first + t, k)));
}

}  // namespace
