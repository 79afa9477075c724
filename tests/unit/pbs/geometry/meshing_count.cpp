// Reference: an artificial mesher whose number of vertices is a known power of the cell size.
#include "pbs/geometry/meshing_count.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

pbs::TetMesh with_vertices(int count)
{
    pbs::TetMesh mesh;
    mesh.rest.setZero(count, 3);
    mesh.tets.setZero(1, 4);
    return mesh;
}

TEST(Count, IsReachedInAFewTriesWhateverThePower)
{
    for (const double power : {-2.0, -2.5, -3.0})
        for (const int wanted : {200, 2000, 200000}) {
            int tries = 0;
            const pbs::TetMesh mesh = pbs::mesh_at_vertex_count(wanted, 0.1, [&](double size) {
                ++tries;
                return with_vertices(static_cast<int>(2.0 * std::pow(size, power)));
            });
            EXPECT_NEAR(double(mesh.rest.rows()), wanted, 0.05 * wanted);
            EXPECT_LE(tries, 5) << power;
        }
}

TEST(Count, TheNearestIsKeptWhereNoSizeReachesIt)
{
    const pbs::TetMesh mesh = pbs::mesh_at_vertex_count(500, 1.0, [](double size) { return with_vertices(size < 0.5 ? 900 : 400); });
    EXPECT_EQ(mesh.rest.rows(), 400);
}

TEST(Count, ASizeThatFailsIsStepped)
{
    const pbs::TetMesh mesh =
        pbs::mesh_at_vertex_count(500, 1.0, [](double size) { return size > 0.7 ? pbs::TetMesh() : with_vertices(500); });
    EXPECT_EQ(mesh.rest.rows(), 500);
}

TEST(Count, NothingButFailuresGivesNoMesh)
{
    EXPECT_EQ(pbs::mesh_at_vertex_count(500, 1.0, [](double) { return pbs::TetMesh(); }).tets.rows(), 0);
}

}  // namespace
