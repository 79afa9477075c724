// Reference: two or three tets, of which each vertex and each face is counted by hand.
#include "pbs/geometry/mesh_repair.hpp"

#include "pbs/geometry/tet_volume.hpp"
#include "pbs/geometry/topology.hpp"
#include "tests/support/structured_bar.hpp"
#include "tests/support/unit_tet.hpp"

#include <gtest/gtest.h>

namespace {

// The unit tet with further points and one further tet.
pbs::TetMesh unit_tet_and(const std::vector<pbs::Vec3>& points, const std::array<int, 4>& tet)
{
    pbs::TetMesh mesh = test_support::unit_tet();
    mesh.rest.conservativeResize(4 + Eigen::Index(points.size()), 3);
    for (std::size_t p = 0; p < points.size(); ++p) mesh.rest.row(4 + Eigen::Index(p)) = points[p].transpose();
    mesh.tets.conservativeResize(2, 4);
    mesh.tets.row(1) << tet[0], tet[1], tet[2], tet[3];
    return mesh;
}

// Every corner of every tet stays in its place.
void expect_the_same_tets(const pbs::RepairedMesh& repair, const pbs::TetMesh& mesh)
{
    ASSERT_EQ(repair.mesh.tets.rows(), mesh.tets.rows());
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t)
        for (int corner = 0; corner < 4; ++corner) {
            EXPECT_EQ(repair.mesh.rest.row(repair.mesh.tets(t, corner)), mesh.rest.row(mesh.tets(t, corner)));
            EXPECT_EQ(repair.file_vertex[std::size_t(repair.mesh.tets(t, corner))], mesh.tets(t, corner));
        }
}

TEST(MeshRepair, ASoundMeshStaysAsItIs)
{
    const pbs::TetMesh bar = test_support::structured_bar({0, 0, 0}, {2, 1, 1}, {3, 2, 2});
    const pbs::RepairedMesh repair = pbs::repaired(bar);
    EXPECT_EQ(repair.mesh.rest, bar.rest);
    EXPECT_EQ(repair.mesh.tets, bar.tets);
    EXPECT_TRUE(repair.unused.empty());
    EXPECT_TRUE(repair.split.empty());
}

TEST(MeshRepair, UnusedVerticesAreLeftOut)
{
    pbs::TetMesh mesh = test_support::unit_tet();
    mesh.rest.conservativeResize(6, 3);
    mesh.rest.row(4) = mesh.rest.row(0);
    mesh.rest.row(0) << 9, 9, 9;
    mesh.rest.row(5) << 8, 8, 8;
    mesh.tets << 4, 1, 2, 3;
    const pbs::RepairedMesh repair = pbs::repaired(mesh);
    EXPECT_EQ(repair.unused, (std::vector<int>{0, 5}));
    EXPECT_EQ(repair.file_vertex, (std::vector<int>{1, 2, 3, 4}));
    EXPECT_EQ(repair.mesh.tets, (pbs::Tets(1, 4) << 3, 0, 1, 2).finished());
    expect_the_same_tets(repair, mesh);
}

TEST(MeshRepair, TetsThatTouchInAVertexGetOneEach)
{
    const pbs::TetMesh mesh = unit_tet_and({{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}}, {0, 4, 6, 5});
    const pbs::RepairedMesh repair = pbs::repaired(mesh);
    EXPECT_EQ(repair.split, std::vector<int>{0});
    EXPECT_EQ(repair.mesh.rest.rows(), 8);
    expect_the_same_tets(repair, mesh);
    EXPECT_TRUE(pbs::topology_of(repair.mesh.tets, 8).boundary_manifold);
}

TEST(MeshRepair, TetsThatTouchInAnEdgeAreSeparatedThere)
{
    const pbs::TetMesh mesh = unit_tet_and({{0.2, -1, -1}, {0.2, -1, -2}}, {0, 1, 5, 4});
    const pbs::RepairedMesh repair = pbs::repaired(mesh);
    EXPECT_EQ(repair.split, (std::vector<int>{0, 1}));
    EXPECT_EQ(repair.mesh.rest.rows(), 8);
    expect_the_same_tets(repair, mesh);
    EXPECT_FALSE(pbs::edge_that_is_not_manifold(repair.mesh.tets));
}

TEST(MeshRepair, TetsThatShareAFaceStayTogether)
{
    const pbs::TetMesh mesh = unit_tet_and({{0, 0, -1}}, {0, 2, 1, 4});
    const pbs::RepairedMesh repair = pbs::repaired(mesh);
    EXPECT_TRUE(repair.split.empty());
    EXPECT_EQ(repair.mesh.tets, mesh.tets);
}

TEST(MeshRepair, OfARepairedMeshChangesNothing)
{
    const pbs::RepairedMesh once = pbs::repaired(unit_tet_and({{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}}, {0, 4, 6, 5}));
    const pbs::RepairedMesh twice = pbs::repaired(once.mesh);
    EXPECT_EQ(twice.mesh.tets, once.mesh.tets);
    EXPECT_TRUE(twice.split.empty() && twice.unused.empty());
}

TEST(NonManifoldEdge, IsFoundWhereTwoTetsTouchInIt)
{
    const auto edge = pbs::edge_that_is_not_manifold(unit_tet_and({{0.2, -1, -1}, {0.2, -1, -2}}, {0, 1, 5, 4}).tets);
    ASSERT_TRUE(edge);
    EXPECT_EQ(*edge, (std::array{0, 1}));
}

TEST(NonManifoldEdge, IsNoneOfASoundMeshNorOfOneThatTouchesInAVertex)
{
    EXPECT_FALSE(pbs::edge_that_is_not_manifold(test_support::structured_bar({0, 0, 0}, {1, 1, 1}, {2, 2, 2}).tets));
    EXPECT_FALSE(pbs::edge_that_is_not_manifold(unit_tet_and({{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}}, {0, 4, 6, 5}).tets));
}

}  // namespace
