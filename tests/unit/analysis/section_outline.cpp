// Reference: regular polygons, rectangles and a figure eight in closed form. Tolerances: a vertex and its distance from the centroid go
// through some twenty roundings of coordinates. Those of the rectangle are multiples of powers of two, which are not rounded.
#include "analysis/section_outline.hpp"

#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace {

using analysis::Plane;
using pbs::Positions;
using pbs::Vec3;

const Plane horizontal{Vec3::Zero(), Vec3::UnitZ()};

Positions polygon(int sides, double radius, const Vec3& centre)
{
    Positions outline(sides, 3);
    for (int i = 0; i < sides; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / sides;
        outline.row(i) = centre + radius * Vec3(std::cos(angle), std::sin(angle), 0.0);
    }
    return outline;
}

TEST(SectionOutline, RegularPolygonHasItsAreaAndItsTwoRadii)
{
    const auto size = analysis::outline_size(polygon(6, 2.0, {5.0, -3.0, 1.0}));
    // Vertices are within 8 m of the origin. Six triangles of two radii of 2 m have an area in error by 2 m times that of a vertex.
    const double of_vertex = test_support::rounding_error(20, 8.0);
    EXPECT_NEAR(size.area_m2, 6.0 * std::sqrt(3.0), 6 * 2.0 * of_vertex);
    EXPECT_NEAR(size.largest_radius_m, 2.0, of_vertex);
    EXPECT_NEAR(size.smallest_radius_m, std::sqrt(3.0), of_vertex);
}

// An additional vertex on one side shifts the mean of the vertices, but not the centroid of the length.
TEST(SectionOutline, DoesNotDependOnHowItsSidesAreCutUp)
{
    Positions rectangle(5, 3);
    rectangle << 0, 0, 0, 0.25, 0, 0, 4, 0, 0, 4, 2, 0, 0, 2, 0;
    const auto size = analysis::outline_size(rectangle);
    EXPECT_EQ(size.area_m2, 8.0);
    EXPECT_EQ(size.smallest_radius_m, 1.0);
    EXPECT_EQ(size.largest_radius_m, std::sqrt(5.0));
}

TEST(SectionOutline, FigureEightEnclosesTheDifference)
{
    Positions eight(4, 3);
    eight << 0, 0, 0, 1, 1, 0, 1, 0, 0, 0, 1, 0;
    const auto size = analysis::outline_size(eight);
    const double of_vertex = test_support::rounding_error(20, std::sqrt(2.0));
    EXPECT_NEAR(size.area_m2, 0.0, 4 * of_vertex);
    EXPECT_NEAR(size.smallest_radius_m, 0.0, of_vertex);
}

TEST(SectionOutline, CollapsedToAPointOrEmptyHasNoSize)
{
    const auto point = analysis::outline_size(Positions::Ones(4, 3));
    EXPECT_EQ(point.area_m2, 0.0);
    EXPECT_EQ(point.largest_radius_m, 0.0);
    EXPECT_EQ(analysis::outline_size(Positions(0, 3)).largest_radius_m, 0.0);
}

TEST(SectionOutline, WindsOnceRoundWhatItEnclosesEitherWay)
{
    const Positions ring = polygon(7, 1.0, Vec3::Zero()), backwards = ring.colwise().reverse();
    EXPECT_EQ(analysis::winding_number(ring, horizontal), 1);
    EXPECT_EQ(analysis::winding_number(backwards, horizontal), -1);
    EXPECT_EQ(analysis::winding_number(ring, {{2.0, 0.0, 0.0}, Vec3::UnitZ()}), 0);
}

TEST(SectionOutline, EnclosingOneIsTakenBeforeANearerOne)
{
    const std::vector<Positions> outlines = {polygon(8, 0.1, {0.3, 0, 0}), polygon(8, 1.0, Vec3::Zero()), polygon(8, 3.0, Vec3::Zero())};
    EXPECT_EQ(analysis::enclosing_outline(outlines, horizontal), &outlines[1]);
    const std::vector<Positions> outside = {polygon(8, 0.1, {2, 0, 0}), polygon(8, 0.1, {1, 0, 0})};
    EXPECT_EQ(analysis::enclosing_outline(outside, horizontal), &outside[1]);
    EXPECT_EQ(analysis::enclosing_outline({}, horizontal), nullptr);
}

}  // namespace
