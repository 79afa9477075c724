// Reference: sections of boxes, pyramids and prisms in closed form. Tolerances: the rounding of the points at which a plane cuts edges.
#include "analysis/cross_section.hpp"

#include "pbs/geometry/input_error.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/structured_bar.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

namespace {

using analysis::cross_section_area;
using analysis::Plane;
using pbs::Vec3;

std::vector<int> all_of(const pbs::Tets& tets)
{
    std::vector<int> all(tets.rows());
    std::iota(all.begin(), all.end(), 0);
    return all;
}

double area_of(const pbs::TetMesh& mesh, const Plane& plane)
{
    return cross_section_area(mesh.rest, mesh.tets, all_of(mesh.tets), plane);
}

pbs::TetMesh bar()
{
    return test_support::structured_bar({-1.0, -0.15, -0.15}, {1.0, 0.15, 0.15}, {8, 2, 2});
}

// Apex (0,0,1) over a regular polygon of radius 1 at z = 0, as a fan of tets.
pbs::TetMesh cone(int sides)
{
    pbs::TetMesh mesh;
    mesh.rest = pbs::Positions::Zero(sides + 2, 3);
    mesh.rest(1, 2) = 1.0;
    mesh.tets.resize(sides, 4);
    for (int i = 0; i < sides; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / sides;
        mesh.rest.row(i + 2) << std::cos(angle), std::sin(angle), 0.0;
        mesh.tets.row(i) << 0, i + 2, (i + 1) % sides + 2, 1;
    }
    return mesh;
}

// The error of an area [m^2]. A cut point goes through six roundings, and the heights of an edge's two ends above the plane through four
// each, which move the point by as much over the sine of the angle between edge and plane. A polygon is half the cross product of two
// diagonals, each at most as long as an edge of its tet, with two cut points each.
double area_error(int cut_tets, double longest_edge, double farthest, double sine)
{
    using test_support::rounding_error;
    return cut_tets * 2.0 * longest_edge * (rounding_error(6, farthest) + rounding_error(4 + 4, farthest) / sine);
}

// Cells of the bar are 0.25 x 0.15 x 0.15; a section across cuts four of them, of six tets each.
const double bar_edge = std::sqrt(0.25 * 0.25 + 2.0 * 0.15 * 0.15), across_error = area_error(4 * 6, bar_edge, 1.0, 0.25 / bar_edge);

TEST(CrossSection, OfABoxBetweenItsVertices)
{
    EXPECT_NEAR(area_of(bar(), {{0.1, 5.0, -7.0}, {1.0, 0.0, 0.0}}), 0.09, across_error);
}

TEST(CrossSection, ThroughVerticesAndFacesCountsOnce)
{
    for (double x : {-0.75, 0.0, 0.25}) {
        EXPECT_NEAR(area_of(bar(), {{x, 0.0, 0.0}, {1.0, 0.0, 0.0}}), 0.09, across_error);
        EXPECT_NEAR(area_of(bar(), {{x, 0.0, 0.0}, {-2.0, 0.0, 0.0}}), 0.09, across_error);
    }
}

TEST(CrossSection, BoundaryFaceCountsFromTheNormalsSide)
{
    EXPECT_NEAR(area_of(bar(), {{-1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}}), 0.09, across_error);
    EXPECT_EQ(area_of(bar(), {{-1.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}}), 0.0);
}

TEST(CrossSection, ObliquePlaneCutsMore)
{
    const double tilt = 0.4;
    // Within 0.4 m of the origin, it cuts cells on both sides of x = 0; the edges closest to it lie in the diagonal of y and z.
    EXPECT_NEAR(area_of(bar(), {Vec3::Zero(), {std::cos(tilt), std::sin(tilt), 0.0}}), 0.09 / std::cos(tilt),
                area_error(2 * 4 * 6, bar_edge, 0.4, std::sin(tilt) / std::sqrt(2.0)));
}

TEST(CrossSection, AlongABox)
{
    EXPECT_NEAR(area_of(bar(), {{0.0, 0.0, 0.01}, {0.0, 0.0, 3.0}}), 2.0 * 0.3, area_error(8 * 2 * 6, bar_edge, 1.1, 0.15 / bar_edge));
}

TEST(CrossSection, MissingTheBodyIsNothing)
{
    EXPECT_EQ(area_of(bar(), {{1.1, 0.0, 0.0}, {1.0, 0.0, 0.0}}), 0.0);
}

// The rounding error of the area in which a plane cuts a cone of so many tets, with edges of sqrt 2 m at 45 degrees.
double cone_error(int sides)
{
    return area_error(sides, std::sqrt(2.0), 1.0, std::sqrt(0.5));
}

TEST(CrossSection, OfAConeFallsWithTheSquareOfTheHeight)
{
    const int sides = 12;
    const double base = 0.5 * sides * std::sin(2.0 * std::numbers::pi / sides);
    for (double z : {0.0, 0.2, 0.5, 0.99})
        EXPECT_NEAR(area_of(cone(sides), {{0.0, 0.0, z}, {0.0, 0.0, 1.0}}), base * (1.0 - z) * (1.0 - z), cone_error(sides)) << z;
}

TEST(CrossSection, FoldedFleshCountsOnceASheet)
{
    auto mesh = cone(6);
    const Plane plane{{0.0, 0.0, 0.3}, {0.0, 0.0, 1.0}};
    const double once = area_of(mesh, plane);
    auto twice = all_of(mesh.tets);
    twice.insert(twice.end(), twice.begin(), twice.begin() + static_cast<long>(mesh.tets.rows()));
    EXPECT_NEAR(cross_section_area(mesh.rest, mesh.tets, twice, plane), 2.0 * once,
                test_support::rounding_error(4, 2.0 * once));  // two sums
    mesh.tets.col(0).swap(mesh.tets.col(1));                   // inverted
    EXPECT_NEAR(area_of(mesh, plane), once, 2.0 * cone_error(6));
}

TEST(SectionExtremes, FindTheNarrowestAndTheWidestStation)
{
    const auto mesh = bar();
    const auto scale = [](double x) { return 1.0 - 0.8 * std::exp(-20.0 * x * x) + (x > 0.7 ? 0.1 : 0.0); };
    pbs::Positions posed = mesh.rest;  // pinched at x = 0, and turned about z by 90 degrees
    for (Eigen::Index i = 0; i < posed.rows(); ++i) {
        const Vec3 p = mesh.rest.row(i);
        posed.row(i) << -p.y() * scale(p.x()), p.x(), p.z() * scale(p.x());
    }
    std::vector<analysis::SectionStation> stations;
    for (double x : {-0.75, -0.25, 0.0, 0.25, 0.75})
        stations.push_back({{{x, 0.0, 0.0}, {1.0, 0.0, 0.0}}, {{0.0, x, 0.0}, {0.0, 1.0, 0.0}}, all_of(mesh.tets)});
    const auto sections = analysis::section_extremes(mesh.rest, posed, mesh.tets, stations);
    EXPECT_EQ(sections.smallest, 2);
    const double of_ratio = across_error / 0.09 * (1.0 + scale(0.75) * scale(0.75));  // of two areas, one of them at most this much larger
    EXPECT_NEAR(sections.smallest_ratio, 0.04, of_ratio);
    EXPECT_NEAR(sections.area_m2[2], 0.09 * 0.04, across_error);
    EXPECT_EQ(sections.largest, 4);
    EXPECT_NEAR(sections.largest_ratio, scale(0.75) * scale(0.75), of_ratio);
}

TEST(SectionExtremes, OnlyTheTetsOfTheStationCount)
{
    auto mesh = bar();
    const Eigen::Index vertices = mesh.rest.rows(), tets = mesh.tets.rows();
    const auto limb = all_of(mesh.tets);
    mesh.rest.conservativeResize(2 * vertices, 3);  // a second limb next to the first
    mesh.rest.bottomRows(vertices) = mesh.rest.topRows(vertices).rowwise() + Eigen::RowVector3d(0.0, 1.0, 0.0);
    mesh.tets.conservativeResize(2 * tets, 4);
    mesh.tets.bottomRows(tets) = mesh.tets.topRows(tets).array() + static_cast<int>(vertices);
    const Plane plane{{0.1, 0.0, 0.0}, {1.0, 0.0, 0.0}};
    EXPECT_NEAR(area_of(mesh, plane), 0.18, 2.0 * across_error);
    EXPECT_NEAR(analysis::section_extremes(mesh.rest, mesh.rest, mesh.tets, {{plane, plane, limb}}).area_m2[0], 0.09, across_error);
}

TEST(SectionExtremes, WithoutStationsThereIsNone)
{
    const auto sections = analysis::section_extremes(bar().rest, bar().rest, bar().tets, {});
    EXPECT_EQ(sections.smallest, -1);
    EXPECT_EQ(sections.smallest_ratio, 1.0);
}

TEST(SectionExtremes, RefusesStationsThatCannotBeMeasured)
{
    const auto mesh = bar();
    const Plane good{Vec3::Zero(), Vec3::UnitX()}, outside{{3.0, 0.0, 0.0}, Vec3::UnitX()}, no_normal{Vec3::Zero(), Vec3::Zero()};
    const auto extremes = [&](const analysis::SectionStation& s) {
        return analysis::section_extremes(mesh.rest, mesh.rest, mesh.tets, {s});
    };
    EXPECT_THROW(extremes({outside, good, all_of(mesh.tets)}), pbs::InputError);
    EXPECT_THROW(extremes({good, no_normal, all_of(mesh.tets)}), pbs::InputError);
    EXPECT_THROW(extremes({good, good, {99999}}), pbs::InputError);
    EXPECT_EQ(extremes({good, outside, all_of(mesh.tets)}).smallest_ratio, 0.0);  // displaced from its plane: a result, not an error
}

}  // namespace
