// Reference: the definition of a colouring, checked tet by tet.
#include "pbs/packed/vertex_order.hpp"

#include "tests/support/structured_bar.hpp"
#include "tests/support/tet_rings.hpp"

#include <gtest/gtest.h>

namespace {

// The colour of each vertex, -1 for none; a vertex with two colours is a failure.
std::vector<int> colour_of_vertex(const std::vector<std::vector<int>>& colours, int vertices)
{
    std::vector<int> colour_of(vertices, -1);
    for (std::size_t colour = 0; colour < colours.size(); ++colour)
        for (const int vertex : colours[colour]) {
            EXPECT_EQ(colour_of[vertex], -1) << vertex;
            colour_of[vertex] = static_cast<int>(colour);
        }
    return colour_of;
}

void expect_colouring(const pbs::Tets& tets, int vertices)
{
    const std::vector<int> colour_of = colour_of_vertex(pbs::vertex_colours(tets, vertices), vertices);
    for (const int colour : colour_of) EXPECT_GE(colour, 0);
    for (const auto& tet : tets.rowwise())
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < i; ++j) EXPECT_NE(colour_of[tet(i)], colour_of[tet(j)]);
}

TEST(VertexColours, NoTwoVerticesOfATetHaveOneColour)
{
    const pbs::TetMesh bar = test_support::structured_bar({-1, -1, -1}, {1, 1, 1}, {5, 4, 3});
    expect_colouring(bar.tets, static_cast<int>(bar.rest.rows()));
    expect_colouring(test_support::shuffled(bar.tets, static_cast<int>(bar.rest.rows()), 5), static_cast<int>(bar.rest.rows()));
    expect_colouring(test_support::tet_ring(7, true), 9);
}

// A vertex has at most 14 neighbours in Kuhn's split.
TEST(VertexColours, AreAtMostOneMoreThanTheLargestNumberOfNeighbours)
{
    const pbs::TetMesh bar = test_support::structured_bar({-1, -1, -1}, {1, 1, 1}, {6, 6, 6});
    EXPECT_LE(pbs::vertex_colours(bar.tets, static_cast<int>(bar.rest.rows())).size(), 15u);
}

TEST(VertexColours, OfOneTetAreFour)
{
    const pbs::Tets tet = test_support::tet_ring(1, false);
    EXPECT_EQ(pbs::vertex_colours(tet, 4).size(), 4u);
}

TEST(VertexColours, AVertexWithoutTetsHasTheFirstColour)
{
    const auto colours = pbs::vertex_colours(test_support::tet_ring(1, false), 5);
    EXPECT_EQ(colour_of_vertex(colours, 5)[4], 0);
}

TEST(VertexColours, OfNoVertexAreNone)
{
    EXPECT_TRUE(pbs::vertex_colours(pbs::Tets(0, 4), 0).empty());
}

}  // namespace
