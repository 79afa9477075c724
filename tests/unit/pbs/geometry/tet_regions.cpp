// Reference: the definition of a division: every tet in one region, each region connected over faces, sizes between half of the wanted size
// and what the merging of small rests allows; volumes of surfaces by the divergence theorem.
#include "pbs/geometry/tet_regions.hpp"

#include "pbs/geometry/tet_volume.hpp"
#include "pbs/geometry/topology.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/structured_bar.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace {

const pbs::TetMesh bar = test_support::structured_bar({0, 0, 0}, {4, 1, 1}, {8, 3, 3});  // 432 tets

pbs::Tets tets_in(const pbs::Tets& tets, const std::vector<int>& region, int which)
{
    std::vector<int> members;
    for (std::size_t t = 0; t < region.size(); ++t)
        if (region[t] == which) members.push_back(int(t));
    return tets(members, Eigen::all);
}

int regions_in(const std::vector<int>& region)
{
    return *std::ranges::max_element(region) + 1;
}

TEST(TetRegions, DivideTheMeshIntoConnectedRegionsOfAboutTheWantedSize)
{
    for (const int size : {1, 7, 40, 100}) {
        const std::vector<int> region = pbs::tet_regions(bar.tets, size);
        ASSERT_EQ(region.size(), std::size_t(bar.tets.rows()));
        for (int r = 0; r < regions_in(region); ++r) {
            const pbs::Tets own = tets_in(bar.tets, region, r);
            EXPECT_GE(2 * own.rows(), size) << size;
            EXPECT_EQ(pbs::topology_of(own, bar.rest.rows()).components, 1) << size << ' ' << r;
        }
        EXPECT_GE(regions_in(region), bar.tets.rows() / (2 * size)) << "rests may at most double the mean size here";
    }
}

TEST(TetRegions, OneTetOrAllOfThem)
{
    const std::vector<int> single = pbs::tet_regions(bar.tets, 1), whole = pbs::tet_regions(bar.tets, 1000000);
    EXPECT_EQ(regions_in(single), bar.tets.rows());
    EXPECT_EQ(regions_in(whole), 1);
    EXPECT_TRUE(pbs::tet_regions(pbs::Tets(0, 4), 8).empty());
}

TEST(TetRegions, APartOfItsOwnIsARegionOfItsOwn)
{
    pbs::Tets two(2, 4);
    two << 0, 1, 2, 3, 4, 5, 6, 7;
    EXPECT_EQ(pbs::tet_regions(two, 100), (std::vector<int>{0, 1}));
    pbs::Tets by_a_vertex = two;
    by_a_vertex(1, 0) = 3;
    EXPECT_EQ(pbs::tet_regions(by_a_vertex, 100), (std::vector<int>{0, 1})) << "a shared vertex is no shared face";
}

TEST(TetRegions, SurfacesEncloseTheVolumesOfTheirTets)
{
    const std::vector<int> region = pbs::tet_regions(bar.tets, 40);
    const std::vector<pbs::Triangles> surfaces = pbs::region_surfaces(bar.tets, region);
    ASSERT_EQ(int(surfaces.size()), regions_in(region));
    for (std::size_t r = 0; r < surfaces.size(); ++r) {
        double enclosed = 0.0;
        for (const auto triangle : surfaces[r].rowwise()) {
            const pbs::Vec3 a = bar.rest.row(triangle(0)), b = bar.rest.row(triangle(1)), c = bar.rest.row(triangle(2));
            enclosed += a.dot(b.cross(c)) / 6.0;
        }
        const pbs::Tets own = tets_in(bar.tets, region, int(r));
        // Triangles with coordinates of up to 4 m, a dozen roundings each, and their sum.
        EXPECT_NEAR(enclosed, pbs::tet_volumes(bar.rest, own).sum(), test_support::rounding_error(200.0 * (12 + 200), 4.0 / 6.0));
    }
}

}  // namespace
