// Reference: each violation of the rules, by name, on the smallest mesh that has it.
#include "pbs/geometry/mesh_io_checks.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/parts.hpp"
#include "tests/support/structured_bar.hpp"
#include "tests/support/unit_tet.hpp"

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

}  // namespace
