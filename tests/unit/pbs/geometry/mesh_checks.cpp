// Reference: each violation of the rules, by name, on the smallest mesh that has it.

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/mesh_io_formats.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"
#include "tests/support/structured_bar.hpp"
#include "tests/unit/pbs/character/expect_input_error.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace {

using test_support::unit_tet;

// Adds points and a tet to a mesh.
pbs::TetMesh with(pbs::TetMesh mesh, const std::vector<pbs::Vec3>& points, const std::array<int, 4>& tet)
{
    for (const pbs::Vec3& p : points) {
        mesh.rest.conservativeResize(mesh.rest.rows() + 1, 3);
        mesh.rest.bottomRows<1>() = p.transpose();
    }
    mesh.tets.conservativeResize(mesh.tets.rows() + 1, 4);
    mesh.tets.bottomRows<1>() << tet[0], tet[1], tet[2], tet[3];
    return mesh;
}

// The unit tet and one that touches it in a vertex, in an edge, and in a face.
const pbs::TetMesh touching_in_a_vertex = with(unit_tet(), {{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}}, {0, 4, 6, 5});
const pbs::TetMesh touching_in_an_edge = with(unit_tet(), {{0.2, -1, -1}, {0.2, -1, -2}}, {0, 1, 5, 4});
const pbs::TetMesh touching_in_a_face = with(unit_tet(), {{0, 0, -1}}, {0, 2, 1, 4});

void expect_refused(const pbs::TetMesh& mesh, const std::string& words)
{
    expect_input_error([&] { pbs::check_rest("m.vtu", mesh); }, "m.vtu: ", words);
}

TEST(RestMesh, ASoundOneIsAcceptedAndAnInvertedTetTurnedAndCounted)
{
    EXPECT_EQ(pbs::check_rest("m.vtu", unit_tet()).flipped_tets, 0);
    EXPECT_EQ(pbs::check_rest("m.vtu", test_support::structured_bar({-1, -1, -1}, {1, 1, 1}, {2, 2, 2})).flipped_tets, 0);
    pbs::TetMesh mesh = unit_tet();
    mesh.tets << 0, 1, 3, 2;
    const pbs::MeshReading reading = pbs::check_rest("m.vtu", mesh);
    EXPECT_EQ(reading.flipped_tets, 1);
    EXPECT_EQ(reading.mesh.tets, unit_tet().tets);
}

TEST(RestMesh, AnySizeIsAcceptedAndAFlatTetRefusedAtAnySize)  // flatness has no unit
{
    for (const double scale : {1e-6, 1.0, 1e6}) {
        pbs::TetMesh mesh = unit_tet();
        EXPECT_NO_THROW(pbs::check_rest("m.vtu", {scale * mesh.rest, mesh.tets})) << scale;
        mesh.rest.row(3) << 0.3, 0.3, 1e-12;
        mesh.rest *= scale;
        expect_refused(mesh, "tet 0 = (0, 1, 2, 3): expected a volume");
    }
}

TEST(RestMesh, IsRefusedByItsDefect)
{
    const pbs::Tets none(0, 4);
    expect_refused({unit_tet().rest, none}, "tets = 0");
    expect_refused(with(unit_tet(), {}, {0, 1, 2, 2}), "tet 1 = (0, 1, 2, 2): expected a volume");
    expect_refused(with(unit_tet(), {}, {1, 2, 3, 4}), "tet 1 vertex = 4: expected an index from 0 to 3");
    expect_refused(with(unit_tet(), {}, {-1, 2, 3, 0}), "tet 1 vertex = -1");
    expect_refused(with(unit_tet(), {{0, 0, 0}, {1, 1, 1}}, {4, 2, 1, 5}), "vertex 0 is there already");
    expect_refused(with(touching_in_a_face, {{0.1, 0.2, 2}}, {0, 1, 2, 5}), "one face is in three");
    expect_refused(with(unit_tet(), {{0.2, 0.2, 0.5}}, {0, 1, 2, 4}), "they overlap");
#ifdef PBS_WITH_CGAL
    expect_refused(with(unit_tet(), {{0.1, 0.1, -1}, {0.2, 0.1, -1}, {0.1, 0.2, -1}, {0.12, 0.12, 3}}, {4, 5, 6, 7}),
                   "does not intersect itself");
#endif
}

TEST(RestMesh, CoordinatesThatAreNotFiniteAreRefused)
{
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        pbs::TetMesh mesh = unit_tet();
        mesh.rest(2, 1) = bad;
        expect_refused(mesh, "vertex 2 = (0, ");
    }
}

TEST(RestMesh, AnUnusedVertexIsLeftOut)
{
    pbs::TetMesh mesh = unit_tet();
    mesh.rest.conservativeResize(5, 3);
    mesh.rest.row(4) << 0, 0, 0;  // it may be where another one is
    const pbs::MeshReading reading = pbs::check_rest("m.vtu", mesh);
    EXPECT_EQ(reading.mesh.rest, unit_tet().rest);
    EXPECT_EQ(reading.unused_vertices, std::vector<int>{4});
    EXPECT_EQ(reading.file_vertices, 5);
}

TEST(RestMesh, TetsThatTouchAreSeparatedThereOrJoinedByTheirFace)
{
    EXPECT_EQ(pbs::check_rest("m.vtu", touching_in_an_edge).split_vertices, (std::vector<int>{0, 1}));
    EXPECT_EQ(pbs::check_rest("m.vtu", touching_in_a_vertex).split_vertices, std::vector<int>{0});
    EXPECT_TRUE(pbs::check_rest("m.vtu", touching_in_a_face).split_vertices.empty());
}

// The middle one of three layers of 2 x 2 cubes has two cubes that touch in an edge alone; the other layers join its ends.
TEST(RestMesh, TetsThatTouchInAnEdgeWhoseEndsAreJoinedAreRefusedByTheirVertices)
{
    const pbs::TetMesh bar = test_support::structured_bar({0, 0, 0}, {2, 2, 3}, {2, 2, 3});
    std::vector<bool> kept(std::size_t(bar.tets.rows()), true);
    for (const int cube : {5, 6}) std::fill_n(kept.begin() + 6 * cube, 6, false);
    expect_refused(pbs::kept_tets(bar, kept), "boundary = vertices 13 and 22: expected a manifold");
}

TEST(Frame, CoordinatesWhoseVolumesOverflowAreRefused)
{
    for (const double bad : {1e200, -2e9, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
        pbs::TetMesh frame = test_support::structured_bar({-1, -1, -1}, {1, 1, 1}, {2, 2, 2});
        frame.rest(1, 2) = bad;
        EXPECT_THROW(pbs::check_frame("m.vtu", frame), pbs::InputError) << bad;
        frame.rest(1, 2) = 1e9;
        EXPECT_NO_THROW(pbs::check_frame("m.vtu", frame));
    }
    EXPECT_NO_THROW(pbs::check_frame("m.vtu", with(unit_tet(), {{0.2, 0.2, 0.5}}, {0, 1, 2, 2}))) << "indices and places alone are checked";
}

// Reference: two or three tets, of which each vertex and each face is counted by hand.

// Every corner of every tet stays in its place.
void expect_the_same_tets(const pbs::MeshReading& repair, const pbs::TetMesh& mesh)
{
    ASSERT_EQ(repair.mesh.tets.rows(), mesh.tets.rows());
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t)
        for (int corner = 0; corner < 4; ++corner) {
            EXPECT_EQ(repair.mesh.rest.row(repair.mesh.tets(t, corner)), mesh.rest.row(mesh.tets(t, corner)));
            EXPECT_EQ(repair.file_vertex[std::size_t(repair.mesh.tets(t, corner))], mesh.tets(t, corner));
        }
}

TEST(MeshRepair, ASoundMeshStaysAsItIsAndTetsThatShareAFaceStayTogether)
{
    for (const pbs::TetMesh& mesh : {test_support::structured_bar({0, 0, 0}, {2, 1, 1}, {3, 2, 2}), touching_in_a_face}) {
        const pbs::MeshReading repair = pbs::repaired(mesh);
        EXPECT_EQ(repair.mesh.rest, mesh.rest);
        EXPECT_EQ(repair.mesh.tets, mesh.tets);
        EXPECT_TRUE(repair.unused_vertices.empty());
        EXPECT_TRUE(repair.split_vertices.empty());
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
    expect_the_same_tets(repair, mesh);
}

TEST(MeshRepair, TetsThatTouchInAVertexOrAnEdgeGetVerticesOfTheirOwn)
{
    for (const auto& [mesh, split] : {std::pair(touching_in_a_vertex, std::vector<int>{0}), {touching_in_an_edge, {0, 1}}}) {
        const pbs::MeshReading repair = pbs::repaired(mesh);
        EXPECT_EQ(repair.split_vertices, split);
        EXPECT_EQ(repair.mesh.rest.rows(), 8);
        expect_the_same_tets(repair, mesh);
        EXPECT_TRUE(pbs::topology_of(repair.mesh.tets, 8).boundary_manifold);
        EXPECT_FALSE(pbs::edge_that_is_not_manifold(repair.mesh.tets));
        const pbs::MeshReading twice = pbs::repaired(repair.mesh);
        EXPECT_EQ(twice.mesh.tets, repair.mesh.tets);
        EXPECT_TRUE(twice.split_vertices.empty() && twice.unused_vertices.empty());
    }
}

TEST(NonManifoldEdge, IsFoundWhereTwoTetsTouchInItAlone)
{
    const auto edge = pbs::edge_that_is_not_manifold(touching_in_an_edge.tets);
    ASSERT_TRUE(edge);
    EXPECT_EQ(*edge, (std::array{0, 1}));
    EXPECT_FALSE(pbs::edge_that_is_not_manifold(test_support::structured_bar({0, 0, 0}, {1, 1, 1}, {2, 2, 2}).tets));
    EXPECT_FALSE(pbs::edge_that_is_not_manifold(touching_in_a_vertex.tets));
}

}  // namespace
