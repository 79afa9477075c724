// Reference: counts of red refinement (V + E vertices, 2E + 3F + T edges, 8T tets), Euler's formula, and the definition of a midpoint.
#include "pbs/geometry/refinement.hpp"

#include "pbs/geometry/quality.hpp"
#include "pbs/geometry/tet_volume.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/structured_bar.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

namespace {

using pbs::Refinement;
using pbs::TetMesh;

TetMesh one_tet()
{
    TetMesh mesh{pbs::Positions(4, 3), pbs::Tets(1, 4)};
    mesh.rest << 0, 0, 0, 1, 0, 0, 0.2, 1, 0, 0.1, 0.3, 1;
    mesh.tets << 0, 1, 2, 3;
    return mesh;
}

// A 3 x 3 x 1 box of unit cubes without the middle one: a body with one handle.
TetMesh ring()
{
    TetMesh box = test_support::structured_bar({0, 0, 0}, {3, 3, 1}, {3, 3, 1});
    constexpr int middle = 4, tets_a_cell = 6;
    pbs::Tets kept(box.tets.rows() - tets_a_cell, 4);
    kept << box.tets.topRows(tets_a_cell * middle), box.tets.bottomRows(box.tets.rows() - tets_a_cell * (middle + 1));
    box.tets = kept;
    return box;
}

// The smallest of the four determinants of a tet in which the point replaces a corner: not negative where the point lies in the tet. It is
// exact where all coordinates are small multiples of 1/4.
double smallest_determinant(const TetMesh& mesh, Eigen::Index tet, const pbs::Vec3& point)
{
    double smallest = std::numeric_limits<double>::infinity();
    for (int replaced = 0; replaced < 4; ++replaced) {
        std::array<pbs::Vec3, 4> p;
        for (int corner = 0; corner < 4; ++corner) p[corner] = mesh.rest.row(mesh.tets(tet, corner));
        p[replaced] = point;
        smallest = std::min(smallest, (p[1] - p[0]).cross(p[2] - p[0]).dot(p[3] - p[0]));
    }
    return smallest;
}

// Each volume goes through ten roundings of products of edges, whose sum is bounded in tests/support/volume_rounding.hpp. A midpoint is
// rounded once; its coordinates are at most twice as long as an edge of a child, which has two ends: twelve more for three edges.
TEST(Refinement, OfOneTetIsEightOfAnEighthOfItsVolume)
{
    const Refinement fine = pbs::refine(one_tet());
    ASSERT_EQ(fine.mesh.rest.rows(), 10);
    ASSERT_EQ(fine.mesh.tets.rows(), 8);
    const double volume = pbs::tet_volumes(one_tet().rest, one_tet().tets)(0);
    const Eigen::VectorXd volumes = pbs::tet_volumes(fine.mesh.rest, fine.mesh.tets);
    const double edge_m = pbs::quality_of(fine.mesh).longest_edge_m, magnitude = 2.0 / std::sqrt(3.0) * std::pow(edge_m, 3) / 6.0;
    for (const double child : volumes) EXPECT_NEAR(child, volume / 8.0, test_support::rounding_error(10 + 10 + 12, magnitude));
}

TEST(Refinement, KeepsTheCoarseVerticesAndHalvesTheEdges)
{
    const TetMesh bar = test_support::structured_bar({-1, 0, 0}, {1, 1, 1}, {3, 2, 2});
    const Refinement fine = pbs::refine(bar);
    EXPECT_EQ(fine.mesh.rest.topRows(bar.rest.rows()), bar.rest);
    ASSERT_EQ(fine.mesh.rest.rows(), bar.rest.rows() + fine.parents.rows());
    EXPECT_EQ(fine.parents, pbs::edges_of(bar.tets));  // each once
    for (Eigen::Index e = 0; e < fine.parents.rows(); ++e)
        EXPECT_EQ(fine.mesh.rest.row(bar.rest.rows() + e), 0.5 * (bar.rest.row(fine.parents(e, 0)) + bar.rest.row(fine.parents(e, 1))));
}

TEST(Refinement, CountsAreThoseOfRedRefinement)
{
    const TetMesh bar = test_support::structured_bar({0, 0, 0}, {4, 3, 2}, {4, 3, 2});
    const pbs::Quality coarse = pbs::quality_of(bar), fine = pbs::quality_of(pbs::refine(bar).mesh);
    const int faces = (4 * coarse.tets + coarse.boundary_triangles) / 2;
    EXPECT_EQ(fine.vertices, coarse.vertices + coarse.edges);
    EXPECT_EQ(fine.tets, 8 * coarse.tets);
    EXPECT_EQ(fine.edges, 2 * coarse.edges + 3 * faces + coarse.tets);
    EXPECT_EQ(fine.boundary_triangles, 4 * coarse.boundary_triangles);  // neighbours agree on the faces between them
    // Coordinates are multiples of 1/2: only the division by 6 in three terms of each tet is rounded, their sum, and the sum over tets.
    EXPECT_NEAR(fine.volume_m3, coarse.volume_m3, test_support::rounding_error(2 * 5 + fine.tets + coarse.tets, 24.0));
}

TEST(Refinement, ABodyWithAHandleKeepsIt)
{
    for (TetMesh mesh = ring(); mesh.tets.rows() < 10000; mesh = pbs::refine(mesh).mesh) {
        const pbs::Topology topology = pbs::topology_of(mesh.tets, mesh.rest.rows());
        EXPECT_TRUE(topology.boundary_manifold);
        EXPECT_EQ(topology.boundary_euler, 0);
        EXPECT_EQ(topology.components, 1);
        EXPECT_EQ(topology.unused_vertices, 0);
    }
}

TEST(Refinement, ChildrenLieInTheirParentAndAtItsCorners)
{
    const TetMesh bar = test_support::structured_bar({0, 0, 0}, {1, 2, 3}, {2, 2, 2});
    const TetMesh fine = pbs::refine(bar).mesh;
    for (Eigen::Index t = 0; t < fine.tets.rows(); ++t) {
        for (const int v : fine.tets.row(t)) EXPECT_GE(smallest_determinant(bar, t / 8, fine.rest.row(v)), 0.0);
        if (const Eigen::Index child = t % 8; child < 4) {
            EXPECT_EQ(fine.tets(t, child), bar.tets(t / 8, child));
        }
    }
}

TEST(Refinement, CutsTheOctahedronAlongItsShortestDiagonal)
{
    for (int longest = 0; longest < 3; ++longest) {  // pairs of opposite edges of a box, so that the diagonals are its extents
        const pbs::Vec3 extent = pbs::Vec3(longest == 0 ? 1 : 3, longest == 1 ? 1 : 3, longest == 2 ? 1 : 3);
        TetMesh mesh{pbs::Positions(4, 3), pbs::Tets(1, 4)};
        mesh.rest << 0, 0, 0, 1, 1, 0, 0, 1, 1, 1, 0, 1;
        mesh.rest = mesh.rest * extent.asDiagonal();
        mesh.tets << 0, 1, 2, 3;
        const TetMesh fine = pbs::refine(mesh).mesh;
        std::set<double> inner;  // lengths of the edges between the midpoints of opposite edges, which lie along one axis
        for (Eigen::Index t = 4; t < 8; ++t)
            for (int a = 0; a < 4; ++a)
                for (int b = 0; b < a; ++b) {
                    const pbs::Vec3 edge = fine.rest.row(fine.tets(t, a)) - fine.rest.row(fine.tets(t, b));
                    if ((edge.array() != 0.0).count() == 1) inner.insert(edge.norm());
                }
        EXPECT_EQ(inner, std::set<double>{1.0});
    }
}

TEST(Refinement, AnInvertedTetStaysInverted)
{
    TetMesh mesh = one_tet();
    mesh.tets << 1, 0, 2, 3;
    const TetMesh fine = pbs::refine(mesh).mesh;
    EXPECT_LT(pbs::tet_volumes(fine.rest, fine.tets).maxCoeff(), 0.0);
}

TEST(Refinement, AnUnusedVertexIsKept)
{
    TetMesh mesh = one_tet();
    mesh.rest.conservativeResize(5, 3);
    mesh.rest.row(4) << 7, 8, 9;
    const TetMesh fine = pbs::refine(mesh).mesh;
    EXPECT_EQ(fine.rest.rows(), 11);
    EXPECT_EQ(fine.rest.row(4), mesh.rest.row(4));
    EXPECT_EQ(pbs::topology_of(fine.tets, fine.rest.rows()).unused_vertices, 1);
}

TEST(Refinement, OfNothingIsNothing)
{
    const Refinement fine = pbs::refine({pbs::Positions(0, 3), pbs::Tets(0, 4)});
    EXPECT_EQ(fine.mesh.rest.rows(), 0);
    EXPECT_EQ(fine.mesh.tets.rows(), 0);
    EXPECT_EQ(fine.parents.rows(), 0);
}

TEST(Prolongated, CarriesAnAffineFieldExactly)
{
    const TetMesh bar = test_support::structured_bar({0, 0, 0}, {1, 1, 1}, {2, 2, 2});
    const Refinement fine = pbs::refine(bar);
    const Eigen::Matrix3d map = (Eigen::Matrix3d() << 1, 2, 3, -4, 5, 6, 7, 8, -9).finished();
    const pbs::Positions carried = pbs::prolongated(bar.rest * map, fine.parents);
    EXPECT_EQ(carried, fine.mesh.rest * map);  // of multiples of 1/4 by whole numbers, which no product or sum rounds
}

}  // namespace
