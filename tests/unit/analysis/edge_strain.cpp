// Reference: theory. A stretch by s along x lengthens edges along x by s and does not change those perpendicular to it.
#include "analysis/edge_strain.hpp"
#include "pbs/geometry/input_error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using analysis::largest_edge_strain;
using analysis::median_edge_ratio;

namespace {

pbs::Positions corner(double x)
{
    pbs::Positions points(3, 3);
    points << 0, 0, 0, x, 0, 0, 0, 1, 0;
    return points;
}

pbs::Edges two_edges()
{
    pbs::Edges edges(2, 2);
    edges << 0, 1, 0, 2;
    return edges;
}

}  // namespace

TEST(EdgeStrain, TheEdgeStretchedOrPressedMost)
{
    EXPECT_EQ(largest_edge_strain(corner(1.0), two_edges(), corner(1.25)), 0.25);
    EXPECT_EQ(largest_edge_strain(corner(1.0), two_edges(), corner(0.5)), 0.5);
    EXPECT_EQ(largest_edge_strain(corner(1.0), two_edges(), corner(1.0)), 0.0);
}

TEST(EdgeStrain, NotANumberStays)
{
    EXPECT_TRUE(std::isnan(largest_edge_strain(corner(1.0), two_edges(), corner(std::numeric_limits<double>::quiet_NaN()))));
}

TEST(EdgeStrain, TheMedianIsTheUnitsFactor)
{
    EXPECT_EQ(median_edge_ratio(corner(1.0), two_edges(), 1000.0 * corner(1.0)), 1000.0);
    EXPECT_EQ(median_edge_ratio(corner(1.0), pbs::Edges(0, 2), corner(2.0)), 1.0);
}

TEST(EdgeStrain, AnotherNumberOfPointsIsRefused)
{
    EXPECT_THROW(largest_edge_strain(corner(1.0), two_edges(), pbs::Positions(2, 3)), pbs::InputError);
}
