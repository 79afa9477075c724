// Reference: vertices, edges and faces of a few tets and of boxes of cubes, counted by hand; what holds of every
// repaired mesh.

#include "experiments/meshes/mesh_io_formats.hpp"
#include "pbs/geometry/topology.hpp"
#include "tests/support/structured_bar.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <tuple>

namespace {

using test_support::carved_box, test_support::two_tets;
using Edges = std::vector<std::array<int, 2>>;

// The unit tet and one that touches it in a vertex, and in an edge.
const pbs::TetMesh touching_in_a_vertex = {
    pbs::Positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}},
    pbs::Tets{{0, 1, 2, 3}, {0, 4, 6, 5}}};
const pbs::TetMesh touching_in_an_edge = {
    pbs::Positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.2, -1, -1}, {0.2, -1, -2}},
    pbs::Tets{{0, 1, 2, 3}, {0, 1, 5, 4}}};

// Each tet has an edge in common with the one before and, opposite to it, one with the next. The edges stand and lie in
// turn.
pbs::TetMesh ring(int tets)
{
    pbs::TetMesh mesh{pbs::Positions(2 * tets, 3), pbs::Tets(tets, 4)};
    for (int i = 0; i < tets; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / tets, half = 0.2, along = i % 2 ? half : 0.0,
                     up = i % 2 ? 0.0 : half;
        for (const int side : {-1, 1})
            mesh.rest.row(2 * i + (side + 1) / 2) << (2.0 + side * along) * std::cos(angle),
                (2.0 + side * along) * std::sin(angle), side * up;
    }
    for (int i = 0; i < tets; ++i) {
        const int next = (i + 1) % tets;
        mesh.tets.row(i) << 2 * i, 2 * i + 1, 2 * next, 2 * next + 1;
        if (pbs::tet_volumes(mesh.rest, mesh.tets.middleRows(i, 1))(0) < 0.0)
            std::swap(mesh.tets(i, 2), mesh.tets(i, 3));
    }
    return mesh;
}

// Two blocks of a box, which touch in the upright edges of these layers; all its other layers are whole.
pbs::TetMesh blocks_joined_outside(int first_layer, int last_layer)
{
    return carved_box({4, 4, 5},
                      [=](int i, int j, int k) { return k < first_layer || k > last_layer || (i < 2) == (j < 2); });
}

// Every corner of every tet stays in its place, the boundary is manifold, and another repair finds nothing to do.
void expect_sound(const pbs::MeshReading& repair, const pbs::TetMesh& mesh)
{
    ASSERT_EQ(repair.mesh.tets.rows(), mesh.tets.rows());
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t)
        for (int corner = 0; corner < 4; ++corner) {
            EXPECT_EQ(repair.mesh.rest.row(repair.mesh.tets(t, corner)), mesh.rest.row(mesh.tets(t, corner)));
            EXPECT_EQ(repair.file_vertex[std::size_t(repair.mesh.tets(t, corner))], mesh.tets(t, corner));
        }
    EXPECT_EQ(pbs::tet_volumes(repair.mesh.rest, repair.mesh.tets), pbs::tet_volumes(mesh.rest, mesh.tets));
    EXPECT_TRUE(pbs::topology_of(repair.mesh.tets, repair.mesh.rest.rows()).boundary_manifold);
    EXPECT_TRUE(pbs::touching_edges(repair.mesh.tets).empty());
    const pbs::MeshReading twice = pbs::repaired(repair.mesh);
    EXPECT_EQ(twice.mesh.tets, repair.mesh.tets);
    EXPECT_EQ(twice.mesh.rest, repair.mesh.rest);
    EXPECT_TRUE(twice.split_vertices.empty() && twice.unused_vertices.empty());
}

TEST(MeshRepair, ASoundMeshStaysAsItIsToTheBit)
{
    const pbs::TetMesh hollow = carved_box({3, 3, 3}, [](int i, int j, int k) { return i != 1 || j != 1 || k != 1; });
    for (const pbs::TetMesh& mesh :
         {test_support::structured_bar({0, 0, 0}, {2, 1, 1}, {3, 2, 2}), two_tets(), hollow}) {
        const pbs::MeshReading repair = pbs::repaired(mesh);
        EXPECT_EQ(repair.mesh.rest, mesh.rest);
        EXPECT_EQ(repair.mesh.tets, mesh.tets);
        EXPECT_TRUE(repair.unused_vertices.empty() && repair.split_vertices.empty());
        EXPECT_EQ(repair.cut_faces, 0);
    }
}

TEST(MeshRepair, UnusedVerticesAreLeftOut)
{
    pbs::TetMesh mesh = test_support::unit_tet();
    mesh.rest.conservativeResize(6, 3);
    mesh.rest.row(4) = mesh.rest.row(0);
    mesh.rest.row(0) << 9, 9, 9;
    mesh.rest.row(5) << 8, 8, 8;
    mesh.tets << 4, 1, 2, 3;
    const pbs::MeshReading repair = pbs::repaired(mesh);
    EXPECT_EQ(repair.unused_vertices, (std::vector<int>{0, 5}));
    EXPECT_EQ(repair.file_vertex, (std::vector<int>{1, 2, 3, 4}));
    EXPECT_EQ(repair.mesh.tets, (pbs::Tets(1, 4) << 3, 0, 1, 2).finished());
    expect_sound(repair, mesh);
}

TEST(MeshRepair, TwoTetsThatTouchGetVerticesOfTheirOwn)
{
    for (const auto& [mesh, split, edges] : {std::tuple(touching_in_a_vertex, std::vector<int>{0}, Edges{}),
                                             {touching_in_an_edge, std::vector<int>{0, 1}, Edges{{0, 1}}}}) {
        const pbs::MeshReading repair = pbs::repaired(mesh);
        EXPECT_EQ(repair.split_vertices, split);
        EXPECT_EQ(pbs::touching_edges(mesh.tets), edges);
        EXPECT_EQ(repair.mesh.rest.rows(), 8);
        EXPECT_EQ(repair.cut_faces, 0);
        expect_sound(repair, mesh);
    }
}

// Without a cut: the sides share no face, so that the vertices of each side are its own.
TEST(MeshRepair, SidesThatShareNoFaceAreSeparatedWithoutACut)
{
    struct Case {
        const char* name;
        pbs::TetMesh mesh;
        std::size_t edges, split;
        int vertices, parts;
    };
    const auto even = [](int i, int j, int k) { return (i + j + k) % 2 == 0; };
    for (const auto& [name, mesh, edges, split, vertices, parts] :
         {Case{"a ring of 8 tets", ring(8), 8, 16, 32, 8},
          Case{"two blocks along two edges", carved_box({2, 2, 2}, [](int i, int j, int) { return i == j; }), 2, 3, 24,
               2},
          Case{"every other cube of 8: six edges at one vertex", carved_box({2, 2, 2}, even), 6, 7, 32, 4},
          Case{"every other cube of 64", carved_box({4, 4, 4}, even), 108, 81, 256, 32}}) {
        SCOPED_TRACE(name);
        const pbs::MeshReading repair = pbs::repaired(mesh);
        EXPECT_EQ(pbs::touching_edges(mesh.tets).size(), edges);
        EXPECT_EQ(repair.split_vertices.size(), split);
        EXPECT_EQ(repair.mesh.rest.rows(), vertices);
        EXPECT_EQ(pbs::topology_of(repair.mesh.tets, vertices).components, parts);
        EXPECT_EQ(repair.cut_faces, 0);
        expect_sound(repair, mesh);
    }
}

// Vertex (2, 2, k) of the box has number 12 + 25 k. The middle one of a chain of two edges belongs to sides that share
// no face.
TEST(MeshRepair, BlocksThatOtherLayersJoinStayOnePartAndOnlyASingleEdgeNeedsACut)
{
    const pbs::TetMesh chain = blocks_joined_outside(2, 3), single = blocks_joined_outside(2, 2);
    const pbs::MeshReading of_chain = pbs::repaired(chain), of_single = pbs::repaired(single);
    EXPECT_EQ(pbs::touching_edges(chain.tets), (Edges{{62, 87}, {87, 112}}));
    EXPECT_EQ(of_chain.split_vertices, std::vector<int>{87});
    EXPECT_EQ(of_chain.cut_faces, 0);
    EXPECT_EQ(pbs::touching_edges(single.tets), (Edges{{62, 87}}));
    EXPECT_EQ(of_single.split_vertices, std::vector<int>{62});
    EXPECT_EQ(of_single.cut_faces, 2) << "from one side of the gap to the other, two faces are the least";
    for (const auto& [repair, mesh] : {std::pair(of_chain, chain), {of_single, single}}) {
        EXPECT_EQ(pbs::topology_of(repair.mesh.tets, repair.mesh.rest.rows()).components, 1);
        expect_sound(repair, mesh);
    }
}

// Two holes that touch in a vertex alone: no edge is in more than two triangles, and faces join all tets at the vertex.
TEST(MeshRepair, HolesThatTouchInAVertexAreSeparatedByACut)
{
    const pbs::TetMesh mesh = carved_box(
        {4, 4, 4}, [](int i, int j, int k) { return (i != 1 || j != 1 || k != 1) && (i != 2 || j != 2 || k != 2); });
    const pbs::MeshReading repair = pbs::repaired(mesh);
    EXPECT_TRUE(pbs::touching_edges(mesh.tets).empty());
    EXPECT_EQ(repair.split_vertices, std::vector<int>{62});
    EXPECT_EQ(repair.cut_faces, 2);
    expect_sound(repair, mesh);
}

TEST(MeshRepair, RandomCubesOfABoxBecomeManifold)
{
    std::mt19937 random(7);
    for (const unsigned kept_of_ten : {5u, 6u, 7u, 8u, 9u}) {
        SCOPED_TRACE(kept_of_ten);
        const pbs::TetMesh mesh = carved_box({5, 5, 5}, [&](int, int, int) { return random() % 10 < kept_of_ten; });
        const pbs::MeshReading repair = pbs::repaired(mesh);
        EXPECT_FALSE(pbs::touching_edges(mesh.tets).empty());
        expect_sound(repair, mesh);
    }
}

TEST(MeshRepair, WithoutSeparationOnlyUnusedVerticesGo)
{
    for (const pbs::TetMesh& mesh : {touching_in_an_edge, ring(8), blocks_joined_outside(2, 2), two_tets()}) {
        const pbs::MeshReading repair = pbs::repaired(mesh, false);
        const pbs::TetMesh used = pbs::kept_tets(mesh, std::vector<bool>(std::size_t(mesh.tets.rows()), true));
        EXPECT_EQ(repair.mesh.rest, used.rest);
        EXPECT_EQ(repair.mesh.tets, used.tets);
        EXPECT_TRUE(repair.split_vertices.empty());
        EXPECT_EQ(repair.cut_faces, 0);
    }
}

TEST(TouchingEdges, AreThoseOfMoreThanTwoTrianglesOfTheBoundary)
{
    EXPECT_EQ(pbs::touching_edges(touching_in_an_edge.tets), (Edges{{0, 1}}));
    EXPECT_TRUE(pbs::touching_edges(test_support::structured_bar({0, 0, 0}, {1, 1, 1}, {2, 2, 2}).tets).empty());
    EXPECT_TRUE(pbs::touching_edges(touching_in_a_vertex.tets).empty());
}

}  // namespace
