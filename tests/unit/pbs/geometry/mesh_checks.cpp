// Reference: each violation of the rules, by name, on the smallest mesh that has it.

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/mesh_io_formats.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"
#include "tests/support/structured_bar.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace {

using test_support::unit_tet;

// Adds a point and a tet to a mesh.
pbs::TetMesh with(pbs::TetMesh mesh, std::vector<pbs::Vec3> points, const std::array<int, 4>& tet)
{
    for (const pbs::Vec3& p : points) {
        mesh.rest.conservativeResize(mesh.rest.rows() + 1, 3);
        mesh.rest.bottomRows<1>() = p.transpose();
    }
    mesh.tets.conservativeResize(mesh.tets.rows() + 1, 4);
    mesh.tets.bottomRows<1>() << tet[0], tet[1], tet[2], tet[3];
    return mesh;
}

void expect_refused(const pbs::TetMesh& mesh, const std::string& words)
{
    try {
        pbs::check_rest("m.vtu", mesh);
        FAIL() << "accepted; expected: " << words;
    } catch (const pbs::InputError& error) {
        const std::string what = error.what();
        EXPECT_EQ(what.rfind("m.vtu: ", 0), 0u) << what;
        EXPECT_NE(what.find(words), std::string::npos) << what;
    }
}

TEST(RestMesh, ASoundOneIsAccepted)
{
    EXPECT_EQ(pbs::check_rest("m.vtu", unit_tet()).flipped_tets, 0);
    EXPECT_EQ(pbs::check_rest("m.vtu", test_support::structured_bar({-1, -1, -1}, {1, 1, 1}, {2, 2, 2})).flipped_tets, 0);
}

TEST(RestMesh, AnInvertedTetIsTurnedAndCounted)
{
    pbs::TetMesh mesh = unit_tet();
    mesh.tets << 0, 1, 3, 2;
    const pbs::MeshReading reading = pbs::check_rest("m.vtu", mesh);
    EXPECT_EQ(reading.flipped_tets, 1);
    EXPECT_EQ(reading.mesh.tets, unit_tet().tets);
}

TEST(RestMesh, AnySizeIsAccepted)  // flatness has no unit
{
    for (const double scale : {1e-6, 1.0, 1e6}) {
        pbs::TetMesh mesh = unit_tet();
        mesh.rest *= scale;
        EXPECT_NO_THROW(pbs::check_rest("m.vtu", mesh)) << scale;
    }
}

TEST(RestMesh, AFlatTetIsRefusedAtAnySize)
{
    for (const double scale : {1e-6, 1.0, 1e6}) {
        pbs::TetMesh mesh = unit_tet();
        mesh.rest.row(3) << 0.3, 0.3, 1e-12;
        mesh.rest *= scale;
        expect_refused(mesh, "tet 0 = (0, 1, 2, 3): expected a volume");
    }
}

TEST(RestMesh, ATetWithATwiceNamedVertexIsRefused)
{
    expect_refused(with(unit_tet(), {}, {0, 1, 2, 2}), "tet 1 = (0, 1, 2, 2): expected a volume");
}

TEST(RestMesh, NoTetsAreRefused)
{
    pbs::TetMesh mesh = unit_tet();
    mesh.tets.resize(0, 4);
    expect_refused(mesh, "tets = 0");
}

TEST(RestMesh, IndicesOutOfRangeAreRefused)
{
    expect_refused(with(unit_tet(), {}, {1, 2, 3, 4}), "tet 1 vertex = 4: expected an index from 0 to 3");
    expect_refused(with(unit_tet(), {}, {-1, 2, 3, 0}), "tet 1 vertex = -1");
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

TEST(RestMesh, ADoubledVertexIsRefused)
{
    expect_refused(with(unit_tet(), {{0, 0, 0}, {1, 1, 1}}, {4, 2, 1, 5}), "vertex 0 is there already");
}

TEST(RestMesh, AFaceInThreeTetsIsRefused)
{
    const pbs::TetMesh pair = with(unit_tet(), {{0, 0, -1}}, {0, 2, 1, 4});
    EXPECT_NO_THROW(pbs::check_rest("m.vtu", pair));
    expect_refused(with(pair, {{0.1, 0.2, 2}}, {0, 1, 2, 5}), "one face is in three");
}

TEST(RestMesh, NeighboursFoldedOverEachOtherAreRefused)
{
    expect_refused(with(unit_tet(), {{0.2, 0.2, 0.5}}, {0, 1, 2, 4}), "they overlap");
}

TEST(RestMesh, TetsThatTouchInAnEdgeOrVertexAreSeparatedThere)
{
    const pbs::TetMesh edge = with(unit_tet(), {{0.2, -1, -1}, {0.2, -1, -2}}, {0, 1, 5, 4});
    EXPECT_EQ(pbs::check_rest("m.vtu", edge).split_vertices, (std::vector<int>{0, 1}));
    const pbs::TetMesh vertex = with(unit_tet(), {{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}}, {0, 4, 6, 5});
    EXPECT_EQ(pbs::check_rest("m.vtu", vertex).split_vertices, std::vector<int>{0});
}

// Of three layers of 2 x 2 cubes, the middle one has two cubes that touch in an edge alone; the other layers join its ends.
TEST(RestMesh, TetsThatTouchInAnEdgeWhoseEndsAreJoinedAreRefusedByTheirVertices)
{
    const pbs::TetMesh bar = test_support::structured_bar({0, 0, 0}, {2, 2, 3}, {2, 2, 3});
    std::vector<bool> kept(std::size_t(bar.tets.rows()), true);
    for (const int cube : {5, 6}) std::fill_n(kept.begin() + 6 * cube, 6, false);
    expect_refused(pbs::kept_tets(bar, kept), "boundary = vertices 13 and 22: expected a manifold");
}

#ifdef PBS_WITH_CGAL
TEST(RestMesh, BodiesThroughEachOtherAreRefused)
{
    const pbs::TetMesh through = with(unit_tet(), {{0.1, 0.1, -1}, {0.2, 0.1, -1}, {0.1, 0.2, -1}, {0.12, 0.12, 3}}, {4, 5, 6, 7});
    expect_refused(through, "does not intersect itself");
}
#endif

TEST(Frame, CoordinatesWhoseVolumesOverflowAreRefused)
{
    for (const double bad : {1e200, -2e9, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
        pbs::TetMesh frame = test_support::structured_bar({-1, -1, -1}, {1, 1, 1}, {2, 2, 2});
        frame.rest(1, 2) = bad;
        EXPECT_THROW(pbs::check_frame("m.vtu", frame), pbs::InputError) << bad;
        frame.rest(1, 2) = 1e9;
        EXPECT_NO_THROW(pbs::check_frame("m.vtu", frame));
    }
}

TEST(Frame, AsksForIndicesAndPlacesAlone)
{
    EXPECT_NO_THROW(pbs::check_frame("m.vtu", with(unit_tet(), {{0.2, 0.2, 0.5}}, {0, 1, 2, 2})));
}

// Reference: two or three tets, of which each vertex and each face is counted by hand.

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
void expect_the_same_tets(const pbs::MeshReading& repair, const pbs::TetMesh& mesh)
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
    const pbs::MeshReading repair = pbs::repaired(bar);
    EXPECT_EQ(repair.mesh.rest, bar.rest);
    EXPECT_EQ(repair.mesh.tets, bar.tets);
    EXPECT_TRUE(repair.unused_vertices.empty());
    EXPECT_TRUE(repair.split_vertices.empty());
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

TEST(MeshRepair, TetsThatTouchInAVertexGetOneEach)
{
    const pbs::TetMesh mesh = unit_tet_and({{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}}, {0, 4, 6, 5});
    const pbs::MeshReading repair = pbs::repaired(mesh);
    EXPECT_EQ(repair.split_vertices, std::vector<int>{0});
    EXPECT_EQ(repair.mesh.rest.rows(), 8);
    expect_the_same_tets(repair, mesh);
    EXPECT_TRUE(pbs::topology_of(repair.mesh.tets, 8).boundary_manifold);
}

TEST(MeshRepair, TetsThatTouchInAnEdgeAreSeparatedThere)
{
    const pbs::TetMesh mesh = unit_tet_and({{0.2, -1, -1}, {0.2, -1, -2}}, {0, 1, 5, 4});
    const pbs::MeshReading repair = pbs::repaired(mesh);
    EXPECT_EQ(repair.split_vertices, (std::vector<int>{0, 1}));
    EXPECT_EQ(repair.mesh.rest.rows(), 8);
    expect_the_same_tets(repair, mesh);
    EXPECT_FALSE(pbs::edge_that_is_not_manifold(repair.mesh.tets));
}

TEST(MeshRepair, TetsThatShareAFaceStayTogether)
{
    const pbs::TetMesh mesh = unit_tet_and({{0, 0, -1}}, {0, 2, 1, 4});
    const pbs::MeshReading repair = pbs::repaired(mesh);
    EXPECT_TRUE(repair.split_vertices.empty());
    EXPECT_EQ(repair.mesh.tets, mesh.tets);
}

TEST(MeshRepair, OfARepairedMeshChangesNothing)
{
    const pbs::MeshReading once = pbs::repaired(unit_tet_and({{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}}, {0, 4, 6, 5}));
    const pbs::MeshReading twice = pbs::repaired(once.mesh);
    EXPECT_EQ(twice.mesh.tets, once.mesh.tets);
    EXPECT_TRUE(twice.split_vertices.empty() && twice.unused_vertices.empty());
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
