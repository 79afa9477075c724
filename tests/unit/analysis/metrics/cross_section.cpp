// Reference: sections of boxes, pyramids and prisms in closed form. Tolerances: the rounding of the points at which a
// plane cuts edges.

#include "analysis/metrics/cross_section.hpp"
#include "pbs/geometry/input_error.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/structured_bar.hpp"

#include <cmath>
#include <numbers>
#include <numeric>

namespace {

using analysis::cross_section_area;
using analysis::Plane;
using pbs::Positions;
using pbs::Vec3;
using test_support::rounding_error;

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

// The error of an area [m^2]. A cut point goes through six roundings, and the heights of an edge's two ends above the
// plane through four each, which move the point by as much over the sine of the angle between edge and plane. A polygon
// is half the cross product of two diagonals, each at most as long as an edge of its tet, with two cut points each.
double area_error(int cut_tets, double longest_edge, double farthest, double sine)
{
    return cut_tets * 2.0 * longest_edge * (rounding_error(6, farthest) + rounding_error(4 + 4, farthest) / sine);
}

// Cells of the bar are 0.25 x 0.15 x 0.15; a section across cuts four of them, of six tets each.
const double bar_edge = std::sqrt(0.25 * 0.25 + 2.0 * 0.15 * 0.15),
             across_error = area_error(4 * 6, bar_edge, 1.0, 0.25 / bar_edge);

TEST(CrossSection, OfABox)
{
    const double tilt = 0.4, along_error = area_error(8 * 2 * 6, bar_edge, 1.1, 0.15 / bar_edge);
    // Within 0.4 m of the origin, the oblique plane cuts cells on both sides of x = 0; the edges closest to it lie in
    // the diagonal of y and z.
    const double oblique_error = area_error(2 * 4 * 6, bar_edge, 0.4, std::sin(tilt) / std::sqrt(2.0));
    struct Case {
        const char* name;
        Plane plane;
        double area, error;
    };
    const std::vector<Case> all = {
        {"between its vertices", {{0.1, 5.0, -7.0}, {1, 0, 0}}, 0.09, across_error},
        {"the boundary counts from the normal's side", {{-1, 0, 0}, {1, 0, 0}}, 0.09, across_error},
        {"and not from the other", {{-1, 0, 0}, {-1, 0, 0}}, 0.0, 0.0},
        {"oblique", {Vec3::Zero(), {std::cos(tilt), std::sin(tilt), 0}}, 0.09 / std::cos(tilt), oblique_error},
        {"along it", {{0, 0, 0.01}, {0, 0, 3}}, 2.0 * 0.3, along_error},
        {"beyond it", {{1.1, 0, 0}, {1, 0, 0}}, 0.0, 0.0}};
    for (const Case& of : all) EXPECT_NEAR(area_of(bar(), of.plane), of.area, of.error) << of.name;
    for (const double x : {-0.75, 0.0, 0.25})  // through vertices and faces, from either side
        for (const double normal : {1.0, -2.0})
            EXPECT_NEAR(area_of(bar(), {{x, 0, 0}, {normal, 0, 0}}), 0.09, across_error) << x;
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
        EXPECT_NEAR(area_of(cone(sides), {{0.0, 0.0, z}, {0.0, 0.0, 1.0}}), base * (1.0 - z) * (1.0 - z),
                    cone_error(sides))
            << z;
}

TEST(CrossSection, FoldedFleshCountsOnceASheet)
{
    auto mesh = cone(6);
    const Plane plane{{0.0, 0.0, 0.3}, {0.0, 0.0, 1.0}};
    const double once = area_of(mesh, plane);
    auto twice = all_of(mesh.tets);
    twice.insert(twice.end(), twice.begin(), twice.begin() + static_cast<long>(mesh.tets.rows()));
    // two sums
    EXPECT_NEAR(cross_section_area(mesh.rest, mesh.tets, twice, plane), 2.0 * once, rounding_error(4, 2.0 * once));
    // inverted
    mesh.tets.col(0).swap(mesh.tets.col(1));
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
    // of two areas, one of them at most this much larger
    const double of_ratio = across_error / 0.09 * (1.0 + scale(0.75) * scale(0.75));
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
    EXPECT_NEAR(analysis::section_extremes(mesh.rest, mesh.rest, mesh.tets, {{plane, plane, limb}}).area_m2[0], 0.09,
                across_error);
}

TEST(SectionExtremes, AreNoneWithoutStationsAndRefuseThoseThatCannotBeMeasured)
{
    const auto mesh = bar();
    const auto none = analysis::section_extremes(mesh.rest, mesh.rest, mesh.tets, {});
    EXPECT_EQ(none.smallest, -1);
    EXPECT_EQ(none.smallest_ratio, 1.0);
    const Plane good{Vec3::Zero(), Vec3::UnitX()}, outside{{3.0, 0.0, 0.0}, Vec3::UnitX()},
        no_normal{Vec3::Zero(), Vec3::Zero()};
    const auto extremes = [&](const analysis::SectionStation& s) {
        return analysis::section_extremes(mesh.rest, mesh.rest, mesh.tets, {s});
    };
    EXPECT_THROW(extremes({outside, good, all_of(mesh.tets)}), pbs::InputError);
    EXPECT_THROW(extremes({good, no_normal, all_of(mesh.tets)}), pbs::InputError);
    EXPECT_THROW(extremes({good, good, {99999}}), pbs::InputError);
    // displaced from its plane: a result, not an error
    EXPECT_EQ(extremes({good, outside, all_of(mesh.tets)}).smallest_ratio, 0.0);
}

// Reference: regular polygons, rectangles and a figure eight in closed form. Tolerances: a vertex and its distance from
// the centroid go through some twenty roundings of coordinates. Those of the rectangle are multiples of powers of two,
// which are not rounded.

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

// A hexagon, within 8 m of the origin: six triangles of two radii of 2 m have an area in error by 2 m times that of a
// vertex. An additional vertex on one side of the rectangle shifts the mean of the vertices, but not the centroid of
// the length.
TEST(SectionOutline, HasItsAreaAndItsTwoRadii)
{
    const double of_hexagon = rounding_error(20, 8.0), of_eight = rounding_error(20, std::sqrt(2.0));
    struct Case {
        const char* name;
        Positions outline;
        double area, smallest, largest, area_error, radius_error;
    };
    const std::vector<Case> all = {
        {"hexagon", polygon(6, 2.0, {5, -3, 1}), 6.0 * std::sqrt(3.0), std::sqrt(3.0), 2.0, 6 * 2.0 * of_hexagon,
         of_hexagon},
        {"rectangle", Positions{{0, 0, 0}, {0.25, 0, 0}, {4, 0, 0}, {4, 2, 0}, {0, 2, 0}}, 8.0, 1.0, std::sqrt(5.0),
         0.0, 0.0},
        {"a figure eight encloses the difference", Positions{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}, 0.0, 0.0,
         std::sqrt(0.5), 4 * of_eight, of_eight},
        {"collapsed to a point", Positions::Ones(4, 3), 0.0, 0.0, 0.0, 0.0, 0.0},
        {"empty", Positions(0, 3), 0.0, 0.0, 0.0, 0.0, 0.0}};
    for (const Case& of : all) {
        SCOPED_TRACE(of.name);
        const auto size = analysis::outline_size(of.outline);
        EXPECT_NEAR(size.area_m2, of.area, of.area_error);
        EXPECT_NEAR(size.smallest_radius_m, of.smallest, of.radius_error);
        EXPECT_NEAR(size.largest_radius_m, of.largest, of.radius_error);
    }
}

TEST(SectionOutline, WindsOnceRoundWhatItEnclosesEitherWayAndIsTakenBeforeANearerOne)
{
    const Positions ring = polygon(7, 1.0, Vec3::Zero()), backwards = ring.colwise().reverse();
    EXPECT_EQ(analysis::winding_number(ring, horizontal), 1);
    EXPECT_EQ(analysis::winding_number(backwards, horizontal), -1);
    EXPECT_EQ(analysis::winding_number(ring, {{2.0, 0.0, 0.0}, Vec3::UnitZ()}), 0);
    const std::vector<Positions> outlines = {polygon(8, 0.1, {0.3, 0, 0}), polygon(8, 1.0, Vec3::Zero()),
                                             polygon(8, 3.0, Vec3::Zero())};
    EXPECT_EQ(analysis::enclosing_outline(outlines, horizontal), &outlines[1]);
    const std::vector<Positions> outside = {polygon(8, 0.1, {2, 0, 0}), polygon(8, 0.1, {1, 0, 0})};
    EXPECT_EQ(analysis::enclosing_outline(outside, horizontal), &outside[1]);
    EXPECT_EQ(analysis::enclosing_outline({}, horizontal), nullptr);
}

// Reference: prisms over a triangle with sides 3, 4 and 5, cut across; a corner of the outline stands for half of each
// side that it ends.

// Only the sides, from z = -0.9 to 1; vertices 2 i below and 2 i + 1 above corner i.
struct Prisms {
    Positions positions, outline{3, 3};  // of the first
    pbs::Triangles skin;
};

Prisms prisms(int count)
{
    const double corners[3][2] = {{0, 0}, {4, 0}, {0, 3}};
    Prisms prisms{.positions = Positions(6 * count, 3), .skin = pbs::Triangles(6 * count, 3)};
    for (int p = 0; p < count; ++p)
        for (int i = 0; i < 3; ++i) {
            const pbs::Vec3 corner(10.0 * p + corners[i][0], corners[i][1], 0.0);
            const int own = 6 * p + 2 * i, next = 6 * p + 2 * ((i + 1) % 3);
            prisms.positions.row(own) = corner - 0.9 * pbs::Vec3::UnitZ();
            prisms.positions.row(own + 1) = corner + pbs::Vec3::UnitZ();
            prisms.skin.row(own) << own, next, next + 1;
            prisms.skin.row(own + 1) << own, next + 1, own + 1;
            if (p == 0) prisms.outline.row(i) = corner;
        }
    return prisms;
}

double cut_share(const Prisms& cut, const std::vector<int>& vertices)
{
    std::vector<bool> chosen(cut.positions.rows());
    for (const int v : vertices) chosen[v] = true;
    return analysis::share_of_outline(cut.outline, {pbs::Vec3::Zero(), 3.0 * pbs::Vec3::UnitZ()}, cut.positions,
                                      cut.skin, chosen);
}

TEST(OutlineSkin, IsSharedByLengthAmongTheNearerVerticesOfTheEdges)
{
    const Prisms one = prisms(1), two = prisms(2);
    EXPECT_EQ(cut_share(one, {0, 2, 4}), 1.0);  // 0.9 below, 1 above
    EXPECT_EQ(cut_share(one, {1, 3, 5}), 0.0);
    EXPECT_DOUBLE_EQ(cut_share(one, {0}), 3.5 / 12.0);
    EXPECT_DOUBLE_EQ(cut_share(one, {2}), 4.5 / 12.0);
    EXPECT_DOUBLE_EQ(cut_share(one, {2, 4}), 8.5 / 12.0);
    EXPECT_EQ(cut_share(two, {6, 8, 10}), 0.0) << "another part that the plane cuts too";
    EXPECT_EQ(cut_share(two, {0, 2, 4}), 1.0);
    Prisms without_length = one;
    for (const int corners : {1, 0}) {
        without_length.outline = Positions(one.outline.topRows(corners));
        EXPECT_EQ(cut_share(without_length, {}), 1.0) << "all of it is the limb's";
    }
}

}  // namespace
