// Reference: the volumes of a box and of single tets, by hand. Tolerances: roundings are counted as in
// projection_rounding.hpp, over all triangles of the surface.
#include "pbs/constraints/region_volume.hpp"

#include "pbs/geometry/topology.hpp"
#include "tests/support/random_points.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/structured_bar.hpp"

#include <gtest/gtest.h>

namespace region_volume_tests {
namespace {

using namespace test_support;
using pbs::RegionVolumeConstraint;
using pbs::Vec3;
using Points = std::vector<Vec3>;

const pbs::TetMesh bar = structured_bar({0, 0, 0}, {2, 1, 1}, {2, 2, 2});
const auto box = pbs::make_region_volume_constraint<double>(pbs::boundary_of(bar.tets), bar.rest, 1.0);
const std::vector<double> unit(box.vertex.size(), 1.0);
// A volume is a sum over the triangles, each with some twenty roundings of products of two edges and a distance, of at
// most 6 m^3 here.
const double rounding_m3 = rounding_error(20.0 * double(box.triangle.size()), 6.0);

Points at_rest()
{
    Points p;
    for (const int v : box.vertex) p.push_back(bar.rest.row(v));
    return p;
}

Points projected(const RegionVolumeConstraint<double>& constraint, const std::vector<double>& w, Points p)
{
    Points g;
    project(constraint, w, p, g);
    return p;
}

TEST(RegionVolume, IsTheVolumeOfTheBoxWhoseInteriorVertexDoesNotEnter)
{
    EXPECT_NEAR(box.rest_volume, 2.0, rounding_m3);
    EXPECT_EQ(box.vertex.size() + 1, std::size_t(bar.rest.rows()));
    Points twice_as_long = at_rest();
    for (Vec3& p : twice_as_long) p.x() *= 2.0;
    EXPECT_NEAR(value(box, twice_as_long), 2.0, rounding_m3);
}

TEST(RegionVolume, OfOneTetIsItsVolumeConstraint)
{
    pbs::TetMesh tet = bar;
    tet.tets = bar.tets.row(0).eval();
    const auto region = pbs::make_region_volume_constraint<double>(pbs::boundary_of(tet.tets), bar.rest, 0.4);
    const pbs::VolumeConstraint<double> alone{{}, region.rest_volume, 0.4};
    RandomPoints random(2);
    Points p(4), g;
    for (int i = 0; i < 4; ++i) p[i] = Vec3(bar.rest.row(tet.tets(0, i))) + random.point(0.2);
    Points of_region(4);
    for (int i = 0; i < 4; ++i)
        of_region[std::ranges::find(region.vertex, tet.tets(0, i)) - region.vertex.begin()] = p[i];
    const Points before = of_region;
    EXPECT_NEAR(value(region, of_region), value(alone, p[0], p[1], p[2], p[3]), rounding_m3);
    project(region, {1, 1, 1, 1}, of_region, g);
    project(alone, 1.0, 1.0, 1.0, 1.0, p[0], p[1], p[2], p[3]);
    for (int i = 0; i < 4; ++i) {
        const std::size_t at = std::ranges::find(region.vertex, tet.tets(0, i)) - region.vertex.begin();
        EXPECT_GT((of_region[at] - before[at]).norm(), 1e-4);
        // some forty roundings each, of a well-shaped tet
        EXPECT_LT((of_region[at] - p[i]).norm(), rounding_error(100, 1.0));
    }
}

TEST(RegionVolume, FlattenedRegionIsInflatedAndAMirroredOneTurnedBack)
{
    Points flat = at_rest(), mirrored = at_rest();
    for (Vec3& p : flat) p.z() *= 1e-3;
    for (Vec3& p : mirrored) p.z() *= -1.0;
    EXPECT_GT(value(box, projected(box, unit, flat)), value(box, flat));
    EXPECT_GT(value(box, projected(box, unit, mirrored)), value(box, mirrored));
}

}  // namespace
}  // namespace region_volume_tests
