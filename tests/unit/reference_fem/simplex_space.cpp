// Reference: the definition of nodal elements. Vertex v is node v, shape functions are 1 at their own node and 0 at the others. At nodes
// they are polynomials of 0, 1/2 and 1, which are not rounded.
#include "reference_fem/simplex_space.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/topology.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/structured_bar.hpp"

#include <gtest/gtest.h>

#include <set>

namespace {

using pbs::Vec3;
using reference_fem::SimplexSpace;

const pbs::TetMesh bar = test_support::structured_bar({0, 0, 0}, {3, 1, 1}, {3, 2, 1});

TEST(SimplexSpace, KeepsVerticesAndTetsInTheirOrder)
{
    for (const int order : {1, 2}) {
        const SimplexSpace space(bar, order);
        EXPECT_EQ(space.node_positions().topRows(bar.rest.rows()), bar.rest);
        EXPECT_EQ(space.tet_nodes().leftCols(4), bar.tets);
    }
}

TEST(SimplexSpace, LinearHasOneNodeAVertexAndQuadraticOneMoreAnEdge)
{
    EXPECT_EQ(SimplexSpace(bar, 1).nodes(), bar.rest.rows());
    EXPECT_EQ(SimplexSpace(bar, 2).nodes(), bar.rest.rows() + pbs::edges_of(bar.tets).rows());
}

TEST(SimplexSpace, MidEdgeNodesLieInTheMiddleOfTheirEdges)
{
    const SimplexSpace space(bar, 2);
    std::set<int> seen;
    for (const auto& tet : space.tet_nodes().rowwise())
        for (int k = 0; k < 6; ++k) {
            const auto& [first, second] = SimplexSpace::edge_corners[k];
            const Eigen::RowVector3d middle = (bar.rest.row(tet(first)) + bar.rest.row(tet(second))) / 2.0;
            EXPECT_EQ(space.node_positions().row(tet(4 + k)), middle);
            seen.insert(tet(4 + k));
        }
    EXPECT_EQ(static_cast<int>(seen.size()), space.nodes() - bar.rest.rows());
}

TEST(SimplexSpace, ShapeFunctionsAreOneAtTheirOwnNodeAndZeroAtTheOthers)
{
    const Vec3 corners[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (const int order : {1, 2}) {
        const SimplexSpace space(bar, order);
        for (int node = 0; node < space.tet_nodes().cols(); ++node) {
            const auto* ends = SimplexSpace::edge_corners[std::max(node - 4, 0)];
            const Vec3 point = node < 4 ? corners[node] : Vec3((corners[ends[0]] + corners[ends[1]]) / 2.0);
            const Eigen::VectorXd expected = Eigen::VectorXd::Unit(space.tet_nodes().cols(), node);
            EXPECT_EQ(space.shape_values(point), expected) << "order " << order << ", node " << node;
        }
        // A function goes through eight roundings and the sum of ten. The terms of L_i (2 L_i - 1) and 4 L_i L_j add up to 3 in magnitude.
        EXPECT_NEAR(space.shape_values({0.1, 0.2, 0.3}).sum(), 1.0, test_support::rounding_error(8 + 10, 3.0));
    }
}

TEST(SimplexSpace, AffineValuesAtVerticesAreAffineOnAllNodes)
{
    const SimplexSpace space(bar, 2);
    Eigen::Matrix3d gradient;
    gradient << 1, 2, 3, -4, 5, 6, 7, -8, 9;
    const pbs::Positions expected = space.node_positions() * gradient.transpose();
    // There are three products and sums on both sides, and the mean of two.
    const pbs::Positions terms = space.node_positions().cwiseAbs() * gradient.cwiseAbs().transpose();
    EXPECT_LT((space.from_vertices(bar.rest * gradient.transpose()) - expected).norm(),
              test_support::rounding_error(3 + 3 + 1, terms.norm()));
}

TEST(SimplexSpace, RefusesAnElementOrderItDoesNotHave)
{
    EXPECT_THROW(SimplexSpace(bar, 0), pbs::InputError);
    EXPECT_THROW(SimplexSpace(bar, 3), pbs::InputError);
}

TEST(SimplexSpace, RefusesDegenerateMeshes)
{
    pbs::TetMesh inverted = bar, flat = bar, unused = bar, out_of_range = bar, not_finite = bar;
    std::swap(inverted.tets(4, 0), inverted.tets(4, 1));
    flat.rest.row(flat.tets(0, 3)) = flat.rest.row(flat.tets(0, 2));
    unused.rest.conservativeResize(bar.rest.rows() + 1, 3);
    unused.rest.bottomRows(1).setZero();
    out_of_range.tets(2, 1) = static_cast<int>(bar.rest.rows());
    not_finite.rest(3, 1) = std::nan("");
    for (const auto& mesh : {inverted, flat, unused, out_of_range, not_finite, pbs::TetMesh{}})
        EXPECT_THROW(SimplexSpace(mesh, 1), pbs::InputError);
}

}  // namespace
