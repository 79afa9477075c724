// Reference: each violation of the rules, by name, on the smallest mesh that has it.

#include "experiments/meshes/mesh_io_formats.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "tests/support/structured_bar.hpp"
#include "tests/unit/experiments/characters/expect_input_error.hpp"

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

void expect_refused(const pbs::TetMesh& mesh, const std::string& words)
{
    expect_input_error([&] { pbs::check_rest("m.vtu", mesh); }, "m.vtu: ", words);
}

TEST(RestMesh, ASoundOneIsAcceptedAndAnInvertedTetTurnedAndCounted)
{
    EXPECT_EQ(pbs::check_rest("m.vtu", unit_tet()).flipped_tets, 0);
    EXPECT_EQ(pbs::check_rest("m.vtu", test_support::structured_bar({-1, -1, -1}, {1, 1, 1}, {2, 2, 2})).flipped_tets,
              0);
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
    expect_refused(with(test_support::two_tets(), {{0.1, 0.2, 2}}, {0, 1, 2, 5}), "one face is in three");
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

// The middle one of three layers of 2 x 2 cubes has two cubes that touch in an edge alone; the other layers join its
// ends.
TEST(RestMesh, ThatTouchesItselfInAnEdgeIsAcceptedWithARemark)
{
    const pbs::TetMesh bar = test_support::carved_box({2, 2, 3}, [](int i, int j, int k) { return k != 1 || i == j; });
    const pbs::MeshReading split = pbs::check_rest("m.vtu", bar), kept = pbs::check_rest("m.vtu", bar, false);
    EXPECT_EQ(pbs::remarks_on("m.vtu", split),
              (std::vector<std::string>{
                  "m.vtu: edges at which parts touch = 1 (13-22): split, so that each side has its own",
                  "m.vtu: vertices at which parts touch = 4 (13, 23, 25, 26): split, so that each part has its own",
                  "m.vtu: faces that were cut = 2: they joined parts that touch"}));
    EXPECT_EQ(pbs::remarks_on("m.vtu", kept),
              std::vector<std::string>{
                  "m.vtu: edges at which parts touch = 1 (13-22): kept: no metric needs a manifold boundary"});
    EXPECT_EQ(kept.mesh.tets, bar.tets);
    EXPECT_EQ(kept.mesh.rest, bar.rest);
}

// Two bars of 4 tets a cell side by side, and one 0.5 within the other: with vertices of their own.
TEST(RestMesh, ForMetricsVerticesInOnePlaceAndBodiesThatOverlapAreKeptWithARemark)
{
    const pbs::TetMesh bar = test_support::structured_bar({0, 0, 0}, {1, 1, 1}, {1, 1, 1});
    for (const double shift : {1.0, 0.5}) {
        pbs::TetMesh both{pbs::Positions(16, 3), pbs::Tets(2 * bar.tets.rows(), 4)};
        both.rest << bar.rest, bar.rest.rowwise() + Eigen::RowVector3d(shift, 0, 0);
        both.tets << bar.tets, bar.tets.array() + 8;
        const pbs::MeshReading reading = pbs::check_rest("m.vtu", both, false);
        EXPECT_EQ(reading.mesh.rest, both.rest);
        EXPECT_EQ(reading.mesh.tets, both.tets);
        EXPECT_EQ(reading.doubled_vertices.size(), shift == 1.0 ? 4u : 0u);
        const std::vector<std::string> remarks = pbs::remarks_on("m.vtu", reading);
#ifdef PBS_WITH_CGAL
        EXPECT_EQ(reading.overlapping >= 0, shift == 0.5);
        ASSERT_EQ(remarks.size(), 2u);
        EXPECT_NE(remarks[0].find(shift == 1.0 ? "vertices in one place = 4 ("
                                               : "boundary that intersects itself, near vertex = "),
                  std::string::npos)
            << remarks[0];
#endif
        EXPECT_EQ(remarks.back(), "m.vtu: parts = 2: kept; no face joins them");
        EXPECT_THROW(pbs::check_rest("m.vtu", both), pbs::InputError);
    }
}

TEST(Frame, CoordinatesWhoseVolumesOverflowAreRefused)
{
    for (const double bad :
         {1e200, -2e9, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
        pbs::TetMesh frame = test_support::structured_bar({-1, -1, -1}, {1, 1, 1}, {2, 2, 2});
        frame.rest(1, 2) = bad;
        EXPECT_THROW(pbs::check_frame("m.vtu", frame), pbs::InputError) << bad;
        frame.rest(1, 2) = 1e9;
        EXPECT_NO_THROW(pbs::check_frame("m.vtu", frame));
    }
    EXPECT_NO_THROW(pbs::check_frame("m.vtu", with(unit_tet(), {{0.2, 0.2, 0.5}}, {0, 1, 2, 2})))
        << "indices and places alone are checked";
}

}  // namespace
